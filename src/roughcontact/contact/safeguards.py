"""Safeguards against cycling, after many iterations of the active-set method.

It has no proof of convergence with inexact, clipped steps, and on combs, checkerboards and single
spikes its sets do cycle. No cycle is detected, iterations are counted. Under a given closure, once
more than :data:`PATIENCE` were made, linear equations are solved nearly to the end and without
clipping, and while nodes leave the set none enters it. Under a given force, whose closure all nodes
share, Newton's method on F(w) then takes over, the force as a function of the closure (the rigid
approach), safeguarded by bisection: F rises, and its slope is the contact stiffness. It solves for
one given closure after the other.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from .bounds import Bounds
from .feasible import verified
from .kkt import KKTResidual, Problem, Solution
from .operator import Operator
from .projected_cg import stiffness

# After more iterations than this the set may be cycling: seen on combs and checkerboards under a
# given force, once in 2,000 random problems under a given closure.
PATIENCE = 30
# Under a given force it cycles for sure where a violation is still of the order of the closure
# after more than these: a spike carries what its neighbours, all or none of them, would.
STALL, STALLED_VIOLATION = 15, 0.5
# Closures tried in search of one force; Newton's method needs about five.
MAX_CLOSURES = 50
# Aim this far below the tolerance, so that one iteration too many is rarer than one too few.
SAFETY = 0.3
# No closure is known better than this, as a fraction of it.
CLOSURE_ROUNDING = 1e-12


def many_iterations(iterations: int) -> bool:
    """True if more iterations were made than go without exact solves, under a given closure."""
    return iterations > PATIENCE


def many_iterations_under_force(iterations: int, violation: float, unit: float) -> bool:
    """True if more iterations were made than go without Newton's method, under a given force.

    Parameters
    ----------
    iterations : int
        Made so far.
    violation : float
        The largest before the last of them.
    unit : float
        What that is counted in (`Problem.tolerated`).
    """
    stalled = violation > STALLED_VIOLATION * unit
    return iterations > (STALL if stalled else PATIENCE)


def without_entering(kkt: KKTResidual, pressure: np.ndarray, bounds: Bounds) -> KKTResidual:
    """The same residual with an active set that no node enters while others leave."""
    if not kkt.infeasible.size:
        return kkt
    inside = bounds.at(kkt.active).between(pressure[kkt.active])
    return replace(kkt, active=kkt.active[inside])


def newton_on_closure(
    problem: Problem,
    rtol: float,
    operator: Operator,
    start: Solution,
    solve: Callable[[Problem, float, Solution], Solution],
) -> Solution:
    """The state of a given force as that of a closure, by Newton's method on F(w).

    Parameters
    ----------
    problem : Problem
        Under a given force.
    rtol : float
        Tolerance of its state.
    operator : Operator
    start : Solution
    solve : callable
        From a problem under a given closure, a tolerance and a start to a solution.

    Returns
    -------
    Solution
        The caller checks its residual.
    """
    low, high, solution = 0.0, problem.largest_closure, start
    closure = start.closure if start.closure < high else high / 2
    tolerance = SAFETY * rtol
    for _ in range(MAX_CLOSURES):
        solution = solve(replace(problem, load=closure, by_force=False), tolerance, solution)
        total = solution.pressure.sum()
        if abs(total / problem.load - 1) <= SAFETY * rtol:
            # What is missing goes to the nodes between the bounds, which may be few.
            state = verified(problem, operator, solution)
            if state.residual <= rtol:
                return state
        low, high = (closure, high) if total < problem.load else (low, closure)
        slope, _ = stiffness(operator, problem.bounds.between(solution.pressure))
        if slope > 0:
            # Steep F(w): a closure within its tolerance must still give the force within its.
            steepness = max(1.0, slope * abs(closure) / problem.load)
            tolerance = max(SAFETY * rtol / steepness, CLOSURE_ROUNDING)
            closure += (problem.load - total) / slope
        if not (slope > 0 and low < closure < high):
            closure = (low + min(high, 4 * low + 1)) / 2
    return verified(problem, operator, solution)
