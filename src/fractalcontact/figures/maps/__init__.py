"""Figures of measured contact maps."""
