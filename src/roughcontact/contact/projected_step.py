"""Closure of an iterate under a given force where nodes yield: that of a projected gradient step.

The active contact set follows from the closure, and the force must come from that set, as every
other node carries 0 or the cap H. Where nearly all that touches yields, few nodes lie between the
bounds, and the closure of the last linear solve is theirs alone. All others that it makes enter or
leave the set do so at once, in one direction, and the next solve sends them back: sets cycle. Where
no node lies between the bounds there is no equation for the closure at all: no condition is
violated, and yet the force is lacking.

The step along the negative gradient, projected on the bounds and the force together, takes each
pressure to min(max(p - g, 0), H) and has its closure from the force, the sum of these. (A node's
own pressure displaces it by about itself in these units.) The nodes that it moves are the active
set at that closure. So they can carry the force, and what enters is as much as what leaves. (P. H.
Calamai and J. J. More, Projected gradient methods for linearly constrained problems, Math. Program.
39 (1987) 93; Y.-H. Dai and R. Fletcher, New algorithms for singly linearly constrained quadratic
programs subject to lower and upper bounds, Math. Program. 106 (2006) 403.)
"""

import numpy as np

from ..kernel_cache import njit
from .kkt import FORCE_ROUNDING, Iterate, Problem


def closure_of_step(problem: Problem, iterate: Iterate) -> float:
    """Closure at which the active set of an iterate is to be judged.

    Parameters
    ----------
    problem : Problem
    iterate : Iterate

    Returns
    -------
    float
        That of the projected step under a given force where a node is at the cap, or none is
        loaded; else the iterate's own.
    """
    if not problem.by_force or np.isinf(problem.cap) or 0 < iterate.pressure.max() < problem.cap:
        return iterate.closure
    reached = np.clip(iterate.pressure, 0.0, problem.cap)
    np.subtract(iterate.displacement, reached, out=reached)
    reached += problem.clearance
    return _closure_of_force(reached, iterate.closure, problem.cap, problem.load)


@njit(cache=True)
def _closure_of_force(reached, closure, cap, force):
    """Closure w at which the sum of min(max(w - reached, 0), cap) is a force.

    By Newton's method from a first guess, safeguarded by bisection: the sum rises with w, from 0 to
    the cap on every node.
    """
    low, high = np.min(reached), np.max(reached) + cap
    if not low < closure < high:
        closure = (low + high) / 2
    while low < closure < high:
        total, between = 0.0, 0
        for end in reached:
            if closure - end >= cap:
                total += cap
            elif closure > end:
                total += closure - end
                between += 1
        if abs(total - force) <= FORCE_ROUNDING * force:
            break
        low, high = (closure, high) if total < force else (low, closure)
        if between:
            closure += (force - total) / between
        if not between or not low < closure < high:
            closure = (low + high) / 2
    return closure
