"""Commands of the laboratory, run by `python -m`."""
