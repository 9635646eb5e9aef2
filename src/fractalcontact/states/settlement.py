"""Closure and stiffness of the interface: those of the window without the blocks.

They lie below the laws of closure, so that a new law solves no state again.
"""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from roughcontact.elastic.halfspace import HalfSpace, rectangle_mean_displacement

from ..core.settings import FREE

_Numbers = float | np.ndarray | xr.DataArray


def bulk_settlement(
    force: ArrayLike, e_star: float, side_y: float, side_x: float, boundary: str = FREE
) -> np.ndarray:
    """w_b, mm: mean settlement under the force spread evenly over the nominal window.

    For a free square of side b, w_b = 0.946402 F/(E* b). A periodic or mirrored window goes on
    beyond its edges: an even pressure leaves no bowl in it, the closure is the approach of the mean
    planes, and w_b = 0.

    Parameters
    ----------
    force : array_like
        F, N.
    e_star : float
        E*, MPa.
    side_y, side_x : float
        Sides of the window, mm.
    boundary : str
        "free", "periodic" or "mirrored", as of :class:`roughcontact.HalfSpace`.
    """
    if boundary != FREE:
        return np.zeros_like(np.asarray(force), dtype=float)
    mean = rectangle_mean_displacement(side_y, side_x)
    return np.asarray(force) / (side_y * side_x) * mean / e_star


def window_settlement(space: HalfSpace, force: ArrayLike) -> np.ndarray:
    """Bulk settlement w_b, mm, of the window of a half-space under a force, N."""
    side_y, side_x = np.multiply(space.shape, space.spacing)
    return bulk_settlement(force, space.modulus, side_y, side_x, boundary=space.boundary)


def interface_closure(closure: _Numbers, settlement: _Numbers, flush: Any = False) -> Any:
    """Interface closure w_int = w - w_b, mm.

    Parameters
    ----------
    closure : float, ndarray or xr.DataArray
        w, mm.
    settlement : float, ndarray or xr.DataArray
        w_b, mm, from :func:`bulk_settlement`.
    flush : bool, ndarray or xr.DataArray
        Where faces match everywhere (a composite topography that is flat).

    Returns
    -------
    ndarray or xr.DataArray
        0 where faces are flush: they have nothing to close. The difference would be
        -0.078 F/(E* b) there, because a flush window is loaded like a rigid punch and w_b belongs
        to a uniform pressure.
    """
    closing = closure - settlement
    if isinstance(closing, xr.DataArray):  # xr.where drops labels of coordinates
        return closing.where(~flush, 0.0)
    return np.where(flush, 0.0, closing)


def interface_stiffness(compliance: _Numbers, bulk: _Numbers) -> Any:
    """Stiffness of the interface alone, MPa/mm: 1/k_int = 1/k - 1/k_bulk.

    Parameters
    ----------
    compliance : float, ndarray or xr.DataArray
        1/k = dw/d sigma_0 of interface and blocks together, mm/MPa.
    bulk : float, ndarray or xr.DataArray
        1/k_bulk = w_b/sigma_0, mm/MPa, with w_b from :func:`bulk_settlement`.

    Returns
    -------
    ndarray or xr.DataArray
        NaN where the whole is no more compliant than the bulk: contact is so full that it answers
        like a punch.
    """
    left = compliance - bulk
    return 1 / xr.where(left > 0, left, np.nan)
