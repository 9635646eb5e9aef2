"""Rigid position of the faces set by one flow test at one pressure; T elsewhere is then predicted.

Scanned faces are brought together by their heights alone, and their distance is uncertain by far
more than T allows: 0.1 mm change it up to a hundredfold. One reading of T fixes that distance, a
shift of the gap that is the same at every pressure.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from scipy import optimize

from ..core.errors import InputError
from ..core.estimate import NO_ESTIMATE, Estimate
from ..core.settings import MeasuredTest
from ..flow.cubic_law import flow_of, grid_error
from ..flow.network import Flow
from .closure import COMPUTED, FITTED, PREDICTED, largest_of
from .computed import Joint
from .curve import Curve, ratio

#: Largest shift that is tried, mm, and the tolerance of it.
MAX_SHIFT, TOLERANCE = 2.0, 1e-4
#: Step of the shift over which d ln T/d shift is taken, mm.
_STEP = 2e-3
_CLOSED = 1e-30  # mm3, in place of 0 in a logarithm

#: Numbers of a flow test: unit, long name, dimension of an array.
OF_FLOW = {
    "datum": ("mm", "shift of the faces apart, at which T is that of a reading at one pressure"),
    "datum_pressure": ("MPa", "pressure of that reading"),
    "datum_reason": ("1", "why there is no shift"),
    "status": ("1", "how the calibrated T came about: computed, fitted or predicted"),
    "calibrated": ("mm3", "transmissivity, computed with that shift", "flow_point"),
    "calibrated_ratio": ("1", "transmissivity with that shift over measured", "flow_point"),
}


def compare_flow(
    joint: Joint,
    tests: Sequence[MeasuredTest],
    readings: Sequence[Curve],
    rows: Sequence[Mapping[str, Any]],
    flow: xr.Dataset,
) -> list[dict[str, Any]]:
    """Rows of flow tests with :data:`OF_FLOW`: T with the shift that one of them sets.

    ``rows`` have ``at`` (MPa) and ``measured`` at the computed states, ``flow`` is the stage of
    this name. Raises `InputError` if the pressure of the reading lies outside of the test, or no T
    is as large or small within :data:`MAX_SHIFT`, and `NotConverged`.
    """
    setting = next((test for test in tests if np.isfinite(test.datum_pressure)), None)
    if setting is None:
        return [{**row, **_without(len(row["at"]))} for row in rows]
    place = tests.index(setting)
    wanted = _reading(setting, readings[place])
    passing = [
        _Passing(joint, test, largest_of(test, curve), row["at"], flow)
        for test, curve, row in zip(tests, readings, rows, strict=True)
    ]
    shift = _fitted_shift(passing[place], setting, wanted)
    found = []
    for test, of_test, row in zip(tests, passing, rows, strict=True):
        calibrated = of_test.estimate(shift)
        is_fitted = test is setting
        found.append(
            {
                **row,
                "datum": shift if is_fitted else NO_ESTIMATE,
                "datum_reason": "" if is_fitted else f"the test '{setting.label}' sets the shift",
                "datum_pressure": test.datum_pressure,
                "status": FITTED if is_fitted and len(row["at"]) == 1 else PREDICTED,
                "calibrated": calibrated,
                "calibrated_ratio": ratio(calibrated, row["measured"]),
            }
        )
    return found


def _without(points: int) -> dict[str, Any]:
    """:data:`OF_FLOW` where no test sets the shift."""
    unknown = np.full(points, np.nan)
    nothing = Estimate(unknown, unknown, unknown)
    return {
        "datum": NO_ESTIMATE,
        "datum_pressure": np.nan,
        "datum_reason": "no flow test states a 'datum_pressure'",
        "status": COMPUTED,
        "calibrated": nothing,
        "calibrated_ratio": nothing,
    }


class _Passing:
    """T of a joint on the branch of a test, over a shift of its faces.

    At some pressures, MPa, and at that of the reading that sets the shift: one path of loads.
    """

    def __init__(self, joint, test, largest, pressures, flow):
        self.axis = str(flow.attrs[f"flow_axis_{test.way}"])
        self.spacing = tuple(float(step) for step in joint.loading.spacing * joint.factor)
        self.pressures = np.asarray(pressures, float)
        every = np.union1d(self.pressures, test.datum_pressure)
        every = every[np.isfinite(every)]
        self._gaps = dict(
            zip(every.tolist(), joint.gaps_on_branch(test, largest, every), strict=True)
        )

    def at(self, shift: float) -> np.ndarray:
        """T (n,), mm3, of faces farther apart by a shift, mm."""
        return np.array([self.flow(p, shift).transmissivity for p in self.pressures.tolist()])

    def estimate(self, shift: Estimate) -> Estimate:
        """T (n,) with the interval of the shift."""
        value, low, high = (self.at(float(end)) for end in shift.ends)
        return Estimate(value, low, high)

    def grid_error(self, pressure: float, shift: float) -> float:
        """Relative grid error of T at a pressure."""
        flow = self.flow(pressure, shift)
        off = grid_error(self.gap(pressure, shift), self.spacing, self.axis, flow)
        return off / max(flow.transmissivity, _CLOSED)

    def gap(self, pressure: float, shift: float = 0.0) -> np.ndarray:
        """Gap (ny, nx) at a pressure of faces farther apart by a shift, mm."""
        return np.maximum(self._gaps[pressure] + shift, 0.0)

    def flow(self, pressure: float, shift: float) -> Flow:
        """Flow through that gap."""
        return flow_of(self.gap(pressure, shift), self.spacing, self.axis)


def _reading(test: MeasuredTest, readings: Curve) -> Estimate:
    """T read at the pressure that sets the shift, mm3; `InputError` if the test has none there."""
    pressure = test.datum_pressure
    wanted = readings.at(np.array([pressure]))[0]
    if not wanted.value > 0:
        ends = f"{readings.x[0]:.3g} to {readings.x[-1]:.3g} MPa"
        raise InputError(
            f"{test.file}: no T is read at 'datum_pressure: {pressure:g} MPa'; write a pressure of "
            f"the test ({ends}) at which water passes"
        )
    return wanted


def _fitted_shift(passing: _Passing, test: MeasuredTest, wanted: Estimate) -> Estimate:
    """Shift, mm, at which T is that of a reading; its interval is that of reading and grid."""
    pressure = test.datum_pressure

    def apart(shift: float) -> float:
        found = passing.flow(pressure, shift).transmissivity
        return float(np.log(max(found, _CLOSED) / wanted.value))

    low, high = -float(passing.gap(pressure).max()), MAX_SHIFT
    if apart(high) < 0:
        raise InputError(
            f"{test.file}: T at {pressure:g} MPa is larger than that of faces {MAX_SHIFT:g} mm "
            "farther apart; check its unit"
        )
    shift = float(optimize.brentq(apart, low, high, xtol=TOLERANCE))
    steepness = (apart(shift + _STEP) - apart(shift - _STEP)) / (2 * _STEP)
    of_reading = abs(np.log(wanted.high / wanted.value))
    half = np.hypot(of_reading, passing.grid_error(pressure, shift)) / max(steepness, _CLOSED)
    return Estimate(shift, shift - half, shift + half)
