"""Means over the sub-windows of each size, and their power laws, into a dataset."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from ..core.estimate import Estimate
from ..core.fitting import fit_line
from ..core.intervals import mean_interval
from ..core.labels import cf_attrs
from ..states.states import error_attrs


def add_mean(
    result: xr.Dataset, name: str, values: xr.DataArray, errors: xr.DataArray | None = None
) -> None:
    """Mean over the sub-windows with its interval, into ``result``.

    Parameters
    ----------
    result : xr.Dataset
        Gets ``name``, ``_low`` and ``_high`` and, with ``errors``, ``_error``.
    values : xr.DataArray (..., window, ...)
        Labelled; NaN where missing.
    errors : xr.DataArray, optional
        Solver error bounds of the values: their mean bounds that of the mean.
    """
    dims = tuple(dim for dim in values.dims if dim != "window")
    units, long_name = values.attrs["units"], values.attrs["long_name"]
    words = f"{long_name}, mean over sub-windows"
    mean = mean_interval(values.values, axis=values.dims.index("window"))
    result.update(mean.variables(name, dims, units, words))
    if errors is not None:
        result[f"{name}_error"] = errors.mean("window").transpose(*dims)
        result[f"{name}_error"].attrs = error_attrs(cf_attrs(units, words))


def add_law(
    result: xr.Dataset, name: str, side: xr.DataArray, values: xr.DataArray, words: str
) -> None:
    """Exponent of positive values against the side b, into ``result``.

    Parameters
    ----------
    result : xr.Dataset
        As :func:`add_exponents` fills it.
    side : xr.DataArray (size,)
        b, mm, along the dimension of the sizes.
    values : xr.DataArray (..., size, ...)
        Those that are not positive, or missing, are left out.
    words : str
        What the exponent is of.
    """
    (size,) = side.dims
    dims = tuple(str(dim) for dim in values.dims if dim != size)
    rows = values.transpose(*dims, size).values
    positive = np.where(rows > 0, rows, np.nan)
    lines = [
        fit_line(np.log(side.values), np.log(positive[index]))
        for index in np.ndindex(rows.shape[:-1])
    ]
    add_exponents(result, name, [line.slope for line in lines], dims, words, "sizes fitted")


def power_through(
    values: xr.DataArray, side: xr.DataArray, exponent: xr.DataArray, words: str
) -> xr.DataArray:
    """Power of b with a known exponent through the middle of values on logarithmic axes.

    Parameters
    ----------
    values : xr.DataArray (..., size, ...)
        Those that are not positive, or missing, are left out.
    side : xr.DataArray (size,)
        b, mm.
    exponent : xr.DataArray
    words : str
        What the line is.

    Returns
    -------
    xr.DataArray
        As ``values``, missing where these are left out or the exponent is unknown.
    """
    positive, (size,) = values.where(values > 0), side.dims
    powers = exponent * xr.ufuncs.log(side)
    level = (xr.ufuncs.log(positive) - powers).mean(size)
    line = xr.ufuncs.exp(powers + level).where(positive.notnull())
    return line.transpose(*values.dims).assign_attrs(cf_attrs(values.attrs["units"], words))


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
