"""Anti-cycling safeguards, after many iterations of the active-set method.

With inexact, clipped steps the method has no proof of convergence, and on combs, checkerboards and
single spikes its sets do cycle. Cycles are not detected; iterations are counted. Under a given
closure, after more than :data:`PATIENCE` iterations, linear equations are solved nearly exactly and
without clipping, and while nodes leave the set none enters it. Under a given force, whose closure
all nodes share, Newton's method on F(w) then takes over, the force as a function of the closure
(the rigid-body approach), safeguarded by bisection: F rises, and its slope is the contact
stiffness. It solves for one given closure after the other.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from .bounds import Bounds
from .feasible import verified
from .kkt import KKTResidual, Problem, Solution
from .operator import Operator
from .projected_cg import stiffness

# Iterations after which the set may be cycling: seen on combs and checkerboards under a given
# force, and once in 2,000 random problems under a given closure.
PATIENCE = 30
# Iterations under a given force, and the violation, as a fraction of the closure, beyond which the
# set is cycling: a spike and its neighbours take the load from each other.
STALL, STALLED_VIOLATION = 15, 0.5
# Most closures tried for one force; Newton's method needs about five.
MAX_CLOSURES = 50
# Fraction of the tolerance that solves aim at: stopping just above it would cost an iteration.
SAFETY = 0.3
# Relative rounding of the closure.
CLOSURE_ROUNDING = 1e-12


def many_iterations(iterations: int) -> bool:
    """True if exact solves are due, under a given closure."""
    return iterations > PATIENCE


def many_iterations_under_force(iterations: int, violation: float, unit: float) -> bool:
    """True if Newton's method is due, under a given force.

    ``violation`` is the largest before the last iteration, ``unit`` that of `Problem.tolerated`.
    """
    stalled = violation > STALLED_VIOLATION * unit
    return iterations > (STALL if stalled else PATIENCE)


def without_entering(kkt: KKTResidual, pressure: np.ndarray, bounds: Bounds) -> KKTResidual:
    """Same residual with an active set that no node enters while others leave."""
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
    """State of a given force, by Newton's method on F(w); the caller checks the residual.

    ``solve`` takes a problem under a given closure, a tolerance and a start, and returns a
    solution.
    """
    low, high, solution = 0.0, problem.largest_closure, start
    closure = start.closure if start.closure < high else high / 2
    tolerance = SAFETY * rtol
    for _ in range(MAX_CLOSURES):
        solution = solve(replace(problem, load=closure, by_force=False), tolerance, solution)
        total = solution.pressure.sum()
        if abs(total / problem.load - 1) <= SAFETY * rtol:
            # The missing force goes to the nodes between the bounds, which may be few.
            state = verified(problem, operator, solution)
            if state.residual <= rtol:
                return state
        low, high = (closure, high) if total < problem.load else (low, closure)
        slope, _ = stiffness(operator, problem.bounds.between(solution.pressure))
        if slope > 0:
            # Where F(w) is steep, the closure needs a tighter tolerance for the force to meet its
            # own.
            steepness = max(1.0, slope * abs(closure) / problem.load)
            tolerance = max(SAFETY * rtol / steepness, CLOSURE_ROUNDING)
            closure += (problem.load - total) / slope
        if not (slope > 0 and low < closure < high):
            closure = (low + min(high, 4 * low + 1)) / 2
    return verified(problem, operator, solution)
