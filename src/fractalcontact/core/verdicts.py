"""Words that the atlas stores as verdicts and reasons, each once."""

from .limits import BANDIS_LENGTHS, CORRECTED_NODES

#: Verdicts on a statement of the paper.
HOLDS, PARTLY, FAILS = "holds", "holds in part", "does not hold"
#: Verdicts where the data cannot decide, and where the question has no meaning.
UNDETERMINED, ILL_POSED = "undetermined", "ill-posed"
VERDICTS = (HOLDS, PARTLY, FAILS, UNDETERMINED, ILL_POSED)

#: Verdicts on the elastic model, best first; the last without a state to judge.
GOOD, IN_PART, POOR, NOT_JUDGED = "good", "partly", "poor", "not judged"
#: Criteria for the pressure of the elastic model.
HARDNESS, STRENGTH, USUAL = "hardness", "joint wall strength", "usual strengths"

#: Trends of the dilatancy.
LEVEL, RISING, FALLING = "level", "rising", "falling"

#: Laws of a closure curve; neither, or both, may fit.
HYPERBOLA, SEMI_LOGARITHMIC, UNDECIDED, NEITHER = LAWS = (
    "hyperbola",
    "semi-logarithmic",
    "undecided",
    "neither",
)

#: Departures of a contact domain from its null models; a set without a surface has only the random
#: null model.
BEYOND_BOTH = "different from random nodes and from the bearing-area cut"
BEYOND_RANDOM = "different from random nodes"
LIKE_RANDOM = "not separated from random nodes"
LIKE_CUT = "different from random nodes, not separated from the bearing-area cut"

#: Verdicts on eq. 6 by one estimator of Delta_sigma under one load; or :data:`UNDECIDED`.
AGREES, FLATTER, STEEPER = "agrees", "measured flatter", "measured steeper"
AMBIGUOUS, NOT_TESTED = "ambiguous", "not tested"
DECIDED = (AGREES, STEEPER, FLATTER)

#: Reason of a missing real mean pressure: areas of fewer nodes are not corrected for their edge.
NO_PRESSURE = f"fewer than {CORRECTED_NODES} nodes in contact, too few for their mean pressure"

#: Reason of an undetermined number without another fault.
TOO_WIDE = "its 95 % interval is too wide to be of use"

#: Places of an estimate relative to the values of theories.
BELOW, WITHIN, ABOVE = "below", "within", "above"

#: Reason why Barton's law of scale gives no strength of a length.
OFF_LENGTHS = "the law of scale was measured on lengths from {:g} to {:g} mm".format(
    *BANDIS_LENGTHS
)
