"""Intervals of slopes that are fitted to sums over one and the same set.

Counts at many scales of one set are no independent points, and the error of a regression alone is
far too small. Here parts of the window are left out one by one (the jackknife), and the waves of
the sums about their smooth bend are added in quadrature. The bend itself is no error: a slope
that changes with the scale is a finding of its own, which local slopes show.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from .estimate import Estimate
from .fitting import fit_line
from .intervals import jackknife_error

#: Parts of the window along each axis, left out one by one.
BLOCKS = 4

#: Points that a slope needs.
MIN_SCALES = 4


#: Degree of the smooth bend of a power law in logarithms.
_BEND = 2


def wave_error(scales: np.ndarray, residuals: np.ndarray) -> float:
    """Slope that waves about the smooth bend of a power law may add to it over its range.

    The tilt of a wave of the root mean square of the residuals (k,) about their parabola over log
    scale; 0 where the parabola goes through all of them. Residuals are logarithms of sums less
    those of the law.
    """
    freedom = scales.size - _BEND - 1
    if freedom < 1:
        return 0.0
    x = np.log(scales / scales[0])
    powers = np.vander(x, _BEND + 1)
    about = residuals - powers @ np.linalg.lstsq(powers, residuals, rcond=None)[0]
    return float(2 * np.sqrt(2 * np.sum(about**2) / freedom) / x[-1])


def slope_of_sums(
    scales: ArrayLike, parts: ArrayLike, statistic: Callable[[np.ndarray], np.ndarray]
) -> Estimate:
    """Slope of log of a statistic of sums against log scale, with the interval of this module.

    ``parts`` (k, m, n) are m sums at each scale (k,), ascending, over n parts of the window.
    ``statistic`` takes (k, m) sums of the whole window, or of all but one part, to (k,) values
    whose logarithm is taken; scales where it is not positive are left out. NaN with fewer than
    `MIN_SCALES` others.
    """
    scales, parts = np.asarray(scales, float), np.asarray(parts, float)
    whole = parts.sum(axis=2)
    x, y = np.log(scales), _log(statistic(whole))
    positive = np.isfinite(y)
    if positive.sum() < MIN_SCALES:
        return Estimate()
    x, y = x[positive], y[positive]
    line = fit_line(x, y)
    slope = line.slope.value
    filled = np.flatnonzero(parts[positive].any(axis=(0, 1)))
    left = [_slope(x, _log(statistic(whole - parts[:, :, i]))[positive]) for i in filled]
    waves = wave_error(scales[positive], y - line.intercept.value - slope * x)
    half = float(np.hypot(jackknife_error(left), waves))
    over = float(np.exp(x[0])), float(np.exp(x[-1]))
    return Estimate(slope, slope - half, slope + half, x.size, over)


def _slope(x, y):
    return fit_line(x, y).slope.value


def _log(values):
    """Logarithm where there is one, else NaN."""
    values = np.asarray(values, float)
    return np.log(np.where(values > 0, values, np.nan))
