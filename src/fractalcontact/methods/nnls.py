"""Non-negative least squares with a warm start (Bemporad & Paggi, Int. J. Solids Struct. 2015).

The pressures minimise p'Kp/2 - p'd under p >= 0, with the interference d: the least-squares problem
of Lawson and Hanson (1974, ch. 23) on a factor of K. Their active set admits one point at a time,
the deepest, and steps back to the first pressure that would turn negative. From zero pressure that
takes as many factorisations as there are points in contact; the warm start of Bemporad and Paggi
(vol. 69-70, p. 292), a number of accelerated gradient projections or the state before, leaves few.
"""

import numpy as np
from scipy import linalg

from ..contact.solve import checked_problem
from ..contact.state import unloaded_state
from .common import checked_state, influence_matrix, refuse_force, refuse_hardness

# Gradient projections for the warm start; each one application of the operator.
PROJECTIONS = 100
# Sets solved for before giving up: finite in theory, this in practice.
MAX_SETS = 5000
# Points are admitted until overlap is this far below the tolerance of the final check.
SAFETY = 0.3


def solve_contact(
    composite, space, *, closure=None, force=None, start=None, rtol=1e-6, hardness=None
):
    """Press a composite topography against a rigid plane by non-negative least squares.

    Parameters
    ----------
    composite : (ny, nx) array_like
        Composite topography h, mm.
    space : HalfSpace
        The elastic operator on the same grid.
    closure : float
        w, mm, from first touch.
    force : None
        Not offered: the authors impose the closure.
    start : ContactState, optional
        Its pressure is the warm start, instead of gradient projections.
    rtol : float
        Largest violation allowed of the contact conditions, as a share of the closure.
    hardness : None
        Not offered.

    Returns
    -------
    ContactState
        Its ``iterations`` count the sets solved for, each a Cholesky factorisation.

    Raises
    ------
    ValueError
        If a force or a hardness is given, or as `fractalcontact.solve_contact`.
    NotConverged
        If the active set does not end, or the state found fails the final check.
    """
    refuse_force("NNLS", force)
    refuse_hardness("NNLS", hardness)
    closure, clearance = checked_problem(composite, space, closure, None, start, rtol)
    if closure == 0:
        return unloaded_state(space, clearance)
    # Pressure in units of E*/s, so that the operator gives mm.
    unit = space.modulus / space.cell
    interference = closure - clearance
    if start is not None:
        pressure = np.where(interference > 0, start.pressure / unit, 0.0)
    else:
        pressure = _gradient_projections(space, interference)
    pressure, sets = _lawson_hanson(space, interference, pressure, SAFETY * rtol * closure)
    return checked_state(
        space,
        clearance,
        pressure * unit,
        closure,
        force=None,
        iterations=sets,
        rtol=rtol,
        reason=f"the active set stopped after {sets} sets",
    )


def _gradient_projections(space, interference):
    """Pressure after `PROJECTIONS` projected gradient steps with Nesterov's acceleration."""
    # No eigenvalue of a positive operator exceeds its largest sum of a row.
    step = 1 / space.convolve(np.ones(space.shape)).max()
    pressure = ahead = np.zeros(space.shape)
    for k in range(PROJECTIONS):
        gap = space.convolve(ahead) - interference
        new = np.maximum(ahead - step * gap, 0.0)
        ahead = new + k / (k + 3) * (new - pressure)
        pressure = new
    return pressure


def _lawson_hanson(space, interference, pressure, tolerance):
    """Pressure and the sets solved for, from a first pressure and the set where it is not zero."""
    inside, sets = pressure > 0, 0
    while True:
        while inside.any() and sets < MAX_SETS:
            wanted = _solve_inside(space, inside, interference)
            sets += 1
            if (wanted[inside] > 0).all():
                pressure = wanted
                break
            # Step towards the solution until the first pressure reaches zero; its point leaves.
            falling = inside & (wanted <= 0)
            shares = pressure[falling] / (pressure[falling] - wanted[falling])
            share = shares.min()
            pressure = pressure + share * (wanted - pressure)
            inside = inside & (pressure > 0)
            inside[falling] &= shares > share
            pressure[~inside] = 0.0
        gap = space.convolve(pressure) - interference
        gap[inside] = 0.0
        deepest = np.unravel_index(gap.argmin(), gap.shape)
        if gap[deepest] >= -tolerance or sets >= MAX_SETS:
            return np.maximum(pressure, 0.0), sets
        inside[deepest] = True


def _solve_inside(space, inside, interference):
    """Pressure that closes the gap on a set exactly, zero outside."""
    matrix = influence_matrix(space, inside, inside) * (space.modulus / space.cell)
    factor = linalg.cho_factor(matrix, lower=True, overwrite_a=True, check_finite=False)
    pressure = np.zeros(space.shape)
    pressure[inside] = linalg.cho_solve(factor, interference[inside])
    return pressure
