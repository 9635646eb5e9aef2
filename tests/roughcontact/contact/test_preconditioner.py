"""The preconditioner on contact sets: exact where it can be, symmetric, positive, close."""

import numpy as np
import plain_twins
import pytest
from ensembles import ensemble
from rough_surfaces import self_affine

from roughcontact import HalfSpace
from roughcontact.contact.coarse_correction import MIN_RIDGE, RIDGE, CoarseCorrection
from roughcontact.contact.inverse_cholesky import (
    NARROW_NEIGHBOURHOOD,
    WIDE_NEIGHBOURHOOD,
    InverseCholesky,
)
from roughcontact.contact.operator import Operator
from roughcontact.contact.preconditioner import DIRECT, Preconditioner
from roughcontact.contact.projected_cg import ProjectedCG


def rough_set(shape, fraction, seed=0, hurst=0.7):
    """Nodes of a rough surface above a level, as numbers of cells."""
    n = max(shape)
    height = self_affine((n, n), 1.0, hurst, rms=1.0, seed=seed)[: shape[0], : shape[1]]
    return np.flatnonzero(height > np.quantile(height, 1 - fraction)).astype(np.int32)


def inverse_on(space, nodes):
    inverse = Preconditioner(space)
    inverse.update(nodes, fresh=True)
    return inverse


#: Shape, spacing and contact fraction.
SETS = ensemble("contact sets")


def test_few_nodes_are_inverted_exactly():
    space = HalfSpace((40, 30), (0.1, 0.2), 1.0)
    nodes = np.sort(np.random.default_rng(1).choice(1200, DIRECT, replace=False)).astype(np.int32)
    right_side = np.random.default_rng(2).standard_normal(DIRECT).astype(np.float32)
    exact = np.linalg.solve(plain_twins.operator_on(space, nodes), right_side)
    np.testing.assert_allclose(inverse_on(space, nodes)(right_side), exact, rtol=1e-4, atol=1e-4)


@pytest.mark.parametrize(
    ("shape", "spacing", "fraction", "neighbourhood"),
    [
        ((40, 48), (1.0, 1.0), 0.3, WIDE_NEIGHBOURHOOD),
        ((40, 48), (1.0, 1.0), 0.3, NARROW_NEIGHBOURHOOD),
        ((33, 21), (1.0, 2.5), 0.6, WIDE_NEIGHBOURHOOD),
    ],
)
def test_factor_is_that_of_scalar_loops(shape, spacing, fraction, neighbourhood):
    space = HalfSpace(shape, spacing, 1.0)
    nodes = rough_set(shape, fraction)
    factor = InverseCholesky(space, neighbourhood)
    factor.update(nodes)
    plain = plain_twins.inverse_cholesky(space, nodes, neighbourhood)
    matrix = np.array([factor(unit) for unit in np.eye(nodes.size, dtype=np.float32)])
    np.testing.assert_allclose(matrix, plain @ plain.T, rtol=0, atol=2e-5 * np.abs(matrix).max())
    assert np.count_nonzero(plain, axis=0).max() > 10 * (neighbourhood is WIDE_NEIGHBOURHOOD)


def test_coarse_correction_is_that_of_dense_matrices():
    space = HalfSpace((30, 170), (1.0, 1.0), 1.0)
    nodes = rough_set(space.shape, 0.1)
    correction = CoarseCorrection(space)
    correction.update(nodes, True)
    # Bilinear interpolation between centres of cells, flat beyond the outermost.
    coarse = space.coarser(8)
    along = [
        np.array([np.interp((at + 0.5) / 8 - 0.5, np.arange(n), unit) for unit in np.eye(n)]).T
        for at, n in zip(np.divmod(nodes, 170), coarse.shape, strict=True)
    ]
    interpolation = (along[0][:, :, None] * along[1][:, None, :]).reshape(nodes.size, -1)
    # A pressure on fine cells is 1/64 of it on coarse ones, eight times as wide.
    every = np.arange(np.prod(coarse.shape))
    smooth = interpolation @ plain_twins.operator_on(coarse, every) / 8 @ interpolation.T
    own = np.eye(nodes.size) * (space.influence()[0, 0] - np.diag(smooth))
    operator = smooth + own
    hats = [
        np.maximum(0, 1 - np.abs((np.arange(n) + 0.5) / n * (k - 1) - np.arange(k)[:, None]))
        for n, k in zip(coarse.shape, (2, 3), strict=True)
    ]
    functions = np.einsum("ay,bx->abyx", *hats).reshape(6, -1)
    basis = interpolation @ functions.T
    matrix = basis.T @ operator @ basis
    diagonal = np.diag(matrix)
    ridge = np.diag(RIDGE * diagonal + MIN_RIDGE * diagonal.max())
    approximate = np.diag(np.random.default_rng(8).uniform(0.5, 1, nodes.size))
    plain = plain_twins.balanced(approximate, operator, basis, np.linalg.inv(matrix + ridge))
    residual = np.random.default_rng(9).standard_normal(nodes.size).astype(np.float32)
    balanced = correction.balance(
        residual, lambda values: (approximate @ values).astype(np.float32)
    )
    expected = plain @ residual
    np.testing.assert_allclose(balanced, expected, rtol=0, atol=1e-4 * np.abs(expected).max())


@pytest.mark.parametrize(("shape", "spacing", "fraction"), SETS)
def test_inverse_is_symmetric_and_positive(shape, spacing, fraction):
    space = HalfSpace(shape, spacing, 1.0)
    nodes = rough_set(shape, fraction)
    inverse = inverse_on(space, nodes)
    a, b = np.random.default_rng(3).standard_normal((2, nodes.size)).astype(np.float32)
    scale = np.linalg.norm(a) * np.linalg.norm(inverse(b))
    assert abs(float(a @ inverse(b)) - float(b @ inverse(a))) < 1e-5 * scale
    for vector in (a, b, np.ones(nodes.size, np.float32)):
        assert float(vector @ inverse(vector)) > 0


@pytest.mark.parametrize(("shape", "spacing", "fraction"), SETS)
def test_spectrum_of_the_product_is_narrow(shape, spacing, fraction):
    """Few eigenvalues of M K leave [1/2, 2]: hence few iterations, on any set."""
    space = HalfSpace(shape, spacing, 1.0)
    nodes = rough_set(shape, fraction)
    inverse = inverse_on(space, nodes)
    matrix = np.array([inverse(unit) for unit in np.eye(nodes.size, dtype=np.float32)], float)
    # Those of M K are those of L' M L, which is symmetric, with K = L L'.
    lower = np.linalg.cholesky(plain_twins.operator_on(space, nodes))
    values = np.linalg.eigvalsh(lower.T @ matrix @ lower)
    assert values.min() > 0.2
    assert np.mean((values > 0.5) & (values < 2)) > 0.97


@pytest.mark.parametrize("shape", [(128, 128), (300, 280)])
def test_ten_iterations_solve_a_linear_problem_to_a_millionth(shape):
    space = HalfSpace(shape, (1.0, 1.0), 1.0)
    nodes = rough_set(shape, 0.1, hurst=0.8)
    operator = Operator(space)
    operator.inverse.update(nodes, fresh=True)
    equations = ProjectedCG(operator, nodes, np.ones(nodes.size))
    equations.iterate(1e-6, by_force=False)
    pressure = np.zeros(shape)
    pressure.ravel()[nodes] = equations.solution
    assert np.abs(1 - space.convolve(pressure).ravel()[nodes]).max() < 1e-5
    assert operator.applications <= 14


def test_an_updated_inverse_is_that_of_a_fresh_start_to_the_bit():
    space = HalfSpace((200, 190), (1.0, 1.0), 1.0)
    first, second = rough_set((200, 190), 0.2), rough_set((200, 190), 0.19)
    updated = Preconditioner(space)
    updated.update(first, fresh=True)
    updated.update(second, fresh=True)
    vector = np.random.default_rng(4).standard_normal(second.size).astype(np.float32)
    np.testing.assert_array_equal(updated(vector), inverse_on(space, second)(vector))


def test_an_inverse_does_not_depend_on_the_sets_of_earlier_solves():
    """Also where a solve begins with a few nodes, whose exact inverse needs no coarse operator."""
    space = HalfSpace((200, 190), (1.0, 1.0), 1.0)
    before, few, many = (rough_set((200, 190), fraction) for fraction in (0.2, 0.002, 0.19))
    assert few.size <= DIRECT
    used, new = Preconditioner(space), Preconditioner(space)
    used.update(before, fresh=True)
    for inverse in (used, new):
        inverse.update(few, fresh=True)
        inverse.update(many, fresh=False)
    vector = np.random.default_rng(6).standard_normal(many.size).astype(np.float32)
    np.testing.assert_array_equal(used(vector), new(vector))


def test_an_update_that_is_interrupted_changes_nothing(monkeypatch):
    space = HalfSpace((200, 190), (1.0, 1.0), 1.0)
    first, second = rough_set((200, 190), 0.2), rough_set((200, 190), 0.3)
    inverse = inverse_on(space, first)

    def interrupt(*_, **__):
        raise KeyboardInterrupt

    with monkeypatch.context() as broken:
        broken.setattr("roughcontact.contact.inverse_cholesky.threads.in_parts", interrupt)
        with pytest.raises(KeyboardInterrupt):
            inverse.update(second, fresh=True)
    inverse.update(second, fresh=True)
    vector = np.random.default_rng(7).standard_normal(second.size).astype(np.float32)
    np.testing.assert_array_equal(inverse(vector), inverse_on(space, second)(vector))


def test_bits_do_not_depend_on_the_number_of_threads(monkeypatch):
    space = HalfSpace((200, 190), (1.0, 1.0), 1.0)
    nodes = rough_set((200, 190), 0.3)
    vector = np.random.default_rng(5).standard_normal(nodes.size).astype(np.float32)
    results = []
    for count in ("1", "3"):
        monkeypatch.setenv("OMP_NUM_THREADS", count)
        results.append(inverse_on(space, nodes)(vector))
    np.testing.assert_array_equal(*results)


def test_a_few_nodes_that_stand_alone_do_not_get_an_operator_out_of_date():
    """Of all nodes they are nothing, of those around their basis function they are all."""
    space = HalfSpace((400, 400), (1.0, 1.0), 1.0)
    grid = np.zeros(space.shape, bool)
    grid[:150, :150] = True
    before, after = grid.copy(), grid.copy()
    before[300:302, 300:302] = after[300, 300] = True
    updated, fresh = Preconditioner(space), Preconditioner(space)
    updated.update(np.flatnonzero(before).astype(np.int32), fresh=True)
    updated.update(np.flatnonzero(after).astype(np.int32), fresh=False)
    fresh.update(np.flatnonzero(after).astype(np.int32), fresh=True)
    residual = np.ones(np.count_nonzero(after), np.float32)
    np.testing.assert_array_equal(updated(residual), fresh(residual))
