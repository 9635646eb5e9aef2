"""Figures over the specimens and groups of a study."""
