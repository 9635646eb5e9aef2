"""Nested iteration: a cold solve starts from the solution on the grid twice as coarse.

(Full multigrid: A. Brandt, Multi-level adaptive solutions to boundary-value problems, Math. Comput.
31 (1977) 333; for contact, A. A. Lubrecht and E. Ioannides, ASME J. Tribol. 113 (1991) 128.)
Restriction gives a coarse cell the height of the highest of its four nodes, which need not all
touch. Prolongation keeps the sum of its pressure, and local redistribution divides it among the
four nodes so that those in contact have equal gaps. The nodes of the eight cells around act on the
four individually; loads further away displace all four alike.
"""

import numpy as np

from ..kernel_cache import njit
from .active_set import ActiveSetMethod
from .dense import inverted
from .kkt import Problem
from .preconditioner import forget_preconditioner
from .restriction import restrict_minimum

# Fewest nodes along the shorter side of a grid that starts from a coarser one; smaller grids start
# from a uniform pressure.
COARSEST_SIDE = 24
# Most cells of a coarse grid whose preconditioner is kept. Larger ones take memory and gain little;
# on small ones, as in sub-windows, many problems are solved.
KEPT_CELLS = 10_000
# Tolerance of coarse solutions, which are only a start. COARSE_ITERATIONS are made even if the
# start on a coarse grid meets it: otherwise errors add up from grid to grid.
COARSE_RTOL, COARSE_ITERATIONS = 2e-2, 1


def nested_iteration_start(problem: Problem) -> np.ndarray:
    """Start pressure, (n,), within its bounds: the solution on the grid twice as coarse, prolonged.

    Grids too small for a coarser one start from a uniform pressure.
    """
    space = problem.space
    ny, nx = space.shape
    if min(ny, nx) < COARSEST_SIDE:
        return _without_coarser_grid(problem)
    coarse = problem.coarser(restrict_minimum(problem.clearance.reshape(ny, nx)).ravel())
    if not coarse.load > 0:  # all coarse nodes are equally high (`Problem.coarser`)
        return _without_coarser_grid(problem)
    method = ActiveSetMethod(coarse, COARSE_RTOL, dtype=np.float32)
    solution = method.solve(nested_iteration_start(coarse), min_iterations=COARSE_ITERATIONS)
    if coarse.clearance.size > KEPT_CELLS:
        forget_preconditioner(coarse.space)
    pressure = solution.pressure.reshape(coarse.space.shape) / 2
    pressure = prolong(pressure, problem.clearance.reshape(ny, nx), space.near_influence(4))
    return problem.bounds.clip(pressure.ravel())


def _without_coarser_grid(problem):
    """Uniform pressure; or the overlap, where a uniform pressure displaces nothing."""
    if problem.by_force or problem.space.is_free:
        return problem.bounds.clip(np.ones(problem.clearance.size))
    return problem.bounds.clip(problem.load - problem.clearance)


@njit(cache=True)
def prolong_constant(cells: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """Values (my, mx) of coarse cells on each of their nodes, (ny, nx)."""
    ny, nx = shape
    if cells.shape[0] != (ny + 1) // 2 or cells.shape[1] != (nx + 1) // 2:
        raise ValueError("expected a cell for each 2 x 2 nodes")
    values = np.empty(shape)
    for y in range(ny):
        for x in range(nx):
            values[y, x] = cells[y // 2, x // 2]
    return values


def prolong(pressure: np.ndarray, clearance: np.ndarray, influence: np.ndarray) -> np.ndarray:
    """Pressure on the fine grid, (ny, nx), from that on the coarse one, m = (n + 1) // 2.

    It is nowhere negative, and the mean of each cell's nodes is the coarse pressure; at an odd
    edge, the mean of the nodes inside the grid. ``clearance`` is that of the fine grid,
    ``influence``, (4, 4) or larger, the displacement per unit pressure in its unit.
    """
    change = prolong_constant(pressure, clearance.shape)
    return redistribute(np.zeros(clearance.shape), change, clearance, influence)


def redistribute(
    before: np.ndarray, change: np.ndarray, gap: np.ndarray, influence: np.ndarray
) -> np.ndarray:
    """Pressure, (ny, nx), with given sums over 2 x 2 nodes, and equal gaps where positive.

    ``gap`` belongs to the pressure ``before``; ``change`` is a first guess of its change, with the
    given sums, positive or zero. ``influence`` as in :func:`prolong`.
    """
    one_grid = before.shape == change.shape == gap.shape
    if not one_grid or min(gap.shape) < 4 or min(influence.shape) < 4:
        shapes = ", ".join(str(values.shape) for values in (before, change, gap, influence))
        raise ValueError(f"shapes {shapes}: expected one grid of 4 x 4 nodes or more")
    # A cell and the eight around it have six rows and columns of nodes.
    my, mx = ((n + 1) // 2 for n in gap.shape)
    padded = np.zeros((2 * my + 4, 2 * mx + 4))
    inside = padded[2 : gap.shape[0] + 2, 2 : gap.shape[1] + 2]
    inside[:] = change
    redistribute_padded(before, padded, gap, influence)
    return before + inside


def redistribute_padded(
    before: np.ndarray, change: np.ndarray, gap: np.ndarray, influence: np.ndarray
) -> None:
    """`redistribute` in place; the change of (my, mx) cells is padded by two rows and columns."""
    _redistribute(before, change, gap, influence[:4, :4].astype(float))


@njit(cache=True)
def _redistribute(before, change, gap, influence):
    """Redistribute a padded change within the cells, one by one.

    Each cell uses the new pressures of the cells before it.
    """
    ny, nx = gap.shape
    own, around = influence_on(influence)
    maps = redistributions(own)
    earlier, opening, pressure = np.zeros(4), np.zeros(4), np.zeros(4)
    for top in range(0, ny, 2):
        for side in range(0, nx, 2):
            total, mask = 0.0, 0
            for y in range(top, min(top + 2, ny)):
                for x in range(side, min(side + 2, nx)):
                    total += before[y, x] + change[y + 2, x + 2]
            if not total > 0:
                continue
            for a in range(4):
                y, x = top + a // 2, side + a % 2
                earlier[a] = opening[a] = 0.0
                if y < ny and x < nx:
                    earlier[a], opening[a] = before[y, x], gap[y, x]
                    mask |= 1 << a
            for i in range(6):
                for j in range(6):
                    value = change[top + i, side + j]
                    for a in range(4):
                        opening[a] += around[i, j, a] * value
            for a in range(4):
                for b in range(4):
                    opening[a] -= own[a, b] * earlier[b]
            equalise_gaps(maps, opening, total, mask, pressure)
            for a in range(4):
                if mask & (1 << a):
                    change[top + a // 2 + 2, side + a % 2 + 2] = pressure[a] - earlier[a]


@njit(cache=True)
def influence_on(influence: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Influence of a cell's four nodes on each other, and of the 6 x 6 nodes around on each.

    The second omits the influence of the four on each other.
    """
    own, around = np.empty((4, 4)), np.empty((6, 6, 4))
    for a in range(4):
        for b in range(4):
            own[a, b] = influence[abs(a // 2 - b // 2), abs(a % 2 - b % 2)]
        for i in range(6):
            for j in range(6):
                within = 2 <= i < 4 and 2 <= j < 4
                away = abs(i - 2 - a // 2), abs(j - 2 - a % 2)
                around[i, j, a] = 0.0 if within else influence[away]
    return own, around


@njit(cache=True)
def redistributions(own: np.ndarray) -> np.ndarray:
    """Linear maps that distribute a sum over each subset of a cell's nodes, (16, 4, 5).

    The subset is given by its bits. For gaps g and a sum S the pressures p = -M g + c S make
    own p + g equal, with M = W - W 1 1' W / (1' W 1), c = W 1 / (1' W 1), and W the inverse of own.
    """
    maps = np.zeros((16, 4, 5))
    for mask in range(1, 16):
        nodes = np.array([a for a in range(4) if mask & (1 << a)])
        inverse = inverted(own[nodes][:, nodes])
        ones = inverse.sum(axis=1)
        for i, a in enumerate(nodes):
            maps[mask, a, 4] = ones[i] / ones.sum()
            for j, b in enumerate(nodes):
                maps[mask, a, b] = ones[i] * ones[j] / ones.sum() - inverse[i, j]
    return maps


@njit(cache=True)
def equalise_gaps(
    maps: np.ndarray, gap: np.ndarray, total: float, mask: int, pressure: np.ndarray
) -> None:
    """Pressures of a given sum on the nodes of a ``mask`` that leave equal gaps where positive.

    Nodes in tension are dropped, the strongest first. The least gap is subtracted: only differences
    count, and a large common gap would lose the sum to rounding.
    """
    while True:
        nearest = np.inf
        for a in range(4):
            if mask & (1 << a):
                nearest = min(nearest, gap[a])
        worst, least = 0, 0.0
        for a in range(4):
            pressure[a] = maps[mask, a, 4] * total
            for b in range(4):
                pressure[a] += maps[mask, a, b] * (gap[b] - nearest)
            if pressure[a] < least:
                worst, least = a, pressure[a]
        if not least < 0:
            break
        mask &= ~(1 << worst)
