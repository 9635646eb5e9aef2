"""Words that the atlas stores as verdicts and reasons, each once."""

from .limits import CORRECTED_NODES

#: On a statement of the paper.
HOLDS, PARTLY, FAILS = "holds", "holds in part", "does not hold"
#: The data cannot decide; the question has no meaning as it is put.
UNDETERMINED, ILL_POSED = "undetermined", "ill-posed"
VERDICTS = (HOLDS, PARTLY, FAILS, UNDETERMINED, ILL_POSED)

#: On the elastic model, best first; the last where there is no state to judge.
GOOD, IN_PART, POOR, NOT_JUDGED = "good", "partly", "poor", "not judged"
#: What its pressure is judged by.
HARDNESS, STRENGTH, USUAL = "hardness", "joint wall strength", "usual strengths"

#: Trends of the dilatancy.
LEVEL, RISING, FALLING = "level", "rising", "falling"

#: Law that a closure curve follows; neither, or both, may fit.
HYPERBOLA, SEMI_LOGARITHMIC, UNDECIDED, NEITHER = LAWS = (
    "hyperbola",
    "semi-logarithmic",
    "undecided",
    "neither",
)

#: Departure of a contact domain from its null models; of a set without a surface only the random
#: null can be asked.
BEYOND_BOTH = "different from random nodes and from the bearing-area cut"
BEYOND_RANDOM = "different from random nodes"
LIKE_RANDOM = "not separated from random nodes"
LIKE_CUT = "different from random nodes, not separated from the bearing-area cut"

#: On eq. 6 by one estimator of Delta_sigma under one load; or :data:`UNDECIDED`.
AGREES, FLATTER, STEEPER = "agrees", "measured flatter", "measured steeper"
AMBIGUOUS, NOT_TESTED = "ambiguous", "not tested"
DECIDED = (AGREES, STEEPER, FLATTER)

#: Why there is no real mean pressure: the areas of fewer nodes are not corrected for their edge.
NO_PRESSURE = f"fewer than {CORRECTED_NODES} nodes in contact, too few for their mean pressure"

#: Why a number is undetermined where nothing else is wrong with it.
TOO_WIDE = "its 95 % interval is too wide to be of use"

#: On where an estimate lies beside the values that theories give.
BELOW, WITHIN, ABOVE = "below", "within", "above"
