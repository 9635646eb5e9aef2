"""Roughness of a surface: its dimension Delta_g, its spectrum, and how good a scan is."""
