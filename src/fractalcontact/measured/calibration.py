"""One constant of the material fitted to one measured closure curve."""

from collections.abc import Callable

import numpy as np
from scipy import optimize

from ..core.estimate import Estimate
from ..core.intervals import t_quantile
from .curve import MIN_READINGS, Curve

#: Number of factors of the constant that are tried.
_TRIED = 81
#: Fraction of the readings that the computed curve has to reach at a factor.
_REACHED = 0.5
#: Range of log factors about the best that is searched closely, and the width of its edge.
NEAR, _EDGE = 0.25, 0.005

#: Function that gives the closure over the pressure at a factor of the constant.
Family = Callable[[float], Curve]


def fit_factor(readings: Curve, family: Family, between: tuple[float, float]) -> Estimate:
    """Factor of a constant at which the computed closure comes nearest to the measured one.

    Readings count from any datum; ``family`` gives the computed closure at a factor, ``between``
    the smallest and largest factor that are tried, which no interval leaves. The estimate has the
    reason why there is none, or little is known of it. Its interval holds the scatter of the
    readings (the sum of squares as large as an F test allows) and the error of the computed
    closure.

    Least squares in the closure; the datum of the readings is fitted too, as the reading at the
    seat scatters as all others do.
    """
    tried = np.linspace(np.log(between[0]), np.log(between[1]), _TRIED)
    values = np.array([_misfit(readings, family, log_tried, _REACHED) for log_tried in tried])
    best = int(values.argmin())
    if not np.isfinite(values[best]):
        why = "the loads of the study do not reach the pressures of the test: widen 'loads'"
        return Estimate(reason=why)
    # All factors are compared over the same readings: those that the loads reach at each of them.
    near = np.clip(tried[best] + np.array([-NEAR, NEAR]), tried[0], tried[-1])
    reached = np.all(
        [np.isfinite(family(np.exp(log_tried)).at(readings.x).value) for log_tried in near], 0
    )
    readings = readings.where(reached)
    if readings.x.size < MIN_READINGS:
        why = f"fewer than {MIN_READINGS} readings lie within the computed loads: widen 'loads'"
        return Estimate(reason=why)

    def misfit(log_factor: float) -> float:
        return _misfit(readings, family, log_factor, 1.0)

    inside = optimize.minimize_scalar(misfit, bounds=tuple(near), method="bounded")
    log_factor, least = float(inside.x), max(float(inside.fun), 1e-18)
    if min(abs(log_factor - near)) < _EDGE:
        why = (
            "no factor from {:.2g} to {:.2g} that the computed loads reach fits better than those "
            "beside it: the test is not of such a joint, or widen 'loads'".format(*between)
        )
        return Estimate(reason=why)
    freedom = readings.x.size - 2
    limit = least * (1 + t_quantile(freedom) ** 2 / freedom)
    ends = [_crossing(misfit, log_factor, end, limit) for end in near]
    error = _of_computed(family, readings, log_factor)
    halves = [np.hypot(end - log_factor, error) for end in ends]
    low, high = (
        np.clip(log_factor + way * half, tried[0], tried[-1])
        for way, half in zip((-1, 1), halves, strict=True)
    )
    why = ""
    if high - low > (tried[-1] - tried[0]) / 2:
        why = (
            "hardly determined: its interval holds half of the factors that were tried, from "
            "{:.2g} to {:.2g}".format(*between)
        )
    value, low, high = np.exp([log_factor, low, high])
    return Estimate(value, low, high, readings.x.size, reason=why)


def _misfit(readings: Curve, family: Family, log_factor: float, reached: float) -> float:
    """Mean square of what the computed closure leaves; infinite where it reaches too few."""
    computed = family(float(np.exp(log_factor))).at(readings.x).value
    finite = np.isfinite(computed)
    if finite.mean() < reached or finite.sum() < MIN_READINGS:
        return np.inf
    apart = readings.y[finite] - computed[finite]
    return float(np.mean((apart - apart.mean()) ** 2))


def _crossing(misfit, start: float, end: float, limit: float) -> float:
    """Constant at which the misfit passes its limit; the end where it does not."""
    if misfit(end) <= limit:
        return end

    def beyond(place: float) -> float:
        return min(misfit(place), 2 * limit) - limit

    return float(optimize.brentq(beyond, start, end, xtol=1e-6))


def _of_computed(family: Family, readings: Curve, log_factor: float) -> float:
    """Half-width of the logarithm of the factor from the error of the computed closure."""
    step = 0.02
    top, datum = readings.x[-1], readings.x[0]
    lower, upper, middle = (
        family(float(np.exp(log_factor + shift))).at(np.array([datum, top]))
        for shift in (-step, step, 0.0)
    )
    slope = (np.diff(upper.value) - np.diff(lower.value)) / (2 * step)
    error = np.hypot(*(middle.high - middle.value))
    return float(error / abs(slope[0])) if slope[0] else np.inf
