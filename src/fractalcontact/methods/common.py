"""What the comparison solvers share: summation without FFT, and the final check of a state."""

import numpy as np

from ..contact import ContactState, NotConverged


def sum_displacement(space, pressure):
    """Displacement under a pressure by direct summation over the loaded cells.

    Parameters
    ----------
    space : HalfSpace
    pressure : (ny, nx) ndarray
        MPa.

    Returns
    -------
    (ny, nx) ndarray
        Displacement in mm.
    """
    ny, nx = space.shape
    table = space.influence()
    # The influence at every distance of either sign, so that a load's field is one slice of it.
    around = table[np.abs(np.arange(1 - ny, ny))][:, np.abs(np.arange(1 - nx, nx))]
    displacement = np.zeros(space.shape)
    for j, i in np.argwhere(pressure):
        field = around[ny - 1 - j : 2 * ny - 1 - j, nx - 1 - i : 2 * nx - 1 - i]
        displacement += pressure[j, i] * field
    return displacement * (space.cell / space.modulus)


def checked_state(space, clearance, pressure, closure, *, force, iterations, rtol, reason):
    """The state of a pressure, once its contact conditions have been verified.

    Parameters
    ----------
    space : HalfSpace
    clearance : (ny, nx) ndarray
        Opening at first touch, mm.
    pressure : (ny, nx) ndarray
        MPa, not negative.
    closure : float
        w > 0, mm.
    force : float or None
        F asked for, N, if any.
    iterations : int
        What the method counts as its work.
    rtol : float
        Largest violation allowed, as in `fractalcontact.solve_contact`.
    reason : str
        What to say if it is exceeded.

    Raises
    ------
    NotConverged
        If a point in contact is not closed, a point outside penetrates, or the force is another.
    """
    displacement = sum_displacement(space, pressure)
    gap = displacement + clearance - closure
    total = float(pressure.sum()) * space.cell_area
    residual = max(np.abs(gap[pressure > 0]).max(initial=0.0), -gap.min()) / closure
    if force is not None:
        residual = max(residual, abs(total / force - 1))
    state = ContactState(
        pressure=pressure,
        displacement=displacement,
        gap=gap,
        closure=closure,
        force=total,
        residual=float(residual),
        iterations=iterations,
        space=space,
    )
    if not residual <= rtol:
        raise NotConverged(reason, state, state.residual)
    return state
