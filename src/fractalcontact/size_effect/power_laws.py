"""Power laws of the side b of sub-windows: exponents with their intervals, into a dataset."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from ..core.fitting import LineFit
from ..core.intervals import INTERVAL
from ..core.labels import cf_attrs


def add_exponents(
    result: xr.Dataset,
    name: str,
    lines: Sequence[LineFit],
    dims: str | tuple[str, ...],
    words: str,
    points: str = "points fitted",
) -> None:
    """Exponents by lines through logarithms over log b, into ``result``.

    Parameters
    ----------
    result : xr.Dataset
        Gets ``name`` with the ends ``_low``, ``_high`` of its interval, ``_n`` and the smallest and
        largest b fitted, ``_b_min`` and ``_b_max``.
    lines : sequence of LineFit
        Over log b, b in mm; in the order of a C array over ``dims``.
    dims : str or tuple of str
        Of ``result``.
    words : str
        What the exponent is of.
    points : str
        What was fitted.
    """
    over = (dims,) if isinstance(dims, str) else dims
    shape = tuple(result.sizes[dim] for dim in over)

    def put(ending: str, values: np.ndarray, units: str, long_name: str) -> None:
        result[f"{name}{ending}"] = (over, values.reshape(shape), cf_attrs(units, long_name))

    for ending, of_end in INTERVAL.items():
        slopes = np.array([getattr(line, f"slope{ending}") for line in lines], float)
        put(ending, slopes, "1", f"{words}{of_end}")
    put("_n", np.array([line.n for line in lines], int), "1", f"{words}, {points}")
    put("_b_min", np.exp([line.x_min for line in lines]), "mm", "smallest b of that fit")
    put("_b_max", np.exp([line.x_max for line in lines]), "mm", "largest b of that fit")
