"""Projected Gauss-Seidel: one point after another closed or released, no pressure below zero.

C. W. Cryer, SIAM J. Control 9 (1971) 385, without over-relaxation. Each sweep costs the square of
the number of interpenetrating points. A pressure capped at a hardness is projected on both sides.
"""

import numpy as np

from roughcontact.contact.state import ContactState
from roughcontact.kernel_cache import njit

from .common import ContactProblem, in_stress
from .method import Method

# Sweeps before giving up: the number needed grows with the width of the contact patches in cells.
MAX_SWEEPS = 5000
# Tolerance of the sweeps over that of the final check.
SAFETY = 0.3


def solve(problem: ContactProblem) -> ContactState:
    """State by projected Gauss-Seidel, from the pressure of a start; ``iterations`` are sweeps.

    NotConverged if `MAX_SWEEPS` were not enough.
    """
    space, clearance, limit = problem.space, problem.clearance, problem.hardness
    closure = problem.load
    # As u >= 0, only interpenetrating points can touch.
    rows, columns = np.nonzero(clearance < closure)
    unit = closure * space.modulus / space.cell
    values = np.zeros(rows.size)
    if problem.start is not None:
        values = np.minimum(problem.start.pressure[rows, columns], limit) / unit
    sweeps = _sweep(
        space.influence(),
        rows,
        columns,
        1 - clearance[rows, columns] / closure,
        values,
        limit / unit,
        SAFETY * problem.rtol,
        MAX_SWEEPS,
    )
    pressure = np.zeros(space.shape)
    pressure[rows, columns] = in_stress(values, unit, limit)
    return problem.checked_state(
        pressure,
        closure,
        iterations=sweeps,
        reason=f"projected Gauss-Seidel stopped after {sweeps} sweeps",
    )


@njit(cache=True)
def relieve(
    influence: np.ndarray,
    rows: np.ndarray,
    columns: np.ndarray,
    s: int,
    change: float,
    left: np.ndarray,
) -> None:
    """Subtract from ``left`` the displacements by a change of pressure at point s."""
    for r in range(rows.size):
        left[r] -= influence[abs(rows[r] - rows[s]), abs(columns[r] - columns[s])] * change


@njit(cache=True)
def _sweep(influence, rows, columns, interference, values, limit, tolerance, max_sweeps):
    """Sweep in place until the conditions hold to ``tolerance``; the number of sweeps done.

    ``left`` is the remaining overlap, updated with every change, so that a sweep ends with its
    residual.
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


METHODS = [
    Method(
        name="gauss-seidel",
        order=40,
        title="projected Gauss-Seidel",
        # A given force is a constraint on a sum, which the projection of single points lacks.
        loads=("closure",),
        hardness=("closure",),
        warm=True,
        counts="sweeps",
        largest=12_000,
        solver=solve,
    )
]
