"""Other windows of the same scan: how far a quantity depends on where the window lies."""

import numpy as np
import xarray as xr

from ..core.intervals import t_quantile
from ..core.window import faces, window_slices
from ..joint.joint import DIRECTION_STEPS
from .loading import JointLoading

#: Windows compared, the specimen's own among them, and the largest overlap of any two.
MAX_WINDOWS, MAX_OVERLAP = 5, 0.5
#: Smallest area that the windows cover together, in windows; with less a spread says nothing.
MIN_EFFECTIVE = 2.5
#: Number of places tried along a window's side.
_PLACES = 16

#: Reason why there is no spread over windows.
TOO_SMALL = "the scan is not large enough for other windows of this size"


def whole_composite(specimen: xr.Dataset, direction: str, cells: int) -> np.ndarray:
    """Composite topography of the whole scan at an offset, mm; NaN where either face is missing.

    As :func:`joint.joint.composite_topography`, at the places of the upper face.
    """
    z_l, z_u = faces(specimen)
    slid = np.full(z_l.shape, np.nan)
    step_y, step_x = (step * int(cells) for step in DIRECTION_STEPS[direction])
    ny, nx = z_l.shape
    to_y, to_x = (
        slice(max(0, -step), n - max(0, step)) for step, n in ((step_y, ny), (step_x, nx))
    )
    from_y, from_x = (
        slice(max(0, step), n - max(0, -step)) for step, n in ((step_y, ny), (step_x, nx))
    )
    slid[to_y, to_x] = z_l[from_y, from_x]
    return slid - z_u


def window_places(present: np.ndarray, own: tuple[slice, slice]) -> tuple[list, float]:
    """Windows of the same size that overlap little, the specimen's own first, and their joint area.

    At most `MAX_WINDOWS`, no two of which share more than `MAX_OVERLAP` of their area: one after
    another that which overlaps least with those before. ``present`` has the cells that a window may
    hold; the area that they cover together is in windows.
    """
    rows, columns = (part.stop - part.start for part in own)
    missing = np.zeros(np.add(present.shape, 1), int)
    missing[1:, 1:] = np.cumsum(np.cumsum(~present, axis=0), axis=1)
    last_y, last_x = present.shape[0] - rows, present.shape[1] - columns
    y = np.unique(np.r_[0 : last_y + 1 : max(1, rows // _PLACES), last_y])
    x = np.unique(np.r_[0 : last_x + 1 : max(1, columns // _PLACES), last_x])
    top, left = (grid.ravel() for grid in np.meshgrid(y, x, indexing="ij"))
    holes = missing[top + rows, left + columns] - missing[top, left + columns]
    holes -= missing[top + rows, left] - missing[top, left]
    top, left = top[holes == 0], left[holes == 0]
    places, shared, most = [own], np.zeros(top.size), np.zeros(top.size)
    while top.size and len(places) < MAX_WINDOWS:
        row, column = places[-1][0].start, places[-1][1].start
        overlap = np.clip(1 - abs(top - row) / rows, 0, 1)
        overlap *= np.clip(1 - abs(left - column) / columns, 0, 1)
        shared += overlap
        most = np.maximum(most, overlap)
        best = int(np.argmin(shared + np.where(most > MAX_OVERLAP, np.inf, 0.0)))
        if most[best] > MAX_OVERLAP:
            break
        places.append((slice(top[best], top[best] + rows), slice(left[best], left[best] + columns)))
    covered = np.zeros(present.shape, bool)
    for place in places:
        covered[place] = True
    return places, float(covered.sum() / (rows * columns))


def other_composites(loading: JointLoading, cells: int) -> tuple[list[np.ndarray], float]:
    """Composite topographies of other windows at an offset, mm, and the area that all cover.

    The list is empty where the scan is too small. The area is in windows, the specimen's included.
    """
    specimen = loading.specimen
    whole = whole_composite(specimen, loading.direction, cells)
    places, effective = window_places(np.isfinite(whole), window_slices(specimen))
    if effective < MIN_EFFECTIVE:
        return [], effective
    return [whole[place] for place in places[1:]], effective


def window_spread(values: np.ndarray, effective: float) -> np.ndarray:
    """Half-width within which another window's value lies, at 95 %, from values (windows, ...).

    Student's t, of one degree of freedom less than independent windows (``effective``: what they
    cover together), times their standard deviation.
    """
    return t_quantile(effective - 1) * np.std(values, axis=0, ddof=1)
