"""Straight lines through points, with their intervals."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .estimate import Estimate
from .intervals import t_quantile

#: Fewest points of a line with an error: two points always lie on a line.
MIN_POINTS = 3


class LineFit(NamedTuple):
    """A least-squares line y = intercept + slope x."""

    slope: Estimate
    """With the number of points, and the range of x, that it was fitted over."""
    intercept: Estimate
    r2: float

    @property
    def n(self) -> int:
        """Number of points."""
        return self.slope.n


def fit_line(x: ArrayLike, y: ArrayLike) -> LineFit:
    """Fit a line by ordinary least squares, with Student-t intervals.

    Parameters
    ----------
    x, y : (k,) array_like
        Points; a pair with a value that is not finite is left out. For a power law give logarithms.

    Returns
    -------
    LineFit
        Slope and intercept, and the coefficient of determination (NaN for a constant y). With fewer
        than three points, or all at one x, everything but the number of points is NaN: the error of
        such a line is not known.
    """
    x_all, y_all = np.asarray(x, float), np.asarray(y, float)
    finite = np.isfinite(x_all) & np.isfinite(y_all)
    return _line_through(x_all[finite], y_all[finite])


def _line_through(x: np.ndarray, y: np.ndarray) -> LineFit:
    n = x.size
    if n < MIN_POINTS or np.ptp(x) == 0:
        return LineFit(Estimate(n=n), Estimate(n=n), np.nan)

    dx, dy = x - x.mean(), y - y.mean()
    sxx, syy = np.sum(dx**2), np.sum(dy**2)
    slope = np.sum(dx * dy) / sxx
    intercept = y.mean() - slope * x.mean()
    residual = np.sum((dy - slope * dx) ** 2)
    quantile = t_quantile(n - 2)
    half_slope = quantile * np.sqrt(residual / (n - 2) / sxx)
    half_intercept = half_slope * np.sqrt(np.mean(x**2))
    over = float(x.min()), float(x.max())
    return LineFit(
        slope=_around(slope, half_slope, n, over),
        intercept=_around(intercept, half_intercept, n, over),
        r2=float(1 - residual / syy) if syy > 0 else np.nan,
    )


def _around(value: float, half: float, n: int, over: tuple[float, float]) -> Estimate:
    return Estimate(float(value), float(value - half), float(value + half), n, over)


def slope_error(x: np.ndarray, error: np.ndarray) -> float:
    """Error of a least-squares slope over x (n,) by the independent errors (n,) of its values.

    Errors are half-widths of intervals. NaN with fewer than two points.
    """
    if x.size < 2:
        return np.nan
    about = x - x.mean()
    return float(np.sqrt(np.sum((about * error) ** 2)) / np.sum(about**2))


def slope_with_bounds(x: np.ndarray, values: np.ndarray, bound: np.ndarray) -> Estimate:
    """Largest slope of a line through values (part,) over x, some of which are lower bounds.

    A line falls faster as values left of its middle rise. So a fit with bounds at small x gives the
    largest slope that the bounds allow, without a lower end; bounds beyond the middle are left out.
    """
    kept = np.isfinite(values)
    while (beyond := kept & bound & (kept.sum() * x > x[kept].sum())).any():
        kept &= ~beyond
    slope = fit_line(x[kept], values[kept]).slope
    return replace(slope, low=-np.inf) if slope.known and bound[kept].any() else slope
