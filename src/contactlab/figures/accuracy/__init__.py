"""Figures of accuracy, speed and stability."""
