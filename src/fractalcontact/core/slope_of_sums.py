"""Intervals of slopes that are fitted to sums over one and the same set.

Counts at many scales of one set are no independent points, and the error of a regression alone is
far too small. Here parts of the window are left out one by one (the jackknife), and the choice of
range and the waves about the line come on top.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from .estimate import Estimate
from .fitting import fit_line
from .intervals import jackknife_error

#: Parts of the window along each axis, left out one by one.
BLOCKS = 4

#: Points a slope needs, and each half of its range for the half's own slope.
FEWEST_SCALES = 4


def wave_error(misfit: float, scales: np.ndarray) -> float:
    """How far a wave of this relative misfit (rms) about a power law tilts it over its range."""
    return 2 * np.sqrt(2) * misfit / np.log(scales[-1] / scales[0])


def interval(value: float, others: list[float], error: float, wave: float) -> tuple[float, float]:
    """Interval of a value: other ways to find it and the jackknife's error, in quadrature.

    Parameters
    ----------
    value : float
    others : list of float
        From parts of the range, or other estimators; NaN where there is none.
    error : float
        From :func:`jackknife_error`.
    wave : float
        From :func:`wave_error`; added at both ends.
    """
    values = np.array([value, *others])
    values = values[np.isfinite(values)]
    below, above = value - values.min(), values.max() - value
    return value - np.hypot(error, below) - wave, value + np.hypot(error, above) + wave


def halves(n: int) -> tuple[slice, slice]:
    """The lower and the upper half of n scales, the middle in both."""
    half = n // 2
    return slice(half + 1), slice(-half - 1, None)


def slope_of_sums(
    scales: ArrayLike,
    parts: ArrayLike,
    statistic: Callable[[np.ndarray], np.ndarray],
    other: Callable[[np.ndarray], np.ndarray] | None = None,
) -> Estimate:
    """Slope of log of a statistic of sums against log scale, with the interval of this module.

    Parameters
    ----------
    scales : (k,) array_like
        Ascending.
    parts : (k, m, n) array_like
        m sums at each scale, over n parts of the window.
    statistic : callable
        (k, m) sums of the whole window, or of all but one part, to (k,) values whose logarithm is
        taken; scales where it is not positive are left out.
    other : callable, optional
        Another statistic for the same slope: the interval spans what it gives.

    Returns
    -------
    Estimate
        Over the scales used; NaN with fewer than `FEWEST_SCALES` of them.
    """
    scales, parts = np.asarray(scales, float), np.asarray(parts, float)
    whole = parts.sum(axis=2)
    x, y = np.log(scales), _log(statistic(whole))
    positive = np.isfinite(y)
    if positive.sum() < FEWEST_SCALES:
        return Estimate()
    x, y = x[positive], y[positive]
    line = fit_line(x, y)
    slope = line.slope.value
    others = [_slope(x[part], y[part]) for part in halves(x.size)]
    if other is not None:
        others.append(_slope(x, _log(other(whole))[positive]))
    filled = np.flatnonzero(parts[positive].any(axis=(0, 1)))
    left = [_slope(x, _log(statistic(whole - parts[:, :, i]))[positive]) for i in filled]
    misfit = float(np.std(y - line.intercept.value - slope * x))
    low, high = interval(slope, others, jackknife_error(left), wave_error(misfit, np.exp(x)))
    over = float(np.exp(x[0])), float(np.exp(x[-1]))
    return Estimate(slope, float(low), float(high), x.size, over)


def _slope(x, y):
    return fit_line(x, y).slope.value


def _log(values):
    """Logarithm where there is one, else NaN."""
    values = np.asarray(values, float)
    return np.log(np.where(values > 0, values, np.nan))
