"""Straight lines through points, with the interval that belongs to them."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .intervals import t_quantile

#: Two points always lie on a line: from three on its error is known.
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


NO_LINE = LineFit(**dict.fromkeys(LineFit._fields[:8], np.nan), n=0, r2=np.nan)


def fit_line(x: ArrayLike, y: ArrayLike) -> LineFit:
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
        everything but `n` is NaN: the error of such a line is not known.
    """
    x_all, y_all = np.asarray(x, float), np.asarray(y, float)
    finite = np.isfinite(x_all) & np.isfinite(y_all)
    return _line_through(x_all[finite], y_all[finite])


def _line_through(x: np.ndarray, y: np.ndarray) -> LineFit:
    n = x.size
    if n < FEWEST_POINTS or np.ptp(x) == 0:
        return NO_LINE._replace(n=n)

    dx, dy = x - x.mean(), y - y.mean()
    sxx, syy = np.sum(dx**2), np.sum(dy**2)
    slope = np.sum(dx * dy) / sxx
    intercept = y.mean() - slope * x.mean()
    residual = np.sum((dy - slope * dx) ** 2)
    quantile = t_quantile(n - 2)
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
