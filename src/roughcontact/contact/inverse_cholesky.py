"""Sparse inverse-Cholesky factor of the elastic operator on a contact set.

The influence of a load falls as 1/r, as a covariance may, and its inverse on a set of nodes falls
much faster: given the displacements around a node, nodes further away hardly affect its pressure.
So the factor U of K^-1 = U U' is nearly sparse. Nodes are ordered from coarse to fine, by blocks of
1, 2, 4, ... cells with one representative each. A node is conditioned on the nodes that precede it
within a neighbourhood of a few blocks of its own level. On these the small dense problem is solved
exactly, which minimises the Kullback-Leibler divergence among all factors of that sparsity (F.
Schaefer, M. Katzfuss and H. Owhadi, Sparse Cholesky factorization by Kullback-Leibler minimization,
SIAM J. Sci. Comput. 43 (2021) A2019; in geostatistics, Vecchia's approximation: A. V. Vecchia, J.
R. Stat. Soc. B 50 (1988) 297). Sixteen nodes are solved side by side, one in each lane of the
processor's SIMD vectors; `tests/support/plain_twins.py` has the same in plain loops.
"""

import numpy as np

from .. import threads
from ..elastic.halfspace import HalfSpace
from ..elastic.simd import WIDTH, load, store
from ..kernel_cache import njit
from .node_sets import check_on_set, symmetric_difference

#: Neighbourhood sizes: reach along x, in blocks to each side, of the preceding nodes that condition
#: a node, in the rows 0, 1, 2 from its own. A larger neighbourhood saves hardly an application and
#: costs more.
WIDE_NEIGHBOURHOOD = np.array([2, 2, 1])
#: Neighbourhood in small windows, where applications cost little: up to a third more of them, and a
#: fifth less time under loads that double from step to step.
NARROW_NEIGHBOURHOOD = np.array([1, 1])
#: Most neighbours: the size of the larger neighbourhood.
MAX_NEIGHBOURS = 20
#: Fewest nodes per thread.
CHUNK = 512
#: Smallest conditional variance, as a fraction of a node's influence on itself. It guards against
#: pivots that rounding in single precision makes zero or negative. The true variance is 0.8 on
#: square cells and falls slowly with their aspect ratio (0.1 at 1e8).
MIN_CONDITIONAL_VARIANCE = np.float32(1e-3)
#: Cells along the table of the influence; further away it is that of a point load. On cells with an
#: aspect ratio above `MAX_STRETCHED` the table covers the window.
TABLE_SIDE, MAX_STRETCHED = 512, 16
#: Fractions of the window's cells: if the nodes on all levels are more than MADE_ANEW, arrays are
#: allocated again rather than cleared at these nodes; if the changed ones are more than COMPARED,
#: arrays are compared as a whole.
MADE_ANEW, COMPARED = 0.1, 0.02


class InverseCholesky:
    """Sparse factor U of the inverse of K on a contact set: U U' is about K^-1.

    ``neighbourhood``, (m,) int, is the reach along x, in blocks, in the rows of blocks 0 ... m - 1
    away.

    Attributes
    ----------
    size : int
        Nodes of the set.
    influence : (my, mx) float32 ndarray
        Table of the half-space's influence.
    """

    def __init__(self, space: HalfSpace, neighbourhood: np.ndarray):
        self._shape = space.shape
        dy, dx = (side / space.cell for side in space.spacing)
        far_alike = space.is_free and max(dy / dx, dx / dy) <= MAX_STRETCHED
        side = TABLE_SIDE if far_alike else max(space.shape)
        self.influence = space.near_influence(side).astype(np.float32)
        whole = self.influence.shape == self._shape
        #: Argument of :func:`influence_between`, for any two nodes.
        self.anywhere = self.influence, np.float32(dy), np.float32(dx), whole
        self._shifts = block_shifts(space)
        self._neighbourhood = neighbourhood
        self._offsets, self._widths = _block_grid(*space.shape, self._shifts)
        # All fields of one set are replaced in one assignment, or not at all.
        representative, slot, *_ = self._empty_window()
        self._known = representative, np.empty(0, np.int32), slot, _empty_factor(0)
        self._spare: tuple[np.ndarray, ...] | None = None

    @property
    def size(self) -> int:
        """Number of nodes of the set."""
        return self._known[1].size

    def update(self, nodes: np.ndarray) -> None:
        """Factorise on another contact set, as far as it differs from the last one.

        ``nodes``, (n,) int32, are ascending numbers of cells; they are not checked.
        """
        nx = self._shape[1]
        representative, *old = self._known
        # Arrays of the window's size are cleared after use and kept, so that a few nodes in a large
        # window need no new ones. If an update is interrupted they are allocated again.
        new, slot, level, affected = self._spare or self._empty_window()
        self._spare = None
        slot[nodes] = np.arange(1, nodes.size + 1, dtype=np.int32)
        _represent(nodes, nx, self._shifts, self._offsets, self._widths, new, level)
        blocks = new, self._offsets, self._widths, level
        changed = np.empty(0, np.int64)
        if old[0].size:
            different = symmetric_difference(old[0], nodes)
            if self._dense(different.size, COMPARED):
                changed = np.flatnonzero(representative != new)
            else:
                changed = _changed(different, representative, blocks, self._shifts, nx)
        where = self._shifts, self._neighbourhood, nx
        _mark_affected(changed, representative, blocks, *where, affected, True)
        factor = _empty_factor(nodes.size)
        before, window = tuple(old), (*blocks, affected)
        grid = *where, self.anywhere
        threads.in_parts(
            lambda start, stop: _factorise(start, stop, nodes, slot, window, grid, before, factor),
            nodes.size,
            smallest=CHUNK,
        )
        self._known = new, nodes, slot, factor
        if self._dense(max(nodes.size, old[0].size), MADE_ANEW):
            return
        _mark_affected(changed, representative, blocks, *where, affected, False)
        level[nodes] = 0
        _clear(old[0], nx, self._shifts, self._offsets, self._widths, representative, old[1])
        self._spare = representative, old[1], level, affected

    def _dense(self, nodes, fraction):
        """True if the nodes on all levels are more than a fraction of the window's cells."""
        return nodes * len(self._shifts) > fraction * self._shape[0] * self._shape[1]

    def _empty_window(self):
        """Empty arrays of representatives, slots, levels and affected blocks.

        Numbers are stored plus one, so that empty is zero: pages of an array of zeros take memory
        only when written to.
        """
        cells, blocks = self._shape[0] * self._shape[1], self._offsets[-1]
        return (
            np.zeros(blocks, np.int32),
            np.zeros(cells, np.int32),
            np.zeros(cells, np.int8),
            np.zeros(blocks, bool),
        )

    def __call__(self, residual: np.ndarray) -> np.ndarray:
        """U U' residual, both (n,) float32 on the contact set."""
        check_on_set(residual, self.size)
        return _apply(*self._known[3], residual)


def _empty_factor(n):
    """Number of neighbours of each node, the neighbours, their weights, and its own weight."""
    return (
        np.empty(n, np.int8),
        np.empty((n, MAX_NEIGHBOURS), np.int32),
        np.empty((n, MAX_NEIGHBOURS), np.float32),
        np.empty(n, np.float32),
    )


def block_shifts(space: HalfSpace) -> np.ndarray:
    """log2 of the block sides (y, x) on every level, (levels, 2); blocks grow towards squares."""
    shifts = [(0, 0)]
    sides = list(space.spacing)
    while (space.shape[0] - 1) >> shifts[-1][0] or (space.shape[1] - 1) >> shifts[-1][1]:
        grow_y = sides[0] < 1.5 * sides[1]
        grow_x = sides[1] < 1.5 * sides[0]
        shifts.append((shifts[-1][0] + grow_y, shifts[-1][1] + grow_x))
        sides = [sides[0] * 2**grow_y, sides[1] * 2**grow_x]
    return np.array(shifts, np.int64)


def _block_grid(ny, nx, shifts):
    """First index of the blocks of every level, and their numbers along y and x."""
    widths = np.stack([((ny - 1) >> shifts[:, 0]) + 1, ((nx - 1) >> shifts[:, 1]) + 1], axis=1)
    return np.concatenate([[0], np.cumsum(widths[:, 0] * widths[:, 1])]), widths


@njit(cache=True)
def _represent(nodes, nx, shifts, offsets, widths, representative, level):
    """Representative node of each block (its cell number plus one, or 0) on every level."""
    candidates = nodes.copy()
    for node in nodes:
        representative[node] = node + 1
    for k in range(1, shifts.shape[0]):
        n = 0
        for node in candidates:
            y, x = (node // nx) >> shifts[k, 0], (node % nx) >> shifts[k, 1]
            block = offsets[k] + y * widths[k, 1] + x
            if representative[block] == 0:
                representative[block] = node + 1
                level[node] = k
                candidates[n] = node
                n += 1
        candidates = candidates[:n]


@njit(cache=True)
def _clear(nodes, nx, shifts, offsets, widths, representative, slot):
    """Undo `_represent`, and clear the slots."""
    for node in nodes:
        slot[node] = 0
        for k in range(shifts.shape[0]):
            y, x = (node // nx) >> shifts[k, 0], (node % nx) >> shifts[k, 1]
            representative[offsets[k] + y * widths[k, 1] + x] = 0


@njit(cache=True)
def _changed(different, before, blocks, shifts, nx):
    """Blocks of all levels, ascending, whose representative changed: each holds a changed node."""
    representative, offsets, widths, _ = blocks
    changed = np.empty(different.size * shifts.shape[0], np.int64)
    n = 0
    for k in range(shifts.shape[0]):
        first = n
        for node in different:
            y, x = (node // nx) >> shifts[k, 0], (node % nx) >> shifts[k, 1]
            block = offsets[k] + y * widths[k, 1] + x
            if before[block] != representative[block]:
                changed[n] = block
                n += 1
        changed[first:n].sort()
        unique = first
        for i in range(first, n):
            if i == first or changed[i] != changed[unique - 1]:
                changed[unique] = changed[i]
                unique += 1
        n = unique
    return changed[:n]


@njit(cache=True)
def _mark_affected(changed, before, blocks, shifts, neighbourhood, nx, affected, value):
    """Mark blocks whose nodes may have other neighbours than with the representatives ``before``.

    Blocks of every level are set to ``value``.
    """
    representative, offsets, widths, _ = blocks
    reach = neighbourhood.size - 1
    k = 0
    for block in changed:
        while block >= offsets[k + 1]:
            k += 1
        y, x = divmod(block - offsets[k], widths[k, 1])
        _mark(affected, offsets[k], widths[k], y, x, reach, value)
        # Both nodes gained or lost precedence on the level below.
        for node in (before[block] - 1, representative[block] - 1):
            if k > 0 and node >= 0:
                y, x = (node // nx) >> shifts[k - 1, 0], (node % nx) >> shifts[k - 1, 1]
                _mark(affected, offsets[k - 1], widths[k - 1], y, x, reach, value)


@njit(cache=True)
def _mark(affected, offset, width, y, x, reach, value):
    for by in range(max(y - reach, 0), min(y + reach + 1, width[0])):
        for bx in range(max(x - reach, 0), min(x + reach + 1, width[1])):
            affected[offset + by * width[1] + bx] = value


@njit(cache=True, nogil=True)
def _factorise(start, stop, nodes, slot, blocks, grid, old, new):
    """Columns start ... stop of the factor: copied where nothing changed, else solved."""
    representative, offsets, widths, level, affected = blocks
    shifts, neighbourhood, nx, influence = grid
    old_nodes, old_slot, (old_count, old_neighbours, old_weight, old_diagonal) = old
    count, neighbours, weight, diagonal = new
    members, far = np.empty(MAX_NEIGHBOURS + 1, np.int64), neighbourhood.size - 1
    # Nodes with equally many neighbours wait to be solved side by side.
    waiting = np.empty((MAX_NEIGHBOURS + 1, WIDTH), np.int64)
    filled = np.zeros(MAX_NEIGHBOURS + 1, np.int64)
    lower = np.empty((MAX_NEIGHBOURS + 1) * (MAX_NEIGHBOURS + 1) * WIDTH, np.float32)
    column = np.empty((MAX_NEIGHBOURS + 1) * WIDTH, np.float32)
    for i in range(start, stop):
        node = nodes[i]
        y, x = node // nx, node % nx
        k = level[node]
        block_y, block_x = y >> shifts[k, 0], x >> shifts[k, 1]
        before = old_slot[node] - 1
        if before >= 0 and not affected[offsets[k] + block_y * widths[k, 1] + block_x]:
            count[i], diagonal[i] = old_count[before], old_diagonal[before]
            for a in range(count[i]):
                neighbours[i, a] = slot[old_nodes[old_neighbours[before, a]]] - 1
                weight[i, a] = old_weight[before, a]
            continue
        n = 0
        for by in range(max(block_y - far, 0), min(block_y + far + 1, widths[k, 0])):
            row = offsets[k] + by * widths[k, 1]
            reach = neighbourhood[abs(by - block_y)]
            for bx in range(max(block_x - reach, 0), min(block_x + reach + 1, widths[k, 1])):
                other = representative[row + bx] - 1
                above = level[max(other, 0)]
                # Stored first and counted only if the node precedes: this is faster than a branch.
                members[n] = other
                n += (other >= 0) & ((above > k) | ((above == k) & (other < node)))
        count[i] = n
        for a in range(n):
            neighbours[i, a] = slot[members[a]] - 1
        waiting[n, filled[n]] = i
        filled[n] += 1
        if filled[n] == WIDTH:
            _solve_columns(waiting[n], nodes, nx, influence, new, lower, column)
            filled[n] = 0
    remaining = _joined(waiting, filled)
    for a in range(0, remaining.size, WIDTH):
        _solve_columns(remaining[a : a + WIDTH], nodes, nx, influence, new, lower, column)


@njit(cache=True)
def _joined(lists, lengths):
    """Concatenation of the first ``lengths`` entries of each list."""
    joined = np.empty(lengths.sum(), lists.dtype)
    n = 0
    for k in range(lengths.size):
        joined[n : n + lengths[k]] = lists[k, : lengths[k]]
        n += lengths[k]
    return joined


@njit(cache=True)
def _fill_below_diagonal(places, nodes, nx, influence, factor, lower):
    """Influence between the nodes of each lane; returns the largest number of neighbours."""
    count, neighbours, _, _ = factor
    n = 0
    for i in places:
        n = max(n, count[i])
    side = (MAX_NEIGHBOURS + 1) * WIDTH
    ys = np.zeros((MAX_NEIGHBOURS + 1, WIDTH), np.int32)
    xs = np.zeros((MAX_NEIGHBOURS + 1, WIDTH), np.int32)
    present = np.zeros((MAX_NEIGHBOURS + 1, WIDTH), np.float32)
    for lane in range(places.size):
        i = places[lane]
        for a in range(count[i]):
            node = nodes[neighbours[i, a]]
            ys[a, lane], xs[a, lane], present[a, lane] = node // nx, node % nx, 1
        ys[n, lane], xs[n, lane], present[n, lane] = nodes[i] // nx, nodes[i] % nx, 1
    table = influence[0]
    # In most windows the table covers all distances.
    if influence[3]:
        for a in range(n + 1):
            for b in range(a):
                entry = a * side + b * WIDTH
                for lane in range(WIDTH):
                    distance = abs(ys[a, lane] - ys[b, lane]), abs(xs[a, lane] - xs[b, lane])
                    both = present[a, lane] * present[b, lane]
                    lower[entry + lane] = both * table[distance]
        return n
    for a in range(n + 1):
        for b in range(a):
            entry = a * side + b * WIDTH
            for lane in range(WIDTH):
                away_y, away_x = abs(ys[a, lane] - ys[b, lane]), abs(xs[a, lane] - xs[b, lane])
                both = present[a, lane] * present[b, lane]
                lower[entry + lane] = both * influence_between(influence, away_y, away_x)
    return n


@njit(cache=True)
def influence_between(influence: tuple, y: int, x: int) -> float:
    """Influence at a distance (y, x >= 0) in cells: from the table, or that of a point load.

    ``influence`` is :attr:`InverseCholesky.anywhere`.
    """
    table, dy, dx, _ = influence
    if y < table.shape[0] and x < table.shape[1]:
        return table[y, x]
    return np.float32(1 / np.pi) / np.sqrt((y * dy) ** 2 + (x * dx) ** 2)


@njit(cache=True)
def _solve_columns(places, nodes, nx, influence, factor, lower, column):
    """Last column of the inverse of the transposed Cholesky factor, for a node in each lane.

    Lanes with fewer nodes than others have empty rows before their last, which change nothing, to
    the bit. The diagonal of ``lower`` is stored inverted.
    """
    count, _, weight, diagonal = factor
    side = (MAX_NEIGHBOURS + 1) * WIDTH
    n = _fill_below_diagonal(places, nodes, nx, influence, factor, lower)
    for a in range(n + 1):
        for b in range(a):
            entry = a * side + b * WIDTH
            s = load(lower, entry)
            for c in range(0, b * WIDTH, WIDTH):
                s = s - load(lower, a * side + c) * load(lower, b * side + c)
            store(lower, entry, s * load(lower, b * (side + WIDTH)))
        entry = a * (side + WIDTH)
        lower[entry : entry + WIDTH] = influence[0][0, 0]
        s = load(lower, entry)
        for c in range(0, a * WIDTH, WIDTH):
            s = s - load(lower, a * side + c) * load(lower, a * side + c)
        store(lower, entry, s)
        for lane in range(entry, entry + WIDTH):
            lower[lane] = np.float32(1) / np.sqrt(
                max(lower[lane], MIN_CONDITIONAL_VARIANCE * influence[0][0, 0])
            )
    column[: n * WIDTH] = 0
    store(column, n * WIDTH, load(lower, n * (side + WIDTH)))
    for a in range(n, 0, -1):
        solved = load(column, a * WIDTH)
        for c in range(0, a * WIDTH, WIDTH):
            store(column, c, load(column, c) - load(lower, a * side + c) * solved)
        entry = (a - 1) * WIDTH
        store(column, entry, load(column, entry) * load(lower, (a - 1) * (side + WIDTH)))
    for lane in range(places.size):
        i = places[lane]
        for a in range(count[i]):
            weight[i, a] = column[a * WIDTH + lane]
        diagonal[i] = column[n * WIDTH + lane]


@njit(cache=True, fastmath=True)
def _apply(count, neighbours, weight, diagonal, residual):
    """U U' residual, one column of U at a time."""
    out = np.zeros(residual.size, np.float32)
    for i in range(residual.size):
        total = diagonal[i] * residual[i]
        for a in range(count[i]):
            total += weight[i, a] * residual[neighbours[i, a]]
        out[i] += diagonal[i] * total
        for a in range(count[i]):
            out[neighbours[i, a]] += weight[i, a] * total
    return out
