"""Orders of convergence and exponents of growth: slopes of fitted lines with their intervals."""

from collections.abc import Sequence

import numpy as np

from ..core.fitting import LineFit
from ..core.intervals import INTERVAL
from ..core.labels import cf_attrs


def slope_variables(
    name: str, dims: Sequence[str], shape: Sequence[int], lines: Sequence[LineFit], words: str
) -> dict[str, tuple]:
    """Slopes of fitted lines and the ends of their intervals, as ``xr.Dataset`` takes them.

    Parameters
    ----------
    name : str
        Of the slopes; the ends of their 95 % intervals are called ``NAME_low`` and ``NAME_high``.
    dims : sequence of str
    shape : sequence of int
        Lengths of the dimensions; the lines are in C order.
    lines : sequence of LineFit
    words : str
        Long name.

    Returns
    -------
    dict of str to (dims, ndarray, dict)
    """
    variables = {}
    for ending, which in zip(INTERVAL, ("slope", "slope_low", "slope_high"), strict=True):
        slopes = np.reshape([getattr(line, which) for line in lines], shape)
        variables[f"{name}{ending}"] = (dims, slopes, cf_attrs("1", f"{words}{INTERVAL[ending]}"))
    return variables
