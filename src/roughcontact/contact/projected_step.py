"""Closure of an iterate under a given force where nodes yield: that of a projected gradient step.

The active contact set follows from the closure, and the force must come from that set, as every
other node is at a bound, 0 or H. If nearly all nodes in contact yield, few lie between the bounds,
and the closure of the last linear solve belongs to these alone. All other nodes that it makes enter
or leave the set do so at once, in one direction, and the next solve sends them back: sets cycle. If
no node lies between the bounds, no equation determines the closure: no condition is violated, but
the force is wrong.

The step along the negative gradient, projected on the bounds and the force together, takes each
pressure to min(max(p - g, 0), H); the sum of these is the force and determines the closure. (A
node's own pressure displaces it by about itself in these units.) The nodes that it moves are the
active set at that closure. They can carry the force, and as much enters the set as leaves it. (P.
H. Calamai and J. J. More, Projected gradient methods for linearly constrained problems, Math.
Program. 39 (1987) 93; Y.-H. Dai and R. Fletcher, New algorithms for singly linearly constrained
quadratic programs subject to lower and upper bounds, Math. Program. 106 (2006) 403.)
"""

import numpy as np

from ..kernel_cache import njit
from .kkt import FORCE_ROUNDING, Iterate, Problem


def closure_of_step(problem: Problem, iterate: Iterate) -> float:
    """Closure for judging the active set of an iterate.

    That of the projected step if the force is given and a node is at its upper bound, or all are at
    the lower one; otherwise the iterate's own.
    """
    pressure, bounds = iterate.pressure, problem.bounds
    if not problem.by_force or bounds.elastic:
        return iterate.closure
    if (pressure > bounds.lower).any() and not bounds.reached_by(pressure):
        return iterate.closure
    reached = bounds.clip(pressure)
    np.subtract(iterate.displacement, reached, out=reached)
    reached += problem.clearance
    return _closure_of_force(reached, iterate.closure, *bounds.on(pressure.size), problem.load)


@njit(cache=True)
def _closure_of_force(reached, closure, lower, upper, force):
    """Closure w at which the sum of min(max(w - reached, lower), upper) is a force.

    Newton's method from a first guess, safeguarded by bisection: the sum rises with w between those
    of the bounds.
    """
    low, high = np.inf, -np.inf
    for i in range(reached.size):
        low = min(low, reached[i] + lower[i])
        # A node without an upper bound carries at most the whole force.
        high = max(high, reached[i] + (upper[i] if upper[i] < np.inf else force))
    if not low < closure < high:
        closure = (low + high) / 2
    while low < closure < high:
        total, between = 0.0, 0
        for i in range(reached.size):
            push = closure - reached[i]
            if push >= upper[i]:
                total += upper[i]
            elif push > lower[i]:
                total += push
                between += 1
            else:
                total += lower[i]
        if abs(total - force) <= FORCE_ROUNDING * force:
            break
        low, high = (closure, high) if total < force else (low, closure)
        if between:
            closure += (force - total) / between
        if not between or not low < closure < high:
            closure = (low + high) / 2
    return closure
