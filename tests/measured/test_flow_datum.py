"""Rigid position of the faces from one reading of a flow test."""

from types import SimpleNamespace

import numpy as np
import pytest
from tiny_pairs import loading_of, pair

from fractalcontact.core.errors import InputError
from fractalcontact.core.settings import MeasuredTest
from fractalcontact.flow.cubic_law import flow_of
from fractalcontact.measured.computed import Joint
from fractalcontact.measured.curve import Curve, compared
from fractalcontact.measured.flow_datum import compare_flow

PRESSURES, SHIFT = np.array([1.0, 2.0, 5.0, 10.0, 25.0]), 0.05
FLOW = SimpleNamespace(attrs={"flow_axis_along": "x", "flow_axis_across": "y"})
LOAD = MeasuredTest("flow", "flow.csv", {}, branch="load", way="along")


@pytest.fixture(scope="module")
def joint():
    loading = loading_of(pair())
    curve = Curve.of(PRESSURES, np.log(PRESSURES) + 1, 0.0)
    return Joint(loading, 1, curve, 0.0, np.zeros(5), curve)


@pytest.fixture(scope="module")
def tested(joint):
    """T of the joint, and of one whose faces lie farther apart, which was tested."""
    gaps = joint.gaps_on_branch(LOAD, 25.0, PRESSURES)
    spacing = tuple(joint.loading.spacing)
    return [
        np.array([flow_of(gap + shift, spacing, "x").transmissivity for gap in gaps])
        for shift in (0.0, SHIFT)
    ]


def row_of(computed, readings):
    return compared(Curve.of(PRESSURES, computed, 0.0), readings)


def test_one_reading_sets_the_distance_and_predicts_the_others(joint, tested):
    computed, measured = tested
    test = MeasuredTest("flow", "flow.csv", {}, branch="load", way="along", datum_pressure=5.0)
    readings = Curve.of(PRESSURES, measured, 0.05 * measured)
    (row,) = compare_flow(joint, [test], [readings], [row_of(computed, readings)], FLOW)
    shift = row["datum"]
    assert shift.low < SHIFT < shift.high
    assert shift.value == pytest.approx(SHIFT, abs=1e-3)
    ratio = row["calibrated_ratio"]
    np.testing.assert_allclose(ratio.value, 1, rtol=0.02)
    assert ((ratio.low < 1) & (ratio.high > 1)).all()
    # As fitted by the heights, T is off by far more than its reading.
    assert (computed / measured < 0.8).all()
    assert (np.diff(row["calibrated"].value) < 0).all()


def test_without_such_a_reading_nothing_is_calibrated(joint, tested):
    computed, measured = tested
    readings = Curve.of(PRESSURES, measured, 0.0)
    (row,) = compare_flow(joint, [LOAD], [readings], [row_of(computed, readings)], FLOW)
    assert row["status"] == "computed"
    assert np.isnan(row["calibrated"].value).all()
    assert np.isnan(row["datum"].value)
    assert "datum_pressure" in row["datum_reason"]


def test_one_test_sets_the_distance_of_all_and_each_is_solved_once(joint, tested, monkeypatch):
    computed, measured = tested
    solved, gaps = [], Joint.gaps_on_branch

    def counted(self, test, largest, pressures):
        solved.append(test)
        return gaps(self, test, largest, pressures)

    monkeypatch.setattr(Joint, "gaps_on_branch", counted)
    setting = MeasuredTest("flow", "first.csv", {}, branch="load", way="along", datum_pressure=3.0)
    readings = [Curve.of(PRESSURES, measured, 0.0)] * 2
    rows = [row_of(computed, of) for of in readings]
    other, own = compare_flow(joint, [LOAD, setting], readings, rows, FLOW)
    assert np.isnan(other["datum"].value)
    assert setting.label in other["datum_reason"]
    assert own["datum_reason"] == ""
    assert solved == [LOAD, setting]
    # One path of loads has one state more: both agree to the tolerance of the solver.
    values = own["calibrated"].value, other["calibrated"].value
    np.testing.assert_allclose(*values, rtol=1e-3)


@pytest.mark.parametrize(
    ("pressure", "factor", "words"), [(50.0, 1.0, "no T is read"), (5.0, 1e9, "check its unit")]
)
def test_a_reading_that_fits_nothing_is_refused(joint, tested, pressure, factor, words):
    test = MeasuredTest("flow", "flow.csv", {}, branch="load", way="along", datum_pressure=pressure)
    readings = Curve.of(PRESSURES, factor * tested[1], 0.0)
    with pytest.raises(InputError, match=words):
        compare_flow(joint, [test], [readings], [row_of(tested[0], readings)], FLOW)
