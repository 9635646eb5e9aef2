"""Influence between separated blocks of cells: one matrix for each relative position.

A smallest block holds the pressures of its cells; a block of a higher level represents those below
by values on Chebyshev nodes (`multipole`). The influence depends on the distance alone: mirrored
positions, and on square cells those with x and y exchanged, share a matrix up to the order of its
rows and columns. In double precision matrices are large and used once or twice, so that one of them
is computed and the vectors are reordered. In single precision all are computed, since reordering
would take as long as the product.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np

from ..kernel_cache import njit
from .halfspace import HalfSpace
from .influence import expansion
from .simd import WIDTH

#: Cells along a smallest block.
LEAF = 8
_SINGLE, _DOUBLE = np.dtype(np.float32), np.dtype(np.float64)
#: By precision: largest distance of neighbouring blocks, between which nothing is interpolated;
#: Chebyshev nodes along a block; and the relative error of the interpolated influence of one cell
#: on another between the nearest two blocks. The relative error of a displacement under many cells
#: is a hundredth of that; in single precision, below rounding.
SEPARATION = {_SINGLE: 1, _DOUBLE: 2}
ORDER = {_SINGLE: 8, _DOUBLE: 12}
ERROR = {_SINGLE: 2e-5, _DOUBLE: 2e-11}
#: Values of a target processed together: those of four pairs fill the processor's registers.
FILLED = {_SINGLE: 2 * WIDTH, _DOUBLE: WIDTH}


@dataclass(frozen=True)
class BlockInfluence:
    """Matrices of the influence of one block's values on another's, on one level.

    Attributes
    ----------
    matrices : (m, side^2, padded) ndarray
        (source, target); targets are padded with zeros.
    matrix, order : (n,) int32 ndarray
        Matrix of each relative position, and the order of both blocks' values for it. Positions are
        counted row by row from the upper left.
    orders, inverses : (8, side^2) int32 ndarray
        Permutations of a block's values, of which number 0 is the identity, and their inverses.
    """

    matrices: np.ndarray
    matrix: np.ndarray
    order: np.ndarray
    orders: np.ndarray
    inverses: np.ndarray


def reach(separation: int) -> int:
    """Largest distance, in blocks, of two blocks of one level whose parents are neighbours."""
    return 2 * separation + 1


def padded(numbers: int, dtype: np.dtype) -> int:
    """Number of values of a block, padded to whole vectors."""
    return -(-numbers // FILLED[dtype]) * FILLED[dtype]


# Matrices by kernel, aspect ratio, level and precision.
_KEPT: dict[tuple, BlockInfluence] = {}


def forget_matrices() -> None:
    """Clear the cached matrices of all levels, for benchmarks of the set-up."""
    _KEPT.clear()


def block_influence(space: HalfSpace, levels: int, dtype: np.dtype) -> list[BlockInfluence]:
    """Influence between blocks on each of ``levels`` levels, from the smallest blocks up.

    Cached for all sets and windows: it depends on the kernel, the precision and the aspect ratio of
    a cell alone.
    """
    influences = []
    for level in range(levels):
        key = space.kernel, space.spacing[0] / space.spacing[1], level, dtype
        if key not in _KEPT:
            _KEPT.setdefault(key, _level_influence(space, level, dtype))
        influences.append(_KEPT[key])
    return influences


def interpolation_nodes(level: int, order: int) -> np.ndarray:
    """Positions of a block's values along one side, in cells from its centre.

    On level 0 they are the centres of its LEAF cells, above that ``order`` Chebyshev nodes.
    """
    half = (LEAF * 2**level - 1) / 2
    if level == 0:
        return np.arange(LEAF) - half
    return half * np.cos(np.pi * (2 * np.arange(order) + 1) / (2 * order))


def transfer(level: int, order: int, dtype: np.dtype) -> np.ndarray:
    """Interpolation weights from a block to its two children along one axis, (2, m, order).

    ``level`` is that of the children, m the number of their nodes (LEAF on level 0, else
    ``order``).
    """
    own, parent = interpolation_nodes(level, order), interpolation_nodes(level + 1, order)
    positions = own + np.array([-0.5, 0.5])[:, None] * LEAF * 2**level
    others = ~np.eye(order, dtype=bool)
    away = np.where(others, positions[:, :, None, None] - parent, 1.0)
    apart = np.where(others, parent[:, None] - parent, 1.0)
    return (away / apart).prod(axis=-1).astype(dtype)


def _level_influence(space, level, dtype):
    places, furthest = interpolation_nodes(level, ORDER[dtype]), reach(SEPARATION[dtype])
    number, first, orders, inverses = _pairs_of_places(places.size)
    square = space.spacing[0] == space.spacing[1]
    positions, matrix, order = _positions(furthest, square, dtype == _SINGLE)
    matrices = np.zeros((len(positions), places.size**2, padded(places.size**2, dtype)), dtype)
    table, least = np.zeros((0, 0)), SEPARATION[dtype] + 1
    if level == 0:
        table, least = space.influence_within((LEAF * (furthest + 1),) * 2), 0
    apart = (places[:, None] - places).ravel()[first]
    sides = space.spacing[0] / space.cell, space.spacing[1] / space.cell
    grid = LEAF * 2.0**level, apart, number, sides
    _fill(positions, least, grid, table, space.spread, matrices)
    return BlockInfluence(matrices, matrix, order, orders, inverses)


@cache
def _pairs_of_places(side):
    """Distances between the positions (i, j) of two blocks, and all orders of a block's values.

    Returns the number of each pair's distance and the first pair of each distance. Positions are
    symmetric, so that i to j is as far as mirrored j to mirrored i: the influence is evaluated for
    a quarter of all pairs.
    """
    i, j = np.indices((side, side))
    mirrored = (side - 1 - j) * side + side - 1 - i
    first, number = np.unique(np.minimum(i * side + j, mirrored), return_inverse=True)
    # Bits of an order: mirrored along x (1), along y (2), then y and x exchanged (4).
    numbers = np.arange(side**2, dtype=np.int32).reshape(side, side)
    orders = [numbers[::sy, ::sx] for sy in (1, -1) for sx in (1, -1)]
    orders += [n.T for n in orders]
    placed = np.stack([n.ravel() for n in orders])
    inverses = np.argsort(placed, axis=1).astype(np.int32)
    return number.reshape(i.shape).astype(np.int32), first, placed, inverses


@cache
def _positions(furthest, square, single):
    """Relative positions with a matrix of their own; matrix and order of every position."""
    y, x = np.indices((2 * furthest + 1,) * 2, np.int32).reshape(2, -1) - np.int32(furthest)
    if single:
        return np.stack([y, x], axis=1), np.arange(y.size, dtype=np.int32), np.zeros_like(y)
    order = 4 * (square & (np.abs(y) < np.abs(x))) + 2 * (y < 0) + (x < 0)
    y, x = np.abs(y), np.abs(x)
    if square:
        y, x = np.maximum(y, x), np.minimum(y, x)
    distinct, matrix = np.unique(y * (furthest + 1) + x, return_inverse=True)
    positions = np.stack(np.divmod(distinct, furthest + 1), axis=1)
    return positions.astype(np.int32), matrix.ravel().astype(np.int32), order.astype(np.int32)


# The divisor vanishes only at distances that are not read; "numpy" leaves out its check.
@njit(cache=True, error_model="numpy")
def _fill(positions, least, grid, table, spread, matrices):
    """Fill the matrices of relative positions; those nearer than ``least`` stay zero.

    Distances of whole cells are read from a table, if there is one.
    """
    length, apart, number, sides = grid
    side = number.shape[0]
    values = np.empty((apart.size, apart.size))
    rows = np.empty((apart.size, side, side), matrices.dtype)
    for k in range(positions.shape[0]):
        y, x = positions[k]
        if max(abs(y), abs(x)) < least:
            continue
        away_y, away_x = np.abs(apart - abs(y) * length), np.abs(apart - abs(x) * length)
        if table.size:
            for i in range(apart.size):
                for j in range(apart.size):
                    values[i, j] = table[round(away_y[i]), round(away_x[j])]
        else:
            away_y, away_x = away_y * sides[0], away_x * sides[1]
            for i in range(apart.size):
                line = values[i]
                for j in range(line.size):
                    line[j] = expansion(away_y[i], away_x[j], *spread)
        for i in range(apart.size):
            for source in range(side):
                for target in range(side):
                    j = number[source, target] if x >= 0 else number[target, source]
                    rows[i, source, target] = values[i, j]
        for source in range(side):
            for target in range(side):
                i = number[source, target] if y >= 0 else number[target, source]
                for other in range(side):
                    row = matrices[k, source * side + other, target * side : (target + 1) * side]
                    for j in range(side):
                        row[j] = rows[i, other, j]
