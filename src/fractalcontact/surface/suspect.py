"""Suspicious cells of scanned faces: lone spikes, and places where two faces overlap."""

import json
from typing import NamedTuple

import numpy as np
import xarray as xr

from ..core.strips import blocks, strips

#: Least distance of a lone spike from the median of its eight neighbours, in typical distances of
#: the cells around it. On self-affine Gaussian surfaces with H from 0.2 to 0.8 none of 160 000
#: cells comes to 6.
ALONE = 8.0
#: The same distance of a spike that the other face confirms: it overlaps there, or the gap stands
#: off its surroundings as much.
CONFIRMED = 4.0
#: Least depth of a deep overlap, and least fall of the gap below the median of its eight
#: neighbours, in typical values: an error of the registration or of the mean gap, which neighbours
#: share, makes no such fall.
DEEP = 3.0
#: Fewest neighbours, and fewest cells around, of a cell that is judged.
_MIN_NEIGHBOURS, _MIN_AROUND = 5, 12
_HALF = 3  # cells to each side: the square around a cell is 7 x 7
_NORMAL = 1.4826  # standard deviation of a normal distribution / its median absolute deviation
#: Rounding of equal heights, as a fraction of the largest.
_ROUNDING = 1e-12
_NEIGHBOURS = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)]


class Suspects(NamedTuple):
    """Suspicious cells (ny, nx) bool of the scanned faces, by face, and of both together."""

    spikes: list[np.ndarray]
    """Lone spikes of each face."""
    overlap: np.ndarray
    """Upper face below the lower one; nowhere where its height is not known."""
    deep: np.ndarray
    """Overlap where the gap stands off its neighbours, too."""
    standing: list[np.ndarray]
    """Deviation of each face towards the other, over the typical deviation."""


def find_suspects(scans: list[xr.DataArray]) -> Suspects:
    """Lone spikes of one or two faces on one grid, the lower first, and cells that overlap.

    A cell of one face is a spike where it stands off the median of its eight neighbours by more
    than 8 times the typical deviation of a cell around it (1.4826 times the median of such
    deviations in the 7 x 7 around, at least that of the whole scan), or by more than 4 times where
    the other face confirms it: both cannot have been there.
    """
    ratios = [stand_off(scan.values) for scan in scans]
    spikes = [abs(ratio) > ALONE for ratio in ratios]
    empty = np.zeros(scans[0].shape, dtype=bool)
    towards = [sign * ratio for sign, ratio in zip((1, -1), ratios, strict=False)]
    if len(scans) == 1:
        return Suspects(spikes, empty, empty, towards)
    gap = scans[1].values - scans[0].values
    of_gap = stand_off(gap)
    overlap, deep = empty, empty
    if height_is_known(scans[1]):
        overlap = gap < -_ROUNDING * max(np.nanmax(abs(scan.values)) for scan in scans)
        deep = overlap & (np.maximum(gap, _deviation(gap)) < -DEEP * typical_deviation(gap))
    for spike, ratio in zip(spikes, towards, strict=True):
        # A cell that stands off towards the other face narrows the gap.
        confirmed = (overlap & (ratio > CONFIRMED)) | (
            (abs(ratio) > CONFIRMED) & (abs(of_gap) > CONFIRMED) & (ratio * of_gap < 0)
        )
        spike |= confirmed
    return Suspects(spikes, overlap, deep, towards)


def height_is_known(upper: xr.DataArray) -> bool:
    """True if the mean gap was measured; else the upper face was lowered until some cells touch.

    The attribute ``registration`` of :func:`registration.pairs.register` tells, if there is one.
    """
    record = json.loads(upper.attrs.get("registration", "{}"))
    return record.get("gap_mean_before_mm", 0.0) is not None


def stand_off(heights: np.ndarray) -> np.ndarray:
    """Deviation of each cell (ny, nx) from its neighbours, over the typical deviation nearby.

    It is positive upwards; 0 where the cell is missing, cannot be judged, or deviates by less than
    `CONFIRMED`.
    """
    deviation = _deviation(heights)
    typical = _typical(deviation, heights)
    result = np.zeros(heights.shape)
    if not typical > 0:
        return result
    rows, columns = np.nonzero(abs(deviation) > CONFIRMED * typical)
    padded = np.pad(abs(deviation), _HALF, constant_values=np.nan)
    side = 2 * _HALF + 1
    windows = np.lib.stride_tricks.sliding_window_view(padded, (side, side))
    for part in blocks(len(rows), side**2):
        places = rows[part], columns[part]
        around = windows[places].reshape(-1, side**2)
        around = np.sort(np.delete(around, side**2 // 2, axis=1), axis=1)  # missing ones come last
        counts = np.isfinite(around).sum(axis=1)
        local = _NORMAL * _middle(around.T, counts)
        ratio = deviation[places] / np.maximum(local, typical)
        result[places] = np.where(counts >= _MIN_AROUND, ratio, 0.0)
    return result


def typical_deviation(heights: np.ndarray) -> float:
    """Typical deviation of a cell from the median of its eight neighbours: 1.4826 times the median.

    At least the step in which heights are recorded; 0 of a plane without steps.
    """
    return _typical(_deviation(heights), heights)


def _typical(deviation: np.ndarray, heights: np.ndarray) -> float:
    sizes = abs(deviation[np.isfinite(deviation)])
    if not sizes.size:
        return 0.0
    levels = np.unique(heights[np.isfinite(heights)])
    step = float(np.median(np.diff(levels))) if levels.size > 1 else 0.0
    return max(_NORMAL * float(np.median(sizes)), step)


def _deviation(z: np.ndarray) -> np.ndarray:
    """Height above the median of the eight neighbours; NaN where fewer than five are present."""
    padded = np.pad(z, 1, constant_values=np.nan)
    deviation = np.empty(z.shape)
    for rows in strips(z.shape, len(_NEIGHBOURS)):
        ny, nx = rows.stop - rows.start, z.shape[1]
        part = padded[rows.start : rows.stop + 2]
        around = np.array([part[1 + i : 1 + i + ny, 1 + j : 1 + j + nx] for i, j in _NEIGHBOURS])
        around.sort(axis=0)
        counts = np.isfinite(around).sum(axis=0)
        middle = _middle(around, counts)
        deviation[rows] = np.where(counts >= _MIN_NEIGHBOURS, z[rows] - middle, np.nan)
    return deviation


def _middle(ordered: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """Median along the first axis of ascending values, of which the first ``counts`` are known."""
    low = np.maximum(counts - 1, 0) // 2
    pair = np.stack([low, np.minimum(np.maximum(counts, 1) // 2, len(ordered) - 1)])
    return np.take_along_axis(ordered, pair, axis=0).mean(axis=0)


def overlap_statistics(
    specimen: xr.Dataset, window: tuple[slice, slice]
) -> dict[str, tuple[float, float]]:
    """Overlap and gap of the two faces of a specimen, as pairs (scan, window).

    ``window`` is its rows and columns. The numbers are ``cells``, ``fraction`` (of the cells both
    faces have), ``depth`` (mm, the deepest), ``gap_mean`` and ``gap_sd`` (mm).
    """
    gap = specimen["upper"].values - specimen["lower"].values
    overlap = specimen["overlap"].values
    rows = []
    for place in ((slice(None), slice(None)), window):
        both = np.isfinite(gap[place])
        cells = int(overlap[place].sum())
        depth = float(-gap[place][overlap[place]].min()) if cells else 0.0
        gaps = gap[place][both]
        mean, spread = (gaps.mean(), gaps.std()) if gaps.size else (np.nan, np.nan)
        rows.append((cells, cells / max(gaps.size, 1), depth, float(mean), float(spread)))
    keys = ("cells", "fraction", "depth", "gap_mean", "gap_sd")
    return dict(zip(keys, zip(*rows, strict=True), strict=True))
