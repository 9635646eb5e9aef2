"""Contact by direct elimination: the reference that shares neither FFT nor iteration with ours.

The influence matrix is written out and the contact set found by block principal pivoting, which
ends after finitely many exchanges. Memory grows with the square, time with the cube of the number
of interpenetrating nodes: a few thousand at most.
"""

import itertools

import numpy as np
from scipy import linalg

from ..contact import checked_load, unloaded_state
from .common import checked_state

# Pressures and gaps smaller than this share of the largest pressure and of the closure are zero:
# the rounding of a Cholesky solution, which must not count as tension or penetration.
ROUNDING = 1e-12
# Whole-set exchanges allowed without progress before single ones, which cannot cycle, take over
# (Judice & Pires 1994 use about ten).
PATIENCE = 10
# Closures tried before giving up on a force: trials needed at most five.
MAX_CLOSURES = 100
# Contact sets solved for at one closure before giving up: finite in theory, this in practice.
MAX_SETS = 10_000


def solve_contact(composite, space, *, closure=None, force=None, rtol=1e-9):
    """Press a composite topography against a rigid plane; direct and exact but for rounding.

    Parameters
    ----------
    composite : (ny, nx) array_like
        Composite topography h, mm.
    space : HalfSpace
        Gives the kernel at every cell distance.
    closure : float, optional
        w, mm, from first touch. Either this or ``force`` is given.
    force : float, optional
        F, N.
    rtol : float
        Largest violation allowed of the contact conditions in the final check by summation.

    Returns
    -------
    ContactState
        Its ``iterations`` count the contact sets solved for.

    Raises
    ------
    ValueError
        As `fractalcontact.solve_contact`.
    NotConverged
        If the pivoting does not end, or the state found fails the final check.

    Notes
    -----
    J. J. Judice & F. M. Pires, Comput. Oper. Res. 21 (1994) 587; K. G. Murty, Linear Algebra Appl.
    20 (1978) 263. Under a given force every set yields, with its closure unknown, the bordered
    system [K -1; 1' 0] [p; w] = [-c; F], solved here by elimination of p.
    """
    height = np.asarray(composite, float)
    load = checked_load(height, space, closure, force, None, rtol)
    clearance = height.max() - height
    if load == 0:
        return unloaded_state(space, clearance)
    if force is None:
        contact, values, sets = _pivot(space, clearance, load, clearance < load)
    else:
        contact, values, load, sets = _find_closure(space, clearance, load)
    pressure = np.zeros(space.shape)
    pressure[contact] = np.maximum(values, 0.0)
    return checked_state(
        space,
        clearance,
        pressure,
        load,
        force=force,
        iterations=sets,
        rtol=rtol,
        reason=f"pivoting stopped after {sets} contact sets",
    )


def _influence_matrix(space, rows, columns):
    """Displacement in mm at the nodes ``rows`` under unit pressure at the nodes ``columns``."""
    influence = space.influence() * (space.cell / space.modulus)
    (row_y, row_x), (column_y, column_x) = np.nonzero(rows), np.nonzero(columns)
    return influence[
        np.abs(row_y[:, None] - column_y[None, :]),
        np.abs(row_x[:, None] - column_x[None, :]),
    ]


def _pivot(space, clearance, closure, contact):
    """Contact set and its pressures at a closure, from a first guess of the set.

    As u >= 0, only nodes with d > 0 can touch: the others are left out of the matrix.
    """
    candidates = clearance < closure
    matrix = _influence_matrix(space, candidates, candidates)
    interference = (closure - clearance)[candidates]
    inside = contact[candidates]
    fewest, patience = inside.size + 1, PATIENCE
    for sets in itertools.count(1):
        pressure = _solve(matrix[np.ix_(inside, inside)], interference[inside])
        gap = matrix[np.ix_(~inside, inside)] @ pressure - interference[~inside]
        wrong = np.zeros_like(inside)
        wrong[inside] = pressure < -ROUNDING * np.abs(pressure).max(initial=0.0)
        wrong[~inside] = gap < -ROUNDING * closure
        number = np.count_nonzero(wrong)
        if number == 0 or sets == MAX_SETS:
            break
        if number < fewest:
            fewest, patience = number, PATIENCE
        elif patience > 0:
            patience -= 1
        else:
            wrong[: np.flatnonzero(wrong)[-1]] = False
        inside = inside ^ wrong
    contact = np.zeros(space.shape, bool)
    contact[candidates] = inside
    return contact, pressure, sets


def _solve(matrix, right_side):
    """Solution of a symmetric positive definite system, which may be empty."""
    if right_side.size == 0:
        return right_side
    return linalg.cho_solve(linalg.cho_factor(matrix, lower=True), right_side)


def _find_closure(space, clearance, force):
    """Contact set, pressures and closure under a force.

    F(w) is continuous, rising and linear while the set stays: the bordered system of the current
    set is Newton's step, exact on the right set; a bracket keeps it from going astray.
    """
    total = force / space.cell_area
    low, high = 0.0, np.inf
    contact = clearance == 0
    sets = 0
    for _ in range(MAX_CLOSURES):
        matrix = _influence_matrix(space, contact, contact)
        right_sides = np.column_stack([np.ones(len(matrix)), clearance[contact]])
        per_closure, at_zero = _solve(matrix, right_sides).sum(axis=0)
        closure = (total + at_zero) / per_closure
        if not low < closure < high:
            closure = (low + high) / 2
        contact, values, more = _pivot(space, clearance, closure, contact)
        sets += more
        if abs(values.sum() / total - 1) <= ROUNDING:
            break
        if values.sum() < total:
            low = closure
        else:
            high = closure
    return contact, values, closure, sets
