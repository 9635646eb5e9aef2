"""Constrained conjugate gradients of Polonsky and Keer (Wear 231 (1999) 206, sect. 2.4).

As published for a given force: two applications of the operator an iteration, one for the gap, one
for the length of the step; the direction starts anew whenever overlapping points enter. A given
closure needs neither the mean gap nor the rescaling of the pressure. There the pressure may be
capped at a hardness as by Almqvist et al. (Tribol. Int. 40 (2007) 574): points at the cap are left
out of the contact set until their gap opens. Under a given force the rescaling and the cap disturb
each other; that is not offered.

One point differs: the authors stop when the pressure changes little, which does not bound the
error; here the iteration ends when the contact conditions hold.
"""

import numpy as np

from roughcontact.contact.state import ContactState

from .common import ContactProblem, in_stress
from .method import Method

# Most iterations, of two applications each: rough surfaces need 30 to 150 for 1e-6.
MAX_ITERATIONS = 5000
# Tolerance of the iteration over that of the final check.
SAFETY = 0.9
# Closures, mm, between which squares of much smaller gaps are in the range of doubles.
MIN_CLOSURE, MAX_CLOSURE = 1e-140, 1e140


def solve(problem: ContactProblem) -> ContactState:
    """State by constrained conjugate gradients, from the pressure of a start.

    ``iterations`` count the applications of the operator without the final check. ValueError if the
    squares of gaps at the closure have no double precision, NotConverged if the conditions are not
    met after `MAX_ITERATIONS`.
    """
    space, force = problem.space, problem.force
    if force is None and not MIN_CLOSURE <= problem.load <= MAX_CLOSURE:
        raise ValueError(
            f"closure {problem.load:g} mm: conjugate gradients square gaps; expected "
            f"{MIN_CLOSURE:g} to {MAX_CLOSURE:g} mm"
        )
    # Pressure is counted in units of E*/s throughout, so that the operator gives mm.
    unit = space.modulus / space.cell
    total = None if force is None else force / (space.cell_area * unit)
    pressure, applications = _first_pressure(problem, total, unit)
    pressure, closure, more = _iterate(problem, pressure, total, problem.hardness / unit)
    applications += more
    return problem.checked_state(
        in_stress(pressure, unit, problem.hardness),
        closure,
        iterations=applications,
        reason=f"constrained conjugate gradients stopped after {applications} applications",
    )


def _first_pressure(problem, total, unit):
    """Pressure to start from, and the applications it took.

    Given a force, the authors' uniform pressure. Given a closure, pressure in proportion to the
    interference, by the factor that leaves the least energy.
    """
    start, clearance = problem.start, problem.clearance
    if start is not None and start.pressure.any():
        return start.pressure / unit, 0
    if total is not None:
        return np.full(clearance.shape, total / clearance.size), 0
    interference = np.maximum(problem.load - clearance, 0.0)
    energy = np.vdot(interference, problem.space.convolve(interference))
    return interference * (np.vdot(interference, interference) / energy), 1


def _iterate(problem, pressure, total, limit):
    """Pressure, closure and applications once the conditions hold, or in vain."""
    space, clearance, by_force = problem.space, problem.clearance, problem.by_force
    closure, tolerance = problem.load, SAFETY * problem.rtol
    pressure = np.minimum(pressure, limit)
    direction = np.zeros(space.shape)
    # The first step has length 1 where no point is free to give one: K is near 1 on a point itself.
    step, previous, conjugate, applications = 1.0, 1.0, False, 0
    if by_force:
        pressure *= total / pressure.sum()
    for iteration in range(MAX_ITERATIONS + 1):
        gap = space.convolve(pressure) + clearance
        applications += 1
        free = (pressure > 0) & (pressure < limit)
        if by_force:
            closure = gap[free].mean()
        gap -= closure
        parted = gap[pressure > 0].max(initial=0.0)
        overlap = -gap[pressure < limit].min(initial=0.0)
        if max(parted, overlap) <= tolerance * closure or iteration == MAX_ITERATIONS:
            return pressure, float(closure), applications

        norm = np.vdot(gap[free], gap[free])
        direction *= norm / previous if conjugate else 0.0
        direction += gap
        direction *= free
        previous = norm
        image = space.convolve(direction)
        applications += 1
        if by_force:
            image -= image[free].mean()
        curvature = np.vdot(image, direction)
        if curvature > 0:
            step = np.vdot(gap, direction) / curvature
        pressure = np.clip(pressure - step * direction, 0.0, limit)

        entering = ((pressure == 0) & (gap < 0)) | ((pressure == limit) & (gap > 0))
        conjugate = not entering.any()
        pressure[entering] -= step * gap[entering]
        np.clip(pressure, 0.0, limit, out=pressure)
        if by_force:
            pressure *= total / pressure.sum()


METHODS = [
    Method(
        name="polonsky-keer",
        order=30,
        title="the Polonsky-Keer iteration",
        loads=("closure", "force"),
        hardness=("closure",),
        warm=True,
        counts="applications",
        solver=solve,
    )
]
