"""Rule for the estimates that are precise enough to be printed."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from .limits import CONFIDENCE, DECISIVE, LARGEST_DISTANCE

#: Largest ratio of the ends of an interval; beyond it not even the order of magnitude is known.
DECADE = 10.0

#: Least width of an interval, as a fraction of its value; a narrower one has left out its errors.
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
        The estimate and its 95 % interval; NaN or infinite if missing.
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
        the ends are equal, as those of a line through counts that happen to lie on one.
    """
    if not np.isfinite([value, low, high]).all():
        return False
    width = high - low
    size = max(abs(low), abs(high))
    if width <= NO_WIDTH * max(size, span):
        return any(abs(value - number) <= NO_WIDTH for number in exact)
    if width <= span:
        return True
    if low * high > 0:
        return size <= DECADE * min(abs(low), abs(high))
    return span == 0 and width <= DECADE * abs(value)


def differs(p: float) -> bool:
    """Significance of a departure with this probability; not significant if it is NaN."""
    # The small number makes 10 of 200 significant at 5 %.
    return p <= 1 - CONFIDENCE + 1e-9


def differ_together(p: ArrayLike) -> np.ndarray:
    """Significance (n,) of departures tested together, by Holm's correction; NaN was not tested.

    Holm, S. 1979: A simple sequentially rejective multiple test procedure. Scandinavian Journal
    of Statistics 6, 65-70.
    """
    p = np.asarray(p, float)
    significant = np.zeros(p.shape, bool)
    tested = [place for place in np.argsort(p) if np.isfinite(p[place])]
    for rank, place in enumerate(tested):
        if not differs(p[place] * (len(tested) - rank)):
            break
        significant[place] = True
    return significant


def decided_by_scan(share: float | np.ndarray | xr.DataArray) -> Any:
    """States whose numbers errors of the scans decide: suspicious cells carry most of the load.

    ``share`` is the fraction of the force on suspicious cells; False where it is NaN.
    """
    return share > DECISIVE


def follows_law(clusters: Any, distance: Any) -> Any:
    """Agreement of cluster sizes with their power law, to the distance that chance allows.

    Arguments are ``cluster_fit_n`` and ``cluster_fit_distance``.
    """
    return distance * np.sqrt(clusters) <= LARGEST_DISTANCE
