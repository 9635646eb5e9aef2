"""Full approximation scheme (FAS): change of a known state under a new load, on coarser grids.

A coarse grid resolves how contact spreads over distances for which iterations on the fine one take
several applications of K, but not the state itself. Its problem is therefore constructed so that
the restricted pressure of the known state leaves the restricted gaps, and only the change is taken
from its solution (A. Brandt, Multi-level adaptive solutions to boundary-value problems, Math.
Comput. 31 (1977) 333). If the known state already solves the new load, nothing changes.
"""

import numpy as np

from ..elastic.halfspace import HalfSpace
from ..kernel_cache import njit
from .active_set import ActiveSetMethod
from .kkt import Problem, kkt_residual, mean_closure
from .nested_iteration import (
    COARSE_ITERATIONS,
    KEPT_CELLS,
    redistribute_padded,
)
from .preconditioner import forget_preconditioner
from .restriction import restrict_minimum, restrict_sum

# Fewest nodes along the shorter side: in smaller windows the coarse solves cost as much as the
# applications they save.
MIN_FINE_SIDE = 768
# Fewest nodes along the shorter side of the coarsest grid.
MIN_COARSE_SIDE = 96
# Largest violation, as a fraction of the closure, of a start that is left unchanged: coarse
# solutions are hardly closer.
WORTHWHILE = 1e-2
# Tolerance of the change on coarser grids, tighter than that of a cold start: its error takes
# applications on the fine grid.
CHANGE_RTOL = 1e-2
# Rounding by which a pressure that is at its bound in two states may miss it when extrapolated.
CAP_ROUNDING = 1e-9


def full_approximation_start(
    problem: Problem, pressure: np.ndarray, displacement: np.ndarray
) -> np.ndarray | None:
    """Start from a known state: its pressure, (n,), changed for the load on coarser grids.

    ``displacement`` is K of the ``pressure``; both may be extrapolated. None if the grid or the
    change is too small to be worth while, and if nodes yield: the gaps of a cell's nodes then
    differ, which restriction cannot keep.
    """
    if min(problem.space.shape) < MIN_FINE_SIDE:
        return None
    if not (problem.by_force or problem.space.is_free):
        return None  # the coarse grid may not reach that closure (`Problem.coarser`)
    clearance, bounds = problem.clearance, problem.bounds
    mean = mean_closure(pressure, displacement, clearance, bounds)
    if bounds.reached_by(pressure, CAP_ROUNDING) or not np.isfinite(mean):
        return None
    closure = mean if problem.by_force else problem.load
    kkt = kkt_residual(pressure, displacement, clearance, closure, bounds)
    if kkt.largest <= WORTHWHILE * closure:
        return None
    return _changed_pressure(problem, pressure, displacement + clearance - closure, closure)


def _changed_pressure(problem, pressure, gap, closure):
    """Changed pressure for a state with known ``gap`` at a ``closure``."""
    shape, space = problem.space.shape, problem.space.coarser(2)
    before, gap = problem.bounds.clip(pressure).reshape(shape), gap.reshape(shape)
    # The number of a pressure is twice the mean of its four nodes there: see `Bounds.coarser`.
    coarse_before, coarse_gap = restrict_sum(before) / 2, restrict_minimum(gap)
    displacement = _displacement(space, coarse_before)
    clearance = (coarse_gap + closure).ravel() - displacement
    coarse = problem.coarser(clearance)
    start = coarse_before.ravel().copy()
    if min(space.shape) >= 2 * MIN_COARSE_SIDE:
        start = _changed_pressure(coarse, start, coarse_gap, closure)
        displacement = _displacement(space, start)
    method = ActiveSetMethod(coarse, CHANGE_RTOL, dtype=np.float32)
    solution = method.solve(start, displacement, min_iterations=COARSE_ITERATIONS)
    if solution.pressure.size > KEPT_CELLS:
        forget_preconditioner(space)
    ny, nx = shape
    padded = np.zeros((2 * ((ny + 1) // 2) + 4, 2 * ((nx + 1) // 2) + 4))
    _in_proportion(before, coarse_before, solution.pressure.reshape(space.shape), padded)
    redistribute_padded(before, padded, gap, problem.space.near_influence(4))
    before += padded[2 : ny + 2, 2 : nx + 2]
    return problem.bounds.clip(before.ravel())


def _displacement(space: HalfSpace, pressure: np.ndarray) -> np.ndarray:
    """K of a pressure, (n,), in single precision: enough for a coarse clearance or a start."""
    pressure = pressure.reshape(space.shape).astype(np.float32)
    return space.convolve(pressure).astype(float).ravel()


@njit(cache=True)
def _in_proportion(before, old, new, padded):
    """Change of a fine pressure in proportion to its cells; uniform where it was zero.

    It is written into an array of zeros with two more nodes on each side. Zeros are not written,
    since writing to all of so large an array takes as long as all the rest.
    """
    ny, nx = before.shape
    for i in range(old.shape[0]):
        for j in range(old.shape[1]):
            if old[i, j] == 0 and new[i, j] == 0:
                continue
            last_y, last_x = min(2 * i + 2, ny), min(2 * j + 2, nx)
            nodes = (last_y - 2 * i) * (last_x - 2 * j)
            for y in range(2 * i, last_y):
                for x in range(2 * j, last_x):
                    if old[i, j] > 0:
                        padded[y + 2, x + 2] = before[y, x] * (new[i, j] / old[i, j] - 1)
                    else:
                        padded[y + 2, x + 2] = 2 * new[i, j] / nodes
