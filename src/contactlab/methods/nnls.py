"""Non-negative least squares with a warm start (Bemporad & Paggi, Int. J. Solids Struct. 2015).

The pressures minimise p'Kp/2 - p'd under p >= 0, with the interference d: the least-squares problem
of Lawson and Hanson (1974, ch. 23) on a factor of K. Their active set admits one point at a time,
the deepest, and steps back to the first pressure that would turn negative. From zero pressure that
takes as many factorisations as there are points in contact; the warm start of Bemporad and Paggi
(vol. 69-70, p. 292), a number of accelerated gradient projections or the state before, leaves few.
"""

import numpy as np
from scipy import linalg

from roughcontact.contact.state import ContactState

from .common import ContactProblem, influence_matrix
from .method import Method

# Gradient projections for the warm start; each applies the operator once.
PROJECTIONS = 100
# Most sets solved for: theory says only that they are finite in number.
MAX_SETS = 5000
# Largest overlap of points not admitted, over the tolerance of the final check.
SAFETY = 0.3


def solve(problem: ContactProblem) -> ContactState:
    """State by non-negative least squares; ``iterations`` count the Cholesky factorisations.

    The pressure of a start replaces the gradient projections of the warm start. NotConverged if the
    active set does not end, or the state fails the final check.
    """
    space, closure = problem.space, problem.load
    # Pressure is in units of E*/s, so that the operator gives mm.
    unit = space.modulus / space.cell
    interference = closure - problem.clearance
    if problem.start is not None:
        pressure = np.where(interference > 0, problem.start.pressure / unit, 0.0)
    else:
        pressure = _gradient_projections(space, interference)
    tolerance = SAFETY * problem.rtol * closure
    pressure, sets = _lawson_hanson(space, interference, pressure, tolerance)
    return problem.checked_state(
        pressure * unit,
        closure,
        iterations=sets,
        reason=f"the active set stopped after {sets} sets",
    )


def _gradient_projections(space, interference):
    """Pressure after `PROJECTIONS` projected gradient steps with Nesterov's acceleration."""
    # The largest row sum bounds the eigenvalues of a positive operator.
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
            fractions = pressure[falling] / (pressure[falling] - wanted[falling])
            fraction = fractions.min()
            pressure = pressure + fraction * (wanted - pressure)
            inside = inside & (pressure > 0)
            inside[falling] &= fractions > fraction
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


METHODS = [
    Method(
        name="nnls",
        order=50,
        title="NNLS",
        loads=("closure",),  # as the authors impose it
        warm=True,
        counts="contact sets",
        largest=12_000,
        solver=solve,
    )
]
