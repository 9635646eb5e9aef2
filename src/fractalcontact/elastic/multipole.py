"""The elastic operator between the nodes of a set, by a fast multipole method.

What is far away is smooth: pressures and displacements of two blocks of cells that lie apart are
interpolated from Chebyshev nodes on each, and the influence is evaluated between those (the
black-box method of W. Fong and E. Darve, J. Comput. Phys. 228 (2009) 8712, on the levels of
L. Greengard and V. Rokhlin, J. Comput. Phys. 73 (1987) 325). Blocks of 8 x 8 cells are the smallest
and hold the pressures themselves; on each level above, blocks are twice as long and wide. Only
blocks with a node of the set exist: work and memory grow with their number, not with the window.
Blocks act on each other at the lowest level on which their parents are neighbours, and there, as
the influence depends on the distance alone, by one small matrix for each relative position.
"""

import numpy as np

from ..core import threads
from ..core.kernel_cache import njit
from .halfspace import HalfSpace
from .simd import WIDTH, load, store

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
#: Cells are at most this many times as long as wide: blocks are neighbours by number, not distance.
MOST_STRETCHED = 1.25
#: Pairs of blocks with the same relative position that are worked on together.
TOGETHER = 4
#: Target blocks of a chunk: for each the matrices are read again.
CHUNK = 128
#: Numbers of a block are filled up with zeros to a multiple of this.
PADDED = 2 * WIDTH


class MultipoleLevels:
    """Blocks, and pairs of blocks, that the nodes of a set occupy on every level.

    Parameters
    ----------
    shape : (int, int)
        Cells of the window, (ny, nx).
    nodes : (n,) int32 ndarray
        Nodes as numbers of cells, ascending; nothing checks them.

    Attributes
    ----------
    place : (n,) ndarray
        Where each node stands in the vectors of the smallest blocks.
    blocks : list of int
        On every level.
    parents : list of (n, 2) int32 ndarray
        On every level but the last, of each block: its parent, and which of its four quarters.
    """

    def __init__(self, shape: tuple[int, int], nodes: np.ndarray):
        grid = tuple(-(-n // LEAF) for n in shape)
        index = np.zeros(grid, np.int32)
        y, x = np.divmod(nodes, shape[1])
        index[y // LEAF, x // LEAF] = 1
        at = np.flatnonzero(index).astype(np.int64)
        index.ravel()[at] = np.arange(1, at.size + 1)
        self.place = (index[y // LEAF, x // LEAF] - 1).astype(np.int64) * LEAF**2
        self.place += y % LEAF * LEAF + x % LEAF
        self.blocks, self.parents, self._grids = [], [], []
        self._pairs: dict[int, list] = {}
        while True:
            rows, columns = np.divmod(at, grid[1])
            self.blocks.append(at.size)
            self._grids.append((rows, columns, index))
            if max(grid) <= 2 * _reach(min(SEPARATION.values())) - 2:
                return
            grid = tuple(-(-n // 2) for n in grid)
            index = np.zeros(grid, np.int32)
            index[rows // 2, columns // 2] = 1
            at = np.flatnonzero(index).astype(np.int64)
            index.ravel()[at] = np.arange(1, at.size + 1)
            quarter = rows % 2 * 2 + columns % 2
            self.parents.append(
                np.stack([index[rows // 2, columns // 2] - 1, quarter], axis=1).astype(np.int32)
            )

    def pairs(self, separation: int) -> list[tuple[np.ndarray, np.ndarray]]:
        """Pairs of blocks that act on each other, for every level.

        Parameters
        ----------
        separation : int

        Returns
        -------
        list of (batches, chunks)
            Batches (m, 1 + 2 TOGETHER): relative position, targets and sources; and where in them
            the chunks of targets begin.
        """
        if separation not in self._pairs:
            self._pairs[separation] = [
                _pairs(*grid, level == 0, separation) for level, grid in enumerate(self._grids)
            ]
        return self._pairs[separation]

    @property
    def work(self) -> int:
        """Batches of all levels, which take nearly all the time of a search's application."""
        return sum(len(batches) for batches, _ in self.pairs(SEPARATION[_SINGLE]))


class MultipoleOperator:
    """K between the nodes of a set, in one precision.

    Parameters
    ----------
    space : HalfSpace
    levels : MultipoleLevels
        Of these nodes.
    dtype : type
        float32 or float64.
    """

    def __init__(self, space: HalfSpace, levels: MultipoleLevels, dtype: type):
        self._levels, self._dtype = levels, np.dtype(dtype)
        self._order = ORDER[self._dtype]
        count = len(levels.blocks)
        self._matrices = _matrices(space, count, self._dtype)
        self._transfers = [_transfer(level, self._order, self._dtype) for level in range(count - 1)]

    def __call__(self, positions: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Displacement of all nodes of the set under pressures on some of them.

        Parameters
        ----------
        positions : (m,) int ndarray
            Which ones, as positions in the set.
        values : (m,) ndarray
            Of this precision.

        Returns
        -------
        (n,) ndarray
            Of this precision.
        """
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
            np.zeros((n + 1) * _padded(side**2), self._dtype)
            for n, side in zip(levels.blocks, sides, strict=True)
        ]
        for k, side in enumerate(sides):
            self._translate(k, side, sources[k], loaded[k], images[k])
        for k in range(len(levels.parents) - 1, -1, -1):
            _to_children(
                *(levels.parents[k], self._transfers[k], sides[k], sides[k + 1]),
                *(images[k], images[k + 1]),
            )
        return images[0][levels.place]

    def _sides(self):
        """Numbers along a block of every level."""
        return [LEAF] + [self._order] * (len(self._levels.blocks) - 1)

    def _translate(self, k, side, sources, loaded, images):
        """Images of the blocks of a level under the others that act on them there."""
        batches, chunks = self._levels.pairs(SEPARATION[self._dtype])[k]
        threads.in_parts(
            lambda start, stop: _translate(
                *(chunks[start], chunks[stop], batches, self._matrices[k], side**2),
                *(sources, loaded, images),
            ),
            len(chunks) - 1,
            smallest=1,
        )


def _reach(separation):
    """How far apart blocks of one level can be whose parents are neighbours."""
    return 2 * separation + 1


def _padded(numbers):
    return -(-numbers // PADDED) * PADDED


def multipole_suits(space: HalfSpace) -> bool:
    """Whether cells are so nearly square that the errors stated hold."""
    return max(space.spacing) <= MOST_STRETCHED * min(space.spacing)


def _chebyshev(level, order):
    """Places in a block of a level, in cells from its centre: of its cells or Chebyshev nodes."""
    half = (LEAF * 2**level - 1) / 2
    if level == 0:
        return np.arange(LEAF) - half
    return half * np.cos(np.pi * (2 * np.arange(order) + 1) / (2 * order))


def _transfer(level, order, dtype):
    """Weights of the parent's nodes in each of a child's, along one axis, (2, child, parent)."""
    own, parent = _chebyshev(level, order), _chebyshev(level + 1, order)
    weights = np.ones((2, own.size, order))
    for half in (0, 1):
        at = own + (half - 0.5) * LEAF * 2**level
        for j in range(order):
            for m in range(order):
                if m != j:
                    weights[half, :, j] *= (at - parent[m]) / (parent[j] - parent[m])
    return weights.astype(dtype)


# By what they follow from.
_KEPT: dict[tuple, np.ndarray] = {}


def _matrices(space, levels, dtype):
    """For every level and relative position, the influence of a block's numbers on another's.

    Kept between sets and windows: it depends on the kernel and the ratio of a cell's sides alone.
    """
    found = []
    for level in range(levels):
        key = space.kernel, space.spacing[0] / space.spacing[1], level, dtype
        if key not in _KEPT:
            _KEPT.setdefault(key, _level_matrices(space, level, dtype))
        found.append(_KEPT[key])
    return found


def _level_matrices(space, level, dtype):
    """(relative position, source, target) flattened; targets padded."""
    own = _chebyshev(level, ORDER[dtype])
    side, separation = own.size, SEPARATION[dtype]
    reach = _reach(separation)
    matrices = np.zeros((2 * reach + 1, 2 * reach + 1, side**2, _padded(side**2)), dtype)
    number, apart = _distances(own)
    for oy in range(reach + 1):
        for ox in range(reach + 1):
            if level > 0 and max(oy, ox) <= separation:
                continue
            y, x = (np.abs(apart - offset * LEAF * 2**level) for offset in (oy, ox))
            values = _influence(space, *(a.ravel() for a in np.meshgrid(y, x, indexing="ij")))
            # (source y, target y) and (source x, target x) to (source, target).
            block = values.reshape(y.size, x.size)[number[:, None, :, None], number[None, :, None]]
            for sy, sx in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
                flipped = block[::sy, ::sx, ::sy, ::sx].reshape(side**2, side**2)
                matrices[reach + sy * oy, reach + sx * ox, :, : side**2] = flipped
    return matrices.ravel()


def _distances(places):
    """Distances (n,) between places of one block and of another on it, and their numbers (i, j).

    Places are symmetric, so those of i to j and of the mirrored j to the mirrored i are the same:
    the influence, which takes longer than all else, is evaluated at a quarter of all pairs.
    """
    i, j = np.indices((places.size, places.size))
    mirrored = (places.size - 1 - j) * places.size + places.size - 1 - i
    first, number = np.unique(np.minimum(i * places.size + j, mirrored), return_inverse=True)
    return number.reshape(i.shape), (places[:, None] - places).ravel()[first]


def _influence(space, y, x):
    apart = (y > 0) | (x > 0)
    values = np.full(y.shape, space.near_influence(1)[0, 0])
    values[apart] = space.influence_at(y[apart], x[apart])
    return values


def _pairs(rows, columns, index, lowest, separation):
    """Batches of pairs of blocks, (m, 1 + 2 TOGETHER), and where their chunks begin."""
    none = np.empty((0, 1 + 2 * TOGETHER), np.int32)
    chunks = _fill_pairs(rows, columns, index, lowest, separation, none)
    batches = np.empty((chunks[-1], 1 + 2 * TOGETHER), np.int32)
    return batches, _fill_pairs(rows, columns, index, lowest, separation, batches)


@njit(cache=True)
def _fill_pairs(rows, columns, index, lowest, separation, batches):
    """Fill the batches if there is room; in any case, return where the chunks begin.

    Sources are blocks within the reach whose parents are neighbours; but neighbours themselves
    only on the lowest level. Places that remain in a batch are given to a block that is not there.
    """
    total, reach = rows.size, 2 * separation + 1
    span = 2 * reach + 1
    chunks = np.zeros((total + CHUNK - 1) // CHUNK + 1, np.int64)
    m = 0
    for chunk in range(chunks.size - 1):
        for offset in range(span * span):
            oy, ox = offset // span - reach, offset % span - reach
            if not lowest and max(abs(oy), abs(ox)) <= separation:
                continue
            filled = TOGETHER
            for target in range(chunk * CHUNK, min((chunk + 1) * CHUNK, total)):
                y, x = rows[target] - oy, columns[target] - ox
                if y < 0 or x < 0 or y >= index.shape[0] or x >= index.shape[1]:
                    continue
                away = max(abs(rows[target] // 2 - y // 2), abs(columns[target] // 2 - x // 2))
                source = index[y, x] - 1
                if source < 0 or away > separation:
                    continue
                if filled == TOGETHER:
                    m, filled = m + 1, 0
                    if batches.shape[0]:
                        batches[m - 1, 0] = offset
                        batches[m - 1, 1:] = total
                if batches.shape[0]:
                    batches[m - 1, 1 + filled] = target
                    batches[m - 1, 1 + TOGETHER + filled] = source
                filled += 1
        chunks[chunk + 1] = m
    return chunks


@njit(cache=True)
def _scatter(positions, values, place, sources, loaded):
    for i in range(positions.size):
        at = place[positions[i]]
        sources[at] = values[i]
        if values[i] != 0:
            loaded[at // (LEAF * LEAF)] = True


@njit(cache=True)
def _to_parents(parents, weights, side, parent_side, values, loaded, above, loaded_above):
    """Add what each block holds to its parent: by the transposed interpolation."""
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
def _to_children(parents, weights, side, parent_side, values, above):
    """Add to each block what its parent is displaced, interpolated."""
    length = -(-side * side // PADDED) * PADDED
    length_above = -(-parent_side * parent_side // PADDED) * PADDED
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
def _translate(start, stop, batches, matrices, numbers, sources, loaded, images):
    """Add the images of some batches; pairs of one batch share each number of the matrix read."""
    length = -(-numbers // PADDED) * PADDED
    for b in range(start, stop):
        offset = batches[b, 0]
        t0, t1, t2, t3 = batches[b, 1], batches[b, 2], batches[b, 3], batches[b, 4]
        s0, s1, s2, s3 = batches[b, 5], batches[b, 6], batches[b, 7], batches[b, 8]
        if not (loaded[s0] or loaded[s1] or loaded[s2] or loaded[s3]):
            continue
        s0, s1, s2, s3 = s0 * numbers, s1 * numbers, s2 * numbers, s3 * numbers
        for v in range(0, length, PADDED):
            a0, a1 = load(images, t0 * length + v), load(images, t0 * length + v + WIDTH)
            b0, b1 = load(images, t1 * length + v), load(images, t1 * length + v + WIDTH)
            c0, c1 = load(images, t2 * length + v), load(images, t2 * length + v + WIDTH)
            d0, d1 = load(images, t3 * length + v), load(images, t3 * length + v + WIDTH)
            row = offset * numbers * length + v
            for j in range(numbers):
                m0, m1 = load(matrices, row), load(matrices, row + WIDTH)
                p, q = sources[s0 + j], sources[s1 + j]
                a0, a1, b0, b1 = a0 + p * m0, a1 + p * m1, b0 + q * m0, b1 + q * m1
                p, q = sources[s2 + j], sources[s3 + j]
                c0, c1, d0, d1 = c0 + p * m0, c1 + p * m1, d0 + q * m0, d1 + q * m1
                row += length
            store(images, t0 * length + v, a0)
            store(images, t0 * length + v + WIDTH, a1)
            store(images, t1 * length + v, b0)
            store(images, t1 * length + v + WIDTH, b1)
            store(images, t2 * length + v, c0)
            store(images, t2 * length + v + WIDTH, c1)
            store(images, t3 * length + v, d0)
            store(images, t3 * length + v + WIDTH, d1)
