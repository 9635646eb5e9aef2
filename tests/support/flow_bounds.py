"""Bounds that the flow through any gap keeps, whatever solves it, and its face values."""

import numpy as np


def face_values(a, b, faces):
    """Conductivities of faces between apertures a and b, 0 where one of them is."""
    with np.errstate(divide="ignore", invalid="ignore"):
        if faces == "linear":
            values = 2 * a**2 * b**2 / (a + b)
        else:
            values = 2 / (a**-3.0 + b**-3.0)
    return np.where((a > 0) & (b > 0), values, 0.0)


def transmissivity_bounds(gap, axis, faces="mean"):
    """Lower and upper bound of the transmissivity along an axis, mm3, with the same face values.

    The lower bound has walls between the rows of cells along the flow: in each row the faces
    are in series, and the rows are parallel. The upper bound has even pressure across the flow: the
    faces of each cross-section are parallel, and the cross-sections are in series.
    """
    if faces == "mean":
        both = [transmissivity_bounds(gap, axis, one) for one in ("harmonic", "linear")]
        return tuple(float(end) for end in np.mean(both, axis=0))
    turned = np.moveaxis(gap, axis, -1)
    ends = [2 * turned[:, side] ** 3 for side in (slice(1), slice(-1, None))]
    inner = face_values(turned[:, 1:], turned[:, :-1], faces)
    conductances = np.concatenate([ends[0], inner, ends[1]], axis=1) / 12
    with np.errstate(divide="ignore"):  # a wall in a strip makes its harmonic mean 0
        lower, upper = (1 / (1 / c).sum(axis=-1) for c in (conductances, conductances.mean(axis=0)))
    n = turned.shape[1]
    return float(n * lower.mean()), float(n * upper)
