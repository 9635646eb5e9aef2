"""Departure of a contact domain from its null models: the one rule that decides it.

Captions, statements and measured maps quote these words.
"""

import math

from ..core.determined import differs
from ..core.limits import NEARLY
from ..core.verdicts import BEYOND_BOTH, BEYOND_RANDOM, LIKE_CUT, LIKE_RANDOM, UNDETERMINED
from .slope_curves import NOT_COMPARED, Departure

#: Every departure there is.
DEPARTURES = (BEYOND_BOTH, BEYOND_RANDOM, LIKE_RANDOM, LIKE_CUT, UNDETERMINED)


def departs(departure: Departure) -> bool:
    """Departure of a domain from a null model, by significance and by margin.

    With thousands of nodes in contact local slopes that differ by 0.002 do so significantly.
    """
    return differs(departure.p) and departure.size >= NEARLY


def departure_of(random: Departure, cut: Departure = NOT_COMPARED, *, surface: bool) -> str:
    """Departure of a domain from its null models, by its curve of local slopes.

    The curve decides alone. It holds all box sides; the correlation dimension, one slope over the
    smaller of them, has to follow where it differs, and asked for as well it only hid what the
    curves show.

    Parameters
    ----------
    random, cut : Departure
        From random nodes, and from the bearing-area cut.
    surface : bool
        Whether there is a composite topography, and so a bearing-area cut.

    Returns
    -------
    str
        One of :data:`DEPARTURES`.
    """
    if math.isnan(random.p):
        return UNDETERMINED
    if not departs(random):
        return LIKE_RANDOM
    if not surface:
        return BEYOND_RANDOM
    if math.isnan(cut.p):
        return UNDETERMINED
    return BEYOND_BOTH if departs(cut) else LIKE_CUT
