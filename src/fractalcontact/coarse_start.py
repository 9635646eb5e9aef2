"""Where to start when no state is known: on a grid twice as coarse, and from there to the fine one.

A coarse cell has the height of the highest of its four nodes, which need not all touch: the sum of
its pressure is kept, and shared among them so that those which touch have even gaps. The nodes of
the eight cells around act on them as they are, from further away the four are displaced alike.
"""

import numpy as np
from numba import njit

from .active_set import ActiveSet
from .conditions import Problem

# A coarser grid gives the start until its shorter side has fewer nodes than this.
COARSEST = 24
# The approximate inverse on coarse grids of more cells is not kept: it takes memory, and there is
# little to gain. Of small ones, as parts of a window have them, many are solved on one grid.
KEPT_CELLS = 10_000
# The coarse solution is only a start. But on grids so fine that the next coarser one's already
# meets this, a correction is made all the same: else errors add up from grid to grid.
COARSE_RTOL, COARSE_CORRECTIONS = 2e-2, 1


def coarse_start(problem):
    """Pressure to start from: the solution on the topography pooled 2 x 2, spread out there.

    Parameters
    ----------
    problem : Problem

    Returns
    -------
    (n,) ndarray
        Within its bounds; on grids too small to be pooled it is uniform.
    """
    space = problem.space
    ny, nx = space.shape
    if min(ny, nx) < COARSEST:
        return np.full(ny * nx, min(1.0, problem.cap))
    coarse_space = space.coarser(2)
    pooled = pool_minimum(problem.clearance.reshape(ny, nx)).ravel()
    # In units of the fine grid the same pressure displaces cells twice as wide twice as much.
    load = problem.load / 2 if problem.by_force else problem.load
    coarse = Problem(coarse_space, pooled, load, problem.by_force, 2 * problem.cap)
    search = ActiveSet(coarse, COARSE_RTOL)
    found = search.solve(coarse_start(coarse), at_least=COARSE_CORRECTIONS)
    if pooled.size > KEPT_CELLS:
        coarse_space.forget()
    pressure = found.pressure.reshape(coarse_space.shape) / 2
    pressure = spread(pressure, problem.clearance.reshape(ny, nx), space.influence())
    return np.minimum(pressure, problem.cap).ravel()


def by_cells(values, missing):
    """Values (ny, nx) as (my, 2, mx, 2): two by two nodes a cell, ``missing`` beyond the grid."""
    ny, nx = values.shape
    if ny % 2 or nx % 2:
        values = np.pad(values, ((0, ny % 2), (0, nx % 2)), constant_values=missing)
    return values.reshape((ny + 1) // 2, 2, (nx + 1) // 2, 2)


def pool_minimum(gap):
    """Smallest gap of each 2 x 2 nodes, an odd last row or column standing alone."""
    return by_cells(gap, np.inf).min(axis=(1, 3))


def spread(pressure, clearance, influence):
    """Pressure of fine nodes, of which each coarse cell holds two by two.

    Parameters
    ----------
    pressure : (my, mx) ndarray
        On the coarse grid, no less than zero; m = (n + 1) // 2.
    clearance : (ny, nx) ndarray
        Opening at first touch on the fine grid.
    influence : (ny, nx) ndarray
        Displacement of nodes so far from one of unit pressure, in the unit of the clearance.

    Returns
    -------
    (ny, nx) ndarray
        Never negative. Of each cell it has the mean of the coarse one, or on an odd edge, where the
        cell reaches beyond the grid, that on the nodes there are.
    """
    change = on_nodes(pressure, clearance.shape)
    return shared_out(np.zeros(clearance.shape), change, clearance, influence)


def on_nodes(cells, shape):
    """Values (my, mx) of coarse cells, on each of their nodes, (ny, nx)."""
    return np.repeat(np.repeat(cells, 2, axis=0), 2, axis=1)[: shape[0], : shape[1]]


def shared_out(before, change, gap, influence):
    """Pressure, (ny, nx), of which each 2 x 2 nodes have a given sum, and even gaps where it is.

    Parameters
    ----------
    before, change : (ny, nx) ndarray
        A pressure, and a first guess of its change, which tells the sums: positive or zero.
    gap : (ny, nx) ndarray
        What the pressure before leaves open.
    influence : (ny, nx) ndarray
        As for :func:`spread`.
    """
    # Two nodes of neighbouring cells are no more than three apart.
    near = influence[:4, :4].astype(float)
    return _shared_out(before, np.ascontiguousarray(change), np.ascontiguousarray(gap), near)


@njit(cache=True)
def _shared_out(before, change, gap, influence):
    """One pass through the cells; each sees what those before it have become."""
    ny, nx = gap.shape
    own = np.empty((4, 4))
    for a in range(4):
        for b in range(4):
            own[a, b] = influence[abs(a // 2 - b // 2), abs(a % 2 - b % 2)]
    known, left, there = np.zeros(4), np.zeros(4), np.zeros(4, np.bool_)
    for cell_y in range((ny + 1) // 2):
        for cell_x in range((nx + 1) // 2):
            total = 0.0
            for a in range(4):
                y, x = 2 * cell_y + a // 2, 2 * cell_x + a % 2
                there[a] = y < ny and x < nx
                known[a] = before[y, x] if there[a] else 0.0
                total += known[a] + change[y, x] if there[a] else 0.0
            if not total > 0:
                continue
            for a in range(4):
                if there[a]:
                    y, x = 2 * cell_y + a // 2, 2 * cell_x + a % 2
                    left[a] = gap[y, x] + _from_around(change, influence, y, x)
                    for b in range(4):
                        left[a] -= own[a, b] * known[b]
            share = _shared(own, left, there, total)
            for a in range(4):
                if there[a]:
                    change[2 * cell_y + a // 2, 2 * cell_x + a % 2] = share[a] - known[a]
    return before + change


@njit(cache=True)
def _from_around(change, influence, y, x):
    """Displacement of a node by the eight cells around its own."""
    own_y, own_x = y // 2, x // 2
    total = 0.0
    for y2 in range(max(2 * own_y - 2, 0), min(2 * own_y + 4, change.shape[0])):
        for x2 in range(max(2 * own_x - 2, 0), min(2 * own_x + 4, change.shape[1])):
            if y2 // 2 != own_y or x2 // 2 != own_x:
                total += influence[abs(y2 - y), abs(x2 - x)] * change[y2, x2]
    return total


@njit(cache=True)
def _shared(own, gap, there, total):
    """Pressures of a given sum, 0 where no node is there, that leave even gaps where positive.

    Those in tension are dropped, the strongest first, until there is none.
    """
    active = there.copy()
    matrix, values = np.empty((5, 5)), np.empty(5)
    while True:
        for a in range(4):
            for b in range(4):
                alone = 1.0 if a == b else 0.0
                matrix[a, b] = own[a, b] if active[a] and active[b] else alone
            matrix[a, 4] = matrix[4, a] = 1.0 if active[a] else 0.0
            values[a] = -gap[a] if active[a] else 0.0
        matrix[4, 4], values[4] = 0.0, total
        # The first four pivots are positive, the last is negative: none need be sought.
        for k in range(5):
            for i in range(k + 1, 5):
                factor = matrix[i, k] / matrix[k, k]
                for j in range(k + 1, 5):
                    matrix[i, j] -= factor * matrix[k, j]
                values[i] -= factor * values[k]
        for k in range(4, -1, -1):
            for i in range(k + 1, 5):
                values[k] -= matrix[k, i] * values[i]
            values[k] /= matrix[k, k]
        worst = np.argmin(values[:4])
        if not values[worst] < 0:
            return values[:4]
        active[worst] = False
