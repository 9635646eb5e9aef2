"""Richardson's extrapolation to zero spacing, with an error bar of its own."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike


class Extrapolated(NamedTuple):
    """Values at zero spacing and their error bars, in the unit and shape (...) of the data."""

    value: np.ndarray
    error: np.ndarray


def richardson(values: ArrayLike, order: float) -> Extrapolated:
    """Extrapolate values at the spacings s, 2 s and 4 s to zero spacing.

    Parameters
    ----------
    values : (3, ...) array_like
        The finest first.
    order : float
        p > 0: the values are off by about c s^p; values off by exactly c s^p are extrapolated
        exactly, and ``error`` is then the change from 2 s to s.

    Notes
    -----
    The value is f(s) + (f(s) - f(2s)) / (2^p - 1). Its bar is the largest of three signs of the
    distance from the limit: the change from 2 s to s; that from 4 s to 2 s, carried on by the
    order; and the disagreement of the extrapolations from (s, 2 s) and (2 s, 4 s). The edge of a
    contact jumps from node to node, and any one of them may be small by chance. P. J. Roache, J.
    Fluids Eng. 116 (1994) 405, asks for three times the correction where the order is only
    believed, which for second order is the first of these.
    """
    fine, middle, coarse = np.asarray(values, float)
    gain = 2.0**order - 1
    value = fine + (fine - middle) / gain
    from_coarse = middle + (middle - coarse) / gain
    signs = [fine - middle, (middle - coarse) / 2.0**order, value - from_coarse]
    return Extrapolated(value, np.max(np.abs(signs), axis=0))
