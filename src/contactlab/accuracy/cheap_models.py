"""Models cheaper than elastic contact at full resolution, to see where they are good enough.

The bearing area cuts the rigid topography with a plane. On a Winkler foundation every node yields
alone. A coarse grid is solved elastically, and its result extrapolated to the requested spacing by
the change between two coarse spacings.

All models take the composite topography, mm, the half-space and the closure w, mm, from first touch
of the whole topography; ValueError if the closure is not valid.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from roughcontact.contact.preconditioner import forget_preconditioner
from roughcontact.contact.solve import checked_problem, solve_contact
from roughcontact.elastic.halfspace import HalfSpace, rectangle_mean_displacement

#: Tolerance of the coarse solves: far below the error of the coarse grid itself.
COARSE_RTOL = 1e-4
#: Order in s of the error of the force on sampled rough surfaces. Measured on 24 problems (H 0.5
#: and 0.8, 256 and 512 nodes per side, 1 to 20 % in contact), first order leaves 0.3 %
#: of the force from the spacings 2 s and 4 s. Samples did better than the largest, or the mean, of
#: each 2 x 2 nodes.
FORCE_ORDER = 1


@dataclass(frozen=True)
class CheapState:
    """State of contact by a cheap model; NaN where the model has no such quantity.

    ``pressure`` (ny, nx) is in MPa, ``in_contact`` (my, mx) the contact domain on the model's own
    grid; ``closure``, ``force`` and ``area`` are in mm, N and mm2.
    """

    pressure: np.ndarray
    in_contact: np.ndarray
    closure: float
    force: float
    area: float


def bearing_area(composite: ArrayLike, space: HalfSpace, *, closure: float) -> CheapState:
    """Contact without elasticity: the bearing area above a plane (Abbott and Firestone 1933).

    A force is not defined.
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

    The modulus is that of the window uniformly loaded: its mean settlement under a pressure p on a
    half-space is 0.9464 p b / E* for a square of side b. The load as a whole then sinks in as far
    as on the half-space; single spots of contact sink in too far.
    """
    sides = [n * d for n, d in zip(space.shape, space.spacing, strict=True)]
    return space.modulus / rectangle_mean_displacement(*sides)


def winkler(composite: ArrayLike, space: HalfSpace, *, closure: float) -> CheapState:
    """Contact on a Winkler foundation, :func:`foundation_modulus`: p = k (w - c) where w > c."""
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

    Force and area are extrapolated to the spacing s, NaN where the coarsest grid does not touch;
    the force by an error of order `FORCE_ORDER` in s, the area by the power law A_r ~ s^a of
    self-affine surfaces (eq. 5 of the paper), which two spacings determine. Pressure and contact
    domain are those of the finer of the two grids. Errors are those of
    `fractalcontact.solve_contact`.
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
    """State on every ``factor``-th node, with the first touch of all nodes."""
    sample = height[::factor, ::factor]
    left = max(closure - (height.max() - sample.max()), 0.0)
    coarse = space.coarser(factor)
    forget_preconditioner(coarse)
    return solve_contact(sample, coarse, closure=left, rtol=COARSE_RTOL)
