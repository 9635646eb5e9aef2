"""Branches of a joint whose contacts crush."""

from dataclasses import replace
from unittest import mock

import numpy as np
import pytest
import xarray as xr
from made_stages import scan, stages_of

from fractalcontact.laws.branches import OF_BRANCHES, OF_CYCLE, _with_loading, branches
from fractalcontact.laws.closure import FLUSH_FACES
from fractalcontact.laws.reference_states import stored_states
from fractalcontact.study.configuration import resolve_settings, solver_settings
from fractalcontact.surface.synthesis import self_affine
from roughcontact.contact import path as path_module
from roughcontact.contact.path import BRANCHES, load_path
from roughcontact.contact.solve import solve_contact
from roughcontact.elastic.halfspace import HalfSpace
from roughcontact.errors import NotConverged

HARDNESS, FORCES = 100.0, np.array([20.0, 60.0, 180.0])
SOLVING = {"hardness": HARDNESS, "rtol": 1e-7}


@pytest.fixture(scope="module")
def joint():
    height = self_affine((48, 56), 0.1, 0.8, rms=0.05, seed=4)
    return height, HalfSpace(height.shape, 0.1, 1e4)


@pytest.fixture(scope="module")
def loaded(joint):
    return [solve_contact(*joint, force=force, **SOLVING) for force in FORCES]


@pytest.fixture(scope="module")
def data(joint, loaded):
    return branches(joint[0], loaded, SOLVING, "joint")


def test_branches_are_those_of_one_path(joint, data):
    """Loading from stored states and unloading, beside a path whose states are all solved."""
    path = load_path(*joint, forces=[*FORCES, *FORCES[-2::-1], 0.0, *FORCES], **SOLVING)
    exact = {"load": path[:3], "unload": path[2:5][::-1], "reload": path[6:]}
    for branch, states in exact.items():
        found = data.sel(branch=branch)
        np.testing.assert_allclose(found.closure, [state.closure for state in states], rtol=1e-5)
        volumes = [state.set_volume for state in states]
        np.testing.assert_allclose(found.set_volume, volumes, rtol=1e-4)
    assert data.residual_closure == pytest.approx(path[5].closure, rel=1e-5)
    assert data.recovered_energy == pytest.approx(path[2].elastic_energy, rel=1e-5)


def test_unloading_lies_above_loading_and_reloading_on_it(data):
    """More closed under the same load, by what is pressed in; they meet at the largest load."""
    load, unload, reload = (data.closure.sel(branch=name) for name in data.branch.values)
    assert (unload[:-1] > load[:-1]).all()
    assert unload[-1] == load[-1]
    np.testing.assert_allclose(reload, unload, rtol=1e-5)
    assert 0 < data.residual_closure < unload[0]


def test_only_loading_presses_in(data):
    volume = data.set_volume
    assert (volume.sel(branch="load").diff("normal_force") > 0).all()
    total = float(data.permanent_set.sum()) * 0.1**2
    for name in ("unload", "reload"):
        np.testing.assert_allclose(volume.sel(branch=name), total)
        assert (data.plastic_load_fraction.sel(branch=name) == 0).all()
    stiffness = data.stiffness.sel(branch="unload")
    np.testing.assert_allclose(stiffness, data.stiffness.sel(branch="reload"), rtol=1e-3)
    assert data.dissipated_energy == pytest.approx(HARDNESS * total)
    assert data.recovered_energy > 0


def test_everything_has_a_unit_and_a_name(data):
    assert {*OF_BRANCHES, *OF_CYCLE, "permanent_set", "yielded"} == set(data.data_vars)
    assert data.branch_maximum == pytest.approx(FORCES[-1])
    assert data.yielded.values[data.permanent_set.values > 0].all()
    assert all({"units", "long_name"} <= set(values.attrs) for values in data.values())


def test_one_load_is_a_cycle_as_well(joint, loaded):
    one = branches(joint[0], loaded[-1:], SOLVING, "joint")
    assert one.closure.sel(branch="reload").item() == pytest.approx(
        one.closure.sel(branch="load").item(), rel=1e-5
    )


def test_a_failure_names_what_is_loaded(joint, loaded):
    with pytest.raises(NotConverged) as caught:
        branches(joint[0], loaded, SOLVING | {"rtol": 1e-17}, "offset 0.3 mm")
    assert "offset 0.3 mm" in caught.value.__notes__[0]


@pytest.mark.parametrize("hardness", [100.1, 100.3])
def test_nodes_at_the_hardness_are_at_it_after_single_precision(joint, hardness):
    """In single precision the first hardness is rounded down, the second one up."""
    state = solve_contact(*joint, force=FORCES[-1], hardness=hardness, rtol=1e-7)
    capped = state.pressure == hardness
    assert capped.any()
    assert float(np.float32(hardness)) != hardness
    curve = xr.Dataset(
        {"closure": ("normal_force", [state.closure]), "residual": ("normal_force", [1e-8])},
        {"normal_force": [state.force]},
    )
    stored = state.pressure.astype(np.float32)[np.newaxis]
    mapped = xr.Dataset({"pressure": (("normal_force", "y", "x"), stored)}, curve.coords)
    (again,) = stored_states(*joint, curve, mapped, hardness)
    np.testing.assert_array_equal(again.pressure == hardness, capped)
    assert again.pressure.max() == hardness
    np.testing.assert_allclose(again.pressure, state.pressure, rtol=1e-7)
    np.testing.assert_allclose(again.gap, state.gap, atol=1e-6 * np.abs(state.gap).max())


def test_branches_solve_only_what_loading_did_not(joint, loaded):
    """A state for each load below the largest, none at all, and the largest again."""
    with mock.patch.object(path_module, "solve_contact", wraps=solve_contact) as counted:
        branches(joint[0], loaded, SOLVING, "joint")
        assert counted.call_count == len(loaded) + 1
        elastic = [replace(state, hardness=np.inf) for state in loaded]
        still = branches(joint[0], elastic, SOLVING, "joint")
        assert counted.call_count == len(loaded) + 1
    assert still.recovered_energy > 0


STUDY = {
    "study": "branches",
    "materials": {
        "elastic": {"modulus": "20 GPa", "poisson": 0.2},
        "weak": {"modulus": "20 GPa", "poisson": 0.2, "hardness": "80 MPa"},
    },
    "defaults": {
        **{"material": "weak", "contact_directions": ["E"], "offsets": ["0.3 mm"]},
        **{"loads": ["0.5 MPa", "1 MPa", "2 MPa", "4 MPa", "8 MPa", "16 MPa"]},
        **{"resolutions": [1], "window": "4.8 mm", "seating_pressure": "1 MPa"},
        "boundary": "mirrored",
    },
    "specimens": {"elastic": {"material": "elastic"}, "weak": {}},
}


@pytest.fixture(scope="module", params=["elastic", "weak"])
def stages(request):
    heights = self_affine((72, 72), 0.1, 0.8, rms=0.1, seed=5, roll_off=1.5)
    settings = resolve_settings(STUDY, request.param, {}, "branches")
    faces, solver = (scan(heights, 0.1), None), solver_settings({}, "branches")
    found = stages_of(request.param, faces, settings, solver, later=("closure",))
    return settings, found["branches"], found["closure"].squeeze()


def test_branches_of_the_interface_begin_and_end_on_the_closure_curve(stages):
    settings, data, curve = stages
    load, unload, reload = (data.sel(branch=name) for name in data["branch"].values)
    np.testing.assert_allclose(load["interface_closure"], curve["interface_closure"], rtol=1e-3)
    seated = curve["seated_closure"].values
    np.testing.assert_allclose(load["seated_closure"], seated, rtol=1e-2, atol=1e-6)
    assert unload["seated_closure"][-1] == load["seated_closure"][-1]
    np.testing.assert_allclose(reload["interface_closure"], unload["interface_closure"], rtol=1e-4)
    crushes = np.isfinite(settings.material.hardness)
    assert (data["residual_closure"] > 0) == crushes
    assert (data["permanent_set"].max() > 0) == crushes
    if not crushes:
        np.testing.assert_array_equal(unload["interface_closure"], load["interface_closure"])


def test_reloading_is_stiffer_than_loading_where_contacts_crush(stages):
    """Its slope is that of its curve; an elastic joint has one stiffness."""
    settings, data, _ = stages
    reload = data.sel(branch="reload")
    closure, pressure = reload["interface_closure"].values, reload["nominal_pressure"].values
    secants = np.diff(pressure) / np.diff(closure)
    stiffness = reload["interface_stiffness"].values
    # A single node has one stiffness under all loads.
    assert (stiffness[:-1] < secants * (1 + 1e-6)).all()
    assert (secants < stiffness[1:] * (1 + 1e-6)).all()
    missing = data["interface_stiffness"].isnull()
    np.testing.assert_array_equal(data["interface_stiffness_reason"] != "", missing)
    again, first = (one["reference_stiffness"] for one in (reload, data.sel(branch="load")))
    if np.isinf(settings.material.hardness):
        np.testing.assert_array_equal(again, first)
    else:
        assert (again.dropna("reference_pressure") > first.fillna(0)).all()
        assert np.isfinite(again[1])


def test_flush_faces_close_on_no_branch():
    """Their w - w_b would be negative: they are loaded like a punch."""
    heights = self_affine((72, 72), 0.1, 0.8, rms=0.1, seed=5, roll_off=1.5)
    defaults = STUDY["defaults"] | {"offsets": ["0 mm", "0.3 mm"], "map_offset": "0 mm"}
    settings = resolve_settings(STUDY | {"defaults": defaults}, "weak", {}, "branches")
    faces, solver = (scan(heights, 0.1), None), solver_settings({}, "branches")
    data = stages_of("flush", faces, settings, solver, later=("closure",))["branches"]
    assert (data["interface_closure"] == 0).all()
    assert data["interface_stiffness"].isnull().all()
    assert (data["interface_stiffness_reason"] == FLUSH_FACES).all()


@pytest.mark.parametrize("crushed", [True, False])
def test_a_stiffness_that_reloading_lacks_is_that_of_loading_only_without_crushing(crushed):
    dims = ("branch", "normal_force")
    stiffness = [[np.nan, np.nan], [5.0, np.nan], [5.0, np.nan]]
    data = xr.Dataset(
        {"stiffness": (dims, stiffness), "yielded": (("y", "x"), [[crushed, False]])},
        {"branch": list(BRANCHES)},
    )
    found = _with_loading(data, xr.DataArray([1.0, 2.0], dims="normal_force"))
    again = [5.0, np.nan] if crushed else [1.0, 2.0]
    np.testing.assert_array_equal(found, [[1.0, 2.0], again, again])
