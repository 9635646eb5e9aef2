"""Decision rule on a size effect of the strength of a sliding joint.

tau/sigma_0 = tan(phi_b + i), and i is atan(d delta/dv) unbounded: truncation at a largest angle
would hide a size effect of steep joints. The strength of a class is that of its mean rate, because
the mean of a bent function of rates that scatter more in small windows falls with the side by
itself.

Angles phi_b are in degrees.
"""

from collections.abc import Sequence

import numpy as np

from .size_decision import (
    NO_EFFECT,
    Exponent,
    mean_exponent,
    size_exponent,
)

FLAT, EFFECT, OPEN = "no size effect", "size effect", "undetermined"
#: Verdicts on a size effect at equal v and at equal v/b together.
OF_V, OF_B = "size effect of v, not of b", "size effect of b"


def friction_ratio(rate: np.ndarray, basic_angle: float) -> np.ndarray:
    """Strength tau/sigma_0 = tan(phi_b + i) with i = atan(rate), the angle not truncated.

    ``rate`` is the dilatancy rate d delta/dv. NaN where the angle reaches 90 degrees: no shear
    force makes that joint slide. Goodman (1989), as in :mod:`laws.strength`.
    """
    angle = np.radians(basic_angle) + np.arctan(rate)
    with np.errstate(invalid="ignore"):
        return np.where(angle < np.pi / 2, np.tan(angle), np.nan)


def mean_strength(rates: np.ndarray, basic_angle: float) -> Exponent:
    """Strength of the mean rate of surfaces (n,) of one class, with its 99 % interval over them."""
    mean = mean_exponent(rates)
    value, low, high = friction_ratio(np.array([mean.value, mean.low, mean.high]), basic_angle)
    lever = abs(_slope(mean.value, basic_angle))
    error, usual = float(lever * mean.error), float(lever * mean.half_width)
    return Exponent(float(value), low, high, error=error, half_width=usual)


def _slope(rate: float, basic_angle: float) -> float:
    """d (tau/sigma_0) / d rate."""
    tangent = float(friction_ratio(np.array(rate), basic_angle))
    return (1 + tangent**2) / (1 + rate**2)


def linear_strengths(groups: np.ndarray, rates: np.ndarray, basic_angle: float) -> np.ndarray:
    """Strengths (n,) of single surfaces, linear in their rates about the mean rate of their group.

    ``groups`` are the sides of the surfaces. Positive; the logarithms of a group have the mean ln
    tan(phi_b + i) of its mean rate, and scatter as its rates do. NaN where the strength of that
    mean is not positive.
    """
    groups, rates = np.asarray(groups), np.asarray(rates, float)
    result = np.full(rates.shape, np.nan)
    for group in np.unique(groups):
        in_group = (groups == group) & np.isfinite(rates)
        if not in_group.any():
            continue
        mean = float(rates[in_group].mean())
        tangent = float(friction_ratio(np.array(mean), basic_angle))
        if tangent > 0:
            lever = _slope(mean, basic_angle) / tangent
            result[in_group] = tangent * np.exp(lever * (rates[in_group] - mean))
    return result


def strength_exponent(sides: np.ndarray, rates: np.ndarray, basic_angle: float) -> Exponent:
    """Exponent of tau/sigma_0 over the side, from dilatancy rates (n,) of surfaces of each side."""
    return size_exponent(sides, linear_strengths(sides, rates, basic_angle))


def size_verdict(exponent: Exponent) -> str:
    """Verdict on an exponent over the side as a size effect.

    No size effect where the whole interval lies within `NO_EFFECT`, a size effect where it
    excludes zero and is not within the bound, else undetermined.
    """
    if not np.isfinite(exponent.error):
        return OPEN
    if max(abs(exponent.low), abs(exponent.high)) < NO_EFFECT:
        return FLAT
    return EFFECT if exponent.low > 0 or exponent.high < 0 else OPEN


def joint_verdict(
    at_v: Sequence[Exponent],
    at_fraction: Sequence[Exponent],
    predicted: Sequence[Exponent],
) -> str:
    """Verdict on the strength of a class: its size effect, and its cause.

    Exponents of tau/sigma_0 over the side are those at equal v, one for each load, those at equal
    v/b, and those predicted from v alone, one for each load and fraction. The size effect is one of
    b where an exponent at equal v is a size effect, or one at equal v/b differs from that by v
    alone. It is one of v where at equal v there is none, and the exponents at equal v/b that v
    alone makes a size effect are size effects, and no other. None where no exponent of either kind
    is. Else undetermined.
    """
    rest = [exponent.less(of) for exponent, of in zip(at_fraction, predicted, strict=True)]
    verdicts = [size_verdict(exponent) for exponent in at_v]
    scaled = [size_verdict(exponent) for exponent in at_fraction]
    if EFFECT in verdicts or EFFECT in [size_verdict(exponent) for exponent in rest]:
        return OF_B
    if not verdicts or set(verdicts) != {FLAT}:
        return OPEN
    if scaled and set(scaled) == {FLAT}:
        return FLAT
    by_v = [size_verdict(exponent) for exponent in predicted]
    explained = [pair == (EFFECT, EFFECT) for pair in zip(scaled, by_v, strict=True)]
    return OF_V if any(explained) else OPEN
