"""Profiles: heights along a line, of a table whose two columns are named x and z with units."""

from pathlib import Path

import numpy as np

from ..core.errors import InputError
from ..core.units import length_factor
from .columns import read_columns

#: Steps may differ from their mean by this part of it.
_EVEN = 0.01


def read_profile(path: Path | str) -> tuple[np.ndarray, float]:
    """Heights of a profile in even steps.

    Parameters
    ----------
    path : path-like
        Text: a line such as ``x [mm], z [um]``, then numbers, x ascending in even steps.

    Returns
    -------
    heights : (n,) ndarray
        mm.
    spacing : float
        mm.

    Raises
    ------
    InputError
        As :func:`scan.columns.read_columns`, or if its x do not rise in even steps.
    """
    columns = read_columns(path, {"x": "x", "z": "z"}).values()
    x, z = (one.values * length_factor(one.unit, one.where) for one in columns)
    steps = np.diff(x)
    even = x.size > 1 and steps.min() > 0 and np.ptp(steps) <= 2 * _EVEN * steps.mean()
    if not even:
        raise InputError(
            f"{path}: x does not rise in even steps (within {100 * _EVEN:.0f} %); resample the "
            "profile to even steps and fill its gaps"
        )
    return z, float(steps.mean())
