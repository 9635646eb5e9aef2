"""Roughness of a surface: its dimension Delta_g, its spectrum, and the quality of a scan."""
