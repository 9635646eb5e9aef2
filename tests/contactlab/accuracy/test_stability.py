"""Hard test problems, the judge of any solver, and when dropping points alone is right."""

import dataclasses
import os

import numpy as np
import pytest
from ensembles import ensemble

from contactlab.accuracy import stability as module
from contactlab.accuracy.elimination import (
    CASES,
    WINDOW,
    counter_example,
    elimination,
    largest_off_diagonal,
)
from contactlab.accuracy.hard_problems import KINDS, hard_problem
from contactlab.accuracy.stability import HONEST, NOT_OFFERED, RIGHT, SILENT, solvers, stability
from contactlab.methods.common import NotOffered
from contactlab.methods.peers import PATIENCE
from contactlab.methods.registry import METHODS, installed_peers
from fractalcontact import HalfSpace, NotConverged, solve_contact
from fractalcontact.core.child_process import in_child


@pytest.fixture(scope="module")
def judged():
    return stability(draws=ensemble("stability draws"))


def verdicts(monkeypatch, solver, kinds):
    """Verdicts (kind, draw) on one solver."""
    monkeypatch.setattr(module, "solvers", lambda: {"other": solver})
    return stability(kinds, 2)["verdict"].sel(solver="other").values


def test_ours_and_elimination_are_right_on_every_kind(judged):
    assert judged.sizes["kind"] == len(KINDS) >= 40
    assert (judged["verdict"].sel(solver=["fractalcontact", "dense"]) == RIGHT).all()


@pytest.mark.parametrize("name", METHODS)
def test_what_a_method_is_not_made_for_is_neither_right_nor_wrong(judged, name):
    found = judged.sel(solver=name)
    refused = found["verdict"] == NOT_OFFERED
    assert (found["said"].values[refused] != "").all()
    by_force = refused.sel(kind="one node, by force")
    method = METHODS[name]
    assert by_force.all() == by_force.any() == ("force" not in method.loads)
    capped = refused.sel(kind="cap, some yield")
    assert capped.all() == capped.any() == ("closure" not in method.hardness)
    assert not (found["verdict"] == SILENT).any()


def test_the_judge_sees_a_state_that_is_none(monkeypatch):
    def careless(height, space, **load):
        state = solve_contact(height, space, **load)
        return dataclasses.replace(state, pressure=1.001 * state.pressure)

    assert (verdicts(monkeypatch, careless, ["H = 0.8"]) == SILENT).all()


def test_the_judge_sees_a_state_of_another_load(monkeypatch):
    def wrong_force(height, space, *, force, rtol):
        return solve_contact(height, space, force=1.01 * force, rtol=rtol)

    assert (verdicts(monkeypatch, wrong_force, ["one node, by force"]) == SILENT).all()


def test_giving_up_is_honest_where_there_is_a_solution_and_right_where_there_is_none(monkeypatch):
    def timid(height, space, **load):
        raise ValueError("I would rather not")

    found = verdicts(monkeypatch, timid, ["H = 0.8", "cap, load above it", "missing cell"])
    assert (found[0] == HONEST).all()
    assert (found[1:] == RIGHT).all()


def test_only_what_is_not_offered_by_name_is_left_unjudged(monkeypatch):
    """A failure whose text speaks of a closure only is a failure all the same."""

    def picky(height, space, *, rtol, closure=None, force=None):
        if force is not None:
            raise NotOffered("no forces")
        raise ValueError("takes a closure only if it is small")

    found = verdicts(monkeypatch, picky, ["one node, by force", "one node, by closure"])
    assert (found[0] == NOT_OFFERED).all()
    assert (found[1] == HONEST).all()


def test_a_state_where_there_is_none_is_silently_wrong(monkeypatch):
    def bold(height, space, *, force, hardness, rtol):
        return solve_contact(height, space, force=force, rtol=rtol)

    assert (verdicts(monkeypatch, bold, ["cap, load above it"]) == SILENT).all()


def peer_of(monkeypatch, solver):
    """Let the judge take a solver for a public code."""
    monkeypatch.setattr(module, "installed_peers", lambda: {"other": solver})
    return solver


def test_a_peer_is_given_tighter_tolerances_until_it_is_right(monkeypatch):
    """Its tolerance may be on another quantity: here a thousandth of ours."""

    def loose(height, space, *, rtol, **load):
        return solve_contact(height, space, rtol=min(1e3 * rtol, 0.1), **load)

    assert (verdicts(monkeypatch, loose, ["H = 0.8"]) == SILENT).any()
    assert (verdicts(monkeypatch, peer_of(monkeypatch, loose), ["H = 0.8"]) == RIGHT).all()
    found = stability(["H = 0.8"], 2)
    assert (found["asked"] < module.RTOL).any()


def test_a_peer_that_is_wrong_at_every_tolerance_is_silently_wrong(monkeypatch):
    tried = []

    def careless(height, space, *, rtol, **load):
        tried.append(rtol)
        return solve_contact(height, space, rtol=0.5, **load)

    found = verdicts(monkeypatch, peer_of(monkeypatch, careless), ["H = 0.3"])
    assert (found == SILENT).any()
    assert set(tried) == set(module.PEER_RTOLS)


def test_whatever_a_peer_raises_is_its_honest_failure(monkeypatch):
    def crashing(height, space, **load):
        return in_child(os.abort, seconds=PATIENCE)

    found = verdicts(monkeypatch, peer_of(monkeypatch, crashing), ["H = 0.8"])
    assert (found == HONEST).all()


@pytest.mark.parametrize("kind", KINDS)
def test_same_draw_same_problem(kind):
    one, same, other = (hard_problem(kind, draw) for draw in (0, 0, 1))
    np.testing.assert_array_equal(one.height, same.height)
    assert one.space == same.space
    keys = [key for key in one.load if key != "start"]
    assert [one.load[key] for key in keys] == [same.load[key] for key in keys]
    different = one.height.shape != other.height.shape or (one.height != other.height).any()
    assert different or one.load != other.load


def test_every_solver_of_the_package_is_judged():
    assert set(solvers()) == {"fractalcontact", *METHODS, *installed_peers()}


@pytest.mark.parametrize(("kernel", "ratio"), CASES)
def test_elimination_is_right_exactly_where_the_inverse_has_no_positive_entry(kernel, ratio):
    space = HalfSpace(WINDOW, (ratio, 1.0), 1.0, kernel=kernel)
    height = counter_example(space)
    assert (height is None) == (largest_off_diagonal(space) < 0)
    if height is not None:
        exact = METHODS["dense"](height, space, closure=1.0)
        assert exact.residual < 1e-9
        with pytest.raises(NotConverged, match="left interpenetrating") as caught:
            METHODS["paper"](height, space, closure=1.0)
        lost = exact.in_contact & ~caught.value.state.in_contact
        assert lost.sum() >= 1


def test_the_counter_example_scales_with_the_closure():
    space = HalfSpace(WINDOW, (1.0, 1.0), 1.0, kernel="rigid square")
    np.testing.assert_allclose(counter_example(space, 3.0), 3 * counter_example(space), atol=1e-15)


def test_elimination_by_kernel_and_tolerance():
    found = elimination(draws=ensemble("elimination draws"))
    assert (found["wrong"].sel(case=found["kernel"] == "love") == 0).all()
    defeated = found["largest_off_diagonal"] > 0
    assert (found["counter_example"] == defeated).all()
    assert found["lost"].values[0] > found["lost"].values[-1] == 0
    assert found["area_error"].values[-1] == 0
