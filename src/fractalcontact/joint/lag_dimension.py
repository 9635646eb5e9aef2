"""Dimension of the composite topography over fixed lags, which compares offsets with each other.

The dimension over lags below the offset is that of the face, whatever the offset. Over lags that
stay the same the composite topography of matching faces changes: at offsets far below a lag it is a
derivative of the face, rougher than the face, and at offsets far above it has the face's own
dimension.
"""

from collections.abc import Sequence

import numpy as np

from ..core.datasets import labelled
from ..core.fitting import fit_line
from ..core.labels import cf_attrs
from ..roughness.dimension import on_square_cells
from ..roughness.estimators.variogram import variogram_curves
from ..roughness.fit_range import MIN_CELLS

#: Choices of lags: the whole range, and its shorter and longer half in logarithms.
LAG_RANGES = ("all", "short", "long")

#: Smallest number of lags in half the range.
MIN_LAGS = 4

_TABLE = {
    "lag_dimension": (
        ("offset", "lag_range"),
        "1",
        "dimension 3 - H of the composite topography over fixed lags, by its variogram",
    ),
    "lag_min": ("lag_range", "mm", "shortest lag of that dimension"),
    "lag_max": ("lag_range", "mm", "longest lag of that dimension"),
}


def lag_dimensions(
    composites: Sequence[np.ndarray], spacings: tuple[float, ...], longest: float
) -> dict[str, tuple]:
    """Dimension of composite topographies over fixed lags, from two cells to the longest, mm.

    ``lag_dimension`` (offset, lag_range), ``lag_min`` and ``lag_max`` (lag_range), mm, and the
    coordinate ``lag_range``, :data:`LAG_RANGES`, as ``xr.Dataset`` takes them. Cells have the sides
    (y, x) of ``spacings``, mm. Missing where the faces are flush.
    """
    spacing = max(spacings)
    longest = max(longest / spacing, MIN_LAGS * MIN_CELLS)
    lags = np.unique(np.round(np.geomspace(MIN_CELLS, longest, 2 * MIN_LAGS)).astype(int))
    middle = lags.size // 2
    parts = slice(None), slice(middle + 1), slice(middle, None)
    values = {
        "lag_dimension": np.array([_dimensions(h, spacings, lags, parts) for h in composites]),
        "lag_min": np.array([lags[part][0] for part in parts]) * spacing,
        "lag_max": np.array([lags[part][-1] for part in parts]) * spacing,
    }
    names = ("lag_range", list(LAG_RANGES), cf_attrs("1", "choice of lags"))
    return labelled(_TABLE, values) | {"lag_range": names}


def _dimensions(
    composite: np.ndarray, spacings: tuple[float, ...], lags: np.ndarray, parts: Sequence[slice]
) -> list[float]:
    """Dimension over each part of the lags, in cells, by half the slope of the variogram."""
    heights, spacing = on_square_cells(composite, spacings)
    square = variogram_curves(heights, spacing, lags)["both"].measure()
    logarithm = np.log(np.where(square > 0, square, np.nan))
    lines = [fit_line(np.log(lags[part]), logarithm[part]) for part in parts]
    return [3 - line.slope.value / 2 for line in lines]
