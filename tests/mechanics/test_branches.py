"""Branches of a joint whose contacts crush."""

import numpy as np
import pytest

from fractalcontact.mechanics.branches import OF_BRANCHES, OF_CYCLE, branches
from fractalcontact.surface.synthesis import self_affine
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
def data(joint):
    return branches(*joint, FORCES, SOLVING, "joint")


def test_loading_is_that_of_single_states(joint, data):
    for force in FORCES:
        state = solve_contact(*joint, force=force, **SOLVING)
        loaded = data.sel(branch="load", normal_force=force)
        assert loaded.closure == pytest.approx(state.closure, rel=1e-6)
        assert loaded.area == pytest.approx(state.area, rel=1e-2)
        at_limit = state.pressure == state.hardness
        assert loaded.yielded_fraction == pytest.approx(at_limit.mean(), rel=1e-2)


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
        assert (data.plastic_load_fraction.sel(branch=name)[:-1] == 0).all()
    assert data.dissipated_energy == pytest.approx(HARDNESS * total)
    assert data.recovered_energy > 0


def test_everything_has_a_unit_and_a_name(data):
    assert {*OF_BRANCHES, *OF_CYCLE, "permanent_set"} == set(data.data_vars)
    assert all({"units", "long_name"} <= set(values.attrs) for values in data.values())


def test_one_load_is_a_cycle_as_well(joint):
    one = branches(*joint, FORCES[-1:], SOLVING, "joint")
    assert one.closure.sel(branch="reload").item() == pytest.approx(
        one.closure.sel(branch="load").item(), rel=1e-5
    )


def test_a_failure_names_what_is_loaded(joint):
    with pytest.raises(NotConverged) as caught:
        branches(*joint, FORCES, SOLVING | {"rtol": 1e-17}, "offset 0.3 mm")
    assert "offset 0.3 mm" in caught.value.__notes__[0]
