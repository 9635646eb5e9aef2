"""Figures of the experiments on synthetic surfaces."""
