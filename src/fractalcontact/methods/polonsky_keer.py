"""Constrained conjugate gradients of Polonsky and Keer (Wear 231 (1999) 206, sect. 2.4).

As published for a given force: two applications of the operator an iteration, one for the gap, one
for the length of the step; the direction starts anew whenever overlapping points enter. A given
closure needs neither the mean gap nor the rescaling of the pressure. There the pressure may be
capped at a hardness as by Almqvist et al. (Tribol. Int. 40 (2007) 574): points at the cap are left
out of the contact set until their gap opens. Under a given force the rescaling and the cap disturb
each other; that is not offered.

One thing differs: the authors stop when the pressure changes little, which says nothing of the
error; here the iteration ends when the contact conditions hold.
"""

import numpy as np

from ..contact.solve import checked_hardness, checked_problem
from ..contact.state import unloaded_state
from .common import checked_state, in_stress

# Two applications each: rough scenes need 30 to 150 for 1e-6.
MAX_ITERATIONS = 5000
# The iteration ends this far below the tolerance of the final check.
SAFETY = 0.9
# Closures, mm, between which the squares of gaps so much smaller still are numbers.
LEAST_CLOSURE, MOST_CLOSURE = 1e-140, 1e140


def solve_contact(
    composite, space, *, closure=None, force=None, start=None, rtol=1e-6, hardness=None
):
    """Press a composite topography against a rigid plane by constrained conjugate gradients.

    Parameters
    ----------
    composite : (ny, nx) array_like
        Composite topography h, mm.
    space : HalfSpace
        The elastic operator on the same grid.
    closure : float, optional
        w, mm, from first touch. Either this or ``force`` is given.
    force : float, optional
        F, N.
    start : ContactState, optional
        Its pressure is where the iteration starts.
    rtol : float
        Largest violation allowed of the contact conditions, as a share of the closure.
    hardness : float, optional
        Largest pressure, MPa; with a closure only.

    Returns
    -------
    ContactState
        Its ``iterations`` count the applications of the operator, the final check left out.

    Raises
    ------
    ValueError
        If both a force and a hardness are given, or as `fractalcontact.solve_contact`.
    NotConverged
        If the conditions are not met after `MAX_ITERATIONS`.
    """
    load, clearance = checked_problem(composite, space, closure, force, start, rtol)
    if hardness is not None and force is not None:
        raise ValueError("conjugate gradients take a hardness with a closure only: give closure=")
    limit = checked_hardness(hardness, space, None)
    if load == 0:
        return unloaded_state(space, clearance)
    if force is None and not LEAST_CLOSURE <= load <= MOST_CLOSURE:
        raise ValueError(
            f"closure {load:g} mm: conjugate gradients square gaps; expected "
            f"{LEAST_CLOSURE:g} to {MOST_CLOSURE:g} mm"
        )
    # Pressure is counted in units of E*/s throughout, so that the operator gives mm.
    unit = space.modulus / space.cell
    total = None if force is None else force / (space.cell_area * unit)
    pressure, applications = _first_pressure(space, clearance, closure, total, start, unit)
    pressure, closure, more = _iterate(
        space, clearance, pressure, closure, total, limit / unit, SAFETY * rtol
    )
    applications += more
    return checked_state(
        space,
        clearance,
        in_stress(pressure, unit, limit),
        closure,
        force=force,
        iterations=applications,
        rtol=rtol,
        reason=f"constrained conjugate gradients stopped after {applications} applications",
        hardness=limit,
    )


def _first_pressure(space, clearance, closure, total, start, unit):
    """Pressure to start from, and the applications it took.

    Given a force, the authors' uniform pressure. Given a closure, pressure in proportion to the
    interference, by the factor that leaves the least energy.
    """
    if start is not None and start.pressure.any():
        return start.pressure / unit, 0
    if total is not None:
        return np.full(space.shape, total / clearance.size), 0
    interference = np.maximum(closure - clearance, 0.0)
    energy = np.vdot(interference, space.convolve(interference))
    return interference * (np.vdot(interference, interference) / energy), 1


def _iterate(space, clearance, pressure, closure, total, limit, tolerance):
    """Pressure, closure and applications once conditions hold to ``tolerance``, or in vain."""
    by_force = total is not None
    pressure = np.minimum(pressure, limit)
    direction = np.zeros(space.shape)
    # The first step's length where no point is free to give one: K is near 1 on a point itself.
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
