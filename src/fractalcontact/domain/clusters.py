"""Clusters of the contact domain: number, sizes and unevenness over the window."""

from typing import Any

import numpy as np
import scipy.ndimage
from numpy.typing import ArrayLike
from scipy import special

from ..core.estimate import Estimate, rows_of
from ..core.limits import CONFIDENCE

#: Numbers kept of the clusters of a domain: name, unit, long name.
CLUSTER_FIELDS = {
    "clusters": ("1", "contact clusters, neighbours by side or corner"),
    "largest_share": ("1", "fraction of the contact area in the largest cluster"),
    "cluster_area_mean": ("mm2", "mean area of a contact cluster"),
    "long_share": ("1", "fraction of the contact in clusters three times as long as wide"),
    **rows_of("cluster_exponent", "1", "beta of N(clusters of area a or more) ~ a^-beta"),
    "cluster_fit_min": ("mm2", "smallest cluster in the fit of beta"),
    "cluster_fit_max": ("mm2", "largest cluster in the fit of beta"),
    "cluster_fit_n": ("1", "clusters in the fit of beta"),
    "cluster_fit_distance": (
        "1",
        "Kolmogorov-Smirnov distance of N(a) from its power law",
    ),
    "morisita": ("1", "Morisita's index of the contact over quadrats, 1 if spread at random"),
    "morisita_scatter": ("1", "standard deviation of Morisita's index of as many random nodes"),
}

#: Quadrats of the window along each axis (fewer where cells are few), in which contact is counted.
QUADRATS = 8

#: Fewest octaves with clusters, and fewest clusters, for the fit of a power law to their sizes:
#: Clauset et al. find estimates from fewer than about 50 untrustworthy.
MIN_OCTAVES = 4
MIN_CLUSTERS = 50


#: Least ratio of length to width of a long cluster: that of three nodes in line.
MIN_ELONGATION = 3.0

#: Nodes that touch over a side or a corner belong together.
NEIGHBOURS = np.ones((3, 3), int)


def cluster_statistics(domain: ArrayLike, spacing: float) -> dict[str, Any]:
    """Number, sizes and spread of the clusters of a contact domain.

    The numbers of :data:`CLUSTER_FIELDS`, NaN where the domain cannot give them, and
    ``cluster_octaves``, clusters of 2^k to 2^(k+1) - 1 nodes for k = 0, 1, ... up to the whole
    window: an array as long for every domain on windows of as many cells. A node covers its square
    of side ``spacing``, mm.
    """
    domain = np.asarray(domain, bool)
    sizes = cluster_sizes(domain)
    number, cell = len(sizes), float(spacing) ** 2
    octaves = octave_counts(sizes, domain.size)
    contact, cells = quadrat_counts(domain)
    index, scatter = morisita_index(contact, cells)
    return {
        "clusters": float(number),
        "largest_share": sizes.max() / sizes.sum() if number else np.nan,
        "cluster_area_mean": sizes.mean() * cell if number else np.nan,
        "long_share": sizes[elongations(domain) >= MIN_ELONGATION].sum() / sizes.sum()
        if number
        else np.nan,
        **size_exponent(octaves, sizes, cell),
        "morisita": index,
        "morisita_scatter": scatter,
        "cluster_octaves": octaves,
    }


def cluster_sizes(domain: ArrayLike) -> np.ndarray:
    """Nodes in each cluster of a domain; neighbours by side or corner belong together."""
    labels, _ = scipy.ndimage.label(domain, structure=NEIGHBOURS)
    return np.bincount(labels.ravel())[1:]


def elongations(domain: np.ndarray) -> np.ndarray:
    """Length over width of each cluster, in the order of :func:`cluster_sizes`.

    Both are those of the ellipse, or rectangle, with the second moments of the cluster's cells.
    """
    labels, number = scipy.ndimage.label(domain, structure=NEIGHBOURS)
    y, x = np.nonzero(labels)
    of_node = labels[y, x] - 1
    nodes = np.bincount(of_node, minlength=number)

    def mean(values):
        return np.bincount(of_node, values, minlength=number) / np.maximum(nodes, 1)

    y, x = y - mean(y)[of_node], x - mean(x)[of_node]
    # A cell has the second moment 1/12 about its own middle.
    yy, xx, xy = mean(y * y) + 1 / 12, mean(x * x) + 1 / 12, mean(x * y)
    middle, half = (yy + xx) / 2, np.hypot((yy - xx) / 2, xy)
    # Rounding may take the moments of a line of nodes a little below their ratio.
    return np.sqrt((middle + half) / (middle - half)) * (1 + 1e-9)


def largest_void(domain: np.ndarray, spacing: tuple[float, float]) -> float:
    """Diameter of the largest disc about a node that holds no contact, mm; NaN without contact.

    The disc lies in the window, whose edges are half a cell beyond the last nodes.
    """
    if not domain.any():
        return np.nan
    free = scipy.ndimage.distance_transform_edt(~domain, spacing)
    for axis, (nodes, step) in enumerate(zip(domain.shape, spacing, strict=True)):
        places = np.arange(nodes) + 0.5
        edge = step * np.minimum(places, nodes - places)
        free = np.minimum(free, np.expand_dims(edge, 1 - axis))
    # A node in contact is at no distance from it.
    return 2 * float(free.max())


def octave_counts(sizes: np.ndarray, most: int) -> np.ndarray:
    """Clusters in each octave of nodes: 1, 2 to 3, 4 to 7, ... up to ``most`` nodes."""
    # frexp gives the binary exponent exactly; a rounded logarithm can miss a power of two.
    octave = np.frexp(sizes)[1] - 1
    return np.bincount(octave, minlength=int(most).bit_length())


def size_exponent(octaves: np.ndarray, sizes: np.ndarray, cell: float) -> dict[str, float]:
    """Exponent beta of N(clusters of area a or more) ~ a^-beta, Korcak's law.

    Parameters
    ----------
    octaves : (k,) int ndarray
        From :func:`octave_counts`.
    sizes : (clusters,) int ndarray
        Nodes in each cluster.
    cell : float
        Area of a node, mm2.

    Returns
    -------
    dict
        The ``cluster_exponent`` and ``cluster_fit`` numbers of :data:`CLUSTER_FIELDS`; NaN, and no
        clusters fitted, where no range has `MIN_OCTAVES` octaves and `MIN_CLUSTERS` clusters.

    Notes
    -----
    Maximum likelihood for counts in logarithmic bins (Virkar & Clauset, Ann. Appl. Stat. 8 (2014)
    89). With N ~ a^-beta the octave of a cluster, counted from the first one fitted, has a
    geometric distribution of ratio 2^-beta, so that the estimate is log2(1 + 1/mean) and its
    interval is the exact one of a negative binomial. As there, the first octave is the one from
    which the counts are nearest to the law (Kolmogorov and Smirnov's distance, which is kept); all
    larger clusters are in. The interval takes that range as given and the clusters as independent.
    """
    fits = [
        (distance, first, estimate)
        for first in range(len(octaves))
        if np.count_nonzero(octaves[first:]) >= MIN_OCTAVES
        and octaves[first:].sum() >= MIN_CLUSTERS
        for distance, estimate in [_geometric(octaves[first:])]
    ]
    if not fits:
        nothing = dict.fromkeys(("cluster_fit_min", "cluster_fit_max"), np.nan)
        nothing |= {"cluster_fit_n": 0.0, "cluster_fit_distance": np.nan}
        return Estimate().columns("cluster_exponent") | nothing
    distance, first, estimate = min(fits)
    fitted = sizes[sizes >= 2**first]
    return {
        **Estimate(*estimate).columns("cluster_exponent"),
        "cluster_fit_min": float(fitted.min()) * cell,
        "cluster_fit_max": float(fitted.max()) * cell,
        "cluster_fit_n": float(len(fitted)),
        "cluster_fit_distance": distance,
    }


def _geometric(counts):
    """Distance of the counts from a geometric distribution; -log2 of its ratio with interval."""
    n, places = counts.sum(), np.arange(len(counts))
    excess = np.sum(counts * places)
    ratio = excess / (n + excess)
    distance = np.max(np.abs(np.cumsum(counts) / n - (1 - ratio ** (places + 1))))
    # Clusters stop at their octave n times and go on `excess` times: a beta variable.
    tail = (1 - CONFIDENCE) / 2
    low = 1 - special.betaincinv(n, excess, 1 - tail)
    high = 1 - special.betaincinv(n, excess + 1, tail)
    return float(distance), tuple(float(-np.log2(q)) for q in (ratio, high, low))


def quadrat_counts(domain: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Nodes in contact, and all nodes, in each of `QUADRATS` by `QUADRATS` parts of the window.

    Parts of a window that cannot be divided evenly differ by a row or a column of cells.
    """
    edges = [np.arange(min(n, QUADRATS)) * n // min(n, QUADRATS) for n in domain.shape]
    contact = np.add.reduceat(domain, edges[0], axis=0, dtype=np.int64)
    contact = np.add.reduceat(contact, edges[1], axis=1)
    height, width = (np.diff(e, append=n) for e, n in zip(edges, domain.shape, strict=True))
    return contact.ravel(), np.outer(height, width).ravel()


def morisita_index(contact: ArrayLike, cells: ArrayLike) -> tuple[float, float]:
    """Morisita's index of dispersion and its scatter for random nodes; NaN below two nodes.

    The index is the ratio of two probabilities: that two nodes in contact share a quadrat, and that
    any two nodes do. It is 1 on average for nodes drawn at random, whatever their number, more
    where contact is localised, less where it is regular (Morisita, Mem. Fac. Sci. Kyushu Univ. E 2
    (1959) 215). Counted without replacement, it is exactly 1 for the full window too, and quadrats
    may differ in size. The scatter is the exact standard deviation of the multivariate
    hypergeometric counts. Thinning a domain at random leaves the expected index as it is, so that
    it compares domains of any area. Arguments are those of :func:`quadrat_counts`.
    """
    contact, cells = np.asarray(contact, float), np.asarray(cells, float)
    n, all_cells = contact.sum(), cells.sum()
    pairs = np.sum(_falling(cells, 2))
    if n < 2 or pairs == 0:
        return np.nan, np.nan

    def chance(k):
        """Probability that k given nodes are all in contact."""
        return np.prod((n - np.arange(k)) / np.maximum(all_cells - np.arange(k), 1))

    mean = chance(2) * pairs
    index = np.sum(_falling(contact, 2)) / mean
    # (n)_2 (n)_2 = (n)_4 + 4 (n)_3 + 2 (n)_2, with falling factorials (n)_k = n (n-1) ... (n-k+1);
    # those of different quadrats multiply.
    fours = pairs**2 - np.sum(_falling(cells, 2) ** 2) + np.sum(_falling(cells, 4))
    square = chance(4) * fours + 4 * chance(3) * np.sum(_falling(cells, 3)) + 2 * mean
    return float(index), float(np.sqrt(max(square - mean**2, 0)) / mean)


def _falling(n, k):
    """n (n-1) ... (n-k+1), the ordered choices of k out of n."""
    return np.prod([n - i for i in range(k)], axis=0)
