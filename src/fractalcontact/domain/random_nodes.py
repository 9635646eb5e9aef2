"""Random nodes, the first null model of a contact domain: bands of draws, exact expectations."""

import numpy as np
import scipy.ndimage

from ..core.estimate import NO_ESTIMATE, Estimate
from ..core.intervals import t_quantile
from ..core.ranges import in_cells
from .box_counts import mean_count, minimal_cover
from .clusters import NEIGHBOURS
from .mean_law import FoundLaw, dimension_by_means, find_law
from .ordinary_dimension import dyadic_sizes

#: Draws of random nodes. The band allows for their number.
DRAWS = 20


def band_of(draws: np.ndarray) -> Estimate:
    """Mean of draws (n, ...) and the band that holds one more normal draw with 95 % probability.

    NaN where fewer than half of the draws have a value.
    """
    draws = np.asarray(draws, float)
    has_value = np.isfinite(draws)
    n = has_value.sum(axis=0)
    enough = n >= max(len(draws) / 2, 2)
    count = np.maximum(n, 2)
    mean = np.where(has_value, draws, 0).sum(axis=0) / count
    variance = np.where(has_value, (draws - mean) ** 2, 0).sum(axis=0) / (count - 1)
    half = t_quantile(count - 1) * np.sqrt(variance * (1 + 1 / count))
    mean = np.where(enough, mean, np.nan)
    return Estimate(mean, mean - half, mean + half)


def random_bands(
    shape: tuple[int, int],
    nodes: int,
    *,
    mask: np.ndarray | None = None,
    limits: tuple[float, float] = (0.0, np.inf),
    whole_cells: bool | None = False,
    law: FoundLaw | None = None,
    draws: int = DRAWS,
) -> tuple[dict[str, Estimate], Estimate]:
    """Bands of ``delta_sigma`` and ``clusters`` of random nodes, and of their minimal cover.

    Parameters are those of :func:`domain.null_models.null_models` and of
    :func:`domain.mean_law.law_of_means`. ``law`` is that of the domain compared: the draws' laws
    are fitted over the same boxes; by default each draw has its own range, between its own
    cut-offs. The cover is over :func:`domain.ordinary_dimension.dyadic_sizes`. NaN for fewer than
    two nodes.

    The same shape and number draw the same nodes on every run. Nodes at random cross over from
    single points to full boxes, a slope of 2 + ln f / ln R over R cells at a fraction f in contact:
    a domain is compared with that slope over its own boxes. A draw whose own range is empty, as its
    nodes are alone or its boxes full at all sizes, has the limit 0 or 2.
    """
    sizes = dyadic_sizes(shape)
    cells = np.arange(np.prod(shape)) if mask is None else np.flatnonzero(mask)
    rows: dict[str, list[float]] = {"delta_sigma": [], "clusters": []}
    covers = []
    for seed in range(draws if nodes > 1 else 0):
        domain = random_nodes(shape, nodes, cells, seed)
        if law is None:
            dimension, cover = dimension_by_means(
                domain, sizes, limits=limits, whole_cells=whole_cells
            )
        else:
            cover = minimal_cover(domain, sizes)
            mean = mean_count(domain, law.separating).ravel()
            dimension = law.refound(mean, whole_cells)
        covers.append(cover)
        rows["delta_sigma"].append(dimension)
        rows["clusters"].append(scipy.ndimage.label(domain, NEIGHBOURS)[1])
    if not covers:
        missing = np.full(sizes.size, np.nan)
        return dict.fromkeys(rows, NO_ESTIMATE), Estimate(missing, missing, missing)
    bands = {name: band_of(np.array(values)) for name, values in rows.items()}
    bands["delta_sigma"] = bands["delta_sigma"].in_plane()
    return bands, band_of(np.array(covers))


def random_nodes(shape: tuple[int, int], nodes: int, cells: np.ndarray, seed: int) -> np.ndarray:
    """As many different nodes at random, (ny, nx) bool; the same ones for the same arguments.

    ``cells`` (m,) are the flat indices to draw from.
    """
    rng = np.random.default_rng([*shape, cells.size, nodes, seed])
    domain = np.zeros(int(np.prod(shape)), bool)
    domain[cells[rng.choice(cells.size, nodes, replace=False, shuffle=False)]] = True
    return domain.reshape(shape)


def expected_mean_counts(shape: tuple[int, int], nodes: int, sizes: np.ndarray) -> np.ndarray:
    """Exact expectation of the mean box counts of random nodes, at box sides ``sizes`` in cells.

    A box that holds m cells of the window is empty with the probability that all nodes lie in the
    others, C(M - m, N) / C(M, N); the count is the sum of its complement over the places of a
    gliding box, divided by its area.
    """
    cells = int(np.prod(shape))
    left = np.arange(min(int(sizes.max()) ** 2, cells))
    with np.errstate(divide="ignore"):
        steps = np.log(np.maximum(cells - nodes - left, 0)) - np.log(cells - left)
    empty = np.exp(np.concatenate([[0.0], np.cumsum(steps)]))
    counts = []
    for size in sizes:
        held = [
            np.minimum.reduce([np.full_like(p, min(size, n)), p + size, n - p])
            for n, p in ((n, np.arange(1 - size, n)) for n in shape)
        ]
        (along_y, times_y), (along_x, times_x) = (np.unique(n, return_counts=True) for n in held)
        occupied = 1 - empty[np.outer(along_y, along_x)]
        counts.append(times_y @ occupied @ times_x / size**2)
    return np.array(counts)


def expected_dimension(
    domain: np.ndarray, spacing: float, *, fit_range: tuple[float, float] | None = None
) -> float:
    """Delta_sigma of as many random nodes over the boxes of a domain's law, from expected counts.

    Spacing and fit range are in mm, as of :func:`domain.box_dimension.box_dimension`. NaN where the
    domain, or random nodes at its boxes, follow no law.
    """
    limits = in_cells(fit_range, spacing)
    law = find_law(domain, limits, False)
    if law is None:
        return np.nan
    counts = expected_mean_counts(domain.shape, int(np.count_nonzero(domain)), law.separating)
    return law.refound(counts, False)
