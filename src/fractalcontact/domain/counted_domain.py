"""Contact domain with its counts by part of the window, for errors of compared quantities."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
import scipy.ndimage

from ..core.intervals import jackknife_error
from ..core.slope_of_sums import BLOCKS
from .box_counts import mean_count
from .box_dimension import BoxDimension
from .clusters import NEIGHBOURS, QUADRATS, morisita_index, quadrat_counts
from .correlation import pair_counts, pair_distances, pairs_slope
from .mean_law import FoundLaw, block_error, find_law
from .ordinary_slope import count_slope

#: Quantities that are compared with null models, in words.
QUANTITIES = {
    "delta_sigma": "box-counting dimension Delta_sigma",
    "delta_sigma_ordinary": "ordinary box-counting dimension",
    "correlation_dimension": "correlation dimension of the nodes in contact",
    "clusters": "contact clusters",
    "morisita": "Morisita's index of the contact over quadrats",
}


@dataclass(frozen=True, eq=False)
class CountedDomain:
    """A contact domain with its box-counting dimension, each count of it made once.

    Attributes
    ----------
    nodes : (ny, nx) bool ndarray
        In contact.
    box : BoxDimension
        From :func:`domain.box_dimension.dimension_of_domain`.
    limits : (float, float)
        Smallest and largest box side that may be fitted, cells.
    whole_cells : bool or None
        As :func:`domain.count_law.best_law` takes it.
    """

    nodes: np.ndarray
    box: BoxDimension
    limits: tuple[float, float]
    whole_cells: bool | None

    @cached_property
    def values(self) -> dict[str, float]:
        """Each of :data:`QUANTITIES`."""
        slope = np.nan
        if self.nodes.any() and self.counts_pairs:
            pairs, lags = self.pairs
            slope = pairs_slope(self.distances, pairs[:, 0].sum(axis=1), lags)
        ordinary = self.box.ordinary
        return {
            "delta_sigma": self.box.dimension,
            "delta_sigma_ordinary": np.nan if ordinary is None else ordinary.value,
            "correlation_dimension": slope,
            "clusters": float(self.clusters[1]),
            "morisita": morisita_index(*self.quadrats)[0],
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
    def ordinary_sizes(self) -> np.ndarray:
        """Box sides of the ordinary slope, cells; empty without a slope."""
        slope = self.box.ordinary
        return np.array([], int) if slope is None else slope.sizes[slope.used]

    @cached_property
    def ordinary_parts(self) -> np.ndarray:
        """Mean counts at those sizes, (k, blocks, blocks)."""
        return mean_count(self.nodes, self.ordinary_sizes, blocks=BLOCKS)

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
        """Pairs of nodes in contact within each lag, by part of the window, and lags there are."""
        return pair_counts(self.nodes, self.distances)

    @cached_property
    def clusters(self) -> tuple[np.ndarray, int]:
        """Number of its cluster at each node, 0 without one, and how many there are."""
        return scipy.ndimage.label(self.nodes, NEIGHBOURS)

    @cached_property
    def cluster_parts(self) -> np.ndarray:
        """Clusters by the part of the window that contains their middle, (1, blocks, blocks)."""
        label, number = self.clusters
        y, x = np.nonzero(label)
        of_node = label[y, x] - 1
        nodes = np.bincount(of_node, minlength=number)
        row, column = (
            (2 * np.bincount(of_node, at, number) + nodes) * BLOCKS // (2 * n * nodes)
            for at, n in zip((y, x), label.shape, strict=True)
        )
        part = (row * BLOCKS + column).astype(int)
        return np.bincount(part, minlength=BLOCKS**2).reshape(1, BLOCKS, BLOCKS)

    @cached_property
    def quadrats(self) -> tuple[np.ndarray, np.ndarray]:
        """Nodes in contact and cells of each quadrat."""
        return quadrat_counts(self.nodes)


def errors_of(domains: Sequence[CountedDomain]) -> dict[str, float]:
    """Half the 95 % t-interval of each quantity of a domain, or of one domain's less another's.

    Parameters
    ----------
    domains : sequence of CountedDomain
        One, or two in one window. The jackknife leaves the same part of the window out of both.

    Returns
    -------
    dict of str to float
        Of each of :data:`QUANTITIES`; NaN where too few parts of the window are occupied.
    """
    found = {
        "delta_sigma": _law_error(domains),
        "delta_sigma_ordinary": _ordinary_error(domains),
        "correlation_dimension": _pairs_error(domains),
        "clusters": block_error(
            np.concatenate([one.cluster_parts for one in domains]), _less, range(len(domains))
        ),
        "morisita": _morisita_error(domains),
    }
    return {name: error if 0 < error < np.inf else np.nan for name, error in found.items()}


def _less(values):
    """The first, less the second if there are two."""
    return float(values[0] - sum(values[1:]))


def _law_error(domains):
    """Estimator of dimensions by the law of the mean counts."""
    laws = [one.law for one in domains]
    if any(law is None for law in laws):
        return np.nan
    return _stacked_error([one.law_parts for one in domains], [law.dimension_of for law in laws])


def _ordinary_error(domains):
    """Estimator of ordinary dimensions."""
    sizes = [one.ordinary_sizes for one in domains]
    if any(used.size == 0 for used in sizes):
        return np.nan
    return _stacked_error(
        [one.ordinary_parts for one in domains],
        [lambda count, used=used: count_slope(count, used) for used in sizes],
    )


def _stacked_error(parts, dimensions):
    """Estimator of dimensions, each from the counts of its own domain at its own sizes."""
    ends = np.cumsum([0, *(len(count) for count in parts)])
    slices = [slice(*pair) for pair in pairwise(ends)]

    def difference(count):
        return _less([of(count[its]) for of, its in zip(dimensions, slices, strict=True)])

    return block_error(np.concatenate(parts), difference, ends[:-1])


def _pairs_error(domains):
    """Estimator of correlation dimensions."""
    distances = domains[0].distances
    if not domains[0].counts_pairs:
        return np.nan
    lags = domains[0].pairs[1]
    pairs = [one.pairs[0][:, 0] for one in domains]
    occupied = np.flatnonzero(np.any([one.any(axis=0) for one in pairs], axis=0))
    left = [
        _less([pairs_slope(distances, one.sum(axis=1) - one[:, i], lags) for one in pairs])
        for i in occupied
    ]
    return jackknife_error(left)


def _morisita_error(domains):
    """Estimator of indices of Morisita, parts of quadrats left out."""
    cells = domains[0].quadrats[1]
    contact = [one.quadrats[0] for one in domains]
    if cells.size != QUADRATS**2:
        return np.nan
    y, x = np.divmod(np.arange(cells.size), QUADRATS)
    part = y * BLOCKS // QUADRATS * BLOCKS + x * BLOCKS // QUADRATS
    occupied = np.unique(part[np.any([one > 0 for one in contact], axis=0)])
    left = [
        _less([morisita_index(one[part != i], cells[part != i])[0] for one in contact])
        for i in occupied
    ]
    return jackknife_error(left)
