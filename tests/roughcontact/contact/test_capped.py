"""Contact whose pressure stops at a hardness: against a dense programme, and where most yields."""

import numpy as np
import pytest
from dense_programmes import dense_operator, dense_pressure
from ensembles import ensemble
from random_problems import random_problem
from rough_surfaces import self_affine

from roughcontact import HalfSpace, solve_contact
from roughcontact.contact.active_set import ActiveSetMethod
from roughcontact.contact.bounds import Bounds
from roughcontact.contact.candidates import MIN_WINDOW, LoadCase
from roughcontact.contact.kkt import Problem
from roughcontact.contact.topography import Topography
from roughcontact.contact.violation import violation

E_STAR = 1e4


def rough(n, seed):
    """A face of sandstone-like statistics: rms 0.3 mm, cells of 0.05 mm, roll-off 2.5 mm."""
    space = HalfSpace((n, n), (0.05, 0.05), E_STAR)
    return self_affine((n, n), 0.05, 0.8, rms=0.3, seed=seed, roll_off=2.5), space


def carried(space, hardness):
    """The force, N, under which the whole window yields."""
    return hardness * space.cell_area * space.shape[0] * space.shape[1]


@pytest.mark.parametrize("seed", range(ensemble("capped programmes")))
def test_state_is_that_of_a_dense_programme_between_bounds(seed):
    """Hardness of 1e-4 to 1 of the modulus, force up to nearly all that it lets be carried."""
    problem = random_problem(seed, largest=37)
    ny, nx = min(problem.space.shape[0], 20), min(problem.space.shape[1], 17)
    height = problem.height[:ny, :nx]
    space = HalfSpace((ny, nx), problem.space.spacing, problem.space.modulus)
    generator = np.random.default_rng([35, seed])
    hardness = space.modulus * 10 ** generator.uniform(-4, 0)
    force = 0.999 * 10 ** generator.uniform(-3, 0) * carried(space, hardness)
    state = solve_contact(height, space, force=force, hardness=hardness, rtol=1e-9)
    assert state.force == pytest.approx(force, rel=1e-9)
    matrix, clearance = dense_operator(space), (height.max() - height).ravel()
    low, exact, high = (
        dense_pressure(matrix, clearance, closure, hardness)
        for closure in state.closure * np.array([1 - 1e-8, 1, 1 + 1e-8])
    )
    assert low.sum() * space.cell_area <= force * (1 + 1e-8)
    assert high.sum() * space.cell_area >= force * (1 - 1e-8)
    # As far as the closure determines them.
    apart = max(1e-6 * hardness, 2 * np.abs(high - low).max())
    np.testing.assert_allclose(state.pressure.ravel(), exact, rtol=0, atol=apart)


@pytest.mark.parametrize("control", ["force", "closure"])
@pytest.mark.parametrize("seed", range(ensemble("hardness of each node")))
def test_hardness_of_each_node_is_a_bound_of_its_own(seed, control):
    """Minerals: a third of the nodes does not yield at all."""
    generator = np.random.default_rng([36, seed])
    height, space = rough(18, seed)
    hardness = E_STAR * 10 ** generator.uniform(-3, -1, height.shape)
    hardness[generator.random(height.shape) < 1 / 3] = np.inf
    hardness.flat[height.argmax()] = 1e-3 * E_STAR
    yielding = hardness[np.isfinite(hardness)].sum() * space.cell_area
    force = yielding * 10 ** generator.uniform(-0.7, -0.2)
    state = solve_contact(height, space, force=force, hardness=hardness, rtol=1e-9)
    if control == "closure":
        state = solve_contact(
            height, space, closure=state.closure, hardness=hardness, start=state, rtol=1e-9
        )
    assert state.force == pytest.approx(force, rel=1e-6)
    yields = state.pressure == state.hardness
    assert yields.any()
    assert (state.pressure <= hardness * (1 + 1e-15)).all()
    exact = dense_pressure(
        *(dense_operator(space), (height.max() - height).ravel()),
        *(state.closure, np.where(np.isinf(hardness), 1e3 * E_STAR, hardness).ravel()),
    )
    np.testing.assert_allclose(state.pressure.ravel(), exact, rtol=0, atol=1e-6 * exact.max())
    assert 0 <= state.energy_error < 1e-6


@pytest.mark.parametrize("lower", [-3.0, 0.0, 2.0])
def test_lower_bound_is_one_like_the_upper(lower):
    """Pressures from another lower bound on are those of a problem shifted by it."""
    height, space = rough(24, seed=4)
    clearance = (height.max() - height).ravel()
    shift = np.full(space.shape, lower)
    moved = clearance + space.convolve(shift).ravel()
    load = 0.2 * clearance.max()
    own = Problem(space, moved, load, False, Bounds(0.0, 40.0))
    other = Problem(space, clearance, load, False, Bounds(lower, 40.0 + lower))
    pressures = []
    for problem in (own, other):
        solution = ActiveSetMethod(problem, 1e-8).solve(np.full(height.size, 1.0))
        assert solution.residual <= 1e-8
        assert problem.bounds.violation(solution.pressure) == 0
        pressures.append(solution.pressure)
    np.testing.assert_allclose(pressures[1], pressures[0] + lower, atol=1e-5)


@pytest.mark.parametrize("control", ["force", "closure"])
@pytest.mark.parametrize("hardness", [30.0, 1000.0])
@pytest.mark.parametrize("share", [0.002, 0.2, 0.9, 0.9999])
def test_yielding_makes_a_problem_no_harder(hardness, share, control):
    """Applications are at most twice those of the elastic problem of the same closure."""
    height, space = rough(128, seed=3)
    force = share * carried(space, hardness)
    state = solve_contact(height, space, force=force, hardness=hardness)
    if control == "closure":
        state = solve_contact(height, space, closure=state.closure, hardness=hardness)
    elastic = solve_contact(height, space, closure=state.closure)
    assert state.iterations <= 2 * elastic.iterations
    assert violation(state, height)[0] <= 1.01e-6


# Seeds of 25, under forces and hardnesses that were given up, as candidates could not carry them.
@pytest.mark.parametrize(("seed", "hardness", "share"), [(0, 30, 0.002), (2, 30, 0.02)])
def test_candidates_can_carry_the_force(seed, hardness, share):
    height, space = rough(MIN_WINDOW, seed)
    force = share * carried(space, hardness)
    state = solve_contact(height, space, force=force, hardness=hardness)
    assert state.force == pytest.approx(force, rel=1e-6)
    wrong, rounding = violation(state, height)
    assert wrong <= 1.01e-6 + rounding


@pytest.mark.parametrize("level", [0, 1, 2])
def test_restricted_problem_holds_nodes_enough_for_its_force(level):
    """However low the bound on the closure that it is made for."""
    height, space = rough(64, seed=5)
    mean = 0.05 * 300.0
    length = mean * space.cell / space.modulus
    case = LoadCase(
        *(space, Topography(height, space.shape), length, 64.0 * 64.0, True),
        Bounds(0.0, 300 / mean),
    )
    for _ in range(level):
        case = case.coarser()
    restricted = case.restricted(1e-6, None)
    assert restricted is not None
    assert restricted.nodes.size * case.bounds.upper >= case.load
    assert restricted.bound >= case.least_closure


def test_least_closure_is_below_that_of_every_state():
    height, space = rough(48, seed=6)
    topography = Topography(height, space.shape)
    for share in (0.01, 0.3, 0.9):
        force = share * carried(space, 200.0)
        state = solve_contact(height, space, force=force, hardness=200.0)
        mean = share * 200.0
        length = mean * space.cell / space.modulus
        case = LoadCase(space, topography, length, 48.0 * 48.0, True, Bounds(0.0, 200 / mean))
        assert 0 < case.least_closure * length <= state.closure


@pytest.mark.parametrize("share", [0.01, 0.5, 0.99])
def test_any_start_leads_to_the_state(share):
    """None, too: the nodes that touch first cannot carry a force that many must share."""
    height, space = rough(32, seed=7)
    clearance = (height.max() - height).ravel() / 0.01
    problem = Problem(space, clearance, share * 50.0 * height.size, True, Bounds(0.0, 50.0))
    generator = np.random.default_rng(8)
    starts = np.zeros(height.size), 50 * generator.random(height.size), np.full(height.size, 1e-9)
    solutions = [ActiveSetMethod(problem, 1e-8).solve(start) for start in starts]
    for solution in solutions:
        assert solution.residual <= 1e-8
        assert solution.pressure.sum() == pytest.approx(problem.load, rel=1e-8)
        np.testing.assert_allclose(solution.pressure, solutions[0].pressure, atol=1e-5)
