"""Points and triangles on a regular grid: repeats, tilt, overhangs, spacing, interpolation."""
