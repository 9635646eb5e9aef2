"""All comparison solvers: Hertz, agreement with direct elimination, and honest failures."""

from dataclasses import replace

import numpy as np
import pytest
from ensembles import ensemble

from contactlab.methods import common, gauss_seidel, nnls, polonsky_keer
from contactlab.methods.common import ContactProblem, NotOffered
from contactlab.methods.registry import METHODS
from fractalcontact import HalfSpace, NotConverged
from fractalcontact.surface.synthesis import self_affine

ITERATIVE = [name for name, method in METHODS.items() if not method.direct]
BY_FORCE = [name for name, method in METHODS.items() if "force" in method.loads]
CAPPED = [name for name, method in METHODS.items() if "closure" in method.hardness]
# One line per problem: seed, nodes each way, H and closure in rms heights; from 2 to 45 % in
# contact.
PROBLEMS = [
    (4, (15, 21), 0.7, 1.2),
    (0, (24, 24), 0.8, 0.8),
    (1, (31, 48), 0.5, 1.5),
    (2, (48, 48), 0.9, 2.5),
    (3, (37, 29), 0.3, 4.0),
][slice(*ensemble("method problems"))]


def rough_problem(seed, shape, hurst):
    height = self_affine(shape, 0.5, hurst, rms=0.1, seed=seed)
    return height, HalfSpace(shape, (0.5, 0.5), 30e3)


def test_flat_window_at_its_hardness_yields_everywhere():
    space = HalfSpace((6, 7), (0.1, 0.1), 1.0)
    for method in CAPPED:
        state = METHODS[method](np.zeros((6, 7)), space, closure=1.0, hardness=0.01)
        np.testing.assert_array_equal(state.pressure, 0.01)


@pytest.mark.parametrize("method", METHODS)
def test_hertz(method):
    radius, spacing, closure, modulus = 10.0, 0.05, 0.04, 2.0
    x = spacing * (np.arange(33) - 16)
    height = -(x[:, None] ** 2 + x[None, :] ** 2) / (2 * radius)
    space = HalfSpace((33, 33), (spacing, spacing), modulus)
    state = METHODS[method](height, space, closure=closure)
    assert state.force == pytest.approx(4 / 3 * modulus * radius**0.5 * closure**1.5, rel=0.01)
    assert state.pressure.max() == pytest.approx(
        2 * modulus / np.pi * np.sqrt(closure / radius), rel=0.01
    )


@pytest.mark.parametrize(("seed", "shape", "hurst", "closure"), PROBLEMS)
@pytest.mark.parametrize("method", ITERATIVE)
def test_agrees_with_elimination(method, seed, shape, hurst, closure):
    height, space = rough_problem(seed, shape, hurst)
    closure *= 0.1
    expected = METHODS["dense"](height, space, closure=closure)
    loads = [{"closure": closure}]
    if method in BY_FORCE:
        loads.append({"force": expected.force})
    for load in loads:
        state = METHODS[method](height, space, rtol=1e-9, **load)
        np.testing.assert_array_equal(state.in_contact, expected.in_contact)
        assert state.force == pytest.approx(expected.force, rel=1e-7)
        assert state.closure == pytest.approx(closure, rel=1e-8)
        np.testing.assert_allclose(
            state.pressure, expected.pressure, rtol=0, atol=1e-6 * expected.pressure.max()
        )


@pytest.mark.parametrize("fraction", [0.5, 0.1])
@pytest.mark.parametrize(("seed", "shape", "hurst", "closure"), PROBLEMS)
def test_capped_pressure(seed, shape, hurst, closure, fraction):
    """One mixed complementarity problem, three ways to its only solution."""
    height, space = rough_problem(seed, shape, hurst)
    closure *= 0.1
    elastic = METHODS["dense"](height, space, closure=closure)
    hardness = fraction * elastic.pressure.max()
    expected = METHODS["dense"](height, space, closure=closure, hardness=hardness)
    capped = expected.pressure == hardness
    assert capped.any()
    assert expected.force < elastic.force
    assert expected.gap[capped].max() <= 1e-9 * closure
    assert np.abs(expected.gap[expected.in_contact & ~capped]).max(initial=0) <= 1e-9 * closure
    assert expected.gap[~expected.in_contact].min() >= -1e-9 * closure
    for method in set(CAPPED) & set(ITERATIVE):
        state = METHODS[method](height, space, closure=closure, hardness=hardness, rtol=1e-9)
        np.testing.assert_array_equal(state.pressure == hardness, capped)
        assert state.force == pytest.approx(expected.force, rel=1e-7)
    by_force = METHODS["dense"](height, space, force=expected.force, hardness=hardness)
    assert by_force.closure == pytest.approx(closure, rel=1e-9)


def test_hardness_never_reached_changes_nothing():
    height, space = rough_problem(1, (24, 24), 0.8)
    for method in CAPPED:
        free = METHODS[method](height, space, closure=0.2)
        hardness = 2 * free.pressure.max()
        capped = METHODS[method](height, space, closure=0.2, hardness=hardness)
        np.testing.assert_allclose(capped.pressure, free.pressure, rtol=1e-12)


@pytest.mark.parametrize("method", [name for name, method in METHODS.items() if method.warm])
def test_warm_start_reaches_the_same_state_with_less_work(method):
    height, space = rough_problem(2, 2 * (ensemble("warm start side"),), 0.7)
    before = METHODS["dense"](height, space, closure=0.19)
    cold = METHODS[method](height, space, closure=0.2)
    warm = METHODS[method](height, space, closure=0.2, start=before)
    assert warm.force == pytest.approx(cold.force, rel=1e-5)
    if method == "nnls":
        # Cold it has gradient projections to start from, which are not counted.
        assert METHODS[method](height, space, closure=0.19, start=before).iterations == 1
    else:
        assert warm.iterations < cold.iterations


@pytest.mark.parametrize("method", METHODS)
def test_units_do_not_matter(method):
    height, space = rough_problem(3, (24, 24), 0.6)
    nanometres = HalfSpace((24, 24), (0.5e6, 0.5e6), 30e3)
    expected = METHODS[method](height, space, closure=0.2)
    state = METHODS[method](1e6 * height + 1e6, nanometres, closure=0.2e6)
    assert state.force == pytest.approx(1e12 * expected.force, rel=1e-5)
    np.testing.assert_array_equal(state.in_contact, expected.in_contact)


@pytest.mark.parametrize(
    ("method", "module", "limit", "value"),
    [
        ("polonsky-keer", polonsky_keer, "MAX_ITERATIONS", 3),
        ("gauss-seidel", gauss_seidel, "MAX_SWEEPS", 2),
        ("nnls", nnls, "MAX_SETS", 1),
    ],
)
def test_unfinished_work_is_an_error(method, module, limit, value, monkeypatch):
    height, space = rough_problem(2, (32, 32), 0.8)
    monkeypatch.setattr(module, limit, value)
    if method == "nnls":
        monkeypatch.setattr(module, "PROJECTIONS", 2)
    with pytest.raises(NotConverged, match="stopped after") as caught:
        METHODS[method](height, space, closure=0.2)
    assert caught.value.residual > 1e-6
    assert caught.value.state.residual == caught.value.residual


@pytest.mark.parametrize("largest_sum", [common.LARGEST_SUM, 0])
def test_final_check_finds_every_violation(largest_sum, monkeypatch):
    """By summation and by FFT: overlap, parting, too little force, a cap not respected."""
    monkeypatch.setattr(common, "LARGEST_SUM", largest_sum)
    height, space = rough_problem(1, (24, 24), 0.8)
    clearance = height.max() - height
    right = METHODS["dense"](height, space, closure=0.2)
    under_force = ContactProblem(space, clearance, right.force, True, np.inf, None, 1e-6)
    at_closure = replace(under_force, load=0.2, by_force=False)
    said = {"iterations": 1, "reason": "test"}
    assert under_force.checked_state(right.pressure, 0.2, **said).residual < 1e-12
    released = right.pressure.copy()
    released[np.unravel_index(released.argmax(), released.shape)] = 0.0
    pushed = right.pressure.copy()
    pushed[np.unravel_index(clearance.argmax(), clearance.shape)] = 1.0
    for problem, pressure, closure in [
        (at_closure, released, 0.2),
        (at_closure, pushed, 0.2),
        (under_force, right.pressure, 0.201),
        (under_force, right.pressure, 0.199),
        (replace(under_force, load=1.001 * right.force), right.pressure, 0.2),
        (replace(under_force, hardness=0.5 * right.pressure.max()), right.pressure, 0.2),
    ]:
        with pytest.raises(NotConverged, match="test"):
            problem.checked_state(pressure, closure, **said)


@pytest.mark.parametrize(
    ("method", "load"), [(m, load) for m in METHODS for load in METHODS[m].loads]
)
def test_first_touch_carries_nothing(method, load):
    height, space = rough_problem(0, (12, 12), 0.8)
    state = METHODS[method](height, space, **{load: 0.0})
    assert state.force == state.closure == state.area == 0.0


def test_what_is_not_offered_is_refused_by_name():
    height, space = rough_problem(0, (12, 12), 0.8)
    for method in set(METHODS) - set(BY_FORCE):
        with pytest.raises(NotOffered, match="closure only"):
            METHODS[method](height, space, force=1.0)
    with pytest.raises(NotOffered, match="hardness with a closure only"):
        METHODS["polonsky-keer"](height, space, force=1.0, hardness=1.0)
    for method in set(METHODS) - set(CAPPED):
        with pytest.raises(NotOffered, match="no hardness"):
            METHODS[method](height, space, closure=0.1, hardness=1.0)
    with pytest.raises(ValueError, match="expected > 0"):
        METHODS["dense"](height, space, closure=0.1, hardness=0.0)
    with pytest.raises(ValueError, match="the window carries"):
        METHODS["dense"](height, space, force=1e6, hardness=1.0)
