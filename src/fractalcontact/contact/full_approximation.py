"""What a new load changes, found on coarser grids first, from the state that is known.

A coarse grid tells how contact spreads over distances for which corrections on the fine one take
several applications of K. What it cannot tell is the state itself. So its problem is such that the
pooled pressure of the known state leaves the pooled gaps of it, and only the change is taken from
the solution (full approximation scheme: A. Brandt, Math. Comput. 31 (1977) 333). If the known state
already were that of the new load, nothing would change.
"""

import numpy as np

from .active_set import ActiveSet
from .kkt import Problem, examined_by, mean_reached
from .nested_iteration import (
    COARSE_CORRECTIONS,
    COARSE_RTOL,
    KEPT_CELLS,
    on_nodes,
    pool_minimum,
    pool_sum,
    shared_out,
)
from .preconditioner import forget_preconditioner

# With fewer nodes along the shorter side, as many applications on the fine grid take no more time.
SMALLEST = 768
# No coarser grid has fewer.
COARSEST = 96
# Starts that violate the conditions by no more, as a share of the closure, are left as they are:
# coarse solutions are hardly nearer.
WORTHWHILE = 1e-2
# Extrapolated from two states, a pressure at the cap in both may miss it by rounding.
CAP_ROUNDING = 1e-9


def coarse_change(problem, pressure, displacement):
    """Where to start from a known state: its pressure, changed for the load on coarser grids.

    Parameters
    ----------
    problem : Problem
    pressure, displacement : (n,) ndarray
        Of the known state, perhaps extrapolated; K of the first is the second.

    Returns
    -------
    (n,) ndarray or None
        Within its bounds; None if the grid is too small, or the change, for this to be worth while,
        and where nodes yield: those of one cell then differ in gap, which pooling cannot keep.
    """
    if min(problem.space.shape) < SMALLEST:
        return None
    clearance, cap = problem.clearance, problem.cap
    mean = mean_reached(pressure, displacement, clearance, cap)
    yields = pressure.max() >= (1 - CAP_ROUNDING) * cap
    if yields or not np.isfinite(mean):
        return None
    closure = mean if problem.by_force else problem.load
    worst = examined_by(pressure, displacement, clearance, closure, cap).worst
    if worst <= WORTHWHILE * closure:
        return None
    return _changed(problem, pressure, displacement + clearance - closure, closure)


def _changed(problem, pressure, gap, closure):
    """The same for a state whose ``gap`` at a ``closure`` is known."""
    shape, space = problem.space.shape, problem.space.coarser(2)
    before, gap = np.clip(pressure, 0.0, problem.cap).reshape(shape), gap.reshape(shape)
    # In units of the fine grid the same pressure displaces cells twice as wide twice as much.
    pooled, pooled_gap = pool_sum(before) / 2, pool_minimum(gap)
    displacement = _displacement(space, pooled)
    clearance = (pooled_gap + closure).ravel() - displacement
    load = problem.load / 2 if problem.by_force else problem.load
    coarse = Problem(space, clearance, load, problem.by_force, 2 * problem.cap)
    start = pooled.ravel().copy()
    if min(space.shape) >= 2 * COARSEST:
        start = _changed(coarse, start, pooled_gap, closure)
        displacement = _displacement(space, start)
    found = ActiveSet(coarse, COARSE_RTOL).solve(start, displacement, at_least=COARSE_CORRECTIONS)
    if found.pressure.size > KEPT_CELLS:
        forget_preconditioner(space)
    change = _in_proportion(before, pooled, found.pressure.reshape(space.shape))
    pressure = shared_out(before, change, gap, problem.space.influence())
    return np.minimum(pressure, problem.cap).ravel()


def _displacement(space, pressure):
    """K of a pressure, (n,), of which single precision is enough: it is only a start."""
    pressure = pressure.reshape(space.shape).astype(np.float32)
    return space.convolve(pressure).astype(float).ravel()


def _in_proportion(before, old, new):
    """Change of a fine pressure in proportion to that of its cells; even where there was none."""
    nodes = pool_sum(np.ones(before.shape))
    factor = np.divide(new, old, out=np.ones(old.shape), where=old > 0)
    fresh = np.where(old > 0, 0.0, 2 * new / nodes)
    return before * on_nodes(factor - 1, before.shape) + on_nodes(fresh, before.shape)
