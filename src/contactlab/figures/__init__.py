"""Figures of the laboratory: accuracy and speed, and experiments on synthetic surfaces."""
