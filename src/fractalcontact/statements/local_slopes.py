"""Local slopes of the box counts of a contact domain: whether they are those of one power law."""

import numpy as np
import xarray as xr

from ..core.estimate import Estimate
from ..core.limits import LOOSELY, NEARLY
from ..core.text import compact, number
from ..core.verdicts import FAILS, HOLDS, PARTLY, UNDETERMINED
from .findings import Finding

#: Least local slope of boxes that are all occupied.
ALL_OCCUPIED = 1.98

#: Box sides whose ends have a smaller ratio show no power law.
MIN_RATIO = 10.0


def one_slope(state: xr.Dataset) -> Finding:
    """Verdict on one local slope at all box sides, with the slopes in words.

    Within ±0.1 of each other local slopes are one, within ±0.25 partly. They are not where no band
    of ±0.25 meets the interval of each: what differs by its scatter alone is no curvature. Nor are
    they where large boxes are all occupied, with a slope of 2, and small ones surely have less, by
    more than 0.1: that is the crossover to a filled plane, which any domain of many nodes has.
    ``state`` is that of one domain, compared with its null models.
    """
    if np.isnan(state["local_slope_random_p"]):
        return Finding(UNDETERMINED, str(state["null_reason"].item()))
    slopes, low, high = Estimate.read(state, "local_slope").ends
    first, last = (state[f"local_slope_side_{end}"].values for end in ("min", "max"))
    ends = " to ".join(dict.fromkeys(number(slope) for slope in (slopes.min(), slopes.max())))
    words = f"local slopes {ends} for boxes of {compact(first[0], 2)} to {compact(last[-1], 2)} mm"
    if np.max(low) - np.min(high) > 2 * LOOSELY:
        return Finding(FAILS, words)
    if slopes.max() >= ALL_OCCUPIED and np.max(low) - np.min(high) > NEARLY:
        return Finding(FAILS, f"{words}, a crossover to a filled plane")
    spread = np.ptp(slopes)
    if spread > 2 * LOOSELY:
        return Finding(UNDETERMINED, f"{words}, their intervals overlap")
    if last[-1] < MIN_RATIO * first[0]:
        return Finding(UNDETERMINED, f"{words}, less than a decade")
    return Finding(HOLDS if spread <= 2 * NEARLY else PARTLY, words)
