"""Commands: check scans, draft studies and sidecars, verify results, export, compile kernels."""
