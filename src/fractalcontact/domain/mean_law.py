"""Count law fitted to the mean box counts of a contact domain: its box sizes and its interval.

The law is that of :mod:`domain.count_law`.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ..core.fitting import MIN_POINTS
from ..core.intervals import jackknife_error
from ..core.ranges import within
from ..core.slope_of_sums import BLOCKS, MIN_SCALES, wave_error
from .box_counts import cropped, mean_count, minimal_cover, whole_sizes
from .count_law import (
    SMALLEST,
    SMALLEST_SEPARATING,
    Law,
    LawTerms,
    best_law,
    law_count,
    law_dimension,
    law_terms,
)
from .cut_offs import SATURATED

#: Largest box of the law of mean counts, as a fraction of the domain's extent.
LARGEST_BOX = 1 / 3


class MeanCounts(NamedTuple):
    """Mean box counts of a domain over all grid origins."""

    sizes: np.ndarray
    """Sides of the boxes (k,) int64, cells."""
    counts: np.ndarray
    """Mean numbers of boxes (k,)."""


class FittedLaw(NamedTuple):
    """The law of the mean counts with the ends of its interval and the sizes it was fitted to."""

    law: Law
    ends: tuple[float, float]
    sizes: np.ndarray
    """Sides of the boxes fitted (k,), cells."""
    terms: LawTerms
    """Terms of the law, in cells."""


NO_MEANS = MeanCounts(np.empty(0, np.int64), np.empty(0))


def mean_sizes(shape: tuple[int, ...]) -> np.ndarray:
    """Box sides in cells at which mean counts are taken: whole ones to `LARGEST_BOX` of an extent.

    The sizes for a domain's extent are the first of the sizes for its window.
    """
    return whole_sizes(LARGEST_BOX * max(shape))


def law_of_means(
    extent: np.ndarray,
    limits: tuple[float, float],
    whole_cells: bool | None,
) -> tuple[FittedLaw | None, MeanCounts]:
    """Law fitted to the mean counts of a domain, None with too few box sizes, and these counts.

    ``extent`` is the domain (ny, nx) without empty rows and columns about it, ``limits`` are the
    smallest and largest box side that may be fitted, cells; ``whole_cells`` is that of
    :func:`domain.count_law.best_law`.
    """
    sizes = mean_sizes(extent.shape)
    parts = mean_count(extent, sizes, blocks=BLOCKS)
    count = parts.sum(axis=(1, 2))
    means = MeanCounts(sizes, count)
    side = max(extent.shape)
    fitted = _fitted(means, extent, limits, whole_cells)
    if fitted is None:
        return None, means
    law, between = fitted
    kept = between & (sizes >= SMALLEST)
    sizes, parts, count = sizes[kept].astype(float), parts[kept], count[kept]
    terms = law_terms(law, sizes, count, side)
    error = block_error(parts, lambda left: law_dimension(law, sizes, left, side))
    if np.isinf(error):  # without its largest cluster a domain may follow no law
        error = block_error(parts, lambda left: count_slope(left, sizes))
    waves = wave_error(sizes, np.log(count / law_count(sizes, law.dimension, terms)))
    half = float(np.hypot(error, waves))
    ends = law.dimension - half, law.dimension + half
    return FittedLaw(law, ends, sizes, terms), means


def _fitted(means, extent, limits, whole_cells):
    """Law and the sizes between the cut-offs; None if they are too few."""
    sizes, count = means
    alone, full = _beyond_cut_offs(means, extent)
    between = ~alone & ~full & (sizes >= SMALLEST_SEPARATING) & within(sizes, *limits)
    if np.count_nonzero(between & (sizes >= SMALLEST)) < MIN_SCALES:
        return None
    law = best_law(sizes[between].astype(float), count[between], max(extent.shape), whole_cells)
    return None if law is None else (law, between)


def _beyond_cut_offs(means, extent):
    """Sizes saturated by lone nodes, and sizes saturated by occupied boxes."""
    sizes, count = means
    all_boxes = np.prod([(n - 1) / sizes + 1 for n in extent.shape], axis=0)
    # A set that fills its own extent is dense at every scale: then no scale is saturated.
    nodes = np.count_nonzero(extent)
    filled = nodes >= (1 - SATURATED) * extent.size
    alone = count >= (1 - SATURATED) * nodes
    return alone, (count >= (1 - SATURATED) * all_boxes) & (not filled)


def is_crowded(means: MeanCounts, extent: np.ndarray) -> bool:
    """True if box sizes are too few for a law because all boxes are occupied at most of the sizes.

    The domain is without empty rows and columns about it.
    """
    alone, full = _beyond_cut_offs(means, extent)
    return bool(np.count_nonzero(full) > len(means.sizes) / 2 > np.count_nonzero(alone))


class FoundLaw(NamedTuple):
    """A law of mean counts, without the interval of its dimension."""

    law: Law
    sizes: np.ndarray
    """Sides of the boxes that it was fitted to, (k,) int64, cells."""
    separating: np.ndarray
    """Sides of the boxes by which its form was chosen, (m,) int64, cells."""
    side: float
    """Extent of the domain, cells."""

    def refound(self, count: np.ndarray, whole_cells: bool | None) -> float:
        """Dimension of the best law of other counts at `separating`; NaN without a fit."""
        law = best_law(self.separating.astype(float), count, self.side, whole_cells)
        return np.nan if law is None else law.dimension

    def dimension_of(self, count: np.ndarray) -> float:
        """Dimension of a law of this form fitted to other counts at these sizes; NaN without."""
        if not (count > 0).all():
            return np.nan
        return law_dimension(self.law, self.sizes.astype(float), count, self.side)


def find_law(
    domain: np.ndarray, limits: tuple[float, float], whole_cells: bool | None
) -> FoundLaw | None:
    """Law of the mean counts of a domain; None with too few sizes between the cut-offs.

    Parameters are those of :func:`law_of_means`.
    """
    extent = cropped(domain)
    sizes = mean_sizes(extent.shape)
    means = MeanCounts(sizes, mean_count(extent, sizes).ravel())
    fitted = _fitted(means, extent, limits, whole_cells)
    if fitted is None:
        return None
    law, between = fitted
    separating = sizes[between]
    return FoundLaw(law, separating[separating >= SMALLEST], separating, max(extent.shape))


def dimension_by_means(
    domain: np.ndarray,
    cover_sizes: np.ndarray,
    *,
    limits: tuple[float, float] = (0, np.inf),
    whole_cells: bool | None = None,
) -> tuple[float, np.ndarray]:
    """Dimension by the law of the mean counts without its interval, and the minimal cover.

    The cover (k,) is at ``cover_sizes`` in cells; the rest is as of :func:`law_of_means`. Where too
    few sizes lie between the cut-offs the dimension is the limit that the counts have reached: 2
    where every box is occupied, 0 where every node is alone; NaN where neither.
    """
    extent = cropped(domain)
    sizes = mean_sizes(extent.shape)
    cover, count = minimal_cover(extent, cover_sizes), mean_count(extent, sizes).ravel()
    means = MeanCounts(sizes, count)
    fitted = _fitted(means, extent, limits, whole_cells)
    if fitted is not None:
        return fitted[0].dimension, cover
    alone, full = (
        np.count_nonzero(beyond[sizes > 1]) for beyond in _beyond_cut_offs(means, extent)
    )
    if max(alone, full) < MIN_SCALES:
        return np.nan, cover
    return 2.0 if full >= alone else 0.0, cover


def block_error(
    parts: np.ndarray, statistic: Callable[[np.ndarray], float], firsts: Sequence[int] = (0,)
) -> float:
    """Half the t-interval of a statistic of counts, by the jackknife over parts of the window.

    The larger error of two: by parts left out, and by rows or columns of them. Neighbouring parts
    of one set are alike, the more so as the largest boxes are wider than one: each holds much of
    the information of the part left out. A strip has fewer neighbours; but of strips there are few.

    ``parts`` (k, blocks, blocks) are counts by part of the window; ``statistic`` takes (k,) counts
    to a number, NaN where there is none. ``firsts`` are the counts that show which parts are
    occupied: those of the smallest boxes, of each set where counts of several are stacked.
    """
    divisions = parts.reshape(len(parts), -1), parts.sum(axis=2), parts.sum(axis=1)
    squares, *strips = (_without_parts(division, statistic, firsts) for division in divisions)
    return max(jackknife_error(squares), jackknife_error(*strips))


def _without_parts(parts, statistic, firsts):
    """Values of a statistic with one occupied part after another left out."""
    occupied = (parts[list(firsts)] > 0).any(axis=0)
    left = parts.sum(axis=1)[:, np.newaxis] - parts[:, occupied]
    return [statistic(count) for count in left.T]


def count_slope(count: np.ndarray, sizes: np.ndarray) -> float:
    """Least-squares slope -d log N / d log r; NaN where a count is 0 or sizes are too few."""
    if sizes.size < MIN_POINTS or not (count > 0).all():
        return np.nan
    x = np.log(sizes)
    x -= x.mean()
    return float(0.0 - x @ np.log(count) / (x @ x))
