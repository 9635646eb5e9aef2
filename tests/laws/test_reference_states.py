"""Stiffness at the reference pressures: solved there, or that of the curve, or none."""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from made_settings import made_settings
from made_stages import scan, stages_of

from fractalcontact.core.limits import MIN_FREE_NODES, REFERENCE_PRESSURES
from fractalcontact.core.settings import Material
from fractalcontact.joint.joint import composite_topography
from fractalcontact.laws.reference_states import (
    NO_LOAD,
    further_pressures,
    reference_stiffness,
    with_curve_stiffness,
)
from fractalcontact.laws.seated_laws import ON_SUSPECTS, curve_stiffness
from fractalcontact.states.settlement import window_settlement
from fractalcontact.states.state_scalars import resolved_slope
from fractalcontact.study.configuration import solver_settings
from fractalcontact.surface.synthesis import self_affine
from roughcontact.contact.slope import Slope
from roughcontact.contact.solve import solve_contact
from roughcontact.elastic.halfspace import HalfSpace

ROCK = Material(30.0, np.nan, 2e3, np.inf, "rock", 4e3, 0.0)


def test_slope_of_a_curve_is_that_of_a_logarithm_and_of_a_power():
    pressure = np.geomspace(0.5, 40, 12)
    found = curve_stiffness(pressure, 0.1 + 0.02 * np.log(pressure))
    np.testing.assert_allclose(found[1:-1], pressure[1:-1] / 0.02)
    assert np.isnan(found[[0, -1]]).all()
    found = curve_stiffness(pressure, 0.03 * pressure**0.5)
    np.testing.assert_allclose(found[1:-1], pressure[1:-1] ** 0.5 / 0.015, rtol=0.02)


def test_slope_of_a_curve_spans_states_that_lie_apart():
    """A neighbour nearer than a quarter of the pressure would divide its own error by little."""
    pressure = np.array([1.0, 2.0, 2.01, 4.0])
    closure = 0.02 * np.log(pressure)
    closure[2] += 1e-3
    found = curve_stiffness(pressure, closure)
    assert found[1] == pytest.approx(2 / 0.02, rel=1e-6)
    closure[0] = np.nan
    assert np.isnan(curve_stiffness(pressure, closure)[[0, 1]]).all()


def test_further_pressures_lie_between_the_loads_and_are_none_of_them():
    np.testing.assert_array_equal(further_pressures(np.array([0.5, 5.0, 20.0])), [1, 10])
    assert further_pressures(np.array([1.0, 2.0])).size == 0
    assert further_pressures(np.array([0.5, 1.0 + 1e-12, 4.0])).size == 0


def test_the_curve_stands_in_for_a_state_without_a_stiffness_at_those_pressures_alone():
    pressure = np.array([0.25, 0.5, 1.0, 2.5, 5.0, 10.0, 25.0])
    stiffness = np.where(pressure < 2, np.nan, 10 * pressure)
    found = with_curve_stiffness(pressure, stiffness, 0.05 * np.log(pressure))
    np.testing.assert_allclose(found, [np.nan, np.nan, 20.0, 25, 50, 100, 250])


def test_a_pressure_below_which_the_scan_decides_says_so():
    """Loads up to 1.5 MPa act on suspicious cells; flush faces have no stiffness anywhere."""
    pressure = np.geomspace(0.25, 50, 12)
    values = {
        "interface_stiffness": 12 * pressure**0.9,
        "suspect_load_share": np.where(pressure < 1.5, 0.9, 0.2),
        "resolved": np.ones(12, bool),
        "nominal_pressure": pressure,
    }
    curves = xr.Dataset(
        {name: ("normal_force", value) for name, value in values.items()},
        {"resolution": [1], "normal_force": 100 * pressure},
    )
    flush = SimpleNamespace(
        cells=[0], offsets=[0.0], direction="E", composite=lambda cells: np.zeros((8, 8))
    )
    found = reference_stiffness(flush, curves, xr.Dataset())
    assert np.isnan(found["reference_stiffness"]).all()
    assert found["reference_stiffness_reason"].values.tolist() == [ON_SUSPECTS, NO_LOAD, NO_LOAD]
    assert found["reference_pressure"].attrs["units"] == "MPa"


def test_few_free_nodes_have_no_slope():
    class State:
        def __init__(self, cells):
            self.slope = Slope(10.0, 1.0, cells)

    assert resolved_slope(State(np.inf)).value == 10
    assert resolved_slope(State(float(MIN_FREE_NODES))).value == 10
    few = resolved_slope(State(MIN_FREE_NODES - 1.0))
    assert np.isnan(few.value)
    assert "under 30" in few.reason


@pytest.mark.parametrize("boundary", ["free", "mirrored"])
def test_stated_stiffness_is_that_of_states_solved_there(boundary):
    heights = self_affine((40, 44), 0.1, 0.8, rms=0.02, seed=5, roll_off=1.6)
    loads = [(pressure, "pressure") for pressure in (0.6, 3.0, 7.0, 30.0)]
    settings = made_settings(
        material=ROCK,
        loads=loads,
        dilatancy_loads=loads[-1:],
        map_load=loads[-1],
        boundary=boundary,
        directions=["E"],
        contact_directions=["E"],
        offsets=[0.3],
        map_offset=0.3,
        window=[3.2, 3.2],
        seating_pressure=0.5,
    )
    solver = solver_settings({"solver": {"rtol": 1e-7}}, "made")
    found = stages_of("made", (scan(heights, 0.1), None), settings, solver, ("closure",))
    composite = composite_topography(found["specimens"], "E", 3)
    space = HalfSpace(composite.shape, 0.1, ROCK.e_star, boundary=boundary)
    stated = found["closure"]["reference_stiffness"].squeeze().values
    assert np.isfinite(stated).sum() >= 2
    for pressure, stiffness in zip(REFERENCE_PRESSURES, stated, strict=True):
        if np.isfinite(stiffness):
            state = solve_contact(composite, space, mean_pressure=pressure, rtol=1e-8)
            bulk = float(window_settlement(space, state.force)) / pressure
            expected = 1 / (space.area / state.stiffness - bulk)
            assert stiffness == pytest.approx(expected, rel=1e-3)
