"""Loads that have an exact answer, or at which users of other codes report no convergence."""

import numpy as np
import pytest
from ensembles import ensemble
from random_problems import random_problem
from rough_surfaces import self_affine

from roughcontact import HalfSpace, solve_contact
from roughcontact.contact.violation import violation

#: alpha of a flat square punch of N x N cells, F = E* L w / alpha: shape factors of MIRCO, a public
#: code. That for 3 is 0.96138923791... here, from two dense solves of the nine equations; the
#: table as we have it has two digits exchanged (0.96138923871...).
SHAPE_FACTORS = {
    1: 1.1221997046783601,
    2: 1.0068605251532488,
    3: 0.9613892379176019,
    4: 0.9385553774805636,
    8: 0.9037519877715218,
    16: 0.8860294454171728,
    32: 0.8770287405762021,
    64: 0.8724685659716702,
}
E_STAR = 3e4


@pytest.mark.parametrize("cells", SHAPE_FACTORS)
@pytest.mark.parametrize("control", ["closure", "force"])
def test_flat_square_punch(cells, control):
    side, closure = 2.0, 1e-3
    space = HalfSpace((cells, cells), (side / cells, side / cells), E_STAR)
    force = E_STAR * side * closure / SHAPE_FACTORS[cells]
    load = {"closure": closure} if control == "closure" else {"force": force}
    state = solve_contact(np.zeros(space.shape), space, rtol=1e-11, **load)
    assert state.force / state.closure == pytest.approx(force / closure, rel=1e-10)
    assert state.in_contact.all()
    assert state.energy_error < 1e-10


def rough_joint(n, slope=None, seed=3):
    """A self-affine window of unit cells, of a given rms slope."""
    height = self_affine((n, n), 1.0, 0.8, rms=1.0, seed=seed)
    if slope is not None:
        rms = np.sqrt(np.mean(np.diff(height, axis=0) ** 2) + np.mean(np.diff(height) ** 2))
        height *= slope / rms
    return height, HalfSpace((n, n), (1.0, 1.0), E_STAR)


@pytest.mark.parametrize("control", ["closure", "force"])
@pytest.mark.parametrize("aim", [0.5, 0.9, 0.99, 0.999])
def test_nearly_full_contact(aim, control):
    height, space = rough_joint(96)
    # Between the load at which this many nodes touch and that at which all do.
    low, high, state = 0.0, 60 * np.ptp(height), None
    for _ in range(30):
        closure = (low + high) / 2
        state = solve_contact(height, space, closure=closure, start=state)
        reached = state.in_contact.mean()
        if abs(reached - aim) < 5e-4:
            break
        low, high = (closure, high) if reached < aim else (low, closure)
    assert state.in_contact.mean() == pytest.approx(aim, abs=5e-4)
    cold = solve_contact(height, space, **{control: getattr(state, control)})
    assert cold.in_contact.mean() == pytest.approx(aim, abs=1e-3)
    wrong, rounding = violation(cold, height)
    assert wrong <= 1.01e-6 + rounding
    assert cold.energy_error < 1e-5


@pytest.mark.parametrize("pressure", [0.002, 0.02, 0.09])
def test_hardness_of_a_tenth_of_the_modulus(pressure):
    """At an rms slope of 0.08, where elastic pressures would reach it on many nodes."""
    height, space = rough_joint(128, slope=0.08)
    hardness, force = 0.1 * E_STAR, pressure * E_STAR * height.size
    state = solve_contact(height, space, force=force, hardness=hardness)
    wrong, rounding = violation(state, height)
    assert wrong <= 1.01e-6 + rounding
    assert state.force == pytest.approx(force, rel=1e-6)
    assert state.pressure.max() <= hardness
    assert state.energy_error < 1e-5
    if pressure > 0.01:
        assert np.count_nonzero(state.pressure == hardness) > 10


def energy(state, clearance):
    """sum (u / 2 + c) p s^2 of a state, N mm."""
    return np.sum((state.displacement / 2 + clearance) * state.pressure) * state.space.cell_area


@pytest.mark.parametrize("seed", range(ensemble("random energies")))
def test_energy_is_within_its_bound_of_the_least(seed):
    """Of a coarse state, against one of the same force solved as tightly as rounding lets."""
    problem = random_problem(seed, largest=40)
    clearance = problem.height.max() - problem.height
    coarse = solve_contact(problem.height, problem.space, rtol=1e-2, **problem.load)
    hardness = {k: v for k, v in problem.load.items() if k == "hardness"}
    exact = solve_contact(problem.height, problem.space, rtol=1e-9, force=coarse.force, **hardness)
    excess = energy(coarse, clearance) / energy(exact, clearance) - 1
    assert -1e-7 < excess <= coarse.energy_error + 1e-7, problem.name
    assert exact.energy_error < 1e-6


def test_energy_bound_is_not_loose_and_not_zero():
    height, space = rough_joint(64)
    closure = 0.5 * np.ptp(height)
    bounds = [
        solve_contact(height, space, closure=closure, rtol=rtol).energy_error
        for rtol in (1e-2, 1e-5, 1e-8)
    ]
    assert 0 < bounds[2] < bounds[1] / 10 < bounds[0] / 100
    assert bounds[0] < 1e-1
    assert solve_contact(height, space, closure=0.0).energy_error == 0
