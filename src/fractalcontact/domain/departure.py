"""Departure of a contact domain from its null models: the one rule that decides it.

Captions, statements and measured maps quote these words.
"""

import math

from ..core.determined import differs
from ..core.verdicts import BEYOND_BOTH, BEYOND_RANDOM, LIKE_CUT, LIKE_RANDOM, UNDETERMINED

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
