"""The flow of a joint that crushes, whose coarsest grid need not be that of its scan."""

import functools

import numpy as np
import pytest
import xarray as xr
from chain import SMALL_STUDY, SOLVER
from made_stages import scan, stages_of
from materials import ROCK
from scipy import ndimage
from unchecked_settings import resolve_unchecked

from fractalcontact.flow.aperture import MAX_CRUSHED
from fractalcontact.flow.cubic_law import plane_flow, window_interval
from fractalcontact.flow.joint_flow import SHIFT, flow_numbers, path_pressures, shifted_ratio
from fractalcontact.surface.synthesis import self_affine


@functools.cache
def crushing(resolutions, boundary="mirrored"):
    """Stages of a joint whose contacts crush."""
    own = {
        "boundary": boundary,
        "material": ROCK | {"hardness": "80 MPa"},
        "loads": ["1 MPa", "5 MPa", "10 MPa"],
        "resolutions": list(resolutions),
        "offsets": ["0.4 mm"],
    }
    settings = resolve_unchecked(SMALL_STUDY, None, own, "made")
    face = scan(self_affine((96, 96), 0.1, 0.8, rms=0.05, seed=1), 0.1)
    return stages_of(
        "capped", (face, None), settings, SOLVER, later=("window_states", "closure", "flow")
    )


@pytest.mark.parametrize("resolutions", [(1, 2), (2, 4)])
def test_what_has_crushed_unloads_on_the_reported_grid(resolutions):
    stages = crushing(resolutions)
    flow = stages["flow"]
    assert (stages["branches"]["permanent_set"] > 0).any()
    assert flow.sizes["flow_x"] == stages["joints"].sizes["window_x"] // resolutions[0]
    gap = flow["branch_mean_gap"].sel(branch="reload").values
    known = np.isfinite(gap)
    assert known.sum() > 1
    # What has been pressed in leaves less of a gap than there was at the same load before.
    loaded = flow["branch_mean_gap"].sel(branch="load").values[known]
    assert (gap[known] <= loaded * (1 + 1e-5)).all()  # equal at the top, to the tolerance of both
    assert (gap[known][:-1] < loaded[:-1]).any()
    for name in ("branch_mean_gap", "branch_transmissivity_along"):
        unload, reload = (flow[name].sel(branch=branch).values for branch in ("unload", "reload"))
        np.testing.assert_array_equal(unload, reload)


def test_a_free_window_that_crushes_has_neither_gap_nor_flow_on_reloading():
    """The bowl of its own settlement stays in the permanent set: it would be a loose square."""
    flow = crushing((1, 2), "free")["flow"]
    for name in ("branch_mean_gap", "branch_transmissivity_along", "branch_transmissivity_across"):
        assert np.isfinite(flow[name].sel(branch="load")).any(), name
        assert np.isnan(flow[name].sel(branch=["unload", "reload"])).all(), name
    assert flow["branch_reason"].sel(branch="load") == ""
    assert (flow["branch_reason"].sel(branch=["unload", "reload"]) != "").all()
    assert np.isnan(flow["permeability_k_0"].sel(branch="reload"))


@pytest.mark.parametrize("boundary", ["free", "mirrored"])
def test_the_permeability_is_fitted_over_one_range_of_all_branches(boundary):
    flow = crushing((1, 2), boundary)["flow"]
    along = flow["branch_transmissivity_along"]
    valid = along.sel(branch=(along > 0).any("normal_force"))
    shared = (valid > 0).all("branch")
    ends = [float(flow[f"permeability_pressure_{end}"]) for end in ("low", "high")]
    pressures = flow["nominal_pressure"].values[shared.values]
    assert ends == [pressures[0], pressures[-1]]


@pytest.fixture(scope="module")
def sheared():
    """Stages of a joint on oblong cells that has slid North; its gap is longer along x."""
    rough = np.random.default_rng(5).normal(size=(64, 80))
    lower, upper = (
        ndimage.gaussian_filter(rough, sides, mode="wrap") for sides in ((2, 3), (2, 6))
    )
    heights = 0.1 * lower / lower.std(), 0.1 * upper / upper.std() + 0.02
    coords = {"y": 0.15 * (np.arange(64) + 0.5), "x": 0.1 * (np.arange(80) + 0.5)}
    attrs = {"spacing_y": 0.15, "spacing_x": 0.1, "source": "made"}
    faces = [xr.DataArray(z, coords, ("y", "x"), attrs=attrs) for z in heights]
    own = {
        "material": ROCK,
        "loads": ["0.5 MPa", "2 MPa", "8 MPa"],
        "window": ["7.5 mm", "7.2 mm"],
        **{"resolutions": [1], "offsets": ["0.3 mm"], "directions": ["N"]},
        "contact_directions": ["N"],
    }
    settings = resolve_unchecked(SMALL_STUDY, None, own, "made")
    return stages_of("sheared", faces, settings, SOLVER, later=("closure", "flow"))


def gap_under_the_reference_load(stages):
    """Gap (ny, nx) in mm, and the index of that load."""
    contact = stages["contact"]
    load = int(np.abs(contact["normal_force"].values - contact.attrs["map_load"]).argmin())
    return contact["map_gap"].values[load].astype(float), load


@pytest.mark.parametrize(("way", "axis"), [("along", "y"), ("across", "x")])
def test_numbers_of_each_way_are_those_of_the_gap_along_its_axis(sheared, way, axis):
    flow = sheared["flow"]
    gap, load = gap_under_the_reference_load(sheared)
    spacing = (0.15, 0.1)
    assert flow.attrs[f"flow_axis_{way}"] == axis
    whole = plane_flow(gap, spacing, axis)
    at_twice = plane_flow(gap[::2, ::2], (0.3, 0.2), axis)
    change = abs(at_twice.transmissivity - whole.transmissivity)
    expected = {
        "transmissivity": whole.transmissivity,
        "critical_gap": whole.critical_gap,
        "transmissivity_face_difference": whole.face_difference,
        "transmissivity_grid_error": max(whole.face_difference / 2, change),
    }
    for name, value in expected.items():
        found = float(flow[f"{name}_{way}"][load])
        assert found == pytest.approx(value, rel=1e-3), name


def test_the_error_of_the_separation_moves_the_transmissivity_along_its_curve(sheared):
    flow, error = sheared["flow"], sheared["error_budget"]["total"].sel(quantity="separation")
    gap, found = sheared["closure"]["mean_gap"].values.ravel(), flow["transmissivity_along"].values
    slope = (found[0] - found[1]) / (gap[0] - gap[1])
    first = float(flow["transmissivity_separation_error_along"][0])
    assert first == pytest.approx(abs(slope) * float(error[0]), rel=1e-6)


def test_the_crushed_volume_is_that_pressed_in_over_the_gap_left():
    stages = crushing((1, 2))
    flow, branches = stages["flow"], stages["branches"]
    gap = stages["closure"]["mean_gap"].values.ravel()
    area = float(branches["normal_force"][0] / branches["nominal_pressure"][0])
    pressed = branches["set_volume"].sel(branch="load").values
    expected = pressed / (gap[: pressed.size] * area)
    assert (expected > 0).any()
    np.testing.assert_allclose(flow["crushed_fraction"][: pressed.size], expected, rtol=1e-3)


def test_an_elastic_joint_crushes_nothing(sheared):
    assert (sheared["flow"]["crushed_fraction"] == 0).all()


def test_a_path_that_is_open_where_no_transmissivity_is_stated_is_open():
    pressure, critical = np.array([1.0, 5.0, 25.0, 50.0]), np.array([0.3, 0.2, 0.1, 0.0])
    flows = np.array([1e-3, np.nan, np.nan, 0.0])
    assert path_pressures(pressure, flows, critical) == (25.0, 50.0)


def test_the_ratio_of_shifted_faces_needs_a_transmissivity_that_is_stated():
    plate = np.full((8, 8), 0.1)
    assert shifted_ratio(plate, (0.1, 0.1), "x") == pytest.approx(8.0)
    pinched = plate.copy()
    pinched[:, 4] = 0.001
    assert np.isnan(shifted_ratio(pinched, (0.1, 0.1), "x"))
    assert np.isnan(shifted_ratio(0 * plate, (0.1, 0.1), "x"))


@pytest.mark.parametrize(("crushed", "states_one"), [(0.99, True), (1.01, False)])
def test_no_transmissivity_is_stated_where_crushed_rock_may_fill_the_gap(crushed, states_one):
    gap = np.full((8, 8), 0.1)
    found = flow_numbers(gap, (0.1, 0.1), "x", crushed * MAX_CRUSHED, 0.0)
    assert np.isfinite(float(found["transmissivity"].value)) == states_one
    assert ("crushed rock" in found["flow_reason"]) != states_one


def test_a_flow_that_the_grid_does_not_resolve_is_missing_with_the_reason():
    # Waves of eight cells of nearly their own height along the flow.
    gap = np.tile(1 + 0.95 * np.sin(np.pi / 4 * (np.arange(32) + 0.5)), (8, 1))
    found = flow_numbers(gap, (0.1, 0.1), "x", 0.0, 0.0)
    assert np.isnan(found["transmissivity"].value)
    assert "does not resolve" in found["flow_reason"]
    assert not found["flow_resolved"]
    across = flow_numbers(gap, (0.1, 0.1), "y", 0.0, 0.0)
    assert across["flow_resolved"]
    assert across["transmissivity"].value > 0


def test_no_path_is_zero_however_much_is_crushed():
    found = flow_numbers(np.zeros((8, 8)), (0.1, 0.1), "x", np.inf, 0.0)
    assert found["transmissivity"].value == 0


def test_the_interval_holds_the_error_of_the_mean_gap_or_there_is_none(sheared):
    flow, budget = sheared["flow"], sheared["error_budget"]
    gap, load = gap_under_the_reference_load(sheared)
    mean = float(sheared["closure"]["mean_gap"].values.ravel()[load])
    error = float(budget["mean_gap_total_of_population"][load]) / mean
    whole = float(flow["transmissivity_along"][load])
    high = window_interval(gap, (0.15, 0.1), "y", whole, error).high if error <= 1 else np.nan
    stated = float(flow["transmissivity_along_high"][load])
    assert stated == pytest.approx(high, rel=1e-3, nan_ok=True)
    for unknown in (np.nan, 1.5):
        without = flow_numbers(gap, (0.15, 0.1), "y", 0.0, unknown)
        assert "no interval" in without["flow_reason"]
        assert without["transmissivity"].value == pytest.approx(whole, rel=1e-3)
        assert np.isnan(without["transmissivity"].ends[1:]).all()
    assert flow_numbers(gap, (0.15, 0.1), "y", 0.0, 0.1)["flow_reason"] == ""


def test_faces_moved_apart_let_more_pass(sheared):
    gap, _ = gap_under_the_reference_load(sheared)
    both = [plane_flow(gap + apart, (0.15, 0.1), "y").transmissivity for apart in (0, SHIFT)]
    found = float(sheared["flow"]["shifted_ratio"])
    assert found == pytest.approx(both[1] / both[0], rel=1e-3)
    assert found > 1


def test_harder_contacts_let_more_pass_than_those_that_crush(sheared):
    budget, flow = crushing((1, 2))["error_budget"], crushing((1, 2))["flow"]
    for way in ("along", "across"):
        harder = budget[f"transmissivity_{way}_hardest"].values
        quoted = np.isfinite(harder)
        assert quoted.any()
        assert (harder[quoted] > flow[f"transmissivity_{way}"].values[quoted]).all()
        aperture_of = budget[f"hydraulic_aperture_{way}_hardest"].values[quoted]
        np.testing.assert_allclose(aperture_of**3 / 12, harder[quoted], rtol=1e-12)
    elastic = sheared["error_budget"]["transmissivity_along_hardest"]
    assert np.isnan(elastic).all()
