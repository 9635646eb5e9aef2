"""Derived numbers of a state, and the forms in which heights and loads are given."""

import numpy as np
import pytest

from roughcontact import HalfSpace, load_path, solve_contact
from roughcontact.contact.state import CandidateState


class Heights:
    """An object that offers its heights as SurfaceTopography's do."""

    def __init__(self, values):
        self.values = values

    def heights(self):
        return self.values


def rough(n=48, seed=0):
    return np.random.default_rng(seed).standard_normal((n, n)) * 1e-3


@pytest.mark.parametrize("boundary", ["free", "periodic", "mirrored"])
def test_a_mean_pressure_is_the_force_over_the_area(boundary):
    space = HalfSpace((48, 48), (0.1, 0.2), 2e4, boundary=boundary)
    by_pressure = solve_contact(rough(), space, mean_pressure=3.0)
    by_force = solve_contact(rough(), space, force=3.0 * space.area)
    np.testing.assert_array_equal(by_pressure.pressure, by_force.pressure)
    assert by_pressure.mean_pressure == pytest.approx(3.0, rel=1e-6)
    assert space.area == pytest.approx(48 * 48 * 0.02)
    assert solve_contact(rough(), space, mean_pressure=0.0).force == 0


@pytest.mark.parametrize("value", [-1.0, np.nan, np.inf, "3", [1.0, 2.0]])
def test_a_mean_pressure_that_is_none_is_refused_by_its_name(value):
    with pytest.raises(ValueError, match="mean pressure"):
        solve_contact(rough(), HalfSpace((48, 48), 0.1, 2e4), mean_pressure=value)


@pytest.mark.parametrize("other", [{"force": 1.0}, {"closure": 1e-3}])
def test_two_loads_are_refused(other):
    space = HalfSpace((48, 48), 0.1, 2e4)
    with pytest.raises(ValueError, match="give exactly one of closure=, force= and mean_pressure="):
        solve_contact(rough(), space, mean_pressure=1.0, **other)


def test_heights_may_be_an_object_that_has_them():
    space = HalfSpace((48, 48), 0.1, 2e4)
    plain = solve_contact(rough(), space, force=10.0)
    np.testing.assert_array_equal(
        solve_contact(Heights(rough()), space, force=10.0).pressure, plain.pressure
    )
    forces = {"forces": [10.0, 5.0], "hardness": 500.0}
    expected = load_path(rough(), space, **forces)[-1]
    path = load_path(Heights(rough()), space, **forces)[-1]
    np.testing.assert_array_equal(path.permanent_set, expected.permanent_set)


def test_masked_heights_of_an_object_are_refused():
    masked = np.ma.masked_greater(rough(), 2e-3)
    with pytest.raises(ValueError, match="masked cells"):
        solve_contact(Heights(masked), HalfSpace((48, 48), 0.1, 2e4), force=10.0)


def test_a_topography_of_surface_topography_has_its_first_axis_along_x():
    library = pytest.importorskip("SurfaceTopography")
    heights = rough()[:40]
    topography = library.Topography(heights, (40 * 0.125, 48 * 0.25))
    space = HalfSpace(topography.nb_grid_pts, topography.pixel_size, 2e4)
    assert space == HalfSpace((40, 48), (0.125, 0.25), 2e4)
    state = solve_contact(topography, space, force=10.0)
    np.testing.assert_array_equal(state.pressure, solve_contact(heights, space, force=10).pressure)


def test_elastic_energy_is_the_work_of_the_force():
    """As loading is elastic, dE = F dw: trapezoids over small steps of the closure."""
    space = HalfSpace((48, 48), 0.1, 2e4)
    closures = np.linspace(0.0, 2e-3, 41)
    states = [solve_contact(rough(), space, closure=closure) for closure in closures]
    work = np.trapezoid([state.force for state in states], closures)
    assert states[-1].elastic_energy == pytest.approx(work, rel=2e-3)


def test_numbers_of_a_state_on_candidates_are_those_of_the_whole_window():
    space = HalfSpace((512, 512), 0.1, 2e4)
    state = solve_contact(rough(512, seed=1), space, closure=1e-3)
    assert isinstance(state, CandidateState)
    whole = (state.pressure * state.displacement).sum() * space.cell_area / 2
    assert state.elastic_energy == pytest.approx(whole, rel=1e-9)
    assert 0 < state.corrected_area < state.area
