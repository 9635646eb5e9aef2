"""Influence between blocks of cells that lie apart: one matrix for each relative position.

A block of the smallest holds the pressures of its cells, one further up stands for those below by
numbers on Chebyshev nodes (`multipole`). The influence depends on the distance alone: mirrored
positions, and on square cells those with x and y exchanged, have the same matrix but for the order
of its rows and columns. In double precision, where matrices are large and used once or twice,
one of them is made and what it is applied to is reordered; in single precision all are made, as
reordering would take as long as the product.
"""

from dataclasses import dataclass

import numpy as np

from ..core.kernel_cache import njit
from .halfspace import HalfSpace
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
#: Numbers of a block are filled up with zeros to a multiple of this.
PADDED = 2 * WIDTH


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
    orders : (8, side^2) int32 ndarray
        Number 0 leaves numbers as they are.
    """

    matrices: np.ndarray
    matrix: np.ndarray
    order: np.ndarray
    orders: np.ndarray


def reach(separation: int) -> int:
    """How far apart blocks of one level can be whose parents are neighbours."""
    return 2 * separation + 1


def padded(numbers: int) -> int:
    """Numbers of a block, filled up."""
    return -(-numbers // PADDED) * PADDED


# By what they follow from.
_KEPT: dict[tuple, BlockInfluence] = {}


def forget_matrices() -> None:
    """Keep nothing of any level: for benchmarks of the set-up."""
    _KEPT.clear()


def block_influence(space: HalfSpace, levels: int, dtype: np.dtype) -> list[BlockInfluence]:
    """The influence between blocks of every level.

    Kept between sets and windows: it depends on the kernel and the ratio of a cell's sides alone.

    Parameters
    ----------
    space : HalfSpace
    levels : int
    dtype : dtype
        float32 or float64.
    """
    found = []
    for level in range(levels):
        key = space.kernel, space.spacing[0] / space.spacing[1], level, dtype
        if key not in _KEPT:
            _KEPT.setdefault(key, _level_influence(space, level, dtype))
        found.append(_KEPT[key])
    return found


def chebyshev(level: int, order: int) -> np.ndarray:
    """Places in a block of a level, in cells from its centre: of its cells or Chebyshev nodes."""
    half = (LEAF * 2**level - 1) / 2
    if level == 0:
        return np.arange(LEAF) - half
    return half * np.cos(np.pi * (2 * np.arange(order) + 1) / (2 * order))


def transfer(level: int, order: int, dtype: np.dtype) -> np.ndarray:
    """Weights of the parent's nodes in each of a child's, along one axis, (2, child, parent)."""
    own, parent = chebyshev(level, order), chebyshev(level + 1, order)
    at = own + np.array([-0.5, 0.5])[:, None] * LEAF * 2**level
    others = ~np.eye(order, dtype=bool)
    away = np.where(others, at[:, :, None, None] - parent, 1.0)
    apart = np.where(others, parent[:, None] - parent, 1.0)
    return (away / apart).prod(axis=-1).astype(dtype)


def _level_influence(space, level, dtype):
    places = chebyshev(level, ORDER[dtype])
    number, apart = _distances(places)
    furthest, square = reach(SEPARATION[dtype]), space.spacing[0] == space.spacing[1]
    least = 0 if level == 0 else SEPARATION[dtype] + 1
    values = _values(space, level, furthest, apart)
    if dtype == _SINGLE:
        positions = np.indices((2 * furthest + 1,) * 2).reshape(2, -1).T - furthest
        matrix, order = np.arange(len(positions)), np.zeros(len(positions))
    else:
        positions, matrix, order = _distinct(furthest, square)
    positions = positions.astype(np.int32)
    matrices = np.zeros((len(positions), places.size**2, padded(places.size**2)), dtype)
    _fill(positions, least, values, number, matrices)
    orders = _orders(places.size)
    return BlockInfluence(matrices, matrix.astype(np.int32), order.astype(np.int32), orders)


def _distances(places):
    """Distances (n,) between places of one block and of another on it, and their numbers (i, j).

    Places are symmetric, so those of i to j and of the mirrored j to the mirrored i are the same:
    the influence, which takes longer than all else, is evaluated at a quarter of all pairs.
    """
    i, j = np.indices((places.size, places.size))
    mirrored = (places.size - 1 - j) * places.size + places.size - 1 - i
    first, number = np.unique(np.minimum(i * places.size + j, mirrored), return_inverse=True)
    number = number.reshape(i.shape).astype(np.int32)
    return number, (places[:, None] - places).ravel()[first]


def _values(space, level, furthest, apart):
    """Influence at all distances (block y, block x, apart y, apart x) of blocks, none negative."""
    away = np.abs(apart - np.arange(furthest + 1)[:, None] * (LEAF * 2.0**level)).ravel()
    if level == 0:
        cells = np.rint(away).astype(np.int64)
        values = space.influence_within(LEAF * (furthest + 1))[np.ix_(cells, cells)]
    else:
        values = space.far_influence(away, away)
    values = values.reshape(furthest + 1, apart.size, furthest + 1, apart.size)
    return values.transpose(0, 2, 1, 3)


def _distinct(furthest, square):
    """Relative positions with a matrix of their own; of all, that of which, in which order."""
    y, x = np.indices((2 * furthest + 1,) * 2).reshape(2, -1) - furthest
    order = 4 * (square & (np.abs(y) < np.abs(x))) + 2 * (y < 0) + (x < 0)
    y, x = np.abs(y), np.abs(x)
    if square:
        y, x = np.maximum(y, x), np.minimum(y, x)
    distinct, matrix = np.unique(y * (furthest + 1) + x, return_inverse=True)
    return np.stack(np.divmod(distinct, furthest + 1), axis=1), matrix.ravel(), order


def _orders(side):
    """Numbers of a block mirrored along y (2), along x (1), with y and x exchanged after that (4)."""
    numbers = np.arange(side**2, dtype=np.int32).reshape(side, side)
    mirrored = [numbers[::sy, ::sx] for sy in (1, -1) for sx in (1, -1)]
    return np.stack([n.ravel() for n in mirrored + [n.T for n in mirrored]])


@njit(cache=True)
def _fill(positions, least, values, number, matrices):
    """Matrices of some relative positions; of nearer ones than ``least`` they stay zero."""
    side = number.shape[0]
    for k in range(positions.shape[0]):
        y, x = positions[k]
        if max(abs(y), abs(x)) < least:
            continue
        block = values[abs(y), abs(x)]
        for s in range(side * side):
            sy, sx = s // side, s % side
            row = matrices[k, s]
            for ty in range(side):
                line = block[number[sy, ty] if y >= 0 else number[ty, sy]]
                for tx in range(side):
                    row[ty * side + tx] = line[number[sx, tx] if x >= 0 else number[tx, sx]]
