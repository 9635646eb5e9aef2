"""Direct elimination: exact small systems, the contact conditions, agreement with the solver."""

import numpy as np
import pytest
from ensembles import ensemble

from contactlab.methods import dense
from contactlab.methods.common import sum_displacement
from contactlab.methods.registry import METHODS
from fractalcontact import HalfSpace, NotConverged, solve_contact
from fractalcontact.surface.synthesis import self_affine

SIDE = 20.0
ELIMINATION = METHODS["dense"]
# One line per problem: seed, H, rms height and closure in mm. Contact from a few nodes to most.
PROBLEMS = [
    (0, 0.5, 0.02, 0.01),
    (1, 0.8, 0.02, 0.02),
    (2, 0.8, 0.30, 0.50),
    (3, 0.3, 0.05, 0.10),
    (4, 0.9, 0.50, 1.50),
    (5, 0.1, 0.02, 0.04),
    (6, 0.7, 0.10, 0.60),
    (7, 0.6, 1.00, 2.00),
    (8, 0.95, 0.01, 0.08),
    (9, 0.4, 0.20, 0.90),
]


N = ensemble("elimination side")


def rough_problem(seed, hurst, rms, n=N):
    height = self_affine((n, n), SIDE / n, hurst, rms=rms, seed=seed)
    return height, HalfSpace((n, n), (SIDE / n, SIDE / n), 30e3)


def test_one_node_is_a_spring():
    space = HalfSpace((1, 1), (0.1, 0.1), 10.0)
    per_force = space.influence()[0, 0] * space.cell / space.modulus / space.cell_area
    for load in ({"closure": 3 * per_force}, {"force": 3.0}):
        state = ELIMINATION(np.zeros((1, 1)), space, **load)
        assert state.force == pytest.approx(3.0, rel=1e-13)
        assert state.closure == pytest.approx(3 * per_force, rel=1e-13)


def test_two_nodes_the_second_touches_at_the_closure_its_neighbour_gives_it():
    space = HalfSpace((1, 2), (1.0, 1.0), 1.0)
    near, far = space.influence()[0]
    # The lower node is pulled down with the first by far/near of the closure.
    depth = 0.5
    touching = depth / (1 - far / near)
    below = ELIMINATION([[0.0, -depth]], space, closure=0.999 * touching)
    above = ELIMINATION([[0.0, -depth]], space, closure=1.001 * touching)
    assert np.count_nonzero(below.in_contact) == 1
    assert np.count_nonzero(above.in_contact) == 2
    expected = np.linalg.solve([[near, far], [far, near]], above.closure - np.array([0, depth]))
    np.testing.assert_allclose(above.pressure[0], expected, rtol=1e-12)


@pytest.mark.parametrize(
    ("seed", "hurst", "rms", "closure"), PROBLEMS[: ensemble("dense problems")]
)
def test_production_solver_finds_the_same_state(seed, hurst, rms, closure):
    height, space = rough_problem(seed, hurst, rms, n=ensemble("dense side"))
    reference = ELIMINATION(height, space, closure=closure)
    peak = reference.pressure.max()
    for load in ({"closure": closure}, {"force": reference.force}):
        state = solve_contact(height, space, **load)
        assert state.force == pytest.approx(reference.force, rel=1e-6)
        assert state.closure == pytest.approx(closure, rel=1e-6)
        np.testing.assert_array_equal(state.in_contact, reference.in_contact)
        tight = solve_contact(height, space, rtol=1e-10, **load)
        assert tight.force == pytest.approx(reference.force, rel=1e-8)
        assert tight.closure == pytest.approx(closure, rel=1e-8)
        np.testing.assert_allclose(tight.pressure, reference.pressure, rtol=0, atol=1e-7 * peak)


@pytest.mark.parametrize("seed", [1, 2, pytest.param(8, marks=pytest.mark.full)])
def test_force_given_and_closure_given_are_the_same_state(seed):
    _, hurst, rms, closure = PROBLEMS[seed]
    height, space = rough_problem(seed, hurst, rms)
    expected = ELIMINATION(height, space, closure=closure)
    state = ELIMINATION(height, space, force=expected.force)
    assert state.closure == pytest.approx(closure, rel=1e-11)
    np.testing.assert_array_equal(state.in_contact, expected.in_contact)


def test_conditions_hold_to_machine_precision():
    height, space = rough_problem(11, 0.8, 0.1)
    for load in ({"closure": 0.2}, {"force": 1e4}):
        state = ELIMINATION(height, space, **load)
        displacement = sum_displacement(space, state.pressure)
        gap = displacement + height.max() - height - state.closure
        assert state.pressure.min() >= 0
        assert gap.min() >= -1e-11 * state.closure
        assert np.abs(gap[state.in_contact]).max() <= 1e-11 * state.closure
        if "force" in load:
            assert state.force == pytest.approx(load["force"], rel=1e-11)


def test_summation_is_the_operator_of_the_half_space():
    space = HalfSpace((9, 14), (0.2, 0.3), 5.0)
    pressure = np.random.default_rng(0).random((9, 14))
    np.testing.assert_allclose(
        sum_displacement(space, pressure), space.displacement(pressure), rtol=1e-12
    )


def test_single_exchanges_alone_reach_the_same_set(monkeypatch):
    height, space = rough_problem(3, 0.3, 0.05, n=16)
    expected = ELIMINATION(height, space, closure=0.05)
    monkeypatch.setattr(dense, "PATIENCE", 0)
    state = ELIMINATION(height, space, closure=0.05)
    np.testing.assert_array_equal(state.in_contact, expected.in_contact)


def test_unfinished_pivoting_is_an_error(monkeypatch):
    height, space = rough_problem(1, 0.8, 0.02, n=24)
    monkeypatch.setattr(dense, "MAX_SETS", 1)
    with pytest.raises(NotConverged, match="1 contact sets") as caught:
        ELIMINATION(height, space, closure=0.02)
    assert caught.value.residual > 1e-9


def test_same_arguments_are_refused_as_by_the_production_solver():
    space = HalfSpace((4, 4), (1.0, 1.0), 1.0)
    with pytest.raises(ValueError, match="exactly one of closure=, force="):
        ELIMINATION(np.zeros((4, 4)), space)
    with pytest.raises(ValueError, match="missing"):
        ELIMINATION(np.full((4, 4), np.nan), space, closure=1.0)
