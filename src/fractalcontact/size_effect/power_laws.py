"""Power laws of the side b of sub-windows: exponents with their intervals, into a dataset."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from ..core.estimate import Estimate
from ..core.labels import cf_attrs


def add_exponents(
    result: xr.Dataset,
    name: str,
    exponents: Sequence[Estimate],
    dims: str | tuple[str, ...],
    words: str,
    points: str = "points fitted",
) -> None:
    """Exponents by lines through logarithms over log b, into ``result``.

    Parameters
    ----------
    result : xr.Dataset
        Gets ``name`` with the ends of its interval, ``_n`` and the smallest and largest b fitted,
        ``_b_min`` and ``_b_max``.
    exponents : sequence of Estimate
        Fitted over log b, b in mm; in the order of a C array over ``dims``.
    dims : str or tuple of str
        Of ``result``.
    words : str
        What the exponent is of.
    points : str
        What was fitted.
    """
    over = (dims,) if isinstance(dims, str) else dims
    found = Estimate.stack(exponents, tuple(result.sizes[dim] for dim in over))
    first, last = np.exp(found.over)
    result.update(found.variables(name, over, "1", words))
    result[f"{name}_n"] = (over, found.n, cf_attrs("1", f"{words}, {points}"))
    result[f"{name}_b_min"] = (over, first, cf_attrs("mm", "smallest b of that fit"))
    result[f"{name}_b_max"] = (over, last, cf_attrs("mm", "largest b of that fit"))
