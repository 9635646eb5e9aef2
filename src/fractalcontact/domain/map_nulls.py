"""What chance alone makes of a measured contact map, and whether its dimension goes with load.

Of a map only the random null model can be had: the bearing-area cut needs heights.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..core.fitting import LineFit, fit_line
from .box_dimension import contact_dimension

#: Draws of random cells: the next falls between the least and the largest of them in 95 % of cases.
DRAWS = 39

#: What a dimension is beside that of random cells, and beside itself at another load.
BEYOND, LIKE_RANDOM, UNDETERMINED = (
    "beyond random",
    "not distinguishable from random",
    "undetermined",
)
RISES, FALLS = "rises", "falls"


class Random(NamedTuple):
    """Dimension of random cells: mean, least and largest of the draws; NaN where there is none."""

    mean: float
    low: float
    high: float


def random_cells(
    domain: np.ndarray,
    measured: np.ndarray,
    spacing: float,
    *,
    whole_cells: bool | None = None,
    draws: int | None = None,
) -> Random:
    """Delta_sigma of as many cells at random among those measured, by the same estimator.

    Parameters
    ----------
    domain : (ny, nx) bool ndarray
        Cells in contact.
    measured : (ny, nx) bool ndarray
    spacing : float
        mm.
    whole_cells : bool, optional
        As for :func:`domain.box_dimension.contact_dimension`.
    draws : int, optional
        By default :data:`DRAWS`.
    """
    rng = np.random.default_rng(0)
    places, n = np.flatnonzero(measured), int(domain.sum())
    draws, found = draws or DRAWS, []
    for _ in range(draws):
        cells = np.zeros(domain.size, bool)
        cells[rng.choice(places, n, replace=False)] = True
        drawn = contact_dimension(cells.reshape(domain.shape), spacing, whole_cells=whole_cells)
        found.append(drawn.dimension)
    known = np.array(found)[np.isfinite(found)]
    # Where some draws have no dimension, the others are a choice of them.
    if len(known) < draws:
        return Random(np.nan, np.nan, np.nan)
    return Random(float(known.mean()), float(known.min()), float(known.max()))


def null_verdict(value: float, low: float, high: float, random: Random) -> str:
    """Whether a dimension with its interval lies beyond those of random cells."""
    if not np.isfinite([value, low, high, *random]).all():
        return UNDETERMINED
    return BEYOND if high < random.low or low > random.high else LIKE_RANDOM


class Trend(NamedTuple):
    """How a dimension goes with the load over a series of maps.

    Attributes
    ----------
    verdict : str
        "rises", "falls" or "undetermined".
    line : LineFit
        Of Delta_sigma over the decades of pressure.
    departure : LineFit
        Of Delta_sigma less that of random cells.
    """

    verdict: str
    line: LineFit
    departure: LineFit

    @property
    def beyond_random(self) -> str:
        """Whether it goes otherwise than that of as many random cells."""
        if not np.isfinite(self.departure.slope_low):
            return UNDETERMINED
        return BEYOND if self.departure.slope_low * self.departure.slope_high > 0 else LIKE_RANDOM


def pressure_trend(pressure: ArrayLike, value: ArrayLike, random: ArrayLike) -> Trend:
    """Trend of Delta_sigma with nominal pressure over the maps of a series.

    Parameters
    ----------
    pressure, value, random : (n,) array_like
        sigma_0 in MPa, Delta_sigma, and that of as many random cells; NaN where not known.

    Notes
    -----
    Maps of a series are measured one by one: the line's own interval (Student's t) is that of the
    trend. More contact raises the dimension of any cells, those at random too, so a rise alone
    shows no fractal: the departure from random must have a trend of its own.
    """
    pressure, value = np.asarray(pressure, float), np.asarray(value, float)
    decades = np.log10(np.where(pressure > 0, pressure, np.nan))
    line = fit_line(decades, value)
    departure = fit_line(decades, value - np.asarray(random, float))
    verdict = UNDETERMINED
    if line.slope_low > 0:
        verdict = RISES
    elif line.slope_high < 0:
        verdict = FALLS
    return Trend(verdict, line, departure)
