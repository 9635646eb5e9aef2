"""Surfaces: measured specimens, their cleaning and window, and synthetic ones."""
