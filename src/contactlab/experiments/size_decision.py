"""Decision rule on the exponent of the size effect.

Eq. 6 demands that the nominal pressure at one sigma*, and so the part of the nominal area that
touches at one nominal pressure, goes with the side as b^-(2 - Delta_sigma), for either measure of
Delta_sigma. Here the exponent alpha of A_r/A_0 over b is compared with that, class by class.
Intervals are over surfaces, not over a regression.
"""

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np
from scipy import special

from fractalcontact.core.estimate import Estimate
from fractalcontact.core.labels import cf_attrs
from fractalcontact.size_effect.size_verdict import NO_EFFECT as NO_EFFECT
from fractalcontact.size_effect.size_verdict import WIDEST_PREDICTION as WIDEST_PREDICTION

#: Probability of the intervals that decide, and of those that are only shown.
PROBABILITY, USUAL = 0.99, 0.95

#: Loads at which a class must follow eq. 6 before it is supported.
SUPPORTING_LOADS = 3

#: Smallest side, roll-offs, that holds enough hills to be compared.
MIN_ROLL_OFFS = 4

REFUTED, SUPPORTED, OPEN = "eq. 6 refuted", "eq. 6 agrees", "undetermined"
#: Verdict where enough loads agree.
UPHELD = "eq. 6 supported"


@dataclass(frozen=True)
class Exponent(Estimate):
    """An exponent with its interval over surfaces, of :data:`PROBABILITY`.

    ``error`` is its standard error, ``half_width`` half of the interval of :data:`USUAL`.
    """

    level: ClassVar[str] = f"{100 * PROBABILITY:g} %"
    error: Any = np.nan
    half_width: Any = np.nan

    @classmethod
    def scattered(cls, value: float, error: float, freedom: float) -> "Exponent":
        """Exponent from the standard error and its degrees of freedom, by Student's t."""
        half, usual = (quantile(freedom, level) * error for level in (PROBABILITY, USUAL))
        return cls(value, value - half, value + half, error=error, half_width=usual)

    def less(self, other: "Exponent") -> "Exponent":
        """Difference from an independent exponent, with the joint interval."""
        value = self.value - other.value
        half = float(np.hypot(self.high - self.value, other.high - other.value))
        error = float(np.hypot(self.error, other.error))
        usual = float(np.hypot(self.half_width, other.half_width))
        return Exponent(value, value - half, value + half, error=error, half_width=usual)

    @classmethod
    def stack(cls, estimates: Iterable[Estimate], shape: Sequence[int] = (-1,)) -> "Exponent":
        """Exponents as one of arrays, in C order over ``shape``."""
        exponents = list(estimates)
        error, usual = (
            np.reshape([getattr(exponent, name) for exponent in exponents], shape)
            for name in ("error", "half_width")
        )
        return cls(*Estimate.stack(exponents, shape).ends, error=error, half_width=usual)

    def variables(
        self, name: str, dims: Hashable | Sequence[Hashable], units: str, long_name: str
    ) -> dict[str, tuple[Any, Any, dict[str, str]]]:
        """Variables of an estimate, and ``NAME_error`` and ``NAME_half_width``."""
        usual = f"{long_name}, half-width of the {100 * USUAL:g} % interval"
        return super().variables(name, dims, units, long_name) | {
            f"{name}_error": (dims, self.error, cf_attrs(units, f"{long_name}, standard error")),
            f"{name}_half_width": (dims, self.half_width, cf_attrs(units, usual)),
        }


UNKNOWN = Exponent()


def quantile(freedom: float, probability: float = PROBABILITY) -> float:
    """Half the width of an interval in standard errors, Student's t."""
    return float(special.stdtrit(max(freedom, 1.0), (1 + probability) / 2))


def mean_exponent(values: np.ndarray) -> Exponent:
    """Mean exponent over single surfaces (n,), with its interval; NaN values are left out."""
    values = np.asarray(values, float)
    values = values[np.isfinite(values)]
    if values.size < 2:
        return UNKNOWN
    error = float(np.std(values, ddof=1) / np.sqrt(values.size))
    return Exponent.scattered(float(values.mean()), error, values.size - 1)


def size_exponent(sides: np.ndarray, values: np.ndarray, *, equal: bool = False) -> Exponent:
    """Exponent of a positive quantity over the side, from independent surfaces of each side.

    Parameters
    ----------
    sides, values : (n,) array_like
        One of each surface; NaN where missing.
    equal : bool, optional
        One weight for all sides: where values follow no straight line, a prediction for the same
        sides then has the same line.

    Returns
    -------
    Exponent
        Of the line through the mean logarithms of every side, weighted with their variances; its
        error follows from the scatter between surfaces of one side and from nothing else. Unknown
        with fewer than two sides of two surfaces each.

    Notes
    -----
    Freedom by Welch and Satterthwaite: squares of the contributions of all sides to the variance.
    """
    sides, values = np.asarray(sides, float), np.asarray(values, float)
    usable = np.isfinite(values) & (values > 0)
    groups = [np.log(values[usable & (sides == side)]) for side in np.unique(sides)]
    scatters = [group.size > 1 for group in groups]
    x = np.log(np.unique(sides))[scatters]
    groups = [group for group in groups if group.size > 1]
    if len(groups) < 2:
        return UNKNOWN
    mean = np.array([group.mean() for group in groups])
    # A side whose surfaces are all equal would have infinite weight.
    variance = np.array([np.var(group, ddof=1) / group.size for group in groups])
    variance = np.maximum(variance, 1e-12)
    weight = np.ones(variance.size) if equal else 1 / variance
    lever = x - np.sum(weight * x) / weight.sum()
    parts = weight * lever / np.sum(weight * lever**2)
    value = float(np.sum(parts * mean))
    of_sides = parts**2 * variance
    error = float(np.sqrt(of_sides.sum()))
    freedom = of_sides.sum() ** 2 / np.sum(of_sides**2 / [group.size - 1 for group in groups])
    return Exponent.scattered(value, error, float(freedom))


def paired_exponent(sides: np.ndarray, values: np.ndarray, surfaces: np.ndarray) -> Exponent:
    """Exponent of a positive quantity over the side, from windows of the same surfaces.

    The mean over the surfaces of the slope of each, with the interval over surfaces. ``sides``
    (n,), ``values`` are means over the windows of a side, ``surfaces`` the numbers of their
    surfaces.
    """
    sides, values, surfaces = (np.asarray(column) for column in (sides, values, surfaces))
    usable = np.isfinite(values) & (values > 0)
    slopes = []
    for surface in np.unique(surfaces):
        of_surface = usable & (surfaces == surface)
        x = np.log(sides[of_surface])
        lever = x - x.mean() if x.size else x
        if np.any(lever):
            slopes.append(float(lever @ np.log(values[of_surface]) / (lever @ lever)))
    return mean_exponent(np.array(slopes))


class Decision(NamedTuple):
    """Verdict of one class of surfaces, at one load, on eq. 6."""

    verdict: str
    no_size_effect: bool
    reason: str


def decide(alpha: Exponent, by_area: Exponent, by_boxes: Exponent) -> Decision:
    """Verdict of the rule: alpha compared with -(2 - Delta_sigma) of both estimators.

    Refuted where alpha, of A_r/A_0 over the side, differs from both predictions (from A_r(s) and
    from box counts) beyond their joint interval; agreeing where it does not differ from one that is
    narrow enough to decide; else undetermined. ``no_size_effect`` where the whole interval of alpha
    lies within :data:`NO_EFFECT` of zero.
    """
    flat = max(abs(alpha.low), abs(alpha.high)) < NO_EFFECT
    if not np.isfinite(alpha.error):
        return Decision(OPEN, False, "fewer than two sizes with two surfaces each")
    predictions = [p for p in (by_area, by_boxes) if np.isfinite(p.error)]
    if not predictions:
        return Decision(OPEN, flat, "no prediction: Delta_sigma is unknown")
    narrow = [p for p in predictions if p.high - p.low <= WIDEST_PREDICTION]
    agreeing = [p for p in narrow if not differ(alpha, p)]
    if agreeing:
        # A prediction of hardly any effect agrees with no effect at all, and supports nothing.
        if all(abs(p.value) < NO_EFFECT for p in agreeing):
            return Decision(OPEN, flat, "the prediction itself is next to no size effect")
        return Decision(SUPPORTED, flat, "within the joint interval of a prediction")
    if len(predictions) < 2:
        return Decision(OPEN, flat, "only one estimator of Delta_sigma is known")
    if all(differ(alpha, p) for p in predictions):
        return Decision(REFUTED, flat, "outside the joint intervals of both predictions")
    return Decision(OPEN, flat, "a prediction is too wide to decide")


def differ(first: Exponent, second: Exponent) -> bool:
    """True if two exponents differ by more than their joint interval."""
    half = np.hypot(first.high - first.value, second.high - second.value)
    return bool(abs(first.value - second.value) > half)


def overall(decisions: list[Decision], *, follows: bool) -> str:
    """Verdict on a class over the decisions at all its loads.

    ``follows`` says whether alpha follows the predicted change where H changes; where it does not,
    nothing supports eq. 6, because single numbers may agree by chance.
    """
    refuted = sum(decision.verdict == REFUTED for decision in decisions)
    agreeing = sum(decision.verdict == SUPPORTED for decision in decisions)
    if agreeing >= SUPPORTING_LOADS and follows:
        return UPHELD
    return REFUTED if refuted and not agreeing else OPEN
