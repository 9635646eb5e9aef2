"""Scan error: nothing where readings agree, and their largest distance where they differ."""

import numpy as np
import pytest
from tiny_pairs import loading_of, pair

from fractalcontact.error_budget.two_scans import reading_values, scan_spread, wider_spread
from fractalcontact.scan.other_readings import (
    MARKS,
    OTHER_FACES,
    OTHER_MARKS,
    READING,
    other_readings,
)
from fractalcontact.states.state_quantities import SOUND, STATE_QUANTITIES
from fractalcontact.surface.synthesis import self_affine


def loading(*changes):
    """A pair with further readings, each the upper face plus a change (ny, nx)."""
    specimen = pair()
    if changes:
        own = np.stack([specimen["lower"].values, specimen["upper"].values])
        heights = [own + np.stack([np.zeros_like(change), change]) for change in changes]
        names = [f"reading {i}" for i in range(len(changes))]
        specimen = specimen.assign_coords({READING: names, "face": ["lower", "upper"]})
        specimen = specimen.assign({OTHER_FACES: ((READING, "face", "y", "x"), np.stack(heights))})
    return loading_of(specimen)


def spread_of(joint):
    """Spread of a pair that is seated under its first load."""
    forces = joint.forces(joint.settings.loads)
    return scan_spread(reading_values(joint), forces, forces[0])


def test_a_single_reading_has_no_spread():
    assert spread_of(loading()) is None
    assert other_readings(loading().specimen) == {}


def test_readings_that_differ_by_their_height_alone_have_no_spread():
    spread = spread_of(loading(np.full((48, 48), 0.3)))
    assert spread.keys() == {*STATE_QUANTITIES, "seated_closure"}
    for name, of in spread.items():
        np.testing.assert_allclose(of, 0, atol=1e-6, err_msg=name)


def test_the_spread_is_the_largest_distance_of_a_reading_from_this_one():
    rough = 0.05 * self_affine((48, 48), 0.5, 0.6, rms=1.0, seed=3)
    joint = loading(rough, 3 * rough)
    values, spread = reading_values(joint), spread_of(joint)
    for name in STATE_QUANTITIES:
        of = values[name]
        assert of.shape == (3, 2)
        np.testing.assert_allclose(spread[name], np.abs(of[1:] - of[0]).max(axis=0))
    closed = np.diff(values["closure"], axis=1)[:, 0]
    apart = np.abs(closed[1:] - closed[0]).max()
    np.testing.assert_allclose(spread["seated_closure"], [0, apart])
    # Rougher faces close more under the heavy load, and a further reading narrows nothing.
    assert values["closure"][2, 1] > values["closure"][0, 1]
    alone = spread_of(loading(rough))
    assert all((spread[name] >= alone[name] * (1 - 1e-6)).all() for name in spread)


def test_a_reading_with_a_hole_in_the_window_is_left_out():
    hole = np.zeros((48, 48))
    hole[24, 24] = np.nan
    assert spread_of(loading(hole)) is None
    rough = 0.05 * self_affine((48, 48), 0.5, 0.6, rms=1.0, seed=3)
    assert reading_values(loading(hole, rough))["closure"].shape == (2, 2)


def test_each_reading_has_its_own_faces():
    joint = loading(np.full((48, 48), 0.2), np.full((48, 48), 0.4))
    readings = other_readings(joint.specimen)
    for (name, specimen), rise in zip(readings.items(), (0.2, 0.4), strict=True):
        change = specimen["upper"].values - joint.specimen["upper"].values
        assert change == pytest.approx(rise), name
        np.testing.assert_array_equal(specimen["lower"], joint.specimen["lower"])


def test_the_errors_of_two_scans_are_the_wider_of_both_spreads():
    readings = {"closure": np.array([1.0, 4.0]), "stiffness": np.array([2.0, np.nan])}
    motions = {"closure": np.array([3.0, 3.0]), "stiffness": np.array([1.0, 5.0]), "more": 1.0}
    wider = wider_spread(readings, motions)
    np.testing.assert_array_equal(wider["closure"], [3.0, 4.0])
    np.testing.assert_array_equal(wider["stiffness"], [2.0, 5.0])
    assert wider_spread(None, motions) == motions
    assert wider_spread(readings, None) == readings
    assert wider_spread(None, None) is None


def test_a_reading_brings_its_own_suspicious_cells():
    """A state on suspicious cells of that reading alone enters no fit of it."""
    joint = loading(np.full((48, 48), 0.2))
    assert (reading_values(joint)[SOUND] == 1).all()
    marks = np.zeros((1, len(MARKS), 48, 48), np.int8)
    marks[:, MARKS.index("suspect_upper")] = 1
    specimen = joint.specimen.assign({OTHER_MARKS: ((READING, "mark", "y", "x"), marks)})
    specimen = specimen.assign_coords(mark=list(MARKS))
    values = reading_values(loading_of(specimen))
    assert (values[SOUND][0] == 1).all()
    assert (values[SOUND][1] == 0).all()
