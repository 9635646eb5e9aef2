"""Contact by direct elimination: the reference that shares neither FFT nor iteration with ours.

The influence matrix is written out and the contact set determined by block principal pivoting,
which ends after finitely many exchanges. Memory grows with the square, time with the cube of the
number of interpenetrating nodes: a few thousand at most.
"""

import itertools

import numpy as np
from scipy import linalg

from roughcontact.contact.state import ContactState

from .common import ContactProblem, influence_matrix
from .method import Method

# Largest rounding of a Cholesky solution, as a fraction of the largest pressure and of the closure:
# it must not count as tension or penetration.
ROUNDING = 1e-12
# Whole-set exchanges allowed without progress before single ones, which cannot cycle, take over
# (Judice & Pires 1994 use about ten).
PATIENCE = 10
# Most closures tried for a force: trials needed at most five.
MAX_CLOSURES = 100
# Most contact sets solved for at one closure: theory says only that they are finite in number.
MAX_SETS = 10_000
# Statuses of a node: pressure zero, gap zero, or pressure at the hardness.
OPEN, CLOSED, CAPPED = 0, 1, 2


def solve(problem: ContactProblem) -> ContactState:
    """State by block principal pivoting: direct, and exact but for rounding.

    The contact set of a start is tried first; ``iterations`` count the contact sets solved.
    NotConverged if the pivoting does not end, or the state fails the final check.

    J. J. Judice & F. M. Pires, Comput. Oper. Res. 21 (1994) 587, and for two bounds J. Optim.
    Theory Appl. 74 (1992) 487; K. G. Murty, Linear Algebra Appl. 20 (1978) 263. Under a given force
    every set yields, with its closure unknown, the bordered system [K -1; 1' 0] [p; w] = [-c; F],
    solved here by elimination of p.
    """
    space, clearance, limit = problem.space, problem.clearance, problem.hardness
    closure = problem.load
    status = np.full(space.shape, OPEN)
    if problem.start is not None:
        status[problem.start.pressure > 0] = CLOSED
    if problem.by_force:
        pressure, closure, sets = _find_closure(space, clearance, problem.load, status, limit)
    else:
        if problem.start is None:
            status[clearance < closure] = CLOSED
        pressure, _, sets = _pivot(space, clearance, closure, status, limit)
    return problem.checked_state(
        pressure.clip(0.0, limit),
        closure,
        iterations=sets,
        reason=f"pivoting stopped after {sets} contact sets",
    )


def _pivot(space, clearance, closure, status, limit):
    """Pressure at a closure, the status of every node, and the sets solved for, from a first guess.

    As u >= 0, only nodes with d > 0 can touch: the others are left out of the matrix.
    """
    candidates = clearance < closure
    matrix = influence_matrix(space, candidates, candidates)
    interference = (closure - clearance)[candidates]
    now = status[candidates]
    fewest, patience = now.size + 1, PATIENCE
    for sets in itertools.count(1):
        closed, capped = now == CLOSED, now == CAPPED
        pressure = np.where(capped, limit, 0.0)
        pressure[closed] = _solve(
            matrix[np.ix_(closed, closed)],
            interference[closed] - _capped(matrix, closed, capped, limit),
        )
        gap = matrix @ pressure - interference
        largest, depth = ROUNDING * pressure.max(initial=0.0), ROUNDING * closure
        next_status = now.copy()
        next_status[closed & (pressure < -largest)] = OPEN
        next_status[closed & (pressure > limit + largest)] = CAPPED
        next_status[(now == OPEN) & (gap < -depth)] = CLOSED
        next_status[capped & (gap > depth)] = CLOSED
        wrong = next_status != now
        number = np.count_nonzero(wrong)
        if number == 0 or sets == MAX_SETS:
            break
        if number < fewest:
            fewest, patience = number, PATIENCE
        elif patience > 0:
            patience -= 1
        else:
            wrong[: np.flatnonzero(wrong)[-1]] = False
        now = np.where(wrong, next_status, now)
    status, whole = np.full(space.shape, OPEN), np.zeros(space.shape)
    status[candidates], whole[candidates] = now, pressure
    return whole, status, sets


def _capped(matrix, rows, capped, limit):
    """Displacement at the nodes ``rows`` under those at the hardness, if any."""
    return limit * matrix[np.ix_(rows, capped)].sum(axis=1) if capped.any() else 0.0


def _solve(matrix, right_side):
    """Solution of a symmetric positive definite system, which may be empty."""
    if right_side.size == 0:
        return right_side
    return linalg.cho_solve(linalg.cho_factor(matrix, lower=True), right_side)


def _find_closure(space, clearance, force, status, limit):
    """Pressure, closure and number of sets under a force.

    F(w) is continuous, rising and linear while the set stays: the bordered system of the current
    set is Newton's step, exact on the right set; a bracket keeps it from going astray.
    """
    total = force / space.cell_area
    low, high = 0.0, np.inf
    if not (status == CLOSED).any():
        status = np.where(clearance == 0, CLOSED, OPEN)
    sets = 0
    for _ in range(MAX_CLOSURES):
        closure = _closure_of_set(space, clearance, total, status, limit)
        if not low < closure < high:
            closure = (low + high) / 2 if np.isfinite(high) else 2 * low
        pressure, status, more = _pivot(space, clearance, closure, status, limit)
        sets += more
        if abs(pressure.sum() / total - 1) <= ROUNDING:
            break
        if pressure.sum() < total:
            low = closure
        else:
            high = closure
    return pressure, closure, sets


def _closure_of_set(space, clearance, total, status, limit):
    """Closure at which a set carries the sum ``total``, NaN where it has no closed node."""
    closed, capped = status == CLOSED, status == CAPPED
    if not closed.any():
        return np.nan
    matrix = influence_matrix(space, closed, closed)
    fixed = clearance[closed]
    if capped.any():
        fixed = fixed + limit * influence_matrix(space, closed, capped).sum(axis=1)
        total = total - limit * np.count_nonzero(capped)
    per_closure, at_zero = _solve(matrix, np.column_stack([np.ones(len(matrix)), fixed])).sum(
        axis=0
    )
    return (total + at_zero) / per_closure


METHODS = [
    Method(
        name="dense",
        order=10,
        title="direct elimination",
        loads=("closure", "force"),
        hardness=("closure", "force"),
        direct=True,
        warm=True,
        counts="contact sets",
        largest=6000,
        rtol=1e-9,
        solver=solve,
    )
]
