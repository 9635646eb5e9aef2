"""Approximate inverse of the elastic operator on a contact set, at the cost of a sparse product.

The influence of a load falls as 1/r, as a covariance may, and its inverse on a set of nodes falls
much faster: given the displacements around a node, those further away hardly matter for its
pressure. Two parts use that:

- A sparse factor of the inverse. Nodes are ordered from coarse to fine, by blocks of 1, 2, 4, ...
  cells of which each has one representative; a node is conditioned on those that precede it within
  :data:`WIDE` blocks of its own level. On these few the small dense problem is solved exactly
  (Kullback-Leibler minimisation: Schaefer, Katzfuss, Owhadi, SIAM J. Sci. Comput. 43 (2021) A2019;
  in geostatistics, Vecchia's approximation).
- A coarse correction. What the factor gets wrong is smooth: it makes widespread pressures too
  soft. They are balanced (Mandel, Comm. Numer. Methods Eng. 9 (1993) 233) in the space of hat
  functions, on which the operator is taken from a coarse grid and the self-displacement of nodes.
"""

import threading
import weakref

import numpy as np

from ..core import threads
from ..core.kernel_cache import njit
from ..elastic.simd import WIDTH, load, store
from .coarse_correction import SmoothCorrection, check_nodes, check_on_set, inverted, times

#: Blocks along a row in which preceding nodes condition a node, so far to each side of its own, in
#: the rows 0, 1, 2 from it. A larger neighbourhood saves hardly an application and costs more.
WIDE = np.array([2, 2, 1])
#: The same in windows of at most `SMALL` cells across, where applications cost little: up to a
#: third more of them, and still a fifth less time under loads that double from step to step.
NARROW = np.array([1, 1])
#: Most nodes that can condition one.
MOST = 20
#: Sets of at most so many nodes are inverted exactly.
DIRECT = 96
#: Windows of at most so many cells across do without the correction for smooth pressures too.
SMALL = 160
#: A thread takes no fewer nodes than this.
CHUNK = 512
#: Least share of a node's influence on itself that others may leave unexplained: on cells much
#: longer than wide, single precision would lose less.
LEAST_OWN = np.float32(1e-3)


class ContactInverse:
    """Symmetric positive definite approximation to the inverse of K on a contact set.

    Parameters
    ----------
    space : HalfSpace

    Attributes
    ----------
    small : bool
        Whether the window is one of those in which applications cost little beside the rest.

    Notes
    -----
    ``update`` keeps what a new set leaves unchanged, bit for bit as a fresh start would have it.
    It changes the object, so that no two threads may use one: `preconditioner` gives each its own.
    """

    def __init__(self, space):
        self._shape = space.shape
        self._influence = space.influence().astype(np.float32)
        self._shifts = _block_shifts(space)
        self.small = max(space.shape) <= SMALL
        self._near = NARROW if self.small else WIDE
        self._smooth = None if self.small else SmoothCorrection(space)
        rows = np.empty(0, np.int32)
        slot = np.full(space.shape[0] * space.shape[1], -1, np.int32)
        first = _representatives(rows, *space.shape, self._shifts)[0]
        # All that belongs to one set, in one place: it changes as a whole, or not at all.
        self._known = first, rows, slot, _empty_factor(0)
        self._exact = None

    def update(self, rows, *, fresh):
        """Make this the inverse on another contact set.

        Parameters
        ----------
        rows : (n,) int32 ndarray
            Its nodes as numbers of cells, ascending.
        fresh : bool
            Whether to make the coarse operator anew, which else may lag a little behind the set.

        Raises
        ------
        ValueError
            If they are no such numbers.
        """
        check_nodes(rows, self._shape)
        nx = self._shape[1]
        self._exact = None
        if fresh and self._smooth is not None:
            # Also where so few nodes come first that none is needed yet.
            self._smooth.forget()
        if rows.size <= DIRECT:
            self._exact = _exact_inverse(rows, nx, self._influence)
            return
        first, *old = self._known
        slot = np.full(old[1].size, -1, np.int32)
        slot[rows] = np.arange(rows.size, dtype=np.int32)
        blocks = _representatives(rows, *self._shape, self._shifts)
        if old[0].size:
            changed = np.flatnonzero(first != blocks[0])
            touched = _touched(changed, first, blocks, self._shifts, self._near, nx)
        else:
            touched = np.ones(blocks[0].size, bool)
        factor = _empty_factor(rows.size)
        old, known = tuple(old), (*blocks, touched)
        grid = self._shifts, self._near, nx, self._influence
        threads.in_parts(
            lambda start, stop: _factorise(start, stop, rows, slot, known, grid, old, factor),
            rows.size,
            smallest=CHUNK,
        )
        self._known = blocks[0], rows, slot, factor
        if self._smooth is not None:
            self._smooth.update(rows, fresh)

    def __call__(self, residual):
        """The approximate solution x of K x = residual, both (n,) float32 on the contact set.

        Raises
        ------
        ValueError
            If the residual is not one on the set of the last update.
        """
        if self._exact is not None:
            check_on_set(residual, len(self._exact))
            return times(self._exact, residual)
        _, rows, _, factor = self._known
        check_on_set(residual, rows.size)
        if self._smooth is None:
            return _apply(*factor, residual)
        return self._smooth.balance(residual, lambda left: _apply(*factor, left))


class _Kept(dict):
    """By the id of a half-space: a weak reference to it, and its preconditioner."""


class _OfThread(threading.local):
    """What this thread keeps; it ends with the thread."""

    def __init__(self):
        self.kept = _Kept()


_THREAD = _OfThread()


def preconditioner(space):
    """The approximate inverse of K that this thread keeps for a half-space.

    It is kept as the next contact set is much the same, and as long as the half-space itself and
    the thread. What it gives does not depend on the sets it was of before.

    Parameters
    ----------
    space : HalfSpace
        This very object, not one equal to it.

    Returns
    -------
    ContactInverse
    """
    kept, key = _THREAD.kept, id(space)
    of, found = kept.get(key, (None, None))
    if of is None or of() is not space:
        # The dictionary is not held by what it holds: neither would ever end.
        mine, found = weakref.ref(kept), ContactInverse(space)
        kept[key] = weakref.ref(space, lambda _: _drop(mine(), key)), found
    return found


def forget_preconditioner(space):
    """Drop what this thread keeps for a half-space, to save the memory or to start anew."""
    _drop(_THREAD.kept, id(space))


def _drop(kept, key):
    if kept is not None:
        kept.pop(key, None)


@njit(cache=True)
def _exact_inverse(rows, nx, influence):
    """Inverse of K on a few nodes, exactly."""
    n = rows.size
    inverse = np.empty((n, n))
    for a in range(n):
        for b in range(n):
            dy = abs(rows[a] // nx - rows[b] // nx)
            inverse[a, b] = influence[dy, abs(rows[a] % nx - rows[b] % nx)]
    return inverted(inverse).astype(np.float32)


def _empty_factor(n):
    """Count of the nodes that condition each node, which, their weights, and its own weight."""
    return (
        np.empty(n, np.int8),
        np.empty((n, MOST), np.int32),
        np.empty((n, MOST), np.float32),
        np.empty(n, np.float32),
    )


def _block_shifts(space):
    """log2 of the block sides (y, x) at every level; blocks grow towards squares."""
    shifts = [(0, 0)]
    sides = list(space.spacing)
    while (space.shape[0] - 1) >> shifts[-1][0] or (space.shape[1] - 1) >> shifts[-1][1]:
        grow_y = sides[0] < 1.5 * sides[1]
        grow_x = sides[1] < 1.5 * sides[0]
        shifts.append((shifts[-1][0] + grow_y, shifts[-1][1] + grow_x))
        sides = [sides[0] * 2**grow_y, sides[1] * 2**grow_x]
    return np.array(shifts, np.int64)


@njit(cache=True)
def _representatives(rows, ny, nx, shifts):
    """For every level, the node (cell number) that stands for each block, or -1."""
    levels = shifts.shape[0]
    offsets = np.empty(levels + 1, np.int64)
    widths = np.empty((levels, 2), np.int64)
    offsets[0] = 0
    for k in range(levels):
        widths[k, 0] = ((ny - 1) >> shifts[k, 0]) + 1
        widths[k, 1] = ((nx - 1) >> shifts[k, 1]) + 1
        offsets[k + 1] = offsets[k] + widths[k, 0] * widths[k, 1]
    first = np.full(offsets[levels], -1, np.int32)
    level = np.zeros(ny * nx, np.int8)
    standing = rows.copy()
    first[standing] = standing
    for k in range(1, levels):
        n = 0
        for node in standing:
            y, x = (node // nx) >> shifts[k, 0], (node % nx) >> shifts[k, 1]
            block = offsets[k] + y * widths[k, 1] + x
            if first[block] < 0:
                first[block] = node
                level[node] = k
                standing[n] = node
                n += 1
        standing = standing[:n]
    return first, offsets, widths, level


@njit(cache=True)
def _touched(changed, before, blocks, shifts, wide, nx):
    """For every level, the blocks whose nodes may be conditioned otherwise than ``before``."""
    first, offsets, widths, _ = blocks
    reach = wide.size - 1
    touched = np.zeros(first.size, np.bool_)
    k = 0
    for block in changed:
        while block >= offsets[k + 1]:
            k += 1
        y, x = divmod(block - offsets[k], widths[k, 1])
        _touch(touched, offsets[k], widths[k], y, x, reach)
        # Both have come to, or lost, precedence on the level below.
        for node in (before[block], first[block]):
            if k > 0 and node >= 0:
                y, x = (node // nx) >> shifts[k - 1, 0], (node % nx) >> shifts[k - 1, 1]
                _touch(touched, offsets[k - 1], widths[k - 1], y, x, reach)
    return touched


@njit(cache=True)
def _touch(touched, offset, width, y, x, reach):
    for by in range(max(y - reach, 0), min(y + reach + 1, width[0])):
        for bx in range(max(x - reach, 0), min(x + reach + 1, width[1])):
            touched[offset + by * width[1] + bx] = True


@njit(cache=True, nogil=True)
def _factorise(start, stop, rows, slot, blocks, grid, old, new):
    """Columns start ... stop of the factor: taken over where nothing changed, else solved."""
    first, offsets, widths, level, touched = blocks
    shifts, wide, nx, influence = grid
    old_rows, old_slot, (old_count, old_near, old_weight, old_own) = old
    count, near, weight, own = new
    members, far = np.empty(MOST + 1, np.int64), wide.size - 1
    # Those solved side by side have equally many nodes, as far as there are enough such.
    waiting, lanes = np.empty((MOST + 1, WIDTH), np.int64), np.zeros(MOST + 1, np.int64)
    lower = np.empty((MOST + 1) * (MOST + 1) * WIDTH, np.float32)
    column = np.empty((MOST + 1) * WIDTH, np.float32)
    for i in range(start, stop):
        node = rows[i]
        y, x = node // nx, node % nx
        k = level[node]
        block_y, block_x = y >> shifts[k, 0], x >> shifts[k, 1]
        before = old_slot[node]
        if before >= 0 and not touched[offsets[k] + block_y * widths[k, 1] + block_x]:
            count[i], own[i] = old_count[before], old_own[before]
            for a in range(count[i]):
                near[i, a] = slot[old_rows[old_near[before, a]]]
                weight[i, a] = old_weight[before, a]
            continue
        n = 0
        for by in range(max(block_y - far, 0), min(block_y + far + 1, widths[k, 0])):
            row = offsets[k] + by * widths[k, 1]
            reach = wide[abs(by - block_y)]
            for bx in range(max(block_x - reach, 0), min(block_x + reach + 1, widths[k, 1])):
                other = first[row + bx]
                above = level[max(other, 0)]
                # Put in its place before it is known to stay there: that takes less than a branch.
                members[n] = other
                n += (other >= 0) & ((above > k) | ((above == k) & (other < node)))
        count[i] = n
        for a in range(n):
            near[i, a] = slot[members[a]]
        waiting[n, lanes[n]] = i
        lanes[n] += 1
        if lanes[n] == WIDTH:
            _solve_columns(waiting[n], rows, nx, influence, new, lower, column)
            lanes[n] = 0
    left = _joined(waiting, lanes)
    for a in range(0, left.size, WIDTH):
        _solve_columns(left[a : a + WIDTH], rows, nx, influence, new, lower, column)


@njit(cache=True)
def _joined(lists, lengths):
    """The beginnings of some lists, one after the other."""
    joined = np.empty(lengths.sum(), lists.dtype)
    n = 0
    for k in range(lengths.size):
        joined[n : n + lengths[k]] = lists[k, : lengths[k]]
        n += lengths[k]
    return joined


@njit(cache=True)
def _solve_columns(nodes, rows, nx, influence, factor, lower, column):
    """Last column of the inverse of the transposed Cholesky factor, for a node in each lane.

    Lanes with fewer nodes than others have empty rows before their last, which change nothing, to
    the bit. The diagonal of ``lower`` is kept inverted.
    """
    count, near, weight, own = factor
    n = 0
    for i in nodes:
        n = max(n, count[i])
    side = (MOST + 1) * WIDTH
    ys = np.zeros((MOST + 1, WIDTH), np.int32)
    xs = np.zeros((MOST + 1, WIDTH), np.int32)
    there = np.zeros((MOST + 1, WIDTH), np.float32)
    for lane in range(nodes.size):
        i = nodes[lane]
        for a in range(count[i]):
            node = rows[near[i, a]]
            ys[a, lane], xs[a, lane], there[a, lane] = node // nx, node % nx, 1
        ys[n, lane], xs[n, lane], there[n, lane] = rows[i] // nx, rows[i] % nx, 1
    for a in range(n + 1):
        for b in range(a):
            here = a * side + b * WIDTH
            for lane in range(WIDTH):
                distance = abs(ys[a, lane] - ys[b, lane]), abs(xs[a, lane] - xs[b, lane])
                both = there[a, lane] * there[b, lane]
                lower[here + lane] = both * influence[distance]
    for a in range(n + 1):
        for b in range(a):
            here = a * side + b * WIDTH
            s = load(lower, here)
            for c in range(0, b * WIDTH, WIDTH):
                s = s - load(lower, a * side + c) * load(lower, b * side + c)
            store(lower, here, s * load(lower, b * (side + WIDTH)))
        here = a * (side + WIDTH)
        lower[here : here + WIDTH] = influence[0, 0]
        s = load(lower, here)
        for c in range(0, a * WIDTH, WIDTH):
            s = s - load(lower, a * side + c) * load(lower, a * side + c)
        store(lower, here, s)
        for lane in range(here, here + WIDTH):
            lower[lane] = np.float32(1) / np.sqrt(max(lower[lane], LEAST_OWN * influence[0, 0]))
    column[: n * WIDTH] = 0
    store(column, n * WIDTH, load(lower, n * (side + WIDTH)))
    for a in range(n, 0, -1):
        known = load(column, a * WIDTH)
        for c in range(0, a * WIDTH, WIDTH):
            store(column, c, load(column, c) - load(lower, a * side + c) * known)
        here = (a - 1) * WIDTH
        store(column, here, load(column, here) * load(lower, (a - 1) * (side + WIDTH)))
    for lane in range(nodes.size):
        i = nodes[lane]
        for a in range(count[i]):
            weight[i, a] = column[a * WIDTH + lane]
        own[i] = column[n * WIDTH + lane]


@njit(cache=True, fastmath=True)
def _apply(count, near, weight, own, residual):
    """U U' residual, a column of U at a time."""
    out = np.zeros(residual.size, np.float32)
    for i in range(residual.size):
        total = own[i] * residual[i]
        for a in range(count[i]):
            total += weight[i, a] * residual[near[i, a]]
        out[i] += own[i] * total
        for a in range(count[i]):
            out[near[i, a]] += weight[i, a] * total
    return out
