"""Rule that decides whether a specimen follows eq. 6.

Eq. 6 is tested in two forms. The well-conditioned one compares the exponent of A_r/A_0 over b at
equal nominal pressure with -(2 - Delta_sigma), which dilations of one contact set have. Its own
form compares the slope of log sigma_0 over log b at equal sigma* with the same number; there
sigma_0 is inverted from sigma*, which hardly depends on it where A_r ~ F. A specimen follows eq. 6
only if it does so in both.
"""

from typing import NamedTuple

import numpy as np
import xarray as xr

from ..core.estimate import Estimate
from ..core.labels import cf_attrs
from ..core.per_curve import stacked
from ..core.verdicts import AGREES, AMBIGUOUS, FLATTER, NOT_TESTED, STEEPER, UNDECIDED

#: Largest difference of exponents by rounding alone.
ROUNDING = 1e-9
#: Largest width of the 95 % interval of a conclusive prediction.
WIDEST_PREDICTION = 0.4
#: Largest size of a prediction or an exponent that is no size effect.
NO_EFFECT = 0.02
#: Largest width of the 95 % interval of a conclusive slope.
WIDEST_SLOPE = 1.0
#: Largest condition number |d ln sigma_0 / d ln sigma*| that is conclusive: what the area of 30
#: nodes leaves open, 4 %, is then 40 % of sigma_0, or 0.3 of a slope over two octaves.
WORST_CONDITION = 10.0

#: Why a prediction or a slope is not judged or not decided.
TOO_WIDE = f"the predicted exponent is uncertain by more than {WIDEST_PREDICTION:g}"
TOO_WIDE_MISSED = f"{TOO_WIDE}, though what is measured lies outside"
NOTHING_PREDICTED = "eq. 6 predicts hardly any size effect"
NEITHER = "eq. 6 and no size effect are both possible"
ILL_CONDITIONED = f"sigma_0 is poorly known from sigma* (condition over {WORST_CONDITION:g})"
SLOPE_TOO_WIDE = f"the measured slope is uncertain by more than {WIDEST_SLOPE:g}"
SEVERAL = "one sigma* has several sigma_0"
NO_SIZES = "too few sizes of window hold enough nodes"
NO_PREDICTION = "Delta_sigma has no interval"


class Judgement(NamedTuple):
    """A verdict, its reason, and measured less predicted with its interval."""

    verdict: str
    reason: str
    difference: Estimate


def judge_exponent(measured: Estimate, predicted: Estimate) -> Judgement:
    """Judgement of a measured exponent beside the predicted one: the rule of both forms.

    Undecided where the prediction is wide or next to nothing, or where the measured interval holds
    both the prediction and zero.
    """
    value = measured.value - predicted.value
    low = value - np.hypot(measured.value - measured.low, predicted.high - predicted.value)
    high = value + np.hypot(measured.high - measured.value, predicted.value - predicted.low)
    difference = Estimate(value, low, high)

    def judged(verdict: str, reason: str = "") -> Judgement:
        return Judgement(verdict, reason, difference)

    if not np.isfinite(measured.ends).all():
        return judged(NOT_TESTED, NO_SIZES)
    if not np.isfinite(predicted.ends).all():
        return judged(NOT_TESTED, NO_PREDICTION)
    missed = low > ROUNDING or high < -ROUNDING
    if predicted.width > WIDEST_PREDICTION:
        return judged(UNDECIDED, TOO_WIDE_MISSED if missed else TOO_WIDE)
    if abs(predicted.value) < NO_EFFECT:
        return judged(UNDECIDED, NOTHING_PREDICTED)
    if missed:
        return judged(FLATTER if low > 0 else STEEPER)
    if measured.low <= 0 <= measured.high:
        return judged(UNDECIDED, NEITHER)
    return judged(AGREES)


def judge_own_form(
    measured: Estimate, predicted: Estimate, condition: float, crossings: int
) -> Judgement:
    """Judgement of the slope at equal sigma*, where that determines sigma_0.

    By :func:`judge_exponent`. ``condition`` is d ln sigma_0 / d ln sigma* of the whole window, of
    any sign, ``crossings`` the number of pressures at which the whole window has its sigma*.
    """
    judgement = judge_exponent(measured, predicted)
    if judgement.verdict == NOT_TESTED:
        return judgement
    if crossings != 1:
        return judgement._replace(verdict=AMBIGUOUS, reason=SEVERAL)
    if not abs(condition) <= WORST_CONDITION:
        return judgement._replace(verdict=UNDECIDED, reason=ILL_CONDITIONED)
    if judgement.verdict == AGREES and measured.width > WIDEST_SLOPE:
        return judgement._replace(verdict=UNDECIDED, reason=SLOPE_TOO_WIDE)
    return judgement


def both_forms(area: Judgement, own: Judgement) -> tuple[str, str]:
    """Verdict and reason on eq. 6 under one load, those of the well-conditioned form.

    Where it agrees, the reason adds what eq. 6 says in its own form.
    """
    if area.verdict != AGREES:
        return area.verdict, area.reason
    if own.verdict in (AGREES, FLATTER, STEEPER):
        return own.verdict, own.reason
    return UNDECIDED, own.reason


_AREA_FORM, _OWN_FORM = "A_r/A_0 at equal sigma_0", "its own form, at equal sigma*"
_NAMES = {
    "verdict": ("1", "whether eq. 6 agrees, both forms together"),
    "reason": ("1", "why undecided, both forms together"),
    "area_verdict": ("1", f"whether eq. 6 agrees, {_AREA_FORM}"),
    "area_reason": ("1", f"why undecided, {_AREA_FORM}"),
    "area_difference": ("1", "exponent of A_r/A_0 less -(2 - Delta_sigma)"),
    "slope_verdict": ("1", f"whether eq. 6 agrees, {_OWN_FORM}"),
    "slope_reason": ("1", f"why undecided, {_OWN_FORM}"),
    "slope_difference": ("1", "slope of log sigma_0 less -(2 - Delta_sigma)"),
}


def size_verdicts(result: xr.Dataset) -> xr.Dataset:
    """Verdicts on eq. 6 by estimator and load, in both forms and together.

    ``result`` has ``area_exponent``, ``slope``, ``predicted_slope``, ``sensitivity`` and
    ``crossings`` of :func:`size_effect.eq6.size_test`. :data:`_NAMES` over (estimator,
    normal_force); ``condition_number``, ``well_conditioned`` and ``size_effect`` over
    (normal_force,).
    """
    dims = ("estimator", "normal_force")
    predicted = Estimate.read(result.transpose(*dims, ...), "predicted_slope")
    measured = {
        form: Estimate.read(result, name)
        for form, name in (("area", "area_exponent"), ("slope", "slope"))
    }
    crossings = result["crossings"].isel(part=0).values
    with np.errstate(divide="ignore"):
        condition = 1 / result["sensitivity"].values
    shape = predicted.value.shape
    results = []
    for place in np.ndindex(shape):
        load = place[1]
        area = judge_exponent(measured["area"][load], predicted[place])
        own = judge_own_form(
            measured["slope"][load], predicted[place], float(condition[load]), int(crossings[load])
        )
        verdict, reason = both_forms(area, own)
        judged = {"verdict": verdict, "reason": reason}
        for form, judgement in (("area", area), ("slope", own)):
            judged |= {f"{form}_{name}": value for name, value in judgement._asdict().items()}
        results.append(judged)
    verdicts = xr.Dataset(stacked(results, _NAMES, dims, shape))
    attrs = cf_attrs("1", "d ln sigma_0 / d ln sigma* of the whole window")
    verdicts["condition_number"] = ("normal_force", condition, attrs)
    single = (crossings == 1) & (abs(condition) <= WORST_CONDITION)
    attrs = cf_attrs(
        "1", f"sigma* determines sigma_0, with a condition number up to {WORST_CONDITION:g}"
    )
    verdicts["well_conditioned"] = ("normal_force", single, attrs)
    effect = (measured["area"].low > ROUNDING) | (measured["area"].high < -ROUNDING)
    attrs = cf_attrs("1", "whether the exponent of A_r/A_0 differs from zero")
    verdicts["size_effect"] = ("normal_force", effect, attrs)
    return verdicts
