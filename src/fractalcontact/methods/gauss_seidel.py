"""Projected Gauss-Seidel: one point after another closed or released, no pressure below zero.

C. W. Cryer, SIAM J. Control 9 (1971) 385, without over-relaxation. Each sweep costs the square of
the number of interpenetrating points. A pressure capped at a hardness is projected on both sides.
"""

import numpy as np

from ..contact.solve import checked_hardness, checked_problem
from ..contact.state import unloaded_state
from ..core.kernel_cache import njit
from .common import checked_state, in_stress, refuse_force

# Sweeps before giving up: the number needed grows with the width of the contact patches in cells.
MAX_SWEEPS = 5000
# The sweeps end this far below the tolerance of the final check.
SAFETY = 0.3


def solve_contact(
    composite, space, *, closure=None, force=None, start=None, rtol=1e-6, hardness=None
):
    """Press a composite topography against a rigid plane by projected Gauss-Seidel.

    Parameters
    ----------
    composite : (ny, nx) array_like
        Composite topography h, mm.
    space : HalfSpace
        Gives the kernel at every cell distance.
    closure : float
        w, mm, from first touch.
    force : None
        Not offered: a sum to be kept is no bound on a single point.
    start : ContactState, optional
        Its pressure is where the sweeps start.
    rtol : float
        Largest violation allowed of the contact conditions, as a share of the closure.
    hardness : float, optional
        Largest pressure, MPa.

    Returns
    -------
    ContactState
        Its ``iterations`` count the sweeps.

    Raises
    ------
    ValueError
        If a force is given, or as `fractalcontact.solve_contact`.
    NotConverged
        If `MAX_SWEEPS` were not enough.
    """
    refuse_force("projected Gauss-Seidel", force)
    closure, clearance = checked_problem(composite, space, closure, None, start, rtol)
    limit = checked_hardness(hardness, space, None)
    if closure == 0:
        return unloaded_state(space, clearance)
    # As u >= 0, only interpenetrating points can touch.
    rows, columns = np.nonzero(clearance < closure)
    unit = closure * space.modulus / space.cell
    values = np.zeros(rows.size)
    if start is not None:
        values = np.minimum(start.pressure[rows, columns], limit) / unit
    sweeps = _sweep(
        space.influence(),
        rows,
        columns,
        1 - clearance[rows, columns] / closure,
        values,
        limit / unit,
        SAFETY * rtol,
        MAX_SWEEPS,
    )
    pressure = np.zeros(space.shape)
    pressure[rows, columns] = in_stress(values, unit, limit)
    return checked_state(
        space,
        clearance,
        pressure,
        closure,
        force=None,
        iterations=sweeps,
        rtol=rtol,
        reason=f"projected Gauss-Seidel stopped after {sweeps} sweeps",
        hardness=limit,
    )


@njit(cache=True)
def relieve(influence, rows, columns, s, change, left):
    """Take from ``left`` at all points what a change of pressure at point s displaces them by."""
    for r in range(rows.size):
        left[r] -= influence[abs(rows[r] - rows[s]), abs(columns[r] - columns[s])] * change


@njit(cache=True)
def _sweep(influence, rows, columns, interference, values, limit, tolerance, max_sweeps):
    """Sweep in place until the conditions hold to ``tolerance``; the number of sweeps done.

    ``left`` is the overlap still there, carried along, so that a sweep ends with its residual.
    """
    left = interference.copy()
    for s in range(rows.size):
        if values[s] != 0:
            relieve(influence, rows, columns, s, values[s], left)
    for sweep in range(max_sweeps):
        worst = 0.0
        for r in range(rows.size):
            if values[r] > 0:
                worst = max(worst, -left[r])
            if values[r] < limit:
                worst = max(worst, left[r])
        if worst <= tolerance:
            return sweep
        for s in range(rows.size):
            value = min(max(values[s] + left[s] / influence[0, 0], 0.0), limit)
            change = value - values[s]
            if change != 0:
                values[s] = value
                relieve(influence, rows, columns, s, change, left)
    return max_sweeps
