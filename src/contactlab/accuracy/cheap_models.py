"""Models cheaper than elastic contact at full resolution, to see where they are good enough.

The bearing area cuts the topography with a plane and lets nothing give way. A Winkler foundation
lets every node give way alone. A coarse grid is solved elastically, and its result extrapolated to
the spacing asked for by what happens between two coarse spacings.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from roughcontact.contact.preconditioner import forget_preconditioner
from roughcontact.contact.solve import checked_problem, solve_contact
from roughcontact.elastic.halfspace import HalfSpace, rectangle_mean_displacement

#: Tolerance of the coarse solves: far below what the coarse grid itself is off by.
COARSE_RTOL = 1e-4
#: Order in s of the error of the force on sampled rough surfaces. Measured on 24 problems (H 0.5
#: and 0.8, 256 and 512 nodes per side, 1 to 20 % in contact), first order leaves 0.3 %
#: of the force from the spacings 2 s and 4 s. Samples did better than the largest, or the mean, of
#: each 2 x 2 nodes.
FORCE_ORDER = 1


@dataclass(frozen=True)
class CheapState:
    """State of contact by a cheap model.

    Attributes
    ----------
    pressure : (ny, nx) ndarray
        MPa; NaN where the model has none.
    in_contact : (my, mx) bool ndarray
        Contact domain, on the model's own grid.
    closure, force, area : float
        mm, N and mm2; NaN where the model has none.
    """

    pressure: np.ndarray
    in_contact: np.ndarray
    closure: float
    force: float
    area: float


def bearing_area(composite: ArrayLike, space: HalfSpace, *, closure: float) -> CheapState:
    """Contact without elasticity: the bearing area above a plane (Abbott and Firestone 1933).

    Parameters
    ----------
    composite : (ny, nx) array_like
        mm.
    space : HalfSpace
        Of which only the grid counts.
    closure : float
        w, mm, from first touch: the plane's depth.

    Returns
    -------
    CheapState
        Without a force: none is defined.

    Raises
    ------
    ValueError
        If the closure makes no sense.
    """
    closure, clearance = checked_problem(composite, space, closure, None, None, 0.5)
    in_contact = clearance < closure
    return CheapState(
        pressure=np.where(in_contact, np.nan, 0.0),
        in_contact=in_contact,
        closure=closure,
        force=np.nan,
        area=np.count_nonzero(in_contact) * space.cell_area,
    )


def foundation_modulus(space: HalfSpace) -> float:
    """Foundation modulus p / u of the Winkler model, MPa/mm.

    Notes
    -----
    That of the window uniformly loaded: its mean settlement under a pressure p on a half-space is
    0.9464 p b / E* for a square of side b. The load as a whole then sinks in as far as on the
    half-space; single spots of contact sink in too far.
    """
    sides = [n * d for n, d in zip(space.shape, space.spacing, strict=True)]
    return space.modulus / rectangle_mean_displacement(*sides)


def winkler(composite: ArrayLike, space: HalfSpace, *, closure: float) -> CheapState:
    """Contact on a Winkler foundation: every node gives way alone, p = k (w - c) where w > c.

    Parameters
    ----------
    composite : (ny, nx) array_like
        mm.
    space : HalfSpace
        Its grid and modulus make the foundation, see `foundation_modulus`.
    closure : float
        w, mm, from first touch.

    Raises
    ------
    ValueError
        If the closure makes no sense.
    """
    closure, clearance = checked_problem(composite, space, closure, None, None, 0.5)
    pressure = foundation_modulus(space) * np.maximum(closure - clearance, 0.0)
    in_contact = pressure > 0
    return CheapState(
        pressure=pressure,
        in_contact=in_contact,
        closure=closure,
        force=float(pressure.sum()) * space.cell_area,
        area=np.count_nonzero(in_contact) * space.cell_area,
    )


def coarse_grid(composite: ArrayLike, space: HalfSpace, *, closure: float) -> CheapState:
    """Elastic contact on every second node, extrapolated with the help of every fourth.

    Parameters
    ----------
    composite : (ny, nx) array_like
        mm.
    space : HalfSpace
    closure : float
        w, mm, from first touch of the whole topography.

    Returns
    -------
    CheapState
        Force and area extrapolated to the spacing s, NaN where the coarsest grid does not touch;
        pressure and contact domain those of the finer of the two grids.

    Raises
    ------
    ValueError, NotConverged
        As `fractalcontact.solve_contact`.

    Notes
    -----
    The force by an error of order `FORCE_ORDER` in s; the area by the power law A_r ~ s^a of
    self-affine surfaces (eq. 5 of the paper), which two spacings determine.
    """
    closure, _ = checked_problem(composite, space, closure, None, None, COARSE_RTOL)
    height = np.asarray(composite, float)
    finer, coarser = (_sampled(height, space, closure, factor) for factor in (2, 4))
    ny, nx = space.shape
    spread = np.repeat(np.repeat(finer.pressure, 2, axis=0), 2, axis=1)[:ny, :nx]
    force = finer.force + (finer.force - coarser.force) * (
        (1 - 2.0**-FORCE_ORDER) / (2.0**FORCE_ORDER - 1)
    )
    touching = coarser.area > 0
    return CheapState(
        pressure=spread,
        in_contact=finer.in_contact,
        closure=closure,
        force=force if touching else np.nan,
        area=finer.area * (finer.area / coarser.area) if touching else np.nan,
    )


def _sampled(height, space, closure, factor):
    """State on every ``factor``-th node, with the plane where it is for all of them."""
    sample = height[::factor, ::factor]
    left = max(closure - (height.max() - sample.max()), 0.0)
    coarse = space.coarser(factor)
    forget_preconditioner(coarse)
    return solve_contact(sample, coarse, closure=left, rtol=COARSE_RTOL)
