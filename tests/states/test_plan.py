"""What accuracy means for the solves of a study, and the errors its states carry."""

import numpy as np
import pytest
import xarray as xr
from made_settings import made_settings

from fractalcontact import HalfSpace, solve_contact
from fractalcontact.core.errors import InputError
from fractalcontact.core.tolerance import tolerance
from fractalcontact.domain.box_dimension import box_dimension
from fractalcontact.error_budget.solve_plan import solve_plan
from fractalcontact.joint.joint import describe_joint
from fractalcontact.laws.closure import closure_curves, elastic_dilatancy
from fractalcontact.states.loading import JointLoading
from fractalcontact.states.plan import solved_loads
from fractalcontact.states.state_scalars import numbers_of
from fractalcontact.states.states import WITH_SOLVER_ERROR, combine
from fractalcontact.states.sweep import contact_states
from fractalcontact.study.configuration import solver_settings
from fractalcontact.surface.specimen import make_specimen
from fractalcontact.surface.synthesis import self_affine

SPACING = 0.1
SETTINGS = made_settings(
    directions=["W", "E"],
    contact_directions=["W", "E"],
    offsets=[0.2, 0.5],
    surface_range=None,
    resolutions=[1, 2, 4],
    loads=[(2.0, "pressure"), (20.0, "force"), (100.0, "force"), (300.0, "force")],
    dilatancy_loads=[(100.0, "force")],
    map_load=(2.0, "pressure"),
)
ACCURACY = {"closure": 0.01, "delta_sigma": 0.02}
FORCES = np.array([20.0, 32.0, 100.0, 300.0])  # 2 MPa on 16 mm2 are 32 N


def which(**where):
    known = {"first": True, "at_maps": False, "factor": 1, "all_states": False}
    return solved_loads(SETTINGS, FORCES, 16.0, **(known | where)).tolist()


def test_only_what_is_shown_is_solved():
    assert which() == [0, 1, 2, 3]
    assert which(factor=2) == []
    assert which(factor=2, at_maps=True) == [0, 1, 2, 3]
    assert which(first=False) == [1, 2]
    assert which(first=False, at_maps=True, factor=2) == []
    assert which(first=False, factor=4, all_states=True) == [0, 1, 2, 3]


def test_the_tolerance_follows_the_stricter_wish():
    assert tolerance(ACCURACY) == pytest.approx(1e-3)
    assert tolerance({"closure": 1e-4, "delta_sigma": 0.02}) == pytest.approx(1e-5)
    assert tolerance({"closure": 0.5, "delta_sigma": 1e-3}) == pytest.approx(5e-5)
    assert tolerance({"closure": 0.9, "delta_sigma": 0.9}) == 1e-2


@pytest.mark.parametrize(
    ("study", "rtol", "accuracy"),
    [
        ({}, 1e-3, ACCURACY),
        ({"accuracy": {"closure": "0.1 %"}}, 1e-4, {"closure": 1e-3, "delta_sigma": 0.02}),
        ({"accuracy": "full"}, 1e-6, None),
        ({"accuracy": "full", "solver": {"rtol": 1e-9}}, 1e-9, None),
        ({"solver": {"rtol": 1e-7}}, 1e-7, ACCURACY),
    ],
)
def test_what_a_study_says_becomes_the_solver_s_settings(study, rtol, accuracy):
    found = solver_settings(study, "study.yaml")
    assert found.kernel == "love"
    assert found.rtol == pytest.approx(rtol)
    assert found.accuracy == (None if accuracy is None else pytest.approx(accuracy))


@pytest.mark.parametrize("text", ["1 mm", "-1 %", "100 %", 0, 1.5, "", "1 % %", True])
def test_what_is_no_share_is_refused_by_its_key(text):
    with pytest.raises(InputError, match=r"study.yaml: accuracy.closure: .* is no share; write"):
        solver_settings({"accuracy": {"closure": text}}, "study.yaml")


@pytest.mark.parametrize("hardness", [None, 600.0])
def test_states_lie_within_their_errors_of_exact_ones(hardness):
    """Loosely solved states beside the same to 1e-10."""
    within = {name: [] for name in WITH_SOLVER_ERROR}
    dimensions = []
    for seed in range(5):
        height = self_affine((64, 64), SPACING, 0.6, seed=seed, rms=0.05)
        space = HalfSpace(height.shape, (SPACING, SPACING), 2e4)
        for force in (30.0, 200.0, 1000.0, 3000.0, 8000.0):
            exact = solve_contact(height, space, force=force, rtol=1e-10, hardness=hardness)
            for rtol in (1e-2, 1e-3):
                found = solve_contact(height, space, force=force, rtol=rtol, hardness=hardness)
                numbers, true = numbers_of(found), numbers_of(exact)
                for name, right in within.items():
                    slack = 1e-9 * abs(true[name])
                    off = abs(numbers[name] - true[name])
                    # Single cells beside yielded ones have no stiffness: in neither state, then.
                    missing = np.isnan(numbers[name]) and np.isnan(true[name])
                    right.append(missing or off <= numbers[f"{name}_error"] + slack)
                share = found.ambiguous / np.count_nonzero(found.in_contact)
                ours, theirs = (box_dimension(s.in_contact, 1).dimension for s in (found, exact))
                if np.isfinite(ours):
                    dimensions.append(abs(ours - theirs) <= share + 1e-9)
    for name, right in within.items():
        assert np.mean(right) >= 0.95, name
    assert len(dimensions) > 30
    assert np.mean(dimensions) >= 0.95


def test_extent_is_that_of_the_rectangle_around_the_contact():
    height = -np.ones((20, 30))
    height[4, 6], height[8, 25] = 0.0, -1e-3
    space = HalfSpace(height.shape, (SPACING, SPACING), 2e4)
    state = solve_contact(height, space, closure=0.01)
    assert np.count_nonzero(state.in_contact) == 2
    assert numbers_of(state)["extent"] == pytest.approx(5 * 20 / 600)


def test_errors_are_small_where_the_state_is_exact():
    height = self_affine((48, 48), SPACING, 0.6, seed=1, rms=0.05)
    space = HalfSpace(height.shape, (SPACING, SPACING), 2e4)
    numbers = numbers_of(solve_contact(height, space, force=200.0, rtol=1e-10))
    assert numbers["nodes_error"] == numbers["area_error"] == numbers["perimeter_error"] == 0
    assert numbers["closure_error"] <= 1e-10 * numbers["closure"]
    assert numbers["stiffness_error"] <= 2e-6 * numbers["stiffness"]


@pytest.fixture(scope="module")
def specimen():
    heights = self_affine((80, 80), SPACING, 0.8, seed=3, rms=0.1)
    coords = {axis: SPACING * np.arange(80) for axis in "yx"}
    attrs = {"spacing_y": SPACING, "spacing_x": SPACING}
    scan = xr.DataArray(heights, dims=("y", "x"), coords=coords, attrs=attrs)
    return make_specimen(scan, window=4.0, name="rock", multiple=4)


def test_a_small_closure_of_the_interface_is_as_exact_as_a_large_one():
    """Near full contact it is a small part of the whole closure."""
    heights = self_affine((80, 80), SPACING, 0.8, seed=3, rms=2e-4)
    coords = {axis: SPACING * np.arange(80) for axis in "yx"}
    attrs = {"spacing_y": SPACING, "spacing_x": SPACING}
    scan = xr.DataArray(heights, dims=("y", "x"), coords=coords, attrs=attrs)
    smooth = make_specimen(scan, window=4.0, name="smooth", multiple=4)
    found = curves_of(smooth, solver_settings({}, "study"))
    closure = found["interface_closure"].isel(direction=0).sel(resolution=1)
    # At the heaviest load it cannot be told from that of a full window, and is missing.
    assert closure.isel(normal_force=-1).isnull().all()
    assert float((closure / found["closure"]).min()) < 0.3
    share = found["interface_closure_error"] / abs(found["interface_closure"])
    assert float(share.max()) <= 0.01


def curves_of(specimen, solver):
    states = [
        contact_states(
            JointLoading(specimen, direction, [2, 5], SETTINGS, solver), [1, 2, 4], map_cells=5
        )
        for direction in SETTINGS.contact_directions
    ]
    return closure_curves(combine(states), (4.0, 4.0), 2e4)


def test_a_study_solves_less_and_says_so(specimen):
    """What it has agrees with the whole, the rest is missing, and the reasons are told."""
    solver = solver_settings({"accuracy": {"delta_sigma": 0.004}}, "study")
    found = curves_of(specimen, solver)
    whole = curves_of(specimen, solver_settings({"accuracy": "full"}, "study"))
    assert whole["solved"].all()
    assert int(found["solved"].sum()) == 2 * 4 + 2 * 4 + 2 * 2
    for name in ("interface_closure", "area", "interface_stiffness"):
        np.testing.assert_array_equal(np.isfinite(found[name]), found["solved"])
        off = abs(found[name] - whole[name]).where(found["solved"], 0)
        allowed = found[f"{name}_error"] + whole[f"{name}_error"] + 1e-9 * abs(whole[name])
        assert bool((off <= allowed.where(found["solved"], 1)).all())
    # Tightened where the tolerance of the study leaves too many nodes undecided.
    share = (found["nodes_error"] / found["nodes"]).where(found["solved"], 0)
    assert float(share.max()) <= 0.004
    # Twice the spacing was solved in the first direction at the offset of the maps alone.
    spacing = np.isfinite(found["closure_spacing_error"])
    assert spacing.any("normal_force").sum() == 2
    dilatancy = elastic_dilatancy(found, describe_joint(specimen, SETTINGS))
    table = solve_plan(found, dilatancy, solver).set_index(choice="choice")
    assert table.attrs["states_solved"] == 20
    assert table.attrs["states"] == 48
    assert float(table["error"].sel(choice="solver tolerance")) < 2e-3
    assert "under the largest" in str(table["reason"].sel(choice="extent of the solve").values)
    assert "E: 2" in str(table["value"].sel(choice="directions").values)
    assert str(table["value"].sel(choice="resolutions").values) == (
        "all nodes: 4 of 4 curves; every 2nd: 1 of 4 curves; every 4th: 1 of 4 curves"
    )
