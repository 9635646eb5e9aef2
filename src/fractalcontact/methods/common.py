"""What the comparison solvers share: the matrix, summation without FFT, and the final check."""

import numpy as np

from ..contact.state import ContactState
from ..core.errors import NotConverged

# Up to this many products (10 ms) the final check sums directly, which shares nothing with the FFT.
# The FFT is always the faster way: 400 loads on 512 x 512 take 0.5 s against 0.015 s.
LARGEST_SUM = 3_000_000


def refuse_force(method, force):
    """Say that a method takes a closure only, if a force is given."""
    if force is not None:
        raise ValueError(f"{method} takes a closure only: give closure=, not force=")


def refuse_closure(method, closure):
    """Say that a method takes a force only, if a closure is given."""
    if closure is not None:
        raise ValueError(f"{method} takes a force only: give force=, not closure=")


def refuse_hardness(method, hardness):
    """Say that a method knows no hardness, if one is given."""
    if hardness is not None:
        raise ValueError(f"{method} knows no hardness: leave hardness= out")


def influence_matrix(space, rows, columns):
    """Displacement at the nodes ``rows`` under unit pressure at the nodes ``columns``.

    Parameters
    ----------
    space : HalfSpace
    rows, columns : (ny, nx) bool ndarray
        The nodes wanted, m and n of them.

    Returns
    -------
    (m, n) ndarray
        In mm/MPa.
    """
    influence = space.influence() * (space.cell / space.modulus)
    (row_y, row_x), (column_y, column_x) = np.nonzero(rows), np.nonzero(columns)
    return influence[
        np.abs(row_y[:, None] - column_y[None, :]),
        np.abs(row_x[:, None] - column_x[None, :]),
    ]


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


def in_stress(values, unit, hardness):
    """Pressures counted in ``unit`` as MPa, those at the cap at exactly that."""
    return np.where(values >= hardness / unit, hardness, values * unit)


def measured_state(
    space, clearance, pressure, closure, *, force=None, iterations=0, hardness=np.inf
):
    """What a pressure is as a state, its violation of the contact conditions measured.

    Parameters
    ----------
    space : HalfSpace
    clearance : (ny, nx) ndarray
        Opening at first touch, mm.
    pressure : (ny, nx) ndarray
        MPa, from 0 to ``hardness``.
    closure : float
        w, mm.
    force : float or None
        F asked for, N, if any.
    iterations : int
        What the method counts as its work.
    hardness : float
        Largest pressure, MPa: where it is reached the surfaces may overlap, but not part.

    Returns
    -------
    ContactState
    """
    if np.count_nonzero(pressure) * pressure.size <= LARGEST_SUM:
        displacement = sum_displacement(space, pressure)
    else:
        displacement = space.convolve(pressure) * (space.cell / space.modulus)
    gap = displacement + clearance - closure
    total = float(pressure.sum()) * space.cell_area
    parted = gap[pressure > 0].max(initial=0.0)
    overlap = -gap[pressure < hardness].min(initial=0.0)
    # What is no number violates no condition, and must not pass for a state.
    worst = max(parted, overlap) if np.isfinite(total) else np.nan
    residual = worst / closure if worst != 0 and closure != 0 else worst
    if np.isfinite(hardness):
        residual = max(residual, pressure.max() / hardness - 1)
    if force:
        residual = max(residual, abs(total / force - 1))
    return ContactState(
        pressure=pressure,
        displacement=displacement,
        gap=gap,
        closure=closure,
        force=total,
        residual=float(residual),
        iterations=iterations,
        space=space,
        hardness=hardness,
    )


def checked_state(space, clearance, pressure, closure, *, rtol, reason, **about):
    """The state of a pressure, once its contact conditions have been verified.

    Parameters
    ----------
    space, clearance, pressure, closure, **about
        As of `measured_state`.
    rtol : float
        Largest violation allowed, as in `fractalcontact.solve_contact`.
    reason : str
        What to say if it is exceeded.

    Raises
    ------
    NotConverged
        If a point in contact is not closed, a point outside penetrates, or the force is another.
    """
    state = measured_state(space, clearance, pressure, closure, **about)
    if not state.residual <= rtol:
        raise NotConverged(reason, state, state.residual)
    return state
