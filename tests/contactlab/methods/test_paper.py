"""The paper's dropping algorithm: its states, and that it never hides a failure."""

import numpy as np
import pytest
from ensembles import ensemble

from contactlab.methods import paper
from contactlab.methods.registry import METHODS
from fractalcontact import HalfSpace, NotConverged, solve_contact
from fractalcontact.surface.synthesis import self_affine
from roughcontact.elastic.halfspace import RIGID_PLATE_SELF_TERMS

DROPPING, ELIMINATION = METHODS["paper"], METHODS["dense"]
KERNELS = ["love", *RIGID_PLATE_SELF_TERMS]
N = ensemble("dropping side")


def rough_problem(seed, n=N, hurst=0.8, kernel="love"):
    height = self_affine((n, n), 0.5, hurst, rms=0.1, seed=seed)
    return height, HalfSpace((n, n), (0.5, 0.5), 30e3, kernel=kernel)


def test_flat_faces_touch_everywhere():
    space = HalfSpace((10, 10), (0.1, 0.1), 1.0)
    state = DROPPING(np.zeros((10, 10)), space, closure=0.01)
    assert state.in_contact.all()
    np.testing.assert_allclose(state.displacement, 0.01, rtol=1e-6)


@pytest.mark.parametrize(
    ("seed", "kernel"),
    [
        pytest.param(seed, kernel, marks=() if seed == i else pytest.mark.full)
        for seed in range(4)
        for i, kernel in enumerate(KERNELS)
    ],
)
def test_dropping_alone_reaches_the_exact_set_on_rough_surfaces(seed, kernel):
    height, space = rough_problem(seed, hurst=0.4 + 0.15 * seed, kernel=kernel)
    closure = 0.1 * (seed + 1)
    expected = ELIMINATION(height, space, closure=closure)
    state = DROPPING(height, space, closure=closure, rtol=1e-8)
    np.testing.assert_array_equal(state.in_contact, expected.in_contact)
    assert state.force == pytest.approx(expected.force, rel=1e-7)


def test_agrees_with_the_production_solver_on_cells_that_are_not_square():
    height = self_affine((24, 48), 0.5, 0.7, rms=0.1, seed=5)
    space = HalfSpace((24, 48), (0.8, 0.5), 30e3)
    expected = solve_contact(height, space, closure=0.2)
    state = DROPPING(height, space, closure=0.2)
    np.testing.assert_array_equal(state.in_contact, expected.in_contact)
    assert state.force == pytest.approx(expected.force, rel=1e-6)


def test_gauss_seidel_that_does_not_converge_is_an_error(monkeypatch):
    height, space = rough_problem(0)
    monkeypatch.setattr(paper, "MAX_SWEEPS", 2)
    with pytest.raises(NotConverged, match="Gauss-Seidel did not converge in 2 sweeps") as caught:
        DROPPING(height, space, closure=0.2)
    assert caught.value.residual > 1e-6


def test_point_dropped_in_error_is_found_out(monkeypatch):
    """An operator, positive definite but not a half-space's, for which dropping alone is wrong.

    The last node is in tension while its neighbours are held down and penetrates once they are
    dropped with it; the exact solution has it in contact.
    """
    space = HalfSpace((1, 4), (1.0, 1.0), 1.0)
    monkeypatch.setattr(space, "influence", lambda: np.array([[1.0, 0.66, 0.21, 0.15]]))
    height = -np.array([[0.97, 0.7, 0.0, 0.2]])
    exact = ELIMINATION(height, space, closure=1.0)
    assert exact.in_contact[0, 3]
    with pytest.raises(NotConverged, match="dropped in tension") as caught:
        DROPPING(height, space, closure=1.0)
    assert not caught.value.state.in_contact[0, 3]
    assert caught.value.residual == pytest.approx(0.14, abs=1e-5)
