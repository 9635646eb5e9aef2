"""First and last iterates: a start scaled to the load, and an iterate within its bounds."""

import numpy as np

from ..kernel_cache import njit
from .kkt import FORCE_ROUNDING, Iterate, Problem, Solution, kkt_residual
from .operator import Operator
from .projected_cg import CLIPPING_PASSES


def first_iterate(
    problem: Problem, operator: Operator, pressure: np.ndarray, displacement: np.ndarray | None
) -> Iterate:
    """Start scaled to the load, with its displacement and closure.

    It may violate the bounds. Under a given force its positive pressures sum to the force; the
    first step corrects for the negative ones. ``pressure``, (n,), and its ``displacement``, if
    known, may become part of the iterate.
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
    """Iterate projected on its bounds, with its displacement in double precision.

    A ``dtype`` of float32 is enough for a solution that is only a start on a finer grid. Under a
    given force the pressure is also scaled to it, as far as the bounds allow. The ``residual`` says
    whether it is a state of contact.
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
    else:  # divided by the largest pressure, which single precision might not represent
        unit = float(pressure.max(initial=0.0)) or 1.0
        displacement = unit * operator((pressure / unit).astype(dtype)).astype(float)
    if problem.by_force:
        closure = problem.closure_at_force(pressure, displacement)
    kkt = kkt_residual(pressure, displacement, problem.clearance, closure, problem.bounds)
    solution = Solution(pressure, displacement, closure, lacking, operator.applications)
    solution.residual = max(kkt.largest / problem.tolerated(solution), lacking)
    return solution


def _scaled_to_force(problem, operator, pressure, displacement):
    """Start with its positive part scaled to the force; without displacement if it was clipped."""
    total = np.maximum(pressure, 0.0).sum()
    if not total > 0:
        return problem.first_touch(), None
    factor, bounds = problem.load / total, problem.bounds
    if (pressure * factor > bounds.upper).any():
        # The pressure is cut at the bounds; the solver's first step gives the force that loaded
        # nodes cannot carry to other nodes.
        pressure = bounds.clip(pressure)
        _scale_to(problem.load, pressure, *bounds.on(pressure.size))
        return pressure, None
    return pressure * factor, None if displacement is None else displacement * factor


def _energy_factor(problem, pressure, displacement):
    """Energy-minimising scale of a start at given closure.

    Coarse cells have the height of their highest node, so that a prolonged start carries too much.
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
    """Scale a pressure above its lower bounds to a total, in place.

    The total is missed only if all pressures above their lower bounds reach the upper ones.
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
