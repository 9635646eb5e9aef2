"""The problem on candidates for contact alone is the problem on the whole window."""

import numpy as np
import pytest
from ensembles import ensemble
from random_problems import random_problem
from rough_surfaces import self_affine

from roughcontact import HalfSpace, solve_contact
from roughcontact.contact import candidates, operator
from roughcontact.contact.state import CandidateState
from roughcontact.contact.violation import violation

SEEDS = range(ensemble("candidate problems"))
RTOL = 1e-8


def rough(shape, seed=1):
    space = HalfSpace(shape, (0.1, 0.1), 1e4)
    return self_affine(shape, 0.1, 0.8, rms=0.2, seed=seed), space


def restricted_always(monkeypatch, most_pairs):
    """Candidates on all but the smallest windows, and up to this many pairs summed directly."""
    monkeypatch.setattr(candidates, "MIN_WINDOW", 16)
    monkeypatch.setattr(candidates, "MIN_SIDE", 8)
    monkeypatch.setattr(candidates, "MAX_CANDIDATES", 1.0)
    monkeypatch.setattr(candidates, "BATCH", 0.0)
    everywhere = dict.fromkeys(operator.MAX_PAIRS, most_pairs)
    monkeypatch.setattr(operator, "MAX_PAIRS", everywhere)


@pytest.fixture
def always(monkeypatch):
    """The multipole operator on every window of 16 nodes or more, however many candidates."""
    restricted_always(monkeypatch, 0)


def both(monkeypatch, height, space, **given):
    """State on candidates, and on the whole window."""
    on_candidates = solve_contact(height, space, **given)
    with monkeypatch.context() as patch:
        patch.setattr(candidates, "MIN_RTOL", 1.0)
        whole = solve_contact(height, space, **given)
    assert not isinstance(whole, CandidateState)
    return on_candidates, whole


def check_same(on_candidates, whole):
    """The same contact set but for ambiguous nodes, and the same force."""
    assert isinstance(on_candidates, CandidateState)
    different = np.count_nonzero(on_candidates.in_contact != whole.in_contact)
    assert different <= on_candidates.ambiguous + whole.ambiguous
    assert on_candidates.force == pytest.approx(whole.force, rel=1e-7)
    assert on_candidates.closure == pytest.approx(whole.closure, rel=1e-7)
    tolerance = 1e-6 * whole.closure
    np.testing.assert_allclose(on_candidates.displacement, whole.displacement, atol=tolerance)
    np.testing.assert_allclose(on_candidates.gap, whole.gap, atol=tolerance)


@pytest.mark.usefixtures("always")
@pytest.mark.parametrize("first", range(0, len(SEEDS), 10))
def test_random_problems_have_the_same_states(monkeypatch, first):
    solved = 0
    for seed in range(first, first + 10):
        problem = random_problem(seed, largest=ensemble("candidate problem side"))
        if not candidates.may_restrict(problem.space, RTOL):
            continue
        solved += 1
        states = both(monkeypatch, problem.height, problem.space, rtol=RTOL, **problem.load)
        check_same(*states)
        wrong, rounding = violation(states[0], problem.height)
        assert wrong <= 1.01 * RTOL + rounding, problem.name
    assert solved


@pytest.mark.parametrize("most_pairs", [5_000, np.inf])
def test_pairs_summed_directly_have_the_same_states(monkeypatch, most_pairs):
    # Also where some applications of one solve sum pairs and others do not.
    restricted_always(monkeypatch, most_pairs)
    for seed in range(100, 100 + len(SEEDS) // 4):
        problem = random_problem(seed, largest=60)
        if candidates.may_restrict(problem.space, RTOL):
            states = both(monkeypatch, problem.height, problem.space, rtol=RTOL, **problem.load)
            check_same(*states)
            wrong, rounding = violation(states[0], problem.height)
            assert wrong <= 1.01 * RTOL + rounding, problem.name


@pytest.mark.usefixtures("always")
@pytest.mark.parametrize("kernel", ["love", "rigid square"])
@pytest.mark.parametrize("control", ["closure", "force"])
def test_hardness_and_kernel(monkeypatch, control, kernel):
    height, _ = rough((61, 83))
    space = HalfSpace(height.shape, (0.1, 0.1), 1e4, kernel=kernel)
    elastic = solve_contact(height, space, closure=0.3 * np.ptp(height))
    hardness = 0.4 * elastic.pressure.max()
    given = {control: 0.8 * getattr(elastic, control), "hardness": hardness, "rtol": RTOL}
    states = both(monkeypatch, height, space, **given)
    check_same(*states)
    assert np.count_nonzero(np.isclose(states[0].pressure, hardness)) > 3
    assert states[0].stiffness == pytest.approx(states[1].stiffness, rel=1e-5)
    assert states[0].area == pytest.approx(states[1].area, rel=1e-2)


@pytest.mark.usefixtures("always")
@pytest.mark.parametrize("control", ["closure", "force"])
def test_load_steps(monkeypatch, control):
    height, space = rough((64, 64))
    last = solve_contact(height, space, closure=0.3 * np.ptp(height))
    state = None
    for part in (0.2, 0.3, 0.5, 0.1):
        load = {control: part * getattr(last, control)}
        state = solve_contact(height, space, start=state, rtol=RTOL, **load)
        assert isinstance(state, CandidateState)
        assert "displacement" not in vars(state)
        with monkeypatch.context() as patch:
            patch.setattr(candidates, "MIN_RTOL", 1.0)
            whole = solve_contact(height, space, rtol=RTOL, **load)
            # A state of candidates is a start for the whole window, too.
            again = solve_contact(height, space, start=state, rtol=RTOL, **load)
        check_same(state, whole)
        check_same(state, again)


@pytest.mark.usefixtures("always")
@pytest.mark.parametrize("spacing", [(0.1, 0.1), (0.12, 0.1)])
@pytest.mark.parametrize("rtol", [1e-6, 1e-3, 5e-3])
@pytest.mark.parametrize("control", ["closure", "force"])
def test_nodes_that_may_touch_within_the_tolerance_are_candidates(spacing, rtol, control):
    height, _ = rough((64, 80))
    space = HalfSpace(height.shape, spacing, 1e4)
    last = solve_contact(height, space, closure=0.2 * np.ptp(height))
    state = solve_contact(height, space, rtol=rtol, **{control: getattr(last, control)})
    assert isinstance(state, CandidateState)
    near = np.flatnonzero(height.max() - height < (1 + rtol) * state.closure)
    assert np.isin(near, state._candidates.nodes).all()


@pytest.mark.usefixtures("always")
def test_a_bound_that_is_too_low_is_found_out(monkeypatch):
    height, space = rough((64, 64))
    force = solve_contact(height, space, closure=0.3 * np.ptp(height)).force
    monkeypatch.setattr(candidates, "_bound", lambda case, closure, coarser: 0.6 * closure)
    check_same(*both(monkeypatch, height, space, force=force, rtol=RTOL))


def test_only_where_few_nodes_can_touch():
    height, space = rough((512, 512))
    light = solve_contact(height, space, closure=0.1 * np.ptp(height))
    assert isinstance(light, CandidateState)
    assert not isinstance(solve_contact(height, space, closure=np.ptp(height)), CandidateState)
    stretched = HalfSpace(height.shape, (0.1, 0.2), 1e4)
    state = solve_contact(height, stretched, closure=0.1 * np.ptp(height))
    assert not isinstance(state, CandidateState)
    tight = solve_contact(height, space, closure=0.1 * np.ptp(height), rtol=1e-10)
    assert not isinstance(tight, CandidateState)


def test_heights_in_single_precision_on_disk(tmp_path):
    height, space = rough((512, 512))
    np.save(tmp_path / "height.npy", height.astype(np.float32))
    mapped = np.load(tmp_path / "height.npy", mmap_mode="r")
    force = 1e-2 * space.modulus * space.cell_area * np.ptp(height) / space.cell
    state = solve_contact(mapped, space, force=force)
    exact = solve_contact(height.astype(np.float32).astype(float), space, force=force)
    assert isinstance(state, CandidateState)
    np.testing.assert_array_equal(state.pressure, exact.pressure)
    np.testing.assert_array_equal(state.gap, exact.gap)


def test_a_changed_topography_is_noticed():
    height, space = rough((512, 512))
    state = solve_contact(height, space, closure=0.1 * np.ptp(height))
    height *= 2
    with pytest.raises(ValueError, match="changed since"):
        _ = state.gap
