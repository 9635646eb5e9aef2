"""Scan files of any kind as heights (y, x) in mm, with missing cells and provenance."""
