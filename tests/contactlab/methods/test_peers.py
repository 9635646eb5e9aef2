"""Other codes, where they are installed, solve the same problem."""

import os

import numpy as np
import pytest

from contactlab.accuracy.hard_problems import hard_problem
from contactlab.accuracy.reference import rough_problem
from contactlab.methods import peers
from contactlab.methods.common import NotOffered
from contactlab.methods.registry import installed_peers
from fractalcontact import HalfSpace, NotConverged, solve_contact
from fractalcontact.core.child_process import ChildFailed

PEERS = installed_peers()
CCG, ASPHER = "ContactMechanics ccg", "ASPHER active set"
needs_peers = pytest.mark.skipif(not PEERS, reason="the peers extra is not installed")
needs_ccg = pytest.mark.skipif(CCG not in PEERS, reason="the peers extra is not installed")
needs_aspher = pytest.mark.skipif(
    ASPHER not in PEERS,
    reason="ASPHER is not installed: it is built with cmake, a C++ compiler, Eigen and FFTW",
)


@pytest.fixture(scope="module")
def problem():
    return rough_problem(32, 0.8, 0.1, 1)


def load_of(name, reference):
    control = PEERS[name].loads[0]
    return {control: getattr(reference.state, control)}


@needs_peers
@pytest.mark.parametrize("name", PEERS)
def test_a_peer_finds_the_same_state(problem, name):
    reference = problem.single
    state = PEERS[name](problem.height, problem.space, rtol=1e-8, **load_of(name, reference))
    assert reference.error(state) < 1e-5
    assert state.residual < 1e-4
    assert state.area == pytest.approx(reference.state.area)


@needs_ccg
@pytest.mark.parametrize(
    ("shape", "spacing"),
    [((20, 31), (0.1, 0.1)), ((12, 17), (5.0, 0.1)), ((1, 40), (0.1, 0.1)), ((1, 1), (0.1, 0.2))],
)
def test_a_peer_has_our_operator(shape, spacing):
    """Axes, units and images: what it is judged by is its solver, not our way of calling it."""
    space = HalfSpace(shape, spacing, 3e4)
    pressure = np.random.default_rng(0).random(shape)
    exact = pytest.approx(space.displacement(pressure), rel=1e-9)
    mechanics = PEERS[CCG].set_up(pressure, space)
    found = mechanics.substrate.evaluate_disp(-pressure * space.cell_area)
    assert found[: shape[0], : shape[1]] == exact
    tamaas = PEERS["Tamaas"].set_up(pressure, space)
    found = np.zeros(shape)
    tamaas.model.operators["dcfft"](pressure, found)
    assert found == exact


@needs_ccg
@pytest.mark.parametrize("load", ["force", "hardness", "force and hardness"])
def test_constrained_gradients_take_a_force_and_a_hardness(problem, load):
    reference = problem.single
    control = "force" if "force" in load else "closure"
    given = {control: getattr(reference.state, control)}
    if "hardness" in load:
        given["hardness"] = 0.5 * reference.state.pressure.max()
    exact = solve_contact(problem.height, problem.space, rtol=1e-9, **given)
    found = PEERS[CCG](problem.height, problem.space, rtol=1e-8, **given)
    assert (found.force, found.closure) == pytest.approx((exact.force, exact.closure), rel=1e-5)
    assert found.residual < 1e-4
    np.testing.assert_array_equal(found.in_contact, exact.in_contact)


@needs_peers
@pytest.mark.parametrize("name", PEERS)
def test_a_peer_says_what_it_was_not_made_for(problem, name):
    load = load_of(name, problem.single)
    other = {"force": 1.0} if "closure" in load else {"closure": 0.01}
    if name != CCG:
        with pytest.raises(NotOffered, match=r"takes a \w+ only"):
            PEERS[name](problem.height, problem.space, **other)
        with pytest.raises(NotOffered, match="knows no hardness"):
            PEERS[name](problem.height, problem.space, hardness=1.0, **load)
    plate = HalfSpace(problem.space.shape, problem.space.spacing, 1.0, kernel="rigid square")
    with pytest.raises(NotOffered, match="no kernel but love: not rigid square"):
        PEERS[name](problem.height, plate, **load)
    holed = np.where(problem.height == problem.height.min(), np.nan, problem.height)
    # Tamaas finds out by itself.
    with pytest.raises((ValueError, ChildFailed, NotConverged)):
        PEERS[name](holed, problem.space, **load)


@needs_aspher
@pytest.mark.parametrize("shape", [(16, 16), (32, 64), (48, 48)])
def test_aspher_takes_dyadic_squares_only(shape):
    space = HalfSpace(shape, (1.0, 1.0), 1.0)
    with pytest.raises(NotOffered, match="takes square windows"):
        PEERS[ASPHER](np.zeros(shape), space, force=1.0)


@needs_aspher
@pytest.mark.parametrize("name", [name for name in PEERS if name.startswith("ASPHER")])
def test_aspher_says_which_way_it_went(problem, name):
    code = PEERS[name].set_up(problem.height, problem.space)
    assert code.path == ""
    pressure = code.solve(peers.Load(force=problem.single.state.force), 1e-8)
    assert code.closure(pressure) == pytest.approx(problem.closure, rel=1e-4)
    assert ("(active)" in code.path) == (name == ASPHER)
    assert "finest:32" in code.path
    assert code.applications > 0


@needs_ccg
def test_a_penetrating_node_that_ccg_does_not_see():
    """Seen in the atlas: the iteration that first sees the second node ends as converged."""
    problem = hard_problem("spike", 5)
    found = PEERS[CCG](problem.height, problem.space, rtol=1e-14, **problem.load)
    assert found.residual > 1e-4


@pytest.mark.parametrize(
    ("seconds", "end", "words"),
    [(10, os.abort, "crashed: SIGABRT"), (0.2, None, "took longer than 0.2 s")],
)
def test_a_peer_that_crashes_or_hangs_does_no_harm(problem, monkeypatch, seconds, end, words):
    class Wild(peers.PublicCode):
        def solve(self, load, rtol):
            while True:
                end and end()

    monkeypatch.setattr(peers, "PATIENCE", seconds)
    load = {"closure": 0.1, "force": None, "hardness": None, "start": None}
    with pytest.raises(ChildFailed, match=words):
        peers.solve_in_child(Wild, problem.height, problem.space, rtol=1e-6, **load)


@needs_peers
# ContactMechanics hands the limit of iterations to its own conjugate gradients only.
@pytest.mark.parametrize("name", [name for name in PEERS if "lbfgs" not in name])
def test_a_peer_that_gives_up_is_not_believed(problem, name, monkeypatch):
    monkeypatch.setattr(peers, "PATIENT_ITERATIONS", 2)
    with pytest.raises(NotConverged) as caught:
        PEERS[name](problem.height, problem.space, rtol=1e-9, **load_of(name, problem.single))
    assert caught.value.state.residual > 1e-9


def test_a_state_of_our_own_pressure_is_our_state(problem):
    ours = solve_contact(problem.height, problem.space, closure=problem.closure)
    clearance = peers.clearance_of(problem.height)
    state = peers.state_of(problem.space, ours.pressure, clearance, closure=ours.closure)
    assert state.force == pytest.approx(ours.force)
    assert state.residual == pytest.approx(ours.residual, rel=1e-3, abs=1e-12)
    by_force = peers.state_of(problem.space, ours.pressure, clearance, force=ours.force)
    assert by_force.closure == pytest.approx(ours.closure, rel=1e-6)


def test_no_pressure_is_the_state_of_first_touch(problem):
    clearance = peers.clearance_of(problem.height)
    state = peers.state_of(problem.space, np.zeros(problem.space.shape), clearance, force=0.0)
    assert (state.closure, state.force, state.residual) == (0, 0, 0)
    np.testing.assert_array_equal(state.gap, clearance)
