"""Registration error: nothing where nothing moves, known where the motion is."""

import numpy as np
import pytest
from tiny_pairs import loading_of, pair

from fractalcontact.core.intervals import t_quantile
from fractalcontact.error_budget.two_scans import (
    moved_specimen,
    registration_spread,
    registration_values,
)
from fractalcontact.registration.registration_scatter import motion_variables
from fractalcontact.registration.surface_motion import Motion
from fractalcontact.states.state_quantities import STATE_QUANTITIES

MIDDLE = (12.0, 12.0)


def loading(motions, level=0.0):
    specimen = pair(level)
    if motions:
        specimen = specimen.assign(motion_variables(motions))
    return loading_of(specimen)


def spread_of(joint):
    """Spread of a pair that is seated under its first load."""
    forces = joint.forces(joint.settings.loads)
    return registration_spread(registration_values(joint), forces, forces[0])


def test_registrations_that_are_none_have_no_spread():
    spread = spread_of(loading([Motion(MIDDLE, MIDDLE)] * 3))
    assert spread.keys() == {*STATE_QUANTITIES, "seated_closure"}
    assert all((of < 1e-9).all() for of in spread.values())
    assert spread_of(loading([])) is None


def test_a_shift_by_a_cell_is_that_of_the_cells():
    shifted = Motion(MIDDLE, (MIDDLE[0] + 0.5, MIDDLE[1] - 1.0))
    specimen = loading([]).specimen
    moved = moved_specimen(specimen, shifted)["upper"].values
    np.testing.assert_allclose(moved[:-2, 1:], specimen["upper"].values[2:, :-1], atol=1e-10)
    tilted = moved_specimen(specimen, Motion(MIDDLE, MIDDLE, slope=(0.1, -0.2)))
    rise = (tilted["upper"] - specimen["upper"]).values
    x, y = np.meshgrid(specimen.x, specimen.y)
    np.testing.assert_allclose(rise, 0.1 * (x - 12) - 0.2 * (y - 12), atol=1e-10)


def test_the_spread_is_that_of_the_values_and_grows_with_the_motions():
    near, far = (
        [Motion(MIDDLE, (12 + size * a, 12 + size * b)) for a, b in ((1, 0), (-1, 0), (0, 1))]
        for size in (0.01, 0.1)
    )
    values = registration_values(loading(far))
    spread = spread_of(loading(far))
    values["seated_closure"] = values["closure"] - values["closure"][:, :1]
    for name in (*STATE_QUANTITIES, "seated_closure"):
        assert values[name].shape == (3, 2)
        half = t_quantile(2) * values[name].std(axis=0, ddof=1)
        np.testing.assert_allclose(spread[name], half)
    assert (spread["closure"] > 2 * spread_of(loading(near))["closure"]).all()
    # More load closes more, on more area, more stiffly.
    assert (np.diff(values["closure"]) > 0).all()
    assert (np.diff(values["separation"]) < 0).all()
    assert (np.diff(values["stiffness"]) > 0).all()


def test_values_do_not_depend_on_how_far_apart_the_faces_were_scanned():
    motions = [Motion(MIDDLE, (12.1, 12.0)), Motion(MIDDLE, (11.9, 12.0))]
    near, far = registration_values(loading(motions)), registration_values(loading(motions, 3.0))
    for name, values in near.items():
        np.testing.assert_allclose(values, far[name], rtol=1e-3)


def test_loads_can_be_chosen():
    whole, one = loading([Motion(MIDDLE, (12.1, 12.0)), Motion(MIDDLE, (11.9, 12.0))]), None
    one = registration_values(whole, [(25.0, "pressure")])
    whole_ladder = registration_values(whole)
    for name, of in whole_ladder.items():
        assert one[name][:, 0] == pytest.approx(of[:, 1], rel=1e-2)
