"""Outliers and holes of a scan: marked by a stated rule, altered only when the study asks."""

import numpy as np
import xarray as xr
from scipy import ndimage

from ..core.errors import InputError
from ..core.mean_plane import without_mean_plane
from ..core.strips import strips
from ..core.window import spacing_of
from .suspect import Suspects, find_suspects

#: Treatments of outlying cells, values of the key ``outliers``.
_TREATED = {
    "keep": "kept",
    "mask": "made missing",
    "fill": "filled, with lone spikes and deep overlaps",
}
#: Side, in cells, of the square with which a cell is compared, and fewest cells present in it: a
#: cluster of 3 x 3 spikes is then a minority that can be set aside, and some cells remain.
_SIDE = 7
_LARGEST_CLUSTER = 9
_FEWEST = 25
#: Least distance of a spike, in typical distances of a cell from the median of its surroundings.
#: Self-affine surfaces with H from 0.3 to 1 have such cells in fewer than one of 10^5.
_MANY_DEVIATIONS = 8.0
#: Least distance of a spike in reliefs of its own surroundings: rough rock has patches far rougher
#: than the rest, with honest steps.
_MANY_RELIEFS = 3.0
_NORMAL = 1.4826  # standard deviation of a normal distribution / its median absolute deviation


def clean_faces(
    scans: list[xr.DataArray],
    *,
    outliers: str = "keep",
    largest_hole: int = 0,
    judged: bool = True,
    name: str = "specimen",
) -> tuple[list[xr.DataArray], dict[str, np.ndarray], dict]:
    """Suspicious cells of the scanned faces counted, masked or filled, and small holes filled.

    Scans are heights (y, x) in mm on one grid, the lower face first. ``outliers`` "keep" leaves
    outliers as they are, "mask" makes them missing, and "fill" puts the harmonic surface in place
    of outliers, lone spikes and deep overlaps (of the face that stands off more), see
    `surface.suspect`. ``largest_hole`` is the rows and columns of the largest hole that is filled.
    ``judged`` is False of a synthetic surface: no suspicious cells are looked for where they would
    be kept.

    Returned are the faces; masks (y, x) of cells: ``outlier``, ``spike`` and ``filled``, in any of
    the faces; ``overlap`` of the faces as they are now; ``sparse``, far from any point measured, of
    any face; ``suspect_lower`` and, of two faces, ``suspect_upper``: all of these, of an overlap
    the deep ones; and the attributes ``outliers``, ``outlier_count``, ``spike_count``,
    ``filled_count`` and, in words, ``cleaning``.
    """
    if outliers not in _TREATED:
        allowed = ", ".join(repr(value) for value in _TREATED)
        raise InputError(f"{name}: key 'outliers' is {outliers!r}; expected one of {allowed}")
    if isinstance(largest_hole, bool) or not isinstance(largest_hole, int) or largest_hole < 0:
        raise InputError(
            f"{name}: key 'fill_holes' is {largest_hole!r}; expected a number of cells, or 0"
        )
    if judged or outliers != "keep":
        outlying, suspects = [find_outliers(scan.values) for scan in scans], find_suspects(scans)
    else:
        none = np.zeros(scans[0].shape, dtype=bool)
        outlying, suspects = [none] * len(scans), Suspects([none] * len(scans), none, none, [])
    removed = _removed(outlying, suspects, outliers)
    faces, filled = _refilled(scans, removed, outliers, largest_hole)
    overlap, deep = suspects.overlap, suspects.deep
    if outliers == "fill":
        left = find_suspects(faces)
        if left.deep.any():  # both faces stand off there
            removed = [cells | left.deep for cells in removed]
            faces, filled = _refilled(scans, removed, outliers, largest_hole)
            left = find_suspects(faces)
        overlap, deep = left.overlap, left.deep
    overlap, deep = (
        cells & np.logical_and.reduce([np.isfinite(face.values) for face in faces])
        for cells in (overlap, deep)
    )
    sparse = [_sparse(scan) for scan in scans]
    marks = zip(outlying, suspects.spikes, filled, sparse, strict=True)
    suspicious = [np.logical_or.reduce([*cells, deep]) for cells in marks]
    cells = {
        "outlier": np.logical_or.reduce(outlying),
        "spike": np.logical_or.reduce(suspects.spikes),
        "filled": np.logical_or.reduce(filled),
        "sparse": np.logical_or.reduce(sparse),
        "overlap": overlap,
    }
    cells |= dict(zip(("suspect_lower", "suspect_upper"), suspicious, strict=False))
    attrs: dict[str, str | int] = {"outliers": outliers}
    attrs |= {f"{key}_count": int(cells[key].sum()) for key in ("outlier", "spike", "filled")}
    missing = int(np.logical_or.reduce([np.isnan(face.values) for face in faces]).sum())
    return faces, cells, attrs | {"cleaning": _in_words(attrs, largest_hole, missing)}


def _removed(outlying, suspects: Suspects, outliers: str) -> list[np.ndarray]:
    """Cells of each face that are made missing, to be filled or not."""
    if outliers != "fill":
        return [cells & (outliers == "mask") for cells in outlying]
    removed = [a | b for a, b in zip(outlying, suspects.spikes, strict=True)]
    if len(removed) == 2:
        lower, upper = suspects.standing
        # Where neither stands off, neither is more likely to be wrong.
        removed[0] |= suspects.deep & (lower >= upper)
        removed[1] |= suspects.deep & (upper >= lower)
    return removed


def _refilled(scans, removed, outliers, largest_hole):
    """Faces without removed cells and with holes filled; the mask of filled cells."""
    faces, filled = [], []
    for scan, cells in zip(scans, removed, strict=True):
        heights = np.where(cells, np.nan, scan.values)
        again = cells if outliers == "fill" else None
        heights, new = fill_holes(heights, spacing_of(scan), largest_hole, again)
        faces.append(scan.copy(data=heights))
        filled.append(new)
    return faces, filled


def _sparse(scan: xr.DataArray) -> np.ndarray:
    """Cells of a gridded cloud far from any point; none for other scans."""
    if "sparse" not in scan.coords:
        return np.zeros(scan.shape, dtype=bool)
    return scan["sparse"].values.astype(bool) & np.isfinite(scan.values)


def _in_words(attrs: dict, largest_hole: int, missing: int) -> str:
    """Treatment of the faces, and the keys that change it."""
    return (
        f"{attrs['outlier_count']} outlying cells {_TREATED[attrs['outliers']]} ('outliers: "
        f"{attrs['outliers']}'); {attrs['spike_count']} lone spikes; {attrs['filled_count']} cells "
        f"filled ('fill_holes: {largest_hole}'), {missing} missing"
    )


def find_outliers(heights: np.ndarray) -> np.ndarray:
    """Mask (ny, nx) of spikes of a scan in any unit: cells and clusters of up to 3 x 3.

    A cell's surroundings are the present cells of the 7 x 7 around it (at the rim of the scan, of
    the nearest 7 x 7 inside), of the surface without its mean plane. The nine highest and the nine
    lowest are set aside: a cluster of spikes is among them, while a step, a ridge or a slope has
    more cells than that on either level. A cell is an outlier if it lies above or below all that
    remain by more than 8 times the typical deviation of the scan (1.4826 times the median of
    |height - median of the surroundings|, as in the rule of Hampel 1974, and at least the step in
    which heights are recorded), and by more than 3 times the range of those that remain. A cell
    with fewer than 25 present cells around it is not judged.
    """
    flagged = np.zeros(heights.shape, dtype=bool)
    present = np.isfinite(heights)
    if min(heights.shape) < _SIDE or present.sum() < _FEWEST or np.ptp(heights[present]) == 0:
        return flagged
    # The plane is taken off because surroundings are one-sided at a rim.
    z = without_mean_plane(heights)
    deviation, margin, relief = _surroundings(z, present)
    if not np.isfinite(deviation).any():
        return flagged
    recorded_step = np.median(np.diff(np.unique(heights[present])))
    typical = max(_NORMAL * np.nanmedian(deviation), recorded_step)
    # A comparison with NaN, for a cell that is not judged, is False.
    flagged[present] = (margin > _MANY_DEVIATIONS * typical) & (margin > _MANY_RELIEFS * relief)
    return flagged


def _surroundings(z: np.ndarray, present: np.ndarray):
    """Distance of each present cell from the median of its surroundings, its distance beyond all
    but their extreme cells, and the range of those; NaN where too few cells are present.
    """
    windows = np.lib.stride_tricks.sliding_window_view(z, (_SIDE, _SIDE))
    surroundings = np.full((3, np.count_nonzero(present)), np.nan)
    start = 0
    for strip in strips(z.shape, _SIDE**2):
        rows, columns = np.nonzero(present[strip])
        rows += strip.start
        first_row, first_column = (
            np.clip(cells - _SIDE // 2, 0, n - _SIDE)
            for cells, n in zip((rows, columns), z.shape, strict=True)
        )
        ordered = windows[first_row, first_column].reshape(-1, _SIDE**2)
        ordered.sort(axis=1)  # missing cells come last
        count = np.isfinite(ordered).sum(axis=1)
        judged = np.flatnonzero(count >= _FEWEST)
        count = count[judged]
        own = z[rows, columns][judged]
        low, high = ordered[judged, _LARGEST_CLUSTER], ordered[judged, count - 1 - _LARGEST_CLUSTER]
        median = (ordered[judged, (count - 1) // 2] + ordered[judged, count // 2]) / 2
        surroundings[:, start + judged] = (
            np.abs(own - median),
            np.maximum(own - high, low - own),
            high - low,
        )
        start += len(rows)
    return surroundings


def fill_holes(
    heights: np.ndarray,
    spacing: tuple[float, float],
    largest: int,
    removed: np.ndarray | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Copy of heights (ny, nx) with small holes filled harmonically, and the mask of filled cells.

    A hole is a set of missing cells connected along rows and columns. It is filled if it does not
    touch the rim of the array and has at most ``largest`` rows and columns; the other missing cells
    stay missing. The surface solves the five-point Laplace equation with the cells around the hole
    as its boundary values, so it has no extremum of its own. The spacing is (dy, dx).

    Holes of ``removed`` cells are filled whatever their size, where they hold no other missing
    cells and do not touch the rim.
    """
    fillable = _small_holes(~np.isfinite(heights), largest, removed)
    filled = heights.copy()
    if fillable.any():
        filled[fillable] = _harmonic(heights, fillable, spacing)
    return filled, fillable


def _small_holes(
    missing: np.ndarray, largest: int, removed: np.ndarray | None = None
) -> np.ndarray:
    """Missing cells of the holes that may be filled."""
    labels, _ = ndimage.label(missing)
    fillable = np.zeros(missing.shape, dtype=bool)
    for label, box in enumerate(ndimage.find_objects(labels), 1):
        hole = labels[box] == label
        inside = all(s.start > 0 and s.stop < n for s, n in zip(box, missing.shape, strict=True))
        small = all(s.stop - s.start <= largest for s in box)
        if inside and (small or (removed is not None and removed[box][hole].all())):
            fillable[box] |= hole
    return fillable


def _harmonic(heights: np.ndarray, unknown: np.ndarray, spacing) -> np.ndarray:
    """Solve the discrete Laplace equation on the unknown cells, row by row of the array."""
    from scipy import sparse
    from scipy.sparse.linalg import spsolve

    rows, columns = np.nonzero(unknown)
    index = np.full(heights.shape, -1)
    index[unknown] = np.arange(len(rows))
    weights = [1 / step**2 for step in spacing]
    level = heights[np.isfinite(heights)].mean()  # an offset must not cost digits
    right = np.zeros(len(rows))
    entries = [(np.full(len(rows), 2 * sum(weights)), index[unknown], index[unknown])]
    for step_y, step_x in ((-1, 0), (1, 0), (0, -1), (0, 1)):
        weight = weights[0 if step_y else 1]
        neighbours = (rows + step_y, columns + step_x)
        given = ~unknown[neighbours]
        right[given] += weight * (heights[neighbours][given] - level)
        equation, neighbour = np.flatnonzero(~given), index[neighbours][~given]
        entries.append((np.full(len(equation), -weight), equation, neighbour))
    values, equation, neighbour = (np.concatenate(parts) for parts in zip(*entries, strict=True))
    matrix = sparse.csc_array((values, (equation, neighbour)), shape=(len(rows), len(rows)))
    return level + spsolve(matrix, right)
