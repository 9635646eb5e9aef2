"""Ordinary box-counting dimension: the least-squares slope of the minimal cover.

Boxes of 1, 2, 4, ... cells, every grid origin tried, a straight line through log N over log r
between the cut-offs: the box counting of textbooks, without a model of the counts.
"""

from dataclasses import dataclass

import numpy as np

from ..core.estimate import DIMENSION, IN_PLANE, Estimate, Scale
from ..core.fitting import fit_line
from ..core.limits import MIN_NODES
from ..core.ranges import within
from ..core.slope_of_sums import BLOCKS, wave_error
from .box_counts import mean_count
from .cut_offs import between_cut_offs
from .mean_law import block_error, count_slope


@dataclass(frozen=True, kw_only=True)
class OrdinaryDimension(Estimate):
    """Ordinary dimension, its box sizes (2^k cells to half of the window) and their counts."""

    sizes: np.ndarray
    counts: np.ndarray
    used: np.ndarray
    scale: Scale = DIMENSION


def dyadic_sizes(shape: tuple[int, ...]) -> np.ndarray:
    """Powers of two to half of the shorter side of a window, cells; at least 1."""
    return 2 ** np.arange(max(int(np.log2(min(shape) / 2) + 1e-9), 0) + 1)


def ordinary_dimension(
    extent: np.ndarray,
    shape: tuple[int, int],
    sizes: np.ndarray,
    count: np.ndarray,
    limits: tuple[float, float] = (0, np.inf),
) -> OrdinaryDimension:
    """Ordinary box-counting dimension of a domain, from its minimal cover at :func:`dyadic_sizes`.

    The interval is that of :mod:`core.slope_of_sums`, by the mean counts at the same sizes; none
    with fewer than `MIN_NODES` nodes. ``extent`` is the domain without empty rows and columns about
    it, ``shape`` its window; ``limits`` are the smallest and largest box side that may be fitted,
    cells.
    """
    nodes = int(np.count_nonzero(extent))
    used = cover_used(count, sizes, nodes, shape, limits)
    line = fit_line(np.log(sizes[used]), np.log(count[used]))
    slope = line.slope
    if nodes < 2 or not np.isfinite(slope.value):
        unused = np.zeros(sizes.size, bool)
        return OrdinaryDimension(sizes=sizes, counts=count, used=unused)
    parts = mean_count(extent, sizes[used], blocks=BLOCKS)
    error = block_error(parts, lambda left: count_slope(left, sizes[used]))
    law = line.intercept.value + slope.value * np.log(sizes[used])
    half = np.hypot(error, wave_error(sizes[used], np.log(count[used]) - law))
    half = half if nodes >= MIN_NODES and np.isfinite(half) else np.nan
    ends = np.clip((-slope.value - half, -slope.value + half), *IN_PLANE)
    return OrdinaryDimension(
        value=0.0 - slope.value,  # a constant count gives 0, not -0
        low=float(ends[0]),
        high=float(ends[1]),
        n=slope.n,
        over=(float(sizes[used][0]), float(sizes[used][-1])),
        sizes=sizes,
        counts=count,
        used=used,
    )


def cover_used(
    count: np.ndarray,
    sizes: np.ndarray,
    nodes: int,
    shape: tuple[int, ...],
    limits: tuple[float, float] = (0, np.inf),
) -> np.ndarray:
    """True for sizes between the cut-offs and within the requested range."""
    return between_cut_offs(count, sizes, nodes, shape)[0] & within(sizes, *limits)
