"""Isotropy of a contact domain: counts of occupied intervals along sliding and across it.

A domain that scales isotropically has the same exponent along both axes.
"""

import numpy as np

from ..core.estimate import Estimate
from ..core.slope_of_sums import BLOCKS, slope_of_sums
from .correlation import pair_distances

#: Axes of the counts.
WAYS = ("along", "across")

#: Variables of every domain: unit, long name.
INTERVALS = {
    f"interval_dimension_{way}": (
        "1",
        f"exponent of the number of occupied intervals {way} sliding over their length, along x "
        "and across y where nothing slides",
    )
    for way in WAYS
}

#: Origins of the intervals that counts are averaged over, at most.
MAX_ORIGINS = 4


def interval_dimensions(
    domain: np.ndarray, spacing: tuple[float, float], direction: str
) -> list[Estimate]:
    """Exponents of the number of occupied intervals of rows and of columns over their length.

    Parameters
    ----------
    domain : (ny, nx) bool ndarray
        Nodes in contact.
    spacing : (float, float)
        Sides (y, x) of a cell, mm.
    direction : str
        Sliding of the upper block: E or W along x, N or S along y; anything else counts as x.

    Returns
    -------
    list of Estimate
        Along and across, over lengths of two cells to an eighth of the window, with the interval of
        :mod:`core.slope_of_sums`; undetermined without contact. A filled window has 1, nodes that
        lie farther apart than the longest interval have 0.
    """
    axis = 0 if direction in ("N", "S") else 1
    lengths = np.unique(np.round(pair_distances(domain.shape)).astype(int))
    exponents = []
    for way in (axis, 1 - axis):
        rows = np.moveaxis(np.asarray(domain, bool), way, 1)
        parts = np.array([_occupied(rows, length) for length in lengths])
        slope = slope_of_sums(lengths * spacing[way], parts, lambda sums: sums[:, 0])
        exponents.append(slope.mapped(np.negative, falling=True))
    return exponents


def _occupied(rows: np.ndarray, length: int) -> np.ndarray:
    """Occupied intervals of rows, mean over origins, by part of the window: (1, parts)."""
    ny, nx = rows.shape
    counts = np.zeros((BLOCKS, BLOCKS))
    origins = np.unique(np.arange(MAX_ORIGINS) * length // MAX_ORIGINS)
    for origin in origins:
        starts = np.unique(np.r_[0, np.arange(origin, nx, length)])
        occupied = np.logical_or.reduceat(rows, starts, axis=1)
        y, x = np.nonzero(occupied)
        np.add.at(counts, (y * BLOCKS // ny, starts[x] * BLOCKS // nx), 1)
    return counts.reshape(1, -1) / origins.size
