"""Commands: check scans, verify results, compile kernels."""
