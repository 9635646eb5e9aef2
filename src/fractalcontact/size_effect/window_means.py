"""Means over the sub-windows of each size, and their power laws, into a dataset."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ..core.estimate import Estimate
from ..core.fitting import fit_line
from ..core.intervals import mean_interval
from ..core.labels import cf_attrs
from ..core.per_curve import per_curve
from ..states.states import error_attrs


def add_mean(
    result: xr.Dataset, name: str, values: xr.DataArray, errors: xr.DataArray | None = None
) -> None:
    """Mean over the sub-windows with its interval, into ``result``.

    With solver error bounds of the values there is an ``_error``, too: the mean of the bounds is a
    bound of the mean.
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
    result: xr.Dataset,
    name: str,
    side: xr.DataArray,
    values: xr.DataArray,
    words: str,
    points: str = "sizes fitted",
) -> None:
    """Exponent of values (..., size, ...) against the side b (size,), mm, into ``result``.

    As :func:`add_exponents`. Values that are not positive, or missing, are left out.
    """
    add_exponents(result, name, {"values": values, "side": side}, _power, side.dims, words, points)


def _power(values: np.ndarray, side: np.ndarray) -> Estimate:
    """Exponent of one curve over the side b."""
    return fit_line(np.log(side), np.log(np.where(values > 0, values, np.nan))).slope


def power_through(
    values: xr.DataArray, side: xr.DataArray, exponent: xr.DataArray, words: str
) -> xr.DataArray:
    """Power of b with a known exponent through the middle of values on logarithmic axes.

    Values (..., size, ...) that are not positive, or missing, are left out, and so is the line
    there and where the exponent is unknown. Sides b (size,) in mm; ``words`` say what the line is.
    """
    positive, (size,) = values.where(values > 0), side.dims
    powers = exponent * xr.ufuncs.log(side)
    level = (xr.ufuncs.log(positive) - powers).mean(size)
    line = xr.ufuncs.exp(powers + level).where(positive.notnull())
    return line.transpose(*values.dims).assign_attrs(cf_attrs(values.attrs["units"], words))


def add_exponents(
    result: xr.Dataset,
    name: str,
    curves: Mapping[Any, xr.DataArray],
    function: Callable[..., Estimate],
    along: Sequence[Any],
    words: str,
    points: str,
) -> None:
    """Exponents against the side b of every curve, into ``result``.

    Parameters
    ----------
    result : xr.Dataset
        Gets ``name`` with the ends of its interval, ``_n`` and the smallest and largest b fitted,
        ``_b_min`` and ``_b_max``.
    curves, along
        As of :func:`core.per_curve.per_curve`.
    function : callable
        Exponent of one curve, fitted over log b, b in mm.
    words : str
        Name of the quantity whose exponent it is, in words.
    points : str
        Name of the fitted numbers, in words.
    """
    names = {
        name: ("1", words),
        f"{name}_n": ("1", f"{words}, {points}"),
        f"{name}_b_min": ("mm", "smallest b of that fit"),
        f"{name}_b_max": ("mm", "largest b of that fit"),
    }

    def of_curve(**curve: Any) -> dict[str, Any]:
        exponent = function(**curve)
        return dict(zip(names, (exponent, exponent.n, *np.exp(exponent.over)), strict=True))

    result.update(per_curve(curves, of_curve, names, along))
