"""Influence between blocks: each matrix, in its order, is the influence at each distance."""

import numpy as np
import pytest

from roughcontact import HalfSpace
from roughcontact.elastic.block_influence import (
    LEAF,
    ORDER,
    SEPARATION,
    block_influence,
    forget_matrices,
    interpolation_nodes,
    reach,
    transfer,
)
from roughcontact.elastic.influence import expansion, influence_table, love_displacement


def mean_over_cell(y, x, dy, dx):
    """Mean of 1/(pi r) over a cell times its area, by Gauss's rule: exact where r is large."""
    at, weight = np.polynomial.legendre.leggauss(12)
    py, px = np.meshgrid(y + at * dy / 2, x + at * dx / 2, indexing="ij")
    return dy * dx * (np.outer(weight, weight) / 4 / (np.pi * np.hypot(py, px))).sum()


def between(influence, side, position, furthest):
    """The influence (source, target) of a block on another, its numbers in their usual order."""
    number = (position[0] + furthest) * (2 * furthest + 1) + position[1] + furthest
    matrix = influence.matrices[influence.matrix[number], :, : side**2]
    order = influence.orders[influence.order[number]]
    found = np.empty_like(matrix)
    found[np.ix_(order, order)] = matrix
    return found


@pytest.mark.parametrize("dtype", [np.dtype(np.float32), np.dtype(np.float64)])
@pytest.mark.parametrize(
    ("kernel", "spacing"),
    [
        ("love", (1.0, 1.0)),
        ("love", (1.2, 1.0)),
        ("love", (1.0, 1.25)),
        ("inscribed disc", (1.0, 1.0)),
    ],
)
def test_every_matrix_is_the_influence_between_its_numbers(kernel, spacing, dtype):
    space = HalfSpace((64, 64), spacing, 1.0, kernel=kernel)
    furthest, rng = reach(SEPARATION[dtype]), np.random.default_rng(0)
    sides = tuple(d / space.cell for d in spacing)
    for level, influence in enumerate(block_influence(space, 3, dtype)):
        places = interpolation_nodes(level, ORDER[dtype])
        # In single precision a matrix for each position, in double for each that is distinct.
        distinct = {np.float32: 49, np.float64: 21 if spacing[0] == spacing[1] else 36}
        assert len(influence.matrices) == distinct[dtype.type]
        for position in np.ndindex(2 * furthest + 1, 2 * furthest + 1):
            position = np.array(position) - furthest
            matrix = between(influence, places.size, position, furthest)
            if level > 0 and np.abs(position).max() <= SEPARATION[dtype]:
                assert not matrix.any()
                continue
            for source, target in rng.integers(0, places.size**2, (6, 2)):
                sy, sx = divmod(source, places.size)
                ty, tx = divmod(target, places.size)
                away = LEAF * 2**level * position
                y, x = (
                    abs(away[0] + places[ty] - places[sy]),
                    abs(away[1] + places[tx] - places[sx]),
                )
                if level == 0:
                    exact = space.influence()[round(y), round(x)]
                elif kernel == "love":
                    exact = mean_over_cell(y * sides[0], x * sides[1], *sides)
                else:
                    exact = 1 / (np.pi * np.hypot(y, x))
                allowed = 2e-7 if dtype == np.float32 else 5e-12
                assert matrix[source, target] == pytest.approx(exact, rel=allowed)


def test_padding_is_zero_and_the_first_order_changes_nothing():
    space = HalfSpace((64, 64), (1.0, 1.0), 1.0)
    for influence in block_influence(space, 2, np.dtype(np.float64)):
        side = influence.orders.shape[1]
        assert not influence.matrices[:, :, side:].any()
        np.testing.assert_array_equal(influence.orders[0], np.arange(side))
        np.testing.assert_array_equal(np.sort(influence.orders), [np.arange(side)] * 8)


def test_matrices_are_kept_until_they_are_forgotten():
    space = HalfSpace((64, 64), (1.0, 1.0), 1.0)
    first = block_influence(space, 2, np.dtype(np.float32))
    again = block_influence(HalfSpace((99, 80), (0.3, 0.3), 5.0), 2, np.dtype(np.float32))
    assert all(a is b for a, b in zip(first, again, strict=True))
    forget_matrices()
    assert block_influence(space, 2, np.dtype(np.float32))[0] is not first[0]


@pytest.mark.parametrize("level", [0, 1, 4])
def test_transfer_interpolates_polynomials_exactly(level):
    weights = transfer(level, 12, np.dtype(np.float64))
    own, parent = interpolation_nodes(level, 12), interpolation_nodes(level + 1, 12)
    scale = parent.max()
    for half, shift in enumerate((-0.5, 0.5)):
        at = (own + shift * LEAF * 2**level) / scale
        for power in range(12):
            found = weights[half] @ (parent / scale) ** power
            np.testing.assert_allclose(found, at**power, atol=1e-12)


@pytest.mark.parametrize("sides", [(1.0, 1.0), (2.0, 0.5), (0.25, 4.0)])
def test_a_table_is_love_s_displacement_at_every_distance(sides):
    dy, dx = sides
    table = influence_table((70, 90), sides, None)
    y, x = np.arange(70)[:, None] * dy, np.arange(90) * dx
    # Its corners cancel: of a value 1/(pi r) some 1e-15 r remain of each of eight terms of size r.
    rounding = 1e-14 * np.hypot(y, x) ** 2 + 1e-14
    exact = love_displacement(x, y, dx, dy)
    assert (np.abs(table / exact - 1) <= 1e-11 + rounding).all()


def test_the_expansion_errs_as_said():
    for away, error in ((17.0, 1e-10), (33.0, 1e-12), (200.0, 1e-14)):
        for y, x in ((away, 0.0), (0.0, away), (0.6 * away, 0.8 * away)):
            found = expansion(y, x, 1.0, 1.0, 1.0)
            assert found == pytest.approx(mean_over_cell(y, x, 1.0, 1.0), rel=error)
