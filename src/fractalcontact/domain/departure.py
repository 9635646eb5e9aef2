"""Departure of a contact domain from its null models: the one rule that decides it.

Captions, statements and measured maps quote these words.
"""

import math

from ..core.determined import differs
from ..core.limits import NEARLY
from ..core.verdicts import BEYOND_BOTH, BEYOND_RANDOM, LIKE_CUT, LIKE_RANDOM, UNDETERMINED
from .slope_curves import NOT_COMPARED, Departure


def departs(departure: Departure) -> bool:
    """Departure of a domain from a null model, by significance and by margin.

    With thousands of nodes in contact local slopes that differ by 0.002 do so significantly.
    """
    return differs(departure.p) and departure.size >= NEARLY


def departure_of(random: Departure, cut: Departure = NOT_COMPARED, *, surface: bool) -> str:
    """Departure of a domain from its null models, by its local slopes.

    The curve of local slopes decides alone, as it holds all box sides. The correlation dimension is
    one slope over the smaller of them, which differs only where the curve does: as a second
    condition it hid departures that the curves show. ``surface`` says whether there is a composite
    topography, and so a bearing-area cut.
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
