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
    """A quantity of a domain less that of its null models: 95 % intervals; NaN where there is none.

    They hold what other parts of the window would change of the domain's, and the scatter of the
    random nodes: that one domain lies outside a narrow band shows nothing of domains like it.
    """

    random_low: float
    """Less that of as many random nodes."""
    random_high: float
    cut_low: float = float("nan")
    """Less that of the bearing-area cut."""
    cut_high: float = float("nan")


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
    random, cut = (
        np.array(
            [(getattr(one, f"{null}_low"), getattr(one, f"{null}_high")) for one in comparisons]
        )
        for null in ("random", "cut")
    )
    if np.isnan(random).any():
        return UNDETERMINED
    if not leave_zero_out(random):
        return LIKE_RANDOM
    if not surface:
        return BEYOND_RANDOM
    if np.isnan(cut).any():
        return UNDETERMINED
    return BEYOND_BOTH if leave_zero_out(cut) else LIKE_CUT


def leave_zero_out(intervals: np.ndarray) -> bool:
    """Whether every one of the intervals, (n, 2), does."""
    return bool(((intervals[:, 0] > 0) | (intervals[:, 1] < 0)).all())


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
