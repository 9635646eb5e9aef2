"""Errors, units, intervals, line fits and atomic files, used by every room."""
