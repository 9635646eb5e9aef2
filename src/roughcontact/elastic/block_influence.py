"""Influence between blocks of cells that lie apart: one matrix for each relative position.

A block of the smallest holds the pressures of its cells, one further up stands for those below by
numbers on Chebyshev nodes (`multipole`). The influence depends on the distance alone: mirrored
positions, and on square cells those with x and y exchanged, have the same matrix but for the order
of its rows and columns. In double precision, where matrices are large and used once or twice,
one of them is made and what it is applied to is reordered; in single precision all are made, as
reordering would take as long as the product.
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
#: By precision: blocks no further apart than this are neighbours, which are not interpolated
#: between; Chebyshev nodes along a block; and the error to which they interpolate the influence of
#: one cell on another, as a fraction, between two blocks as near as any. Of the displacement under
#: many cells it is a hundredth of that, in single precision less than what rounding leaves.
SEPARATION = {_SINGLE: 1, _DOUBLE: 2}
ORDER = {_SINGLE: 8, _DOUBLE: 12}
ERROR = {_SINGLE: 2e-5, _DOUBLE: 2e-11}
#: Numbers of a target that are worked on together: as many as the processor holds of four pairs.
FILLED = {_SINGLE: 2 * WIDTH, _DOUBLE: WIDTH}


@dataclass(frozen=True)
class BlockInfluence:
    """Matrices of the influence of a block's numbers on another's, on one level.

    Attributes
    ----------
    matrices : (m, side^2, padded) ndarray
        (source, target); targets filled up with zeros.
    matrix, order : (n,) int32 ndarray
        Of each relative position: which matrix, and in which order numbers of both blocks go with
        it. Positions are counted row by row from the one furthest up and left.
    orders, inverses : (8, side^2) int32 ndarray
        Number 0 leaves numbers as they are. And where each number then stands.
    """

    matrices: np.ndarray
    matrix: np.ndarray
    order: np.ndarray
    orders: np.ndarray
    inverses: np.ndarray


def reach(separation: int) -> int:
    """Largest distance of blocks of one level whose parents are neighbours.

    Parameters
    ----------
    separation : int
        How far apart neighbours can be; all in blocks of their level.
    """
    return 2 * separation + 1


def padded(numbers: int, dtype: np.dtype) -> int:
    """Numbers of a block, filled up with zeros to whole vectors.

    Parameters
    ----------
    numbers : int
    dtype : dtype
        float32 or float64.
    """
    return -(-numbers // FILLED[dtype]) * FILLED[dtype]


# By what they follow from.
_KEPT: dict[tuple, BlockInfluence] = {}


def forget_matrices() -> None:
    """Clear the cache of all levels, for benchmarks of the set-up."""
    _KEPT.clear()


def block_influence(space: HalfSpace, levels: int, dtype: np.dtype) -> list[BlockInfluence]:
    """The influence between blocks of every level.

    Kept between sets and windows: it depends on the kernel and the ratio of a cell's sides alone.

    Parameters
    ----------
    space : HalfSpace
    levels : int
        How many, from that of the smallest blocks.
    dtype : dtype
        float32 or float64.

    Returns
    -------
    list of BlockInfluence
        One a level, that of the smallest blocks first.
    """
    found = []
    for level in range(levels):
        key = space.kernel, space.spacing[0] / space.spacing[1], level, dtype
        if key not in _KEPT:
            _KEPT.setdefault(key, _level_influence(space, level, dtype))
        found.append(_KEPT[key])
    return found


def interpolation_nodes(level: int, order: int) -> np.ndarray:
    """Positions of the Chebyshev nodes of a block along one side.

    Parameters
    ----------
    level : int
        0 of the smallest blocks, which hold their cells themselves.
    order : int
        Chebyshev nodes along a block of any other level.

    Returns
    -------
    (LEAF,) or (order,) ndarray
        In cells from its centre: centres of the cells on level 0, else Chebyshev nodes.
    """
    half = (LEAF * 2**level - 1) / 2
    if level == 0:
        return np.arange(LEAF) - half
    return half * np.cos(np.pi * (2 * np.arange(order) + 1) / (2 * order))


def transfer(level: int, order: int, dtype: np.dtype) -> np.ndarray:
    """Weights that interpolate from the nodes of a block to those of its children, along one axis.

    Parameters
    ----------
    level : int
        Of the children.
    order : int
        Chebyshev nodes along a block.
    dtype : dtype
        float32 or float64.

    Returns
    -------
    (2, m, order) ndarray
        Of the child on either side: of each of its m nodes (LEAF on level 0, else ``order``), by
        each node of the parent.
    """
    own, parent = interpolation_nodes(level, order), interpolation_nodes(level + 1, order)
    at = own + np.array([-0.5, 0.5])[:, None] * LEAF * 2**level
    others = ~np.eye(order, dtype=bool)
    away = np.where(others, at[:, :, None, None] - parent, 1.0)
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
    """Numbers (i, j) of the distances between places of one block and of another on it.

    Of each distance the first pair, and the orders of all numbers of a block. Places are symmetric,
    so the distances of i to j and of the mirrored j to the mirrored i are the same: the influence
    is evaluated at a quarter of all pairs.
    """
    i, j = np.indices((side, side))
    mirrored = (side - 1 - j) * side + side - 1 - i
    first, number = np.unique(np.minimum(i * side + j, mirrored), return_inverse=True)
    # Mirrored along y (2), along x (1), and y and x exchanged after that (4).
    numbers = np.arange(side**2, dtype=np.int32).reshape(side, side)
    orders = [numbers[::sy, ::sx] for sy in (1, -1) for sx in (1, -1)]
    orders += [n.T for n in orders]
    placed = np.stack([n.ravel() for n in orders])
    inverses = np.argsort(placed, axis=1).astype(np.int32)
    return number.reshape(i.shape).astype(np.int32), first, placed, inverses


@cache
def _positions(furthest, square, single):
    """Relative positions with a matrix of their own; of all, that of which, in which order."""
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


# Divided by is what vanishes only where nothing is read.
@njit(cache=True, error_model="numpy")
def _fill(positions, least, grid, table, spread, matrices):
    """Matrices of some relative positions; of nearer ones than ``least`` they stay zero.

    Distances between whole cells are looked up in a table, if there is one.
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
