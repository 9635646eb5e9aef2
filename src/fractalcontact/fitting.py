"""Straight lines through points, with the interval that belongs to them, and mean planes."""

from typing import NamedTuple

import numpy as np
from scipy import special

#: Probability covered by every interval the package states.
CONFIDENCE = 0.95

#: Two points always lie on a line: from three on its error can be told.
FEWEST_POINTS = 3


class LineFit(NamedTuple):
    """A least-squares line y = intercept + slope x and its 95 % intervals."""

    slope: float
    slope_low: float
    slope_high: float
    intercept: float
    intercept_low: float
    intercept_high: float
    x_min: float
    x_max: float
    n: int
    r2: float


def fit_line(x: np.ndarray, y: np.ndarray) -> LineFit:
    """Fit a line by ordinary least squares, with Student-t intervals.

    Parameters
    ----------
    x, y : (k,) array_like
        Points; a pair with a value that is not finite is left out. For a power law give logarithms.

    Returns
    -------
    LineFit
        Slope and intercept with their 95 % intervals, range of x, number of points and coefficient
        of determination (NaN for a constant y). With fewer than three points, or all at one x,
        everything but `n` is NaN: the error of such a line cannot be told.
    """
    x, y = np.asarray(x, float), np.asarray(y, float)
    finite = np.isfinite(x) & np.isfinite(y)
    x, y = x[finite], y[finite]
    n = x.size
    if n < FEWEST_POINTS or np.ptp(x) == 0:
        return LineFit(*[np.nan] * 8, n=n, r2=np.nan)

    dx, dy = x - x.mean(), y - y.mean()
    sxx, syy = np.sum(dx**2), np.sum(dy**2)
    slope = np.sum(dx * dy) / sxx
    intercept = y.mean() - slope * x.mean()
    residual = np.sum((dy - slope * dx) ** 2)
    # stdtrit is the quantile behind scipy.stats.t, whose import alone costs most of a second.
    quantile = special.stdtrit(n - 2, (1 + CONFIDENCE) / 2)
    half_slope = quantile * np.sqrt(residual / (n - 2) / sxx)
    half_intercept = half_slope * np.sqrt(np.mean(x**2))
    return LineFit(
        slope=float(slope),
        slope_low=float(slope - half_slope),
        slope_high=float(slope + half_slope),
        intercept=float(intercept),
        intercept_low=float(intercept - half_intercept),
        intercept_high=float(intercept + half_intercept),
        x_min=float(x.min()),
        x_max=float(x.max()),
        n=n,
        r2=float(1 - residual / syy) if syy > 0 else np.nan,
    )


class Mean(NamedTuple):
    """Mean of independent values, its 95 % interval and how many there were."""

    value: np.ndarray
    low: np.ndarray
    high: np.ndarray
    n: np.ndarray


def mean_interval(values, axis: int = 0) -> Mean:
    """Mean of independent values and its Student-t interval.

    Parameters
    ----------
    values : array_like
        NaN where missing.
    axis : int
        Along which the mean is taken.

    Returns
    -------
    Mean
        NaN without a value; the interval needs two.
    """
    values = np.asarray(values, float)
    n = np.isfinite(values).sum(axis=axis)
    at_least_one, at_least_two = np.maximum(n, 1), np.maximum(n, 2)
    mean = np.where(n > 0, np.nansum(values, axis=axis) / at_least_one, np.nan)
    squares = np.nansum((values - np.expand_dims(mean, axis)) ** 2, axis=axis)
    error = np.sqrt(squares / (at_least_two - 1) / at_least_two)
    half = special.stdtrit(at_least_two - 1, (1 + CONFIDENCE) / 2) * error
    half = np.where(n > 1, half, np.nan)
    return Mean(mean, mean - half, mean + half, n)


def without_mean_plane(heights: np.ndarray) -> np.ndarray:
    """Heights less the least-squares plane through the cells that were measured.

    Parameters
    ----------
    heights : (ny, nx) array_like
        NaN where missing.

    Returns
    -------
    (ny, nx) float64
        All NaN where the measured cells do not span a plane: fewer than three, or in one line.
    """
    heights = np.asarray(heights, float)
    known = np.isfinite(heights)
    if known.all() and min(heights.shape) > 1:
        return without_mean_planes(heights)
    if not known.any():
        return np.full(heights.shape, np.nan)
    y, x = np.indices(heights.shape, dtype=float)
    y -= y[known].mean()
    x -= x[known].mean()
    mean = heights[known].mean()
    # Sums, not a matrix product: the last bit must not depend on the number of cores.
    dy, dx, dz = y[known], x[known], heights[known] - mean
    yy, xx, xy = np.sum(dy * dy), np.sum(dx * dx), np.sum(dx * dy)
    determinant = yy * xx - xy**2
    if determinant <= 1e-12 * yy * xx or yy * xx == 0:
        return np.full(heights.shape, np.nan)
    zy, zx = np.sum(dz * dy), np.sum(dz * dx)
    slope_y = (zy * xx - zx * xy) / determinant
    slope_x = (zx * yy - zy * xy) / determinant
    return heights - mean - slope_y * y - slope_x * x


def without_mean_planes(heights):
    """Complete grids, each less its own mean plane: their rows are orthogonal to their columns.

    Parameters
    ----------
    heights : (..., ny, nx) array_like
        Two cells or more along each side.

    Returns
    -------
    (..., ny, nx) float64
    """
    heights = np.asarray(heights, float)
    ny, nx = heights.shape[-2:]
    y, x = np.arange(ny) - (ny - 1) / 2, np.arange(nx) - (nx - 1) / 2
    left = heights - heights.mean(axis=(-2, -1), keepdims=True)
    slope_y = np.sum(left.sum(axis=-1) * y, axis=-1) / (nx * np.sum(y * y))
    slope_x = np.sum(left.sum(axis=-2) * x, axis=-1) / (ny * np.sum(x * x))
    left -= slope_y[..., np.newaxis, np.newaxis] * y[:, np.newaxis]
    left -= slope_x[..., np.newaxis, np.newaxis] * x
    return left
