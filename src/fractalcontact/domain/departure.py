"""Departure of a contact domain from its null models: the one rule that decides it.

Captions, statements and measured maps quote these words.
"""

import math

from ..core.intervals import CONFIDENCE

BEYOND_BOTH = "different from random nodes and from the bearing-area cut"
#: Of a set without a surface: only the random null can be asked.
BEYOND_RANDOM = "different from random nodes"
LIKE_RANDOM = "not separated from random nodes"
LIKE_CUT = "different from random nodes, not separated from the bearing-area cut"
UNDETERMINED = "undetermined"

#: Every departure there is.
DEPARTURES = (BEYOND_BOTH, BEYOND_RANDOM, LIKE_RANDOM, LIKE_CUT, UNDETERMINED)


def departure_of(random: float, cut: float = math.nan, *, surface: bool) -> str:
    """Departure of a domain from its null models, by its curve of local slopes.

    The curve decides alone. It holds all box sides; the correlation dimension, one slope over the
    smaller of them, has to follow where it differs, and asked for as well it only hid what the
    curves show.

    Parameters
    ----------
    random, cut : float
        Probability of so large a departure from random nodes, and from the bearing-area cut, where
        there is no difference; NaN where it is not known.
    surface : bool
        Whether there is a composite topography, and so a bearing-area cut.

    Returns
    -------
    str
        One of :data:`DEPARTURES`.
    """
    if math.isnan(random):
        return UNDETERMINED
    if not differs(random):
        return LIKE_RANDOM
    if not surface:
        return BEYOND_RANDOM
    if math.isnan(cut):
        return UNDETERMINED
    return BEYOND_BOTH if differs(cut) else LIKE_CUT


def differs(p: float) -> bool:
    """Whether a departure of this probability is a difference; not where it is not known.

    Parameters
    ----------
    p : float
        NaN where it is not known.
    """
    # The small number keeps 10 of 200 at 5 %.
    return p <= 1 - CONFIDENCE + 1e-9


def loads_of(some: int, total: int) -> str:
    """Number of loads at which something is so, in words: "no load", "3 of 7 loads", "every load".

    Parameters
    ----------
    some, total : int
    """
    if some in (0, total):
        return "every load" if some else "no load"
    return f"{some} of {total} loads"
