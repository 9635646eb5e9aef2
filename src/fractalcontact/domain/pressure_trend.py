"""Trend of the dimension of measured contact maps with load, compared with that of random cells.

A map has only the random null model: the bearing-area cut needs heights.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..core.fitting import LineFit, fit_line
from ..core.verdicts import BEYOND_RANDOM, LIKE_RANDOM, UNDETERMINED

#: Trends of a dimension with load.
RISES, FALLS = "rises", "falls"


class Trend(NamedTuple):
    """Trend of a dimension with load over a series of maps.

    ``verdict`` is "rises", "falls" or "undetermined"; ``line`` is Delta_sigma over the decades of
    pressure, ``departure`` Delta_sigma less that of random cells.
    """

    verdict: str
    line: LineFit
    departure: LineFit

    @property
    def beyond_random(self) -> str:
        """Verdict on the trend less that of as many random cells."""
        slope = self.departure.slope
        if not np.isfinite(slope.low):
            return UNDETERMINED
        return BEYOND_RANDOM if slope.low * slope.high > 0 else LIKE_RANDOM


def pressure_trend(pressure: ArrayLike, value: ArrayLike, random: ArrayLike) -> Trend:
    """Trend of Delta_sigma with nominal pressure (MPa) over the maps of a series; NaN if missing.

    ``random`` is the Delta_sigma of as many random cells. Maps of a series are measured one by one:
    the line's own interval (Student's t) is that of the trend. More contact raises the dimension of
    any cells, those at random too, so a rise alone shows no fractal: the departure from random must
    have a trend of its own.
    """
    pressure, value = np.asarray(pressure, float), np.asarray(value, float)
    decades = np.log10(np.where(pressure > 0, pressure, np.nan))
    line = fit_line(decades, value)
    departure = fit_line(decades, value - np.asarray(random, float))
    verdict = UNDETERMINED
    if line.slope.low > 0:
        verdict = RISES
    elif line.slope.high < 0:
        verdict = FALLS
    return Trend(verdict, line, departure)
