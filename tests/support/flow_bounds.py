"""Bounds that the flow through any gap keeps, whatever solves it."""

import numpy as np


def transmissivity_bounds(gap, axis):
    """Lower and upper bound of the transmissivity along an axis, mm3.

    The lower bound has walls between the rows of cells along the flow: in each row the cells
    are in series, and the rows are parallel. The upper bound has even pressure across the flow: the
    cells of each cross-section are parallel, and the cross-sections are in series.
    """
    cubed = np.moveaxis(gap, axis, -1) ** 3 / 12
    with np.errstate(divide="ignore"):  # a wall in a strip makes its harmonic mean 0
        lower, upper = (1 / (1 / one).mean(axis=-1) for one in (cubed, cubed.mean(axis=0)))
    return float(lower.mean()), float(upper)
