"""Rule that an estimate is known well enough to be printed."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from .limits import CONFIDENCE, DECISIVE, LARGEST_DISTANCE

#: An interval whose ends are farther apart than this factor says not even the order of magnitude.
DECADE = 10.0

#: An interval narrower than this, as a fraction of its value, has left out its errors.
NO_WIDTH = 1e-6


def determined(
    value: float,
    low: float,
    high: float,
    *,
    span: float = 0.0,
    exact: Sequence[float] = (),
) -> bool:
    """True if an interval determines its quantity, so that the number may be printed.

    Parameters
    ----------
    value, low, high : float
        The estimate and its 95 % interval; NaN or infinite where there is none.
    span : float
        An interval up to this wide is narrow whatever the value, as 1 is for exponents; 0 where the
        quantity has no scale of its own.
    exact : sequence of float
        Values that need no interval: a full window has the dimension 2.

    Returns
    -------
    bool
        False where an end is missing; where the ends are farther apart than ``span``, and than a
        factor of `DECADE` or, differing in sign, than ``span`` or else `DECADE` values; and where
        they are not apart at all, as those of a line through counts that happen to lie on one.
    """
    if not np.isfinite([value, low, high]).all():
        return False
    width = high - low
    size = max(abs(low), abs(high))
    if width <= NO_WIDTH * max(size, span):
        return any(abs(value - known) <= NO_WIDTH for known in exact)
    if width <= span:
        return True
    if low * high > 0:
        return size <= DECADE * min(abs(low), abs(high))
    return span == 0 and width <= DECADE * abs(value)


def differs(p: float) -> bool:
    """Significance of a departure with this probability; not significant if it is unknown.

    Parameters
    ----------
    p : float
        NaN where it is not known.
    """
    # The small number keeps 10 of 200 at 5 %.
    return p <= 1 - CONFIDENCE + 1e-9


def differ_together(p: ArrayLike) -> np.ndarray:
    """Significance of several departures tested together, by Holm's correction.

    Parameters
    ----------
    p : (n,) array_like
        Probabilities; one that is NaN was not tested.

    Returns
    -------
    (n,) bool ndarray

    References
    ----------
    Holm, S. 1979: A simple sequentially rejective multiple test procedure. Scandinavian Journal
    of Statistics 6, 65-70.
    """
    p = np.asarray(p, float)
    found = np.zeros(p.shape, bool)
    tested = [place for place in np.argsort(p) if np.isfinite(p[place])]
    for rank, place in enumerate(tested):
        if not differs(p[place] * (len(tested) - rank)):
            break
        found[place] = True
    return found


def decided_by_scan(share: float | np.ndarray | xr.DataArray) -> Any:
    """States whose numbers errors of the scans decide: suspicious cells carry most of the load.

    Parameters
    ----------
    share : float, ndarray or xr.DataArray
        Fraction of the force on suspicious cells; NaN where it is not known.

    Returns
    -------
    bool, or array of bool
    """
    return share > DECISIVE


def follows_law(clusters: Any, distance: Any) -> Any:
    """Agreement of cluster sizes with their power law, to the distance that chance allows.

    Parameters
    ----------
    clusters, distance : float or array_like
        ``cluster_fit_n`` and ``cluster_fit_distance``.

    Returns
    -------
    bool, or array of bool
    """
    return distance * np.sqrt(clusters) <= LARGEST_DISTANCE
