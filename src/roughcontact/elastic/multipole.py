"""Elastic operator between the nodes of a set, by a fast multipole method.

The far influence is smooth: pressures and displacements of two separated blocks of cells are
interpolated from Chebyshev nodes on each, and the influence is evaluated between those (black-box
method of W. Fong and E. Darve, J. Comput. Phys. 228 (2009) 8712, on the levels of L. Greengard and
V. Rokhlin, J. Comput. Phys. 73 (1987) 325). The smallest blocks have 8 x 8 cells and hold the
pressures themselves; blocks of each level above are twice as long and wide. Only blocks with a node
of the set exist: work and memory grow with their number, not with the window. Blocks interact on
the lowest level on which their parents are neighbours, by one small matrix for each relative
position, as the influence depends on the distance alone.
"""

import numpy as np

from .. import threads
from ..kernel_cache import njit
from .block_influence import (
    LEAF,
    ORDER,
    SEPARATION,
    block_influence,
    padded,
    transfer,
)
from .block_pairs import TOGETHER, MultipoleLevels
from .halfspace import HalfSpace
from .simd import WIDTH, load, store

#: Largest aspect ratio of cells: neighbouring blocks are counted in blocks, not in lengths.
MAX_STRETCHED = 1.25
#: Largest mean number of loaded cells per loaded block for which cells are processed one by one.
FEW = 32


class MultipoleOperator:
    """K between the nodes of a set, whose `MultipoleLevels` are given, in one precision."""

    def __init__(self, space: HalfSpace, levels: MultipoleLevels, dtype: type):
        self._levels, self._dtype = levels, np.dtype(dtype)
        self._order = ORDER[self._dtype]
        count = len(levels.blocks)
        self._influence = block_influence(space, count, self._dtype)
        self._transfers = [transfer(level, self._order, self._dtype) for level in range(count - 1)]

    def __call__(self, positions: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Displacement of all nodes, (n,), under ``values`` (m,) at ``positions`` in the set."""
        levels, sides = self._levels, self._sides()
        sources = [
            np.zeros((n + 1) * side**2, self._dtype)
            for n, side in zip(levels.blocks, sides, strict=True)
        ]
        loaded = [np.zeros(n + 1, np.bool_) for n in levels.blocks]
        _scatter(positions, values, levels.place, sources[0], loaded[0])
        for k, parents in enumerate(levels.parents):
            _to_parents(
                *(parents, self._transfers[k], sides[k], sides[k + 1]),
                *(sources[k], loaded[k], sources[k + 1], loaded[k + 1]),
            )
        images = [
            np.zeros((n + 1) * padded(side**2, self._dtype), self._dtype)
            for n, side in zip(levels.blocks, sides, strict=True)
        ]
        for k, side in enumerate(sides):
            self._translate(k, side, sources[k], loaded[k], images[k])
        for k in range(len(levels.parents) - 1, -1, -1):
            _to_children(
                *(levels.parents[k], self._transfers[k], sides[k], sides[k + 1]),
                *(padded(sides[k] ** 2, self._dtype), padded(sides[k + 1] ** 2, self._dtype)),
                *(images[k], images[k + 1]),
            )
        return images[0][levels.place]

    def _sides(self):
        """Number of values along a block of every level."""
        return [LEAF] + [self._order] * (len(self._levels.blocks) - 1)

    def _translate(self, k, side, sources, loaded, images):
        """Add the influence of the sources of one level to the images of its blocks."""
        batches, chunks = self._levels.pairs(SEPARATION[self._dtype])[k]
        influence = self._influence[k]
        matrices = influence.matrices.ravel()
        which = influence.matrix, influence.order, influence.orders
        count = padded(side**2, self._dtype)

        def translate(start: int, stop: int) -> None:
            _translate(
                *(chunks[start], chunks[stop], batches, matrices, *which),
                *(side**2, count, sources, loaded, images),
            )

        def translate_few(start: int, stop: int) -> None:
            _translate_few(
                *(chunks[start], chunks[stop], batches, matrices, *which),
                *(influence.inverses, *listed, sources, images),
            )

        if k == 0:
            listed = _listed(sources, loaded)
            if listed[0].sum() <= FEW * np.count_nonzero(loaded):
                translate = translate_few
        threads.in_parts(translate, len(chunks) - 1, smallest=1)


def multipole_suits(space: HalfSpace) -> bool:
    """True if cells are nearly square, as the stated errors require."""
    return max(space.spacing) <= MAX_STRETCHED * min(space.spacing)


@njit(cache=True)
def _scatter(positions, values, place, sources, loaded):
    for i in range(positions.size):
        entry = place[positions[i]]
        sources[entry] = values[i]
        if values[i] != 0:
            loaded[entry // (LEAF * LEAF)] = True


@njit(cache=True)
def _to_parents(parents, weights, side, parent_side, values, loaded, above, loaded_above):
    """Add the values of each block to its parent by the transposed interpolation."""
    part = np.empty((side, parent_side), values.dtype)
    for block in range(parents.shape[0]):
        if not loaded[block]:
            continue
        parent, quarter = parents[block, 0], parents[block, 1]
        loaded_above[parent] = True
        wy, wx = weights[quarter // 2], weights[quarter % 2]
        first, first_above = block * side * side, parent * parent_side * parent_side
        part[:] = 0
        for y in range(side):
            for x in range(side):
                value = values[first + y * side + x]
                for j in range(parent_side):
                    part[y, j] += value * wx[x, j]
        for y in range(side):
            for i in range(parent_side):
                for j in range(parent_side):
                    above[first_above + i * parent_side + j] += wy[y, i] * part[y, j]


@njit(cache=True)
def _to_children(parents, weights, side, parent_side, length, length_above, values, above):
    """Add to each block the interpolated displacement of its parent."""
    part = np.empty((side, parent_side), values.dtype)
    for block in range(parents.shape[0]):
        parent, quarter = parents[block, 0], parents[block, 1]
        wy, wx = weights[quarter // 2], weights[quarter % 2]
        first, first_above = block * length, parent * length_above
        part[:] = 0
        for y in range(side):
            for i in range(parent_side):
                for j in range(parent_side):
                    part[y, j] += wy[y, i] * above[first_above + i * parent_side + j]
        for y in range(side):
            for x in range(side):
                total = values[first + y * side + x]
                for j in range(parent_side):
                    total += wx[x, j] * part[y, j]
                values[first + y * side + x] = total


@njit(cache=True, nogil=True)
def _translate(
    start, stop, batches, matrices, matrix, order, orders, numbers, length, sources, loaded, images
):
    """Add the images of some batches; the pairs of a batch share each matrix entry that is read."""
    held = np.empty(TOGETHER * numbers, sources.dtype)
    moved = np.empty(TOGETHER * length, sources.dtype)
    pairs = np.arange(TOGETHER)
    source, target = np.empty(TOGETHER, np.int64), np.empty(TOGETHER, np.int64)
    for b in range(start, stop):
        offset, anything = batches[b, 0], False
        for pair in range(TOGETHER):
            anything |= loaded[batches[b, 1 + TOGETHER + pair]]
            source[pair] = batches[b, 1 + TOGETHER + pair] * numbers
            target[pair] = batches[b, 1 + pair] * length
        if not anything:
            continue
        first = matrix[offset] * numbers * length
        if order[offset] == 0:
            _multiply(matrices, first, numbers, length, sources, source, images, target)
            continue
        places = orders[order[offset]]
        for pair in range(TOGETHER):
            for j in range(numbers):
                held[pair * numbers + j] = sources[source[pair] + places[j]]
        moved[:] = 0
        _multiply(matrices, first, numbers, length, held, pairs * numbers, moved, pairs * length)
        for pair in range(TOGETHER):
            for j in range(numbers):
                images[target[pair] + places[j]] += moved[pair * length + j]


@njit(cache=True)
def _multiply(matrices, first, numbers, length, sources, source, images, target):
    """Add the product of a matrix and four sources' values to their targets."""
    if matrices.itemsize == 4:
        for v in range(0, length, 2 * WIDTH):
            _multiply_two(
                *(matrices, first + v, numbers, length, sources, source, images, target, v)
            )
    else:
        for v in range(0, length, WIDTH):
            _multiply_one(
                *(matrices, first + v, numbers, length, sources, source, images, target, v)
            )


@njit(cache=True)
def _multiply_two(matrices, row, numbers, length, sources, source, images, target, v):
    """`_multiply` for two vectors of targets, in single precision."""
    s0, s1, s2, s3 = source[0], source[1], source[2], source[3]
    t0, t1, t2, t3 = target[0] + v, target[1] + v, target[2] + v, target[3] + v
    a0, a1 = load(images, t0), load(images, t0 + WIDTH)
    b0, b1 = load(images, t1), load(images, t1 + WIDTH)
    c0, c1 = load(images, t2), load(images, t2 + WIDTH)
    d0, d1 = load(images, t3), load(images, t3 + WIDTH)
    for j in range(numbers):
        m0, m1 = load(matrices, row), load(matrices, row + WIDTH)
        p, q = sources[s0 + j], sources[s1 + j]
        a0, a1, b0, b1 = a0 + p * m0, a1 + p * m1, b0 + q * m0, b1 + q * m1
        p, q = sources[s2 + j], sources[s3 + j]
        c0, c1, d0, d1 = c0 + p * m0, c1 + p * m1, d0 + q * m0, d1 + q * m1
        row += length
    store(images, t0, a0)
    store(images, t0 + WIDTH, a1)
    store(images, t1, b0)
    store(images, t1 + WIDTH, b1)
    store(images, t2, c0)
    store(images, t2 + WIDTH, c1)
    store(images, t3, d0)
    store(images, t3 + WIDTH, d1)


@njit(cache=True)
def _multiply_one(matrices, row, numbers, length, sources, source, images, target, v):
    """`_multiply` for one vector of targets, which in double precision fills the registers."""
    s0, s1, s2, s3 = source[0], source[1], source[2], source[3]
    t0, t1, t2, t3 = target[0] + v, target[1] + v, target[2] + v, target[3] + v
    a, b, c, d = load(images, t0), load(images, t1), load(images, t2), load(images, t3)
    for j in range(numbers):
        m = load(matrices, row)
        p, q = sources[s0 + j], sources[s1 + j]
        a, b = a + p * m, b + q * m
        p, q = sources[s2 + j], sources[s3 + j]
        c, d = c + p * m, d + q * m
        row += length
    store(images, t0, a)
    store(images, t1, b)
    store(images, t2, c)
    store(images, t3, d)


@njit(cache=True)
def _listed(sources, loaded):
    """Number and list of the loaded cells of each smallest block."""
    counts = np.zeros(loaded.size, np.int64)
    cells = np.empty(loaded.size * LEAF * LEAF, np.int32)
    for block in range(loaded.size):
        if not loaded[block]:
            continue
        first = block * LEAF * LEAF
        for j in range(LEAF * LEAF):
            if sources[first + j] != 0:
                cells[first + counts[block]] = j
                counts[block] += 1
    return counts, cells


@njit(cache=True, nogil=True)
def _translate_few(
    start, stop, batches, matrices, matrix, order, orders, inverses, counts, cells, sources, images
):
    """`_translate` between smallest blocks, one row of the matrix for each loaded cell."""
    numbers = LEAF * LEAF
    moved = np.empty(numbers, images.dtype)
    for b in range(start, stop):
        offset = batches[b, 0]
        first, way = np.int64(matrix[offset]) * numbers * numbers, order[offset]
        for pair in range(TOGETHER):
            block = batches[b, 1 + TOGETHER + pair]
            if counts[block] == 0:
                continue
            source, target = np.int64(block) * numbers, np.int64(batches[b, 1 + pair]) * numbers
            those = cells[source : source + counts[block]]
            if way == 0:
                _add_rows(matrices, first, those, inverses[0], sources, source, images, target)
                continue
            moved[:] = 0
            _add_rows(matrices, first, those, inverses[way], sources, source, moved, 0)
            for j in range(numbers):
                images[target + orders[way, j]] += moved[j]


@njit(cache=True)
def _add_rows(matrices, first, cells, number, sources, source, images, target):
    """Add rows of a matrix, each times the pressure of a cell, to 64 numbers."""
    step = LEAF * LEAF
    if matrices.itemsize == 4:
        a, b = load(images, target), load(images, target + WIDTH)
        c, d = load(images, target + 2 * WIDTH), load(images, target + 3 * WIDTH)
        for cell in cells:
            row, p = first + number[cell] * step, sources[source + cell]
            a, b = a + p * load(matrices, row), b + p * load(matrices, row + WIDTH)
            c = c + p * load(matrices, row + 2 * WIDTH)
            d = d + p * load(matrices, row + 3 * WIDTH)
        store(images, target, a)
        store(images, target + WIDTH, b)
        store(images, target + 2 * WIDTH, c)
        store(images, target + 3 * WIDTH, d)
        return
    for v in range(0, step, 2 * WIDTH):
        a, b = load(images, target + v), load(images, target + v + WIDTH)
        for cell in cells:
            row, p = first + number[cell] * step + v, sources[source + cell]
            a, b = a + p * load(matrices, row), b + p * load(matrices, row + WIDTH)
        store(images, target + v, a)
        store(images, target + v + WIDTH, b)
