"""Exponents of contact quantities against the side b, with intervals over disjoint sub-windows.

The sub-windows of one size are disjoint pieces of one joint, those of different sizes lie on the
same ground. So the interval is neither that of a regression over the means nor one of independent
sizes: the window is divided into its four quarters, and one after another is left out with
all that is cut from it (jackknife).
"""

from collections.abc import Sequence
from functools import partial

import numpy as np
import xarray as xr

from ..core.estimate import Estimate
from ..core.intervals import t_quantile
from ..core.ranges import within
from .window_means import add_exponents

#: Disjoint top-level pieces that are left out in turn.
QUARTERS = 4


def kept_fractions(parts: int, places: np.ndarray) -> np.ndarray:
    """Fraction (4, n) of each sub-window that is left where a quarter of the window is left out.

    1 outside the quarter, 0 in it; of a division into thirds some lie across. ``places`` (n,) are
    those of :func:`size_effect.division.split`.
    """
    first = np.clip(parts / 2 - np.arange(parts), 0, 1)  # in the first half, along one side
    y, x = first[places // parts], first[places % parts]
    return 1 - np.array([y * x, y * (1 - x), (1 - y) * x, (1 - y) * (1 - x)])


def of_usable_sizes(values: np.ndarray, nodes: np.ndarray, fewest: int) -> np.ndarray:
    """Values (part, window, ...) of :func:`usable_sizes` that are all positive, NaN of others."""
    positive = ((values > 0) | np.isnan(values)).all(axis=1)
    usable = usable_sizes(nodes, fewest) & positive
    return np.where(usable[:, np.newaxis], values, np.nan)


def usable_sizes(nodes: np.ndarray, fewest: int) -> np.ndarray:
    """Sizes (part, ...) all of whose sub-windows hold nodes enough; nodes (part, window, ...).

    Nodes are NaN where there are fewer sub-windows. One state of too few nodes leaves out its whole
    size: the states left would be the windows that touch most, so that small windows would seem to
    touch more.
    """
    solved = np.isfinite(nodes)
    return solved.any(axis=1) & (within(nodes, fewest, np.inf) | ~solved).all(axis=1)


def size_exponent(
    parts: Sequence[int], sides: np.ndarray, values: np.ndarray, places: Sequence[np.ndarray]
) -> Estimate:
    """Exponent d ln(quantity) / d ln b of one quantity, of means over disjoint sub-windows.

    Sides (part,) in mm; positive values (part, window), NaN of sub-windows that do not count; a
    size without any is left out. ``places`` are where the sub-windows of each size lie. NaN with
    fewer than two sizes, or where no size has several windows.

    The line through the logarithms of the means, all sizes alike. Its error has two independent
    parts: that of all sizes with several windows, by the jackknife over quarters, in which what
    they share cancels; and that of the whole window, a single one, for which the scatter of the
    largest windows that are several is taken. Both have three degrees of freedom. The whole lies on
    the same ground as its parts, so their errors tend to cancel in the slope: the sum of the
    variances is an upper bound where large windows scatter no more than small ones do. It is a
    cautious one: of 16 surfaces of 192 nodes per side with a roll-off of 24, whole, halves, thirds
    and quarters of the side, the area exponents scattered by 0.005 to 0.011 about zero, and the
    intervals, all of which held zero, reached 0.05 to 0.14 to either side.
    """
    used = [k for k in range(len(parts)) if (values[k] > 0).any()]
    several = [k for k in used if parts[k] > 1]
    if len(used) < 2 or not several:
        return Estimate()
    x = np.log(sides[used])
    lever = (x - x.mean()) / np.sum((x - x.mean()) ** 2)
    means = np.empty((len(used), 1 + QUARTERS))
    variance = 0.0
    for i, k in enumerate(used):
        own = values[k, : len(places[k])]
        counts = np.isfinite(own)
        weights = np.vstack([np.ones(len(own)), kept_fractions(parts[k], places[k])])[:, counts]
        # Without a quarter that holds all windows that count there is no mean, and no interval.
        with np.errstate(invalid="ignore"):
            means[i] = np.log(weights @ own[counts] / weights.sum(axis=1))
        if parts[k] == 1:
            largest = values[min(several, key=lambda size: parts[size])]
            counted = np.log(largest[np.isfinite(largest)])
            scatter = np.var(counted, ddof=1) if counted.size > 1 else np.nan
            variance = lever[i] ** 2 * float(scatter)
    slope, *replicates = lever @ means
    variance += (QUARTERS - 1) * float(np.var(replicates))
    half = float(t_quantile(QUARTERS - 1)) * variance**0.5
    return Estimate(slope, slope - half, slope + half, len(used), (x.min(), x.max()))


def add_size_exponents(
    result: xr.Dataset,
    name: str,
    values: xr.DataArray,
    places: Sequence[np.ndarray],
    words: str,
) -> None:
    """Exponents of a quantity (part, window, ...) of sub-windows against b, into ``result``.

    As :func:`size_effect.window_means.add_exponents`. The quantity is NaN where a size is not used,
    ``places`` are those of :func:`size_exponent`, and ``words`` say what the exponent is of.
    """
    parts, sides = result["part"].values.tolist(), result["side"].values
    exponent = partial(size_exponent, parts, sides, places=places)
    along = ("part", "window")
    add_exponents(result, name, {"values": values}, exponent, along, words, "sizes used")
