"""Contact domain with its counts by part of the window, for errors of compared quantities."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.ndimage

from ..core.estimate import IN_PLANE
from ..core.intervals import jackknife_error
from ..core.slope_of_sums import BLOCKS
from .box_counts import mean_count
from .box_dimension import BoxDimension
from .clusters import NEIGHBOURS, morisita_index, quadrat_counts
from .correlation import pair_counts, pair_distances, pairs_slope
from .mean_law import FoundLaw, block_error, find_law

#: Quantities of which a domain is compared with its null models, in words.
DOMAIN_QUANTITIES = {
    "delta_sigma": "box-counting dimension Delta_sigma",
    "correlation_dimension": "correlation dimension of the nodes in contact",
    "clusters": "contact clusters",
    "morisita": "Morisita's index of the contact over quadrats",
}


@dataclass(frozen=True, eq=False)
class CountedDomain:
    """A contact domain (ny, nx) with its box-counting dimension, each count of it made once.

    ``limits`` and ``whole_cells`` are those of :func:`domain.mean_law.law_of_means`.
    """

    nodes: np.ndarray
    box: BoxDimension
    limits: tuple[float, float]
    whole_cells: bool | None

    @cached_property
    def values(self) -> dict[str, float]:
        """Values of :data:`DOMAIN_QUANTITIES` by name."""
        slope = np.nan
        if self.nodes.any() and self.counts_pairs:
            pairs, lags = self.pairs
            slope = pairs_slope(self.distances, pairs[:, 0].sum(axis=1), lags)
        return {
            "delta_sigma": self.box.dimension,
            "correlation_dimension": float(np.clip(slope, *IN_PLANE)),
            "clusters": float(scipy.ndimage.label(self.nodes, NEIGHBOURS)[1]),
            "morisita": morisita_index(*quadrat_counts(self.nodes))[0],
        }

    @cached_property
    def law(self) -> FoundLaw | None:
        """Law of the mean counts over the boxes between the cut-offs."""
        return find_law(self.nodes, limits=self.limits, whole_cells=self.whole_cells)

    @cached_property
    def law_parts(self) -> np.ndarray:
        """Mean counts at the sizes of the law, (k, blocks, blocks); empty without a law."""
        sizes = np.array([], int) if self.law is None else self.law.sizes
        return mean_count(self.nodes, sizes, blocks=BLOCKS)

    @cached_property
    def distances(self) -> np.ndarray:
        """Lags of the pairs that are counted, cells."""
        return pair_distances(self.nodes.shape)

    @property
    def counts_pairs(self) -> bool:
        """True if the window is wider than all lags."""
        return bool(self.distances[-1] < min(self.nodes.shape))

    @cached_property
    def pairs(self) -> tuple[np.ndarray, np.ndarray]:
        """Pairs of nodes in contact within each lag, by part of the window, and number of lags."""
        return pair_counts(self.nodes, self.distances)


def errors_of(domain: CountedDomain, other: CountedDomain) -> dict[str, float]:
    """Half the 95 % t-interval of the difference of two domains' dimensions, in one window.

    Of ``delta_sigma`` and ``correlation_dimension``, by the jackknife that leaves the same part of
    the window out of both; NaN where too few parts of the window are occupied.
    """
    errors = {
        "delta_sigma": _law_error(domain, other),
        "correlation_dimension": _pairs_error(domain, other),
    }
    return {name: error if 0 < error < np.inf else np.nan for name, error in errors.items()}


def _law_error(domain, other):
    """Error of the dimensions by the law of the mean counts, each at the sizes of its own law."""
    if domain.law is None or other.law is None:
        return np.nan
    ours = len(domain.law_parts)

    def difference(count):
        return domain.law.dimension_of(count[:ours]) - other.law.dimension_of(count[ours:])

    return block_error(np.concatenate([domain.law_parts, other.law_parts]), difference, (0, ours))


def _pairs_error(domain, other):
    """Error of the correlation dimensions."""
    if not domain.counts_pairs:
        return np.nan
    lags = domain.pairs[1]
    pairs = [counted.pairs[0][:, 0] for counted in (domain, other)]

    def without(counts, part):
        return pairs_slope(domain.distances, counts.sum(axis=1) - counts[:, part], lags)

    occupied = np.flatnonzero(np.any([counts.any(axis=0) for counts in pairs], axis=0))
    return jackknife_error([without(pairs[0], i) - without(pairs[1], i) for i in occupied])
