"""Departure of a contact domain from its null models: the one rule that decides it.

Captions, statements and measured maps quote these words. A domain is called fractal only where
:func:`is_fractal` says so.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

BEYOND_BOTH = "beyond both nulls"
#: Of a set without a surface: only the random null can be asked.
BEYOND_RANDOM = "beyond random nodes, no surface to cut"
LIKE_RANDOM = "not distinguishable from random"
LIKE_CUT = "not distinguishable from the bearing-area cut"
UNDETERMINED = "undetermined"

#: Every departure there is.
DEPARTURES = (BEYOND_BOTH, BEYOND_RANDOM, LIKE_RANDOM, LIKE_CUT, UNDETERMINED)


class Comparison(NamedTuple):
    """A quantity of a domain beside its null models; NaN where there is none."""

    value: float
    random_low: float
    """Band of as many random nodes."""
    random_high: float
    difference_low: float = float("nan")
    """Interval of the value less that of the bearing-area cut."""
    difference_high: float = float("nan")


def departure_of(comparisons: Sequence[Comparison], *, surface: bool) -> str:
    """How a domain departs from its null models, by one quantity or several together.

    Parameters
    ----------
    comparisons : sequence of Comparison
        Of one domain. Several estimates of one dimension have to depart together: what one of them
        shows alone is the estimator's. (They may depart to different sides. Where points alone
        cross over to full boxes, slopes over different ranges of sizes do.)
    surface : bool
        Whether there is a composite topography, and so a bearing-area cut.

    Returns
    -------
    str
        One of :data:`DEPARTURES`.
    """
    values = np.array([one.value for one in comparisons])
    low = np.array([one.random_low for one in comparisons])
    high = np.array([one.random_high for one in comparisons])
    if not np.isfinite([values, low, high]).all():
        return UNDETERMINED
    if not ((values < low) | (values > high)).all():
        return LIKE_RANDOM
    if not surface:
        return BEYOND_RANDOM
    below = np.array([one.difference_high for one in comparisons])
    above = np.array([one.difference_low for one in comparisons])
    if np.isnan([below, above]).any():
        return UNDETERMINED
    return BEYOND_BOTH if ((below < 0) | (above > 0)).all() else LIKE_CUT


def verdict_of(departure: str, determined: bool) -> str:
    """A departure, or undetermined where the dimension itself is.

    Parameters
    ----------
    departure : str
        From :func:`departure_of`.
    determined : bool
        Whether the interval of the dimension says something.
    """
    return departure if determined else UNDETERMINED


def is_fractal(verdict: str) -> bool:
    """Whether a domain may be called fractal: determined, and beyond every null model there is.

    Parameters
    ----------
    verdict : str
        From :func:`verdict_of`.
    """
    return verdict in (BEYOND_BOTH, BEYOND_RANDOM)
