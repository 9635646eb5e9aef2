"""Gridded heights that are hardly those of a rough surface, named in sentences.

Coordinates, profiles drawn out, planes, two tables in one file, hardly any cell measured: none of
them need be wrong, all of them mostly are.
"""

import numpy as np

from ..core.errors import InputError
from ..core.mean_plane import without_mean_plane
from ..core.text import percent

#: Relief that arithmetic, or the seven digits of single precision, leaves of an exact plane.
_PLANE = 1e-6
#: From here on so few cells are measured that the user should hear of it.
MANY_MISSING = 0.5
#: Rows differ more across a seam, in units of the median difference of neighbouring rows ...
_SEAM = 10.0
#: ... and by this many times the next largest difference: relief has no single cut right across.
_NEXT = 3.0
#: Fewer cells in a row that both rows have say nothing of a seam.
_MIN_IN_ROW = 8
#: Cells of a row that are looked at for that, spread over it.
_SAMPLE = 500


def refuse_coordinates(heights: np.ndarray, path: object) -> None:
    """Refuse coordinates: numbers that are alike along one axis and go one way along the other.

    Parameters
    ----------
    heights : (ny, nx) ndarray
        mm, NaN where missing; not constant.
    path : path-like
        The file, for errors.

    Raises
    ------
    InputError
    """
    for along, across, z in (("y", "x", heights), ("x", "y", heights.T)):
        profile = _common_profile(z)
        if profile is not None and _goes_one_way(profile):
            raise InputError(
                f"{path}: all heights are equal along {along} and rise or fall steadily along "
                f"{across}: these are coordinates or a bare slope, no rough surface; name the "
                "array or the columns of the heights in the sidecar ('variable', 'columns')"
            )


def doubts(heights: np.ndarray) -> list[str]:
    """Suspicions about heights on a grid, one sentence each.

    Parameters
    ----------
    heights : (ny, nx) ndarray
        mm, NaN where missing; not constant.
    """
    found = []
    missing = float(np.isnan(heights).mean())
    if missing > MANY_MISSING:
        found.append(
            f"{percent(missing)} of the cells are missing; look at the file in the program that "
            "wrote it, and check 'missing' and the columns in the sidecar"
        )
    for along, z in (("y", heights), ("x", heights.T)):
        if _common_profile(z) is not None:
            found.append(
                f"every height is the same all along {along}: a profile drawn out, not a scanned "
                "surface"
            )
            return found
    levelled = without_mean_plane(heights)
    present = np.isfinite(levelled)
    if present.any() and np.ptp(levelled[present]) <= _PLANE * np.ptp(heights[present]):
        found.append(
            "all heights lie on one plane to within rounding: this file has no roughness, and "
            "results on it would be rounding errors"
        )
        return found
    for line, z in (("rows", heights), ("columns", heights.T)):
        if (seam := _seam(z)) is not None:
            place, factor = seam
            found.append(
                f"{line} {place} and {place + 1} differ {factor:.0f} times as much as neighbouring "
                f"{line} usually do, all along: two tables in one file, or two scans side by "
                "side? Cut them apart"
            )
    return found


def _goes_one_way(profile: np.ndarray) -> bool:
    rises = np.diff(profile[np.isfinite(profile)])
    return bool((rises > 0).all() or (rises < 0).all())


def _common_profile(z: np.ndarray) -> np.ndarray | None:
    """The row that all rows repeat, None if they differ."""
    known = np.isfinite(z)
    filled = np.where(known, z, np.inf).min(axis=0), np.where(known, z, -np.inf).max(axis=0)
    if (known.sum(axis=0) < 2).any() or not np.array_equal(*filled):
        return None
    return filled[0]


def _seam(z: np.ndarray) -> tuple[int, float] | None:
    """The row after which all heights change at once, and how much more than elsewhere."""
    z = z[:, :: max(1, z.shape[1] // _SAMPLE)]
    steps = np.abs(np.diff(z, axis=0))
    known = np.isfinite(steps).sum(axis=1) >= _MIN_IN_ROW
    if known.sum() < _MIN_IN_ROW:
        return None
    # The lower quartile along the row: nearly all cells must take part.
    size = np.zeros(len(steps))
    size[known] = np.nanquantile(steps[known], 0.25, axis=1)
    usual = float(np.median(size[known]))
    first = int(np.argmax(size))
    next_most = float(np.delete(size, first).max())
    if usual == 0 or size[first] < max(_SEAM * usual, _NEXT * next_most):
        return None
    return first + 1, float(size[first] / usual)
