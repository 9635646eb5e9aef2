"""Seat of a joint: the load from which a laboratory counts its closure."""

import numpy as np
from numpy.typing import ArrayLike

from ..core.limits import PRESSURE_ROUNDING


def seat_of(loads: ArrayLike, stated: float, decided: ArrayLike = True) -> np.ndarray:
    """Lightest load from the stated seat on at which contact is decided; NaN where there is none.

    Parameters
    ----------
    loads : (load,) array_like
        Forces, N, or pressures, MPa.
    stated : float
        Load from which the study lets a joint be seated, in the unit of ``loads``.
    decided : (..., load) bool array_like, optional
        Loads whose contact is decided: their state is solved, and enough nodes touch in it. All
        loads if left out.

    Returns
    -------
    (...) ndarray
        In the unit of ``loads``.
    """
    loads = np.asarray(loads, float)
    usable = np.logical_and(decided, loads >= stated * (1 - PRESSURE_ROUNDING))
    lightest = np.where(usable, loads, np.inf).min(axis=-1, initial=np.inf)
    return np.where(np.isfinite(lightest), lightest, np.nan)


def closure_from(
    closure: np.ndarray, loads: np.ndarray, seat: float, on_loading: np.ndarray | None = None
) -> np.ndarray:
    """Closures (..., load) counted from that under the load of the seat, NaN below it.

    The seat has the unit of ``loads`` (load,). All closures are NaN where it is none of the loads.
    Closures of other branches count from that ``on_loading`` (load,), mm.
    """
    at_seat = np.isclose(loads, seat, rtol=PRESSURE_ROUNDING, atol=0)
    if not at_seat.any():
        return np.full(closure.shape, np.nan)
    counted_from = closure if on_loading is None else on_loading
    beyond = loads >= seat * (1 - PRESSURE_ROUNDING)
    return np.where(beyond, closure - counted_from[..., at_seat][..., :1], np.nan)
