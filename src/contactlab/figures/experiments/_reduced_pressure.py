"""The axis of p / (E* h'_rms) in figures of the experiment on the size effect."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import NullLocator


def load_axis(axes: Axes, loads: np.ndarray) -> None:
    """Logarithmic axis with ticks at the loads p / (E* h'_rms) that were solved, and no others."""
    axes.set_xscale("log")
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xticks(loads, [f"{load:g}" for load in loads])
