"""Curves of local slopes of box counts: a contact domain compared with its null models.

A slope fitted over a range agrees by accident: nodes at random, whose local slopes cross over from
0 to 2, can have the mean slope of a set of dimension 1. Two domains differ where the curves do.

The local slope of mean counts N(r) over a doubling of the box side r is

    2 - ln[n(2 r) / n(r)] / ln 2,    n(r) = N(r) / N_w(r),

with N_w(r) the mean count of the whole window, whose boxes hang over its edge as those of the
domain do: a filled window has slope 2 at every side.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy import special

from ..core.estimate import Estimate
from ..core.intervals import t_quantile
from ..core.limits import CONFIDENCE
from ..core.slope_of_sums import BLOCKS
from .box_counts import mean_count
from .count_law import SMALLEST
from .mean_law import LARGEST_BOX
from .random_nodes import random_nodes

#: Draws of random nodes: 200 with the domain, so that 5 % are ten.
DRAWS = 199


#: Fewest occupied parts of the window that give a scatter.
MIN_PARTS = 4

#: Smallest scatter of local slopes; below it all boxes are occupied, and all draws are equal.
_NO_SCATTER = 1e-9


class Departure(NamedTuple):
    """Departure of a curve of local slopes from that of a null model.

    The probability is of the departure that is largest in units of its scatter. Where the scatter
    is small a difference of 0.002 is significant; ``size`` is the largest of the significant
    differences.
    """

    p: float
    """Probability of so large a departure where there is no difference; NaN where not known."""
    place: int
    """Index of the local slope that departs by most, of those that depart significantly."""
    size: float
    """Departure of that local slope."""

    def columns(self, null: str, sides: np.ndarray) -> dict[str, float]:
        """Columns of the stage ``domains`` for a null model: probability, and box side, mm."""
        side = sides[self.place] if np.isfinite(self.p) else np.nan
        return {f"local_slope_{null}_p": self.p, f"local_slope_{null}_side": side}


NOT_COMPARED = Departure(np.nan, 0, np.nan)


@dataclass(frozen=True, eq=False)
class SlopeCurve:
    """Local slopes of the box counts of a contact domain.

    Attributes
    ----------
    nodes : (ny, nx) bool ndarray
        Nodes in contact.
    mask : (ny, nx) bool ndarray, optional
        Cells that nodes may lie in; all by default.
    """

    nodes: np.ndarray
    mask: np.ndarray | None = None

    @cached_property
    def sizes(self) -> np.ndarray:
        """Doubling box sides, (k,) int64, cells."""
        return curve_sizes(self.nodes.shape)

    @cached_property
    def parts(self) -> np.ndarray:
        """Mean counts by part of the window over those of the whole window, (k, parts)."""
        counts = mean_count(self.nodes, self.sizes, blocks=BLOCKS).reshape(
            self.sizes.size, BLOCKS**2
        )
        return counts / window_counts(self.nodes.shape, self.sizes, self.mask)[:, np.newaxis]

    @cached_property
    def values(self) -> np.ndarray:
        """Local slopes, (k - 1,); NaN without a node."""
        return slope_curve(self.parts.sum(axis=1), self.sizes)

    @cached_property
    def interval(self) -> Estimate:
        """Local slopes with the 95 % interval of each, by the jackknife over parts."""
        half = _jackknife(self.without(self.occupied))[0]
        return Estimate(self.values, self.values - half, self.values + half).in_plane()

    @property
    def occupied(self) -> np.ndarray:
        """Parts of the window with a box of the smallest size; none in a window without sizes."""
        return np.flatnonzero(self.parts[:1].sum(axis=0))

    def without(self, parts: np.ndarray) -> np.ndarray:
        """Local slopes with one part of the window after another left out, (m, k - 1)."""
        left = self.parts.sum(axis=1) - self.parts.T[parts]
        # A remainder of the subtraction by rounding is no count.
        return slope_curve(np.where(left > _NO_SCATTER * left.max(initial=1), left, 0), self.sizes)

    @cached_property
    def nodes_by_part(self) -> np.ndarray:
        """Nodes in contact by part of the window, (parts,)."""
        return mean_count(self.nodes, np.array([1]), blocks=BLOCKS).ravel()


def curve_sizes(shape: tuple[int, ...]) -> np.ndarray:
    """Doubling box sides in cells, from `SMALLEST` to `LARGEST_BOX` of a window, (k,) int64."""
    sizes = SMALLEST * 2 ** np.arange(max(shape).bit_length())
    return sizes[sizes <= LARGEST_BOX * min(shape)]


def window_counts(
    shape: tuple[int, ...], sizes: np.ndarray, mask: np.ndarray | None = None
) -> np.ndarray:
    """Mean box counts N_w(r) of a whole window, or of the cells of a mask, (k,)."""
    window = np.ones(shape, bool) if mask is None else mask
    return mean_count(window, sizes).ravel()


def slope_curve(relative: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Local slopes (..., k - 1) between neighbouring box sides (k,); NaN where a count is 0.

    ``relative`` (..., k) are mean counts N(r) / N_w(r).
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        curve = 2 - np.diff(np.log(relative), axis=-1) / np.diff(np.log(sizes))
    return np.where(np.isfinite(curve), curve, np.nan)


def random_curves(
    shape: tuple[int, int], nodes: int, mask: np.ndarray | None = None, draws: int = DRAWS
) -> np.ndarray:
    """Local slopes of as many nodes drawn at random, (draws, k - 1); the same ones on every run.

    Nodes lie in the cells of the mask, all of the window by default.
    """
    sizes = curve_sizes(shape)
    cells = np.arange(np.prod(shape)) if mask is None else np.flatnonzero(mask)
    counts = [
        mean_count(random_nodes(shape, nodes, cells, seed), sizes).ravel() for seed in range(draws)
    ]
    return slope_curve(np.array(counts) / window_counts(shape, sizes, mask), sizes)


def departure_from_draws(curve: np.ndarray, draws: np.ndarray) -> Departure:
    """Departure of local slopes (j,) from draws (n, j) of a null model: a Monte Carlo test.

    The statistic is the largest standardised deviation over the box sides. Mean and scatter are
    those of the curve and the draws together: all of them being alike, a further draw is among the
    k that depart most of n + 1 with probability k / (n + 1), however slopes are distributed (Besag,
    J. & Diggle, P. J. 1977: Simple Monte Carlo tests for spatial pattern. Applied Statistics 26,
    327-333).
    """
    curves = np.vstack([curve, draws])
    if not curves.size or not np.isfinite(curves).all():
        return NOT_COMPARED
    deviation = _in_scatters(curves - curves.mean(axis=0), curves.std(axis=0))
    largest = deviation.max(axis=1)
    # The small number counts draws that equal the curve as departing as much.
    p = np.mean(largest >= deviation[0][:, np.newaxis] * (1 - 1e-9), axis=1)
    return _departure(p, curve - draws.mean(axis=0))


def paired_departure(domain: SlopeCurve, other: SlopeCurve) -> tuple[Estimate, Departure]:
    """Local slopes of a domain less those of another of as many nodes, and their departure.

    The scatter is that of the jackknife: the same part of the window is left out of both. Both have
    as many nodes in the window, though not in its parts. The part of the scatter that goes with
    this difference in number is none of the whole; regression removes it.
    """
    difference = domain.values - other.values
    if np.array_equal(domain.nodes, other.nodes):
        return Estimate(difference, difference, difference), Departure(1.0, 0, 0.0)
    parts = np.union1d(domain.occupied, other.occupied)
    more = (domain.nodes_by_part - other.nodes_by_part)[parts]
    half, freedom = _jackknife(domain.without(parts) - other.without(parts), more)
    band = Estimate(difference, difference - half, difference + half)
    return band, largest_departure(band, freedom)


def largest_departure(difference: Estimate, freedom: int) -> Departure:
    """Departure by differences (j,) of local slopes from a null model's, with their t-intervals.

    The probability is Student's with ``freedom`` degrees of freedom, times the number of local
    slopes (Bonferroni). Not compared where a local slope is missing.
    """
    values, half = difference.value, difference.width / 2
    if not np.size(values) or not np.isfinite(half).all():
        return NOT_COMPARED
    deviation = _in_scatters(values, half / t_quantile(freedom))
    return _departure(np.minimum(1, values.size * 2 * special.stdtr(freedom, -deviation)), values)


def _departure(p: np.ndarray, difference: np.ndarray) -> Departure:
    """Departure by the probabilities and the differences of all local slopes."""
    least = p.min()
    # If none is significant the nearest to 5 % counts; the small number keeps 10 of 200 at 5 %.
    counts = p <= max(least, 1 - CONFIDENCE + 1e-9)
    place = int(np.where(counts, np.abs(difference), -1.0).argmax())
    return Departure(float(least), place, float(abs(difference[place])))


def _jackknife(left: np.ndarray, covariate: np.ndarray | None = None) -> tuple[np.ndarray, int]:
    """Half the 95 % t-interval of each column by parts left out, (j,), and degrees of freedom.

    ``left`` (m, j) are values without each part. ``covariate`` (m,) is a number by which parts
    differ and which is zero for the whole: its effect is taken off by regression.
    """
    n, columns = left.shape
    freedom = n - 1
    if n < MIN_PARTS or not np.isfinite(left).all():
        return np.full(columns, np.nan), freedom
    residual = left - left.mean(axis=0)
    if covariate is not None and np.ptp(covariate) > 0:
        v = covariate - covariate.mean()
        residual = residual - np.outer(v, v @ residual / (v @ v))
        freedom -= 1
    variance = (n - 1) ** 2 / n * (residual**2).sum(axis=0) / freedom
    return t_quantile(freedom) * np.sqrt(variance), freedom


def _in_scatters(deviation: np.ndarray, scatter: np.ndarray) -> np.ndarray:
    """Size of deviations in units of their scatter; 0 where nothing scatters."""
    some = scatter > _NO_SCATTER
    return np.abs(deviation) * some / np.where(some, scatter, 1)
