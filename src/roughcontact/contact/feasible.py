"""First and last iterates: a start brought near the load, and an iterate within its bounds."""

import numpy as np

from ..kernel_cache import njit
from .kkt import FORCE_ROUNDING, Iterate, Problem, Solution, kkt_residual
from .operator import Operator
from .projected_cg import CLIPPING_PASSES


def first_iterate(
    problem: Problem, operator: Operator, pressure: np.ndarray, displacement: np.ndarray | None
) -> Iterate:
    """A start brought near the load, with its displacement and its closure.

    It may violate the bounds. Under a given force the sum of its positive pressures is the force;
    what negative ones take off, the first step makes up.

    Parameters
    ----------
    problem : Problem
    operator : Operator
    pressure : (n,) ndarray
        It may become part of the iterate, and so may the displacement.
    displacement : (n,) ndarray or None
        K of it, where known.
    """
    if problem.by_force:
        pressure, displacement = _scaled_to_force(problem, operator, pressure, displacement)
    if displacement is None:
        displacement = operator(pressure.astype(np.float32)).astype(float)
        factor = _energy_factor(problem, pressure, displacement)
        pressure, displacement = factor * pressure, factor * displacement
    if problem.by_force:
        return Iterate(pressure, displacement, problem.closure_at_force(pressure, displacement))
    return Iterate(pressure, displacement, problem.load)


def verified(
    problem: Problem, operator: Operator, iterate: Iterate, dtype: type = np.float64
) -> Solution:
    """The iterate projected on its bounds, with a displacement in double precision.

    Or of another ``dtype``: float32 is enough for what is but a start on a finer grid. Under a
    given force it is also scaled to that, as far as the bounds allow. Whoever asks for it reads
    from the ``residual`` whether it is a state of contact.
    """
    closure, lacking = iterate.closure, 0.0
    pressure = problem.bounds.clip(iterate.pressure)
    if problem.by_force:
        if not pressure.any():
            pressure = problem.first_touch()
        _scale_to(problem.load, pressure, *problem.bounds.on(pressure.size))
        lacking = abs(1 - pressure.sum() / problem.load)
    if dtype is np.float64:
        displacement = operator(pressure)
    else:  # in units of their largest, as no pressure may be beyond what single precision holds
        unit = float(pressure.max(initial=0.0)) or 1.0
        displacement = unit * operator((pressure / unit).astype(dtype)).astype(float)
    if problem.by_force:
        closure = problem.closure_at_force(pressure, displacement)
    kkt = kkt_residual(pressure, displacement, problem.clearance, closure, problem.bounds)
    found = Solution(pressure, displacement, closure, lacking, operator.applications)
    found.residual = max(kkt.largest / problem.tolerated(found), lacking)
    return found


def _scaled_to_force(problem, operator, pressure, displacement):
    """The start, its positive part scaled to the force; no displacement where that is not all."""
    total = np.maximum(pressure, 0.0).sum()
    if not total > 0:
        return problem.first_touch(), None
    factor, bounds = problem.load / total, problem.bounds
    if (pressure * factor > bounds.upper).any():
        # What the loaded nodes cannot carry, the first step gives to the next ones to touch.
        pressure = bounds.clip(pressure)
        _scale_to(problem.load, pressure, *bounds.on(pressure.size))
        return pressure, None
    return pressure * factor, None if displacement is None else displacement * factor


def _energy_factor(problem, pressure, displacement):
    """Energy-minimising scale of a start at given closure.

    On a coarse grid, of which each cell has its highest point, too much is carried.
    """
    work = pressure @ displacement
    if problem.by_force or not work > 0:
        return 1.0
    factor = pressure @ (problem.load - problem.clearance) / work
    loaded = np.flatnonzero(pressure > 0)
    most = np.min(problem.bounds.at(loaded).upper / pressure[loaded])
    return min(factor, float(most)) if factor > 0 else 1.0


@njit(cache=True)
def _scale_to(total, pressure, lower, upper):
    """Scale a pressure, as far as it is above its lower bounds, to a total in place.

    Less than the total is left only where all that was above them is at the upper ones.
    """
    passes, reached = 0, True
    while reached or passes < CLIPPING_PASSES:
        lacking, between = total, 0.0
        for i in range(pressure.size):
            lacking -= pressure[i]
            if pressure[i] < upper[i]:
                between += pressure[i] - lower[i]
        if abs(lacking) <= FORCE_ROUNDING * total or between == 0:
            break
        factor, reached = 1 + lacking / between, False
        for i in range(pressure.size):
            if lower[i] < pressure[i] < upper[i]:
                pressure[i] = min(lower[i] + (pressure[i] - lower[i]) * factor, upper[i])
                reached = reached or pressure[i] == upper[i]
        passes += 1
