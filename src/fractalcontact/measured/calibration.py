"""One constant of the material fitted to one measured closure curve."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import optimize

from ..core.estimate import Estimate
from ..core.intervals import t_quantile
from .curve import Curve

#: Factors of the constant that are tried, and how many readings have to lie on a computed curve.
LARGEST_FACTOR, _TRIED = 4.0, 81
_MIN_READINGS = 5
#: Fraction of the readings that the computed curve has to reach at a factor.
_REACHED = 0.9

#: Closure over the pressure at a factor of the constant.
Family = Callable[[float], Curve]


@dataclass(frozen=True)
class Calibration:
    """Factor of a constant with its interval; ``reason`` says why there is none."""

    factor: Estimate
    reason: str = ""


def fit_factor(readings: Curve, family: Family, largest: float = LARGEST_FACTOR) -> Calibration:
    """Factor of a constant at which the computed closure comes nearest to the measured one.

    Parameters
    ----------
    readings : Curve
        Measured closure, from any datum.
    family : callable
        Computed closure at a factor.
    largest : float, optional
        Factors from its reciprocal to it are tried.

    Returns
    -------
    Calibration
        The interval holds the scatter of the readings (the sum of squares as large as an F test
        allows) and the error of the computed closure.

    Notes
    -----
    Least squares in the closure; the datum of the readings is fitted too, as the reading at the
    seat scatters as all others do.
    """

    def misfit(log_factor: float) -> float:
        computed = family(float(np.exp(log_factor))).at(readings.x).value
        known = np.isfinite(computed)
        if known.mean() < _REACHED or known.sum() < _MIN_READINGS:
            return np.inf
        apart = readings.y[known] - computed[known]
        return float(np.mean((apart - apart.mean()) ** 2))

    tried = np.linspace(-np.log(largest), np.log(largest), _TRIED)
    values = np.array([misfit(one) for one in tried])
    best = int(values.argmin())
    if not np.isfinite(values[best]):
        return Calibration(
            Estimate(),
            "the loads of the study do not reach the pressures of the test: widen 'loads'",
        )
    if best in (0, tried.size - 1) or not np.isfinite(values[[best - 1, best + 1]]).all():
        return Calibration(
            Estimate(),
            f"no factor between {1 / largest:.2g} and {largest:.2g} that the computed loads reach "
            "fits best: widen 'loads', or correct the constant that is stated",
        )
    inside = optimize.minimize_scalar(
        misfit, bounds=(tried[best - 1], tried[best + 1]), method="bounded"
    )
    log_factor, least = float(inside.x), float(inside.fun)
    freedom = readings.x.size - 2
    least = max(least, 1e-18)
    limit = least * (1 + t_quantile(freedom) ** 2 / freedom)
    ends = [_crossing(misfit, log_factor, way * np.log(largest), limit) for way in (-1, 1)]
    error = _of_computed(family, readings, log_factor)
    half = [np.hypot(end - log_factor, error) for end in ends]
    value = np.exp(log_factor)
    return Calibration(
        Estimate(value, value * np.exp(-half[0]), value * np.exp(half[1]), n=readings.x.size)
    )


def _crossing(misfit, start: float, end: float, limit: float) -> float:
    """Where the misfit passes its limit; the end where it does not."""
    if misfit(end) <= limit:
        return end

    def beyond(place: float) -> float:
        return min(misfit(place), 2 * limit) - limit

    return float(optimize.brentq(beyond, start, end, xtol=1e-6))


def _of_computed(family: Family, readings: Curve, log_factor: float) -> float:
    """Half-width of the logarithm of the factor from the error of the computed closure."""
    step = 0.02
    top, datum = readings.x[-1], readings.x[0]
    lower, upper, here = (
        family(float(np.exp(log_factor + one))).at(np.array([datum, top]))
        for one in (-step, step, 0.0)
    )
    slope = (np.diff(upper.value) - np.diff(lower.value)) / (2 * step)
    error = np.hypot(*(here.high - here.value))
    return float(error / abs(slope[0])) if np.isfinite(slope[0]) and slope[0] else 0.0
