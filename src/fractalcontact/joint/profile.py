"""Roughness of one profile: Z2, JRC by step and fit, and its dimension by roughness length."""

import numpy as np
import xarray as xr

from ..core.datasets import labelled
from ..core.slope_of_sums import slope_of_sums
from .jrc import roughness_of_profiles

#: Cells of the shortest window, and how many of the longest windows fit into the profile.
_SHORTEST, _MIN_WINDOWS = 8, 8
_BLOCKS = 8
_TABLE = {
    "range_min": ((), "mm", "shortest window of the roughness length"),
    "range_max": ((), "mm", "longest window of the roughness length"),
    "no_dimension": ((), "1", "why there is no dimension"),
}


def profile_coefficients(heights: np.ndarray, spacing: float) -> xr.Dataset:
    """Z2, JRC and Delta_g = 3 - H of a profile (n,), mm, H by the roughness length.

    As :func:`joint.jrc.profile_roughness`, over ``contact_direction`` "x" too;
    ``recommended_dimension`` with its interval is that of an isotropic surface with such profiles.
    Malinverno, Geophys. Res. Lett. 17 (1990) 1953: the variance about the line of windows of length
    b grows as b^(2H). Windows shorter than 8 cells are left out; nothing else is corrected.
    """
    x = np.arange(heights.size)
    levelled = heights - np.polyval(np.polyfit(x, heights, 1), x)
    longest = heights.size // _MIN_WINDOWS
    sides = np.unique(np.geomspace(_SHORTEST, max(longest, _SHORTEST), 12).astype(int))
    parts = np.array([_sums(levelled, side) for side in sides])
    exponent = slope_of_sums(sides * spacing, parts, lambda sums: sums[:, 0] / sums[:, 1])
    dimension = exponent.mapped(lambda slope: 3 - slope / 2, falling=True)
    roughness = roughness_of_profiles([levelled[:, None]], spacing).expand_dims(
        contact_direction=["x"]
    )
    values = {
        "range_min": exponent.over[0],
        "range_max": exponent.over[1],
        "no_dimension": "" if exponent.known else "the profile has too few cells for it",
    }
    words = ("1", "Delta_g = 3 - H of an isotropic surface with such profiles")
    return roughness.assign(
        dimension.variables("recommended_dimension", (), *words) | dict(labelled(_TABLE, values))
    )


def _sums(heights: np.ndarray, side: int) -> np.ndarray:
    """Variances about their lines of the windows of one length, and their numbers (2, blocks)."""
    count = heights.size // side
    start = heights.size % side // 2
    windows = heights[start : start + count * side].reshape(count, side)
    x = np.arange(side) - (side - 1) / 2
    about = windows - windows.mean(axis=1, keepdims=True)
    about = about - np.outer(about @ x / (x @ x), x)
    blocks = np.arange(count) * _BLOCKS // count
    sums = np.bincount(blocks, (about**2).sum(axis=1) / (side - 2), minlength=_BLOCKS)
    return np.array([sums, np.bincount(blocks, minlength=_BLOCKS)])
