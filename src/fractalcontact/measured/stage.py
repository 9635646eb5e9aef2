"""The stage ``measured``: laboratory tests beside the computed curves of a specimen."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from ..core.datasets import titled
from ..core.errors import InputError
from ..core.estimate import NO_ESTIMATE, Estimate
from ..core.per_curve import stacked
from ..core.reported import Reported
from ..core.settings import TEST_COLUMNS, MeasuredSettings, MeasuredTest, Solver
from ..states.loading import JointLoading
from .closure import OF_CALIBRATION, OF_CLOSURE, compare_closure
from .computed import Joint
from .curve import Curve, compared
from .flow_datum import OF_FLOW, compare_flow
from .others import WHY_NONE, computed_curve
from .readings import read_test

#: Unit and long name of what each kind of test measures, and of the axes that it is read over.
_MEASURED = {
    "closure": ("mm", "closure of the joint"),
    "flow": ("mm3", "transmissivity"),
    "dilatancy": ("mm", "dilation under constant pressure"),
    "shear": ("MPa", "shear stress"),
    "strength": ("MPa", "peak shear strength"),
}
_AXES = {"pressure": ("MPa", "nominal pressure"), "displacement": ("mm", "shear displacement")}
#: Settings of every test that are stored: field, unit, long name.
_OF_TESTS = {
    "branch": ("branch", "1", "branch of the test"),
    "cycle": ("cycle", "1", "number of the cycle"),
    "way": ("way", "1", "way of the flow"),
    "direction": ("direction", "1", "direction of sliding"),
    "held_pressure": ("pressure", "MPa", "nominal pressure that is held"),
}


@titled(measured="laboratory tests beside computed closure, flow, dilatancy and strength")
def measured_stage(
    specimens: xr.Dataset,
    joints: xr.Dataset,
    closure: xr.Dataset,
    dilatancy: xr.Dataset,
    error_budget: xr.Dataset,
    flow: xr.Dataset,
    settings: MeasuredSettings,
    solver: Solver,
    strength: xr.Dataset | None = None,
) -> dict[str, xr.Dataset]:
    """Readings of all tests of a specimen, computed values there, and their ratios.

    From stages by name; ``strength`` is that of a joint that slides. Of each kind of test K the
    readings over (K_test, K_reading) and, over (K_test, K_point), the computed curve within them:
    ``K_at``, ``K_measured``, ``K_computed`` and ``K_ratio``, with intervals; of closure also the
    laws and what is calibrated. Raises `InputError` if a file, or what is said of it, does not fit
    the computed curves, and `NotConverged` if a state of another branch or hardness could not be
    verified.
    """
    reported = Reported.read(closure)
    whole = JointLoading.of_joint(specimens, joints, reported.direction, settings, solver)
    joint = Joint.of(whole, closure, error_budget)
    stage = xr.Dataset()
    for kind in TEST_COLUMNS:
        tests = [test for test in settings.measured if test.kind == kind]
        if not tests:
            continue
        read = [read_test(test) for test in tests]
        readings = [reading.curve for reading in read]
        if kind == "closure":
            rows, calibration = compare_closure(joint, tests, readings)
            stage.update(stacked([calibration], OF_CALIBRATION, (), ()))
        else:
            rows = [
                _beside(test, curve, computed_curve(test, flow, dilatancy, strength, reported))
                for test, curve in zip(tests, readings, strict=True)
            ]
        if kind == "flow":
            rows = compare_flow(joint, tests, readings, rows, flow)
        rows = [row | {"note": reading.said} for row, reading in zip(rows, read, strict=True)]
        stage = stage.merge(_of_kind(kind, tests, rows))
    return {"measured": stage}


def _beside(test: MeasuredTest, readings: Curve, computed: Curve) -> dict[str, Any]:
    """Readings of a test, and the computed curve at its own points within them."""
    inside = (computed.x >= readings.x[0]) & (computed.x <= readings.x[-1])
    within = computed.where(inside)
    if not within.x.size and computed.x.size:
        ends = ("computed from {:.3g} to {:.3g}, measured from {:.3g} to {:.3g}").format(
            *(curve.x[place] for curve in (computed, readings) for place in (0, -1))
        )
        raise InputError(
            f"{test.file}: no computed {test.kind} lies within the readings ({ends}); add loads "
            "or offsets to the study"
        )
    return {
        "readings": readings,
        "laid": readings.y,
        **compared(within, readings),
        "reason": "" if within.x.size else WHY_NONE[test.kind],
    }


def _of_kind(kind: str, tests: Sequence[MeasuredTest], rows: Sequence[Mapping]) -> xr.Dataset:
    """Variables of the tests of a kind, rows of unequal length filled with NaN."""
    unit, words = _MEASURED[kind]
    axis = TEST_COLUMNS[kind][0]
    axis_unit, axis_words = _AXES[axis]
    test, reading, point = (f"{kind}_{name}" for name in ("test", "reading", "point"))
    names = {
        axis: (axis_unit, f"{axis_words} of a reading", reading),
        "at": (axis_unit, f"{axis_words} of a computed state", point),
        "read": (unit, f"{words}, a reading", reading),
        "measured": (unit, f"{words}, measured", point),
        "computed": (unit, f"{words}, computed", point),
        "ratio": ("1", f"{words}, computed over measured", point),
        "ratio_at_last": ("1", f"{words}, computed over measured at the last state"),
        "reason": ("1", "why nothing is compared"),
        "note": ("1", "what to know of the readings"),
        **{name: (unit, said) for name, (_, unit, said) in _OF_TESTS.items()},
        **(OF_CLOSURE if kind == "closure" else {}),
        **(OF_FLOW if kind == "flow" else {}),
    }
    results = [
        {axis: row["readings"].x, "read": replace(row["readings"], y=row["laid"]).values}
        | {"ratio_at_last": _last(row["ratio"]), "reason": ""}
        | {name: getattr(of_row, field) for name, (field, *_) in _OF_TESTS.items()}
        | {name: value for name, value in row.items() if name in names}
        for of_row, row in zip(tests, rows, strict=True)
    ]
    variables = stacked(results, names, [test])
    data = xr.Dataset({f"{kind}_{name}": variables[name] for name in variables})
    if not data.sizes[point]:  # no test has a computed state: each gets a missing one
        data = data.pad({point: (0, 1)}, keep_attrs=True)
    return data.assign_coords({test: [of_kind.label for of_kind in tests]})


def _last(ratio: Estimate) -> Estimate:
    """Ratio at the last point that has one."""
    finite = np.flatnonzero(np.isfinite(ratio.value))
    return ratio[int(finite[-1])] if finite.size else NO_ESTIMATE
