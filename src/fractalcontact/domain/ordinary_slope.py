"""The ordinary box-counting dimension: the least-squares slope of the minimal cover.

Boxes of 1, 2, 4, ... cells, every grid origin tried, a straight line through log N over log r
between the cut-offs: what a textbook calls box counting, without a model of the counts.
"""

from typing import NamedTuple

import numpy as np

from ..core.fitting import FEWEST_POINTS, fit_line
from ..core.ranges import within
from ..core.slope_of_sums import BLOCKS
from .box_counts import mean_count
from .cut_offs import between_cut_offs
from .mean_law import block_error


class OrdinarySlope(NamedTuple):
    """Slope of the minimal cover with its interval and range; NaN and 0 where there is none."""

    dimension: float
    low: float
    high: float
    r_min: float
    """Cells."""
    r_max: float
    n: int
    sizes: np.ndarray
    """(k,) int64, cells: the powers of two to half of the window."""
    counts: np.ndarray
    """(k,)"""
    used: np.ndarray
    """(k,) bool"""


def dyadic_sizes(shape: tuple[int, ...]) -> np.ndarray:
    """Powers of two to half of the shorter side of a window, cells; at least 1."""
    return 2 ** np.arange(max(int(np.log2(min(shape) / 2) + 1e-9), 0) + 1)


def ordinary_slope(
    extent: np.ndarray,
    shape: tuple[int, int],
    sizes: np.ndarray,
    count: np.ndarray,
    limits: tuple[float, float] = (0, np.inf),
) -> OrdinarySlope:
    """Ordinary box-counting dimension of a domain.

    Parameters
    ----------
    extent : (ny, nx) bool ndarray
        The domain, without empty rows and columns about it.
    shape : (int, int)
        Cells of its window.
    sizes : (k,) int ndarray
        From :func:`dyadic_sizes`.
    count : (k,) ndarray
        Minimal cover at these.
    limits : (float, float)
        Smallest and largest box side that may be fitted, cells.

    Returns
    -------
    OrdinarySlope
        The interval is that of the regression and the jackknife's in quadrature, the latter of the
        slope of the mean counts at the same sizes: a few counts may lie on a line by chance.
    """
    nodes = int(np.count_nonzero(extent))
    used = cover_used(count, sizes, nodes, shape, limits)
    line = fit_line(np.log(sizes[used]), np.log(count[used]))
    nothing = (np.nan,) * 5
    if nodes < 2 or not np.isfinite(line.slope):
        return OrdinarySlope(*nothing, 0, sizes, count, np.zeros(sizes.size, bool))
    parts = mean_count(extent, sizes[used], blocks=BLOCKS)
    error = block_error(parts, lambda left: cover_slope(left, sizes[used]))
    half = np.hypot(error, line.slope_high - line.slope)
    ends = np.clip((-line.slope - half, -line.slope + half), 0.0, 2.0)
    r = sizes[used].astype(float)
    return OrdinarySlope(
        0.0 - line.slope,  # a constant count gives 0, not -0
        float(ends[0]),
        float(ends[1]),
        float(r[0]),
        float(r[-1]),
        line.n,
        sizes,
        count,
        used,
    )


def cover_used(
    count: np.ndarray,
    sizes: np.ndarray,
    nodes: int,
    shape: tuple[int, ...],
    limits: tuple[float, float] = (0, np.inf),
) -> np.ndarray:
    """Whether each size lies between the cut-offs and within the range asked for."""
    return between_cut_offs(count, sizes, nodes, shape)[0] & within(sizes, *limits)


def cover_slope(count: np.ndarray, sizes: np.ndarray) -> float:
    """Least-squares slope -d log N / d log r; NaN where a count is 0 or sizes are too few."""
    if sizes.size < FEWEST_POINTS or not (count > 0).all():
        return np.nan
    x = np.log(sizes)
    x -= x.mean()
    return float(0.0 - x @ np.log(count) / (x @ x))
