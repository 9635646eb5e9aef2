"""Closure tests beside computed closure: from one datum, by the same laws, with one constant."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.interpolate import PchipInterpolator

from ..core.errors import InputError
from ..core.estimate import NO_ESTIMATE, Estimate
from ..core.limits import SEATED_SPAN
from ..core.settings import MeasuredTest
from ..laws.closure_laws import fit_hyperbola, fit_semi_logarithmic
from .beforehand import require_calibration, require_relief
from .calibration import NEAR, fit_factor
from .computed import CARRIED, Joint
from .curve import Curve, compared, ratio

#: Origin of the computed curve beside a test.
COMPUTED, FITTED, PREDICTED = "computed", "fitted", "predicted"
#: Hardnesses that are solved to fit one, and the ends of moduli, as factors of those stated.
_HARDNESSES = np.array([1 / 3, 3**-0.5, 1.0, 3**0.5, 3.0])
_MODULI = (0.25, 4.0)
#: Fewest hardnesses for a fit.
_MIN_HARDNESSES = 3

_PARAMETERS = {
    "k_ni": ("MPa/mm", "initial normal stiffness k_ni of the hyperbola"),
    "v_m": ("mm", "largest closure v_m of the hyperbola"),
    "chi": ("mm", "closure per e-fold of pressure chi"),
}
#: Numbers of a closure test: unit, long name.
OF_CLOSURE = {
    **{
        f"{name}_{of}": ("1" if of == "ratio" else unit, f"{words}, {of}")
        for name, (unit, words) in _PARAMETERS.items()
        for of in ("measured", "computed", "ratio")
    },
    "datum": ("MPa", "pressure from which both closures count"),
    "largest": ("MPa", "pressure that the joint had carried before"),
    "rock": ("mm/MPa", "displacement of the rock, which was subtracted"),
    "status": ("1", "how the calibrated curve came about: computed, fitted or predicted"),
    "ratio_calibrated": ("1", "calibrated over measured closure at the end"),
}
#: The calibrated constant: unit, long name.
OF_CALIBRATION = {
    "calibrated_constant": ("1", "constant that is fitted to a test; empty without"),
    "calibrated_test": ("1", "test that it is fitted to"),
    "calibrated_value": ("MPa", "constant as fitted"),
    "calibrated_factor": ("1", "constant as fitted over that stated"),
    "calibration_reason": ("1", "why there is none, or what to know of it"),
}


def compare_closure(
    joint: Joint, tests: Sequence[MeasuredTest], readings: Sequence[Curve]
) -> tuple[list[dict[str, Any]], dict[str, Any]]:
    """Rows of closure tests of a joint beside its computed closure, and the calibrated constant.

    A row has ``readings``, ``laid`` (on the axis of the stage ``closure``), ``at``, ``measured``,
    ``computed``, ``ratio`` and :data:`OF_CLOSURE`; the constant has :data:`OF_CALIBRATION`. Raises
    `NotConverged`, and `InputError` if a closure exceeds the relief of the faces, or no computed
    state lies within a test.
    """
    for test, curve in zip(tests, readings, strict=True):
        require_relief(test, curve, joint.relief)
    calibrated = _Calibrated(joint, tests, readings)
    rows = [
        _row(joint, test, curve, calibrated) for test, curve in zip(tests, readings, strict=True)
    ]
    return rows, calibrated.described()


def largest_of(test: MeasuredTest, readings: Curve) -> float:
    """Pressure that a joint has carried, MPa: as stated, else the largest reading."""
    stated = test.largest_pressure
    return max(stated, readings.x[-1]) if np.isfinite(stated) else float(readings.x[-1])


class _Calibrated:
    """Constant that one of the tests calibrates, and the closures with it."""

    def __init__(self, joint, tests, readings):
        self.joint, self.test = joint, next((test for test in tests if test.calibrate), None)
        self.factor = NO_ESTIMATE
        if self.test is None:
            return
        curve = readings[tests.index(self.test)]
        require_calibration(self.test, joint.hardness)
        fitted = self._ladder(curve) if self.test.calibrate == "hardness" else self._scaled(curve)
        self.factor = fit_factor(curve.where(curve.x >= self.test.seat), *fitted)

    def at(self, test: MeasuredTest, largest: float, factor: float) -> Curve:
        """Computed closure on the branch of a test at a factor of the constant."""
        if self.test.calibrate == "hardness":
            return self.joint.with_hardness(test, largest, factor * self.joint.hardness)
        return self.joint.on_branch(test, largest, factor)

    def _scaled(self, readings):
        largest = largest_of(self.test, readings)
        return lambda factor: self.joint.on_branch(self.test, largest, factor), _MODULI

    def _ladder(self, readings):
        """Closures between those at a few hardnesses, over the logarithm of the hardness."""
        largest = largest_of(self.test, readings)
        carry = _HARDNESSES[largest < CARRIED * self.joint.hardness * _HARDNESSES]
        if carry.size < _MIN_HARDNESSES:
            raise InputError(
                f"{self.test.file}: {largest:.3g} MPa are too near to the hardness of "
                f"{self.joint.hardness:.3g} MPa to fit that; state a larger one in the material"
            )
        solved = [self.at(self.test, largest, factor) for factor in carry]
        curves = PchipInterpolator(np.log(carry), np.array([curve.y for curve in solved]))
        first = solved[0]

        def family(factor: float) -> Curve:
            return Curve(first.x, curves(np.log(factor)), first.error)

        return family, (carry[0], carry[-1])

    def described(self) -> dict[str, Any]:
        """:data:`OF_CALIBRATION`."""
        constant = self.test.calibrate if self.test else ""
        settings = self.joint.loading.settings.material
        stated = self.joint.hardness if constant == "hardness" else settings.e_star
        reason = self.factor.reason
        if constant == "modulus" and not reason:
            reason = "the value is E*"
            if np.isfinite(self.joint.hardness):
                reason += "; the hardness is multiplied by the same factor"
        return {
            "calibrated_constant": constant,
            "calibrated_test": self.test.label if self.test else "",
            "calibrated_value": self.factor.mapped(lambda factor: factor * stated),
            "calibrated_factor": self.factor,
            "calibration_reason": reason,
        }


def _row(
    joint: Joint, test: MeasuredTest, readings: Curve, calibrated: _Calibrated
) -> dict[str, Any]:
    """One test beside the computed closure on its branch."""
    largest = largest_of(test, readings)
    curve = joint.on_branch(test, largest)
    datum = max(test.seat, curve.x[0] if curve.x.size else np.nan, readings.x[0])
    measured, computed = readings.since(datum), curve.since(datum)
    inside = (computed.x > datum) & (computed.x <= readings.x[-1] * (1 + 1e-9))
    if not inside.any():
        raise InputError(
            f"{test.file}: no computed state lies between its datum of {datum:.3g} MPa and "
            f"{readings.x[-1]:.3g} MPa; add loads to the study"
        )
    span = computed.where(computed.x <= readings.x[-1])
    apart = joint.apart(test, largest, datum, computed)
    computed = replace(computed, error=np.hypot(computed.error, apart))
    row = {
        "readings": readings,
        # The readings on the axis of the stage ``closure``, which counts from the study's seat.
        "laid": readings.y - readings.at(datum).value + curve.at(datum).value - joint.seat_closure,
        **compared(computed.where(inside), measured),
        "datum": datum,
        "largest": largest,
        "rock": test.compliance,
        "status": COMPUTED,
        "ratio_calibrated": NO_ESTIMATE,
    }
    row |= _laws(measured, span, datum)
    if calibrated.factor.known:
        row["status"] = FITTED if test is calibrated.test else PREDICTED
        row["ratio_calibrated"] = _with_constant(calibrated, test, largest, datum, readings)
    return row


def _with_constant(calibrated: _Calibrated, test, largest, datum, readings) -> Estimate:
    """Calibrated over measured closure at the largest pressure that both have, from a datum.

    The error holds the interval of the constant, of the computed closure and of the readings. The
    interval of the constant is carried over by the slope near it, because at a distant constant the
    loads may not reach the pressure.
    """
    best, *ends = np.log(calibrated.factor.ends)
    nearby = [best + np.clip(end - best, -NEAR, NEAR) for end in ends]
    curves = [calibrated.at(test, largest, float(np.exp(log))) for log in (best, *nearby)]
    datum = max(datum, *(curve.x[0] for curve in curves))
    top = min(readings.x[-1], *(curve.x[-1] for curve in curves))
    if top <= datum:
        return NO_ESTIMATE
    value, *at_ends = (curve.since(datum).at(top) for curve in curves)
    apart = max(
        abs(at_end.value - value.value) * (end - best) / (near - best)
        for at_end, end, near in zip(at_ends, ends, nearby, strict=True)
    )
    half = np.hypot(apart, value.high - value.value)
    computed = Estimate(value.value, value.value - half, value.value + half)
    return ratio(computed, readings.since(datum).at(top))


def _laws(measured: Curve, computed: Curve, datum: float) -> Mapping[str, Estimate]:
    """Parameters of both laws, fitted to both curves over the same pressures."""
    parameters: dict[str, dict[str, Estimate]] = {}
    for name, curve in (("measured", measured), ("computed", computed)):
        fitted = (curve.x <= SEATED_SPAN * datum) & (curve.y > 0)
        bent = fit_hyperbola(curve.x[fitted], curve.y[fitted], datum)
        logarithm = fit_semi_logarithmic(curve.x[fitted], curve.y[fitted])
        parameters[name] = {"k_ni": bent.k_ni, "v_m": bent.w_m, "chi": logarithm.b}
    return {
        f"{parameter}_{of}": value
        for parameter in _PARAMETERS
        for of, value in (
            *((name, parameters[name][parameter]) for name in parameters),
            ("ratio", ratio(parameters["computed"][parameter], parameters["measured"][parameter])),
        )
    }
