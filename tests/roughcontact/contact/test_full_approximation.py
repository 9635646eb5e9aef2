"""Changes of load on coarser grids, from a state that is known."""

import numpy as np
import pytest
from rough_surfaces import self_affine

from roughcontact import HalfSpace, solve_contact
from roughcontact.contact import candidates, full_approximation
from roughcontact.contact.kkt import Problem
from roughcontact.contact.nested_iteration import prolong_constant, redistribute
from roughcontact.contact.restriction import restrict_sum

CONTROLS = ["closure", "force"]


@pytest.fixture
def on_small_grids(monkeypatch):
    monkeypatch.setattr(full_approximation, "MIN_FINE_SIDE", 48)
    monkeypatch.setattr(full_approximation, "MIN_COARSE_SIDE", 24)


def rough(shape, seed=3):
    """Composite topography and its half-space, in units in which the solver works."""
    height = self_affine(shape, 1.0, 0.8, rms=1.0, seed=seed)
    return height, HalfSpace(shape, (1.0, 1.0), 1.0)


@pytest.mark.parametrize("control", CONTROLS)
@pytest.mark.parametrize("shape", [(96, 104), (97, 99)])
def test_a_state_of_the_load_is_not_changed(on_small_grids, shape, control):
    height, space = rough(shape)
    state = solve_contact(height, space, closure=3.0, rtol=1e-8)
    by_force = control == "force"
    load = state.pressure.sum() if by_force else 3.0
    clearance = (height.max() - height).ravel()
    problem = Problem(space, clearance, load, by_force)
    pressure, displacement = state.pressure.ravel(), state.displacement.ravel()
    assert full_approximation.full_approximation_start(problem, pressure, displacement) is None
    found = full_approximation._changed_pressure(problem, pressure, state.gap, 3.0)
    np.testing.assert_allclose(found, pressure, rtol=0, atol=1e-4 * pressure.max())


@pytest.mark.parametrize("shape", [(24, 30), (25, 31)])
def test_every_cell_keeps_the_sum_it_is_given(shape):
    rng = np.random.default_rng(8)
    before = rng.random(shape) * (rng.random(shape) > 0.6)
    old = restrict_sum(before) / 2
    new = rng.random(old.shape) * (rng.random(old.shape) > 0.3)
    my, mx = old.shape
    padded = np.zeros((2 * my + 4, 2 * mx + 4))
    full_approximation._in_proportion(before, old, new, padded)
    change = padded[2 : shape[0] + 2, 2 : shape[1] + 2].copy()
    assert padded.sum() == pytest.approx(change.sum(), abs=1e-9)
    influence = rough(shape)[1].influence()
    for pressure in (before + change, redistribute(before, change, rng.random(shape), influence)):
        np.testing.assert_allclose(restrict_sum(pressure), 2 * new, atol=1e-12)
        assert (pressure >= 0).all()


def test_values_of_cells_on_their_nodes():
    cells = np.arange(6.0).reshape(2, 3)
    nodes = prolong_constant(cells, (3, 5))
    np.testing.assert_array_equal(nodes, cells[np.ix_([0, 0, 1], [0, 0, 1, 1, 2])])


@pytest.mark.parametrize("control", CONTROLS)
@pytest.mark.parametrize(("hardness", "times"), [(None, 4), (0.1, 0)])
def test_states_are_those_of_cold_starts(on_small_grids, monkeypatch, control, hardness, times):
    height, space = rough((96, 101), seed=4)
    changed = []
    monkeypatch.setattr(
        "roughcontact.contact.solve.full_approximation_start",
        lambda *known: (
            changed.append(full_approximation.full_approximation_start(*known)) or changed[-1]
        ),
    )
    state = None
    for closure in (1.0, 1.8, 2.2, 3.0, 2.4):
        cold = solve_contact(height, space, closure=closure, hardness=hardness, rtol=1e-8)
        load = {control: getattr(cold, control)}
        state = solve_contact(height, space, start=state, hardness=hardness, rtol=1e-8, **load)
        np.testing.assert_array_equal(state.in_contact, cold.in_contact)
        peak = cold.pressure.max()
        np.testing.assert_allclose(state.pressure, cold.pressure, rtol=0, atol=1e-5 * peak)
    assert sum(start is not None for start in changed) == times


@pytest.mark.parametrize("control", CONTROLS)
def test_applications_are_saved_on_large_grids(monkeypatch, control):
    n = full_approximation.MIN_FINE_SIDE
    # On candidates for contact there is no such scheme.
    monkeypatch.setattr(candidates, "MIN_WINDOW", n + 1)
    height, space = rough((n, n), seed=1)
    depth = np.ptp(height)
    loads = [{"closure": share * depth} for share in (0.16, 0.20)]
    if control == "force":
        loads = [{"force": solve_contact(height, space, **load).force} for load in loads]
    first, applications = solve_contact(height, space, **loads[0]), {}
    for smallest in (n, n + 1):
        monkeypatch.setattr(full_approximation, "MIN_FINE_SIDE", smallest)
        state = solve_contact(height, space, start=first, **loads[1])
        applications[smallest] = state.iterations
    assert applications[n] < applications[n + 1]
