"""The contact algorithm of Borri-Brunetto, Carpinteri and Chiaia (1999), sect. 4, as published.

Start from all interpenetrating points, solve eq. 3 on them by Gauss-Seidel, keep the points in
compression, repeat. Points are dropped, never added. The procedure does not ensure
that a dropped point stays open: the final check does.

With ``HalfSpace(..., kernel=...)`` the influence terms are Love's or a rigid plate's.
"""

import numpy as np

from roughcontact.contact.state import ContactState
from roughcontact.kernel_cache import njit

from .common import ContactProblem
from .gauss_seidel import relieve
from .method import Method

# Sweeps on one set before giving up: 500 over all sets sufficed for 12,000 interpenetrating nodes.
MAX_SWEEPS = 5000
# Tolerance of each set over that of the final check.
SAFETY = 0.3


def solve(problem: ContactProblem) -> ContactState:
    """State by dropping points in tension from all interpenetrating ones, whatever the start.

    ``iterations`` count the Gauss-Seidel sweeps. NotConverged if Gauss-Seidel does not converge, or
    a dropped point is left interpenetrating.
    """
    space, closure = problem.space, problem.load
    tolerance = SAFETY * problem.rtol
    influence = space.influence()
    interference = 1 - problem.clearance / closure
    rows, columns = np.nonzero(interference > 0)
    values = np.zeros(rows.size)
    sweeps, reason = 0, "a point dropped in tension was left interpenetrating"
    while True:
        target = interference[rows, columns]
        done = _gauss_seidel(influence, rows, columns, target, values, tolerance, MAX_SWEEPS)
        sweeps += done
        if done > MAX_SWEEPS:
            reason = f"Gauss-Seidel did not converge in {MAX_SWEEPS} sweeps"
            break
        kept = values > 0
        if kept.all():
            break
        rows, columns, values = rows[kept], columns[kept], values[kept]
    pressure = np.zeros(space.shape)
    pressure[rows, columns] = np.maximum(values, 0.0) * closure * space.modulus / space.cell
    return problem.checked_state(pressure, closure, iterations=sweeps, reason=reason)


@njit(cache=True)
def _gauss_seidel(influence, rows, columns, target, values, tolerance, max_sweeps):
    """Solve sum_s H_rs f_s = target_r in place; returns the sweeps done, max_sweeps + 1 if in vain.

    The remaining right side is updated with every change, so that each sweep ends with its
    residual.
    """
    left = target.copy()
    for s in range(rows.size):
        relieve(influence, rows, columns, s, values[s], left)
    for sweep in range(max_sweeps + 1):
        worst = 0.0
        for r in range(rows.size):
            worst = max(worst, abs(left[r]))
        if worst <= tolerance:
            return sweep
        for s in range(rows.size):
            change = left[s] / influence[0, 0]
            values[s] += change
            relieve(influence, rows, columns, s, change, left)
    return max_sweeps + 1


METHODS = [
    Method(
        name="paper",
        order=20,
        title="the paper's algorithm",
        loads=("closure",),  # as the paper imposes it
        counts="sweeps",
        largest=12_000,
        solver=solve,
    )
]
