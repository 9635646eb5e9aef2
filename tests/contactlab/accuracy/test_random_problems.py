"""Random contact problems, each state verified by a convolution of its own.

``make problems PROBLEMS=5000`` tries more.
"""

import os

import numpy as np
import pytest
from ensembles import ensemble
from random_problems import KINDS, LOADINGS, random_problem

from fractalcontact import HalfSpace, NotConverged, solve_contact
from roughcontact.contact import active_set
from roughcontact.contact.violation import violation

#: Every kind is met under every loading.
SEEDS = range(ensemble("random problems"))
#: Cells along the longer side, at most.
LARGEST = ensemble("random problem side")
TRIED = int(os.environ.get("PROBLEMS", len(SEEDS)))
RTOL = 1e-6


@pytest.mark.parametrize("first", range(0, TRIED, 10))
def test_every_state_is_verified(first):
    """Ten problems at a time: one of every kind."""
    for seed in range(first, first + 10):
        problem = random_problem(seed, largest=LARGEST)
        state = solve_contact(problem.height, problem.space, rtol=RTOL, **problem.load)
        wrong, rounding = violation(state, problem.height)
        assert wrong <= 1.01 * RTOL + rounding, problem.name
        if "force" in problem.load:
            assert state.force == pytest.approx(problem.load["force"], rel=RTOL), problem.name
        else:
            assert state.closure == problem.load["closure"], problem.name


def test_random_problems_cover_what_they_should():
    problems = [random_problem(seed, largest=LARGEST) for seed in SEEDS]
    names = {f"{kind}, {loading}" for kind in KINDS for loading in LOADINGS}
    assert {problem.name for problem in problems} == names
    sides = [side for problem in problems for side in problem.space.shape]
    assert max(sides) > 0.975 * LARGEST
    ratios = [max(s.space.shape) / min(s.space.shape) for s in problems]
    assert sum(7.9 < ratio < 9.2 for ratio in ratios) > len(problems) / 15
    cells = [problem.space.spacing[1] for problem in problems]
    assert min(cells) < 1e-5
    assert max(cells) > 1e2
    stretched = [max(s.space.spacing) / min(s.space.spacing) for s in problems]
    assert max(stretched) > 6
    slopes = [np.abs(np.diff(s.height, axis=1)).mean() / s.space.spacing[1] for s in problems]
    assert min(slopes) < 2e-4
    assert max(slopes) > 5
    assert {next(iter(problem.load)) for problem in problems} == {"closure", "force"}


def test_same_seed_same_problem():
    one, same, other = random_problem(7), random_problem(7), random_problem(8)
    np.testing.assert_array_equal(one.height, same.height)
    assert one.load == same.load
    assert one.space == same.space
    assert other.space != one.space


@pytest.mark.parametrize("harm", ["a node more", "a node less", "all a little more"])
def test_the_judge_sees_a_wrong_state(harm):
    problem = random_problem(0)
    state = solve_contact(problem.height, problem.space, **problem.load)
    pressure = state.pressure.copy()
    if harm == "a node more":
        pressure[np.unravel_index(state.gap.argmax(), pressure.shape)] = pressure.max()
    elif harm == "a node less":
        pressure[np.unravel_index(pressure.argmax(), pressure.shape)] = 0.0
    else:
        pressure *= 1 + 1e-4
    wrong, rounding = violation(
        type(state)(**{**vars(state), "pressure": pressure}), problem.height
    )
    assert wrong > 1e-5 + rounding


@pytest.mark.parametrize("patience", [0, 2])
def test_forces_found_by_way_of_closures_are_the_same_states(monkeypatch, patience):
    """What serves where the set would swing for ever serves elsewhere too."""
    seeds = [seed for seed in range(40) if "force" in random_problem(seed, largest=80).load]
    for seed in seeds:
        problem = random_problem(seed, largest=80)
        expected = solve_contact(problem.height, problem.space, rtol=1e-8, **problem.load)
        with monkeypatch.context() as patched:
            patched.setattr("roughcontact.contact.safeguards.PATIENCE", patience)
            state = solve_contact(problem.height, problem.space, rtol=1e-8, **problem.load)
        assert state.closure == pytest.approx(expected.closure, rel=1e-6), problem.name
        assert state.force == pytest.approx(expected.force, rel=1e-8), problem.name


def test_the_patient_way_alone_finds_the_same_states(monkeypatch):
    """What serves where the set would swing for ever, from the first correction on."""
    for seed in range(40):
        problem = random_problem(seed, largest=80)
        if "force" in problem.load:
            continue
        expected = solve_contact(problem.height, problem.space, rtol=1e-8, **problem.load)
        with monkeypatch.context() as patched:
            patched.setattr("roughcontact.contact.safeguards.PATIENCE", -1)
            state = solve_contact(problem.height, problem.space, rtol=1e-8, **problem.load)
        assert state.force == pytest.approx(expected.force, rel=1e-6), problem.name


def test_no_problem_is_given_up():
    """The reason a problem has no state would be raised; of these none has one."""
    for seed in ensemble(
        "problems once given up"
    ):  # swung for ever once, the last under a given closure
        problem = random_problem(seed)
        try:
            solve_contact(problem.height, problem.space, **problem.load)
        except NotConverged as error:
            pytest.fail(f"random problem {seed}: {error}")


@pytest.mark.parametrize("seed", range(4))
def test_a_force_that_rises_steeply_is_found_by_way_of_closures(monkeypatch, seed):
    """A spike on a mirror: F changes by 25 times the share by which the closure does.

    The scan of a polished surface with a grain of dust was given up, because the closures tried
    differed by less than the tolerance to which each was solved.
    """
    generator = np.random.default_rng(seed)
    height = np.round(7 * generator.standard_t(4, size=(48, 48))) * 1e-6
    height.flat[generator.integers(height.size)] = 1.3e-3 + height.std()
    space = HalfSpace(height.shape, (0.024, 0.024), 26666.0)
    closure = 1.03 * (height.max() - np.quantile(height, 0.98))
    expected = solve_contact(height, space, closure=closure, rtol=1e-8)
    assert expected.stiffness * expected.closure / expected.force > 20
    monkeypatch.setattr("roughcontact.contact.safeguards.PATIENCE", 0)
    state = solve_contact(height, space, force=expected.force)
    assert state.closure == pytest.approx(expected.closure, rel=1e-6)
    assert (state.in_contact == expected.in_contact).mean() > 0.999


def test_a_set_that_is_far_off_when_patience_ends_is_sought_by_closures(monkeypatch):
    """Far off at the end of patience, though not when hopelessness was looked for: both count."""
    called = []
    newton = active_set.newton_on_closure
    monkeypatch.setattr("roughcontact.contact.safeguards.PATIENCE", 0)
    monkeypatch.setattr("roughcontact.contact.safeguards.STALL", -1)
    monkeypatch.setattr(active_set, "newton_on_closure", lambda *a: called.append(1) or newton(*a))
    problems = [random_problem(seed, largest=60) for seed in range(12)]
    problems = [problem for problem in problems if "force" in problem.load]
    for problem in problems:
        state = solve_contact(problem.height, problem.space, **problem.load)
        assert state.residual <= RTOL
    assert len(called) >= len(problems) > 3
