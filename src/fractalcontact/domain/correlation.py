"""Correlation dimension of a contact domain, from the distances of its pairs of nodes."""

import numpy as np
from scipy import fft

from ..core.estimate import Estimate
from ..core.fitting import fit_line
from ..core.slope_of_sums import BLOCKS, MIN_SCALES, slope_of_sums
from .box_counts import geometric_sizes

#: Smallest and largest distance of the fit: cells, and fraction of the window's shorter side.
SMALLEST_DISTANCE = 2
LARGEST_DISTANCE = 1 / 8


def pair_counts(domain: np.ndarray, distances: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of nodes within distances (k,), by the part of the window of the first node, and lags.

    Exact, by fast Fourier transform; distances are in cells, ascending, smaller than the window.
    The pairs are (k, 2, BLOCKS**2), first with the translation correction: pairs at a lag h over
    the fraction of the window that h leaves inside, as if the domain went on beyond the window;
    then without. The (k,) numbers of lags other than 0 are the pairs of each node of a filled
    window.
    """
    domain = np.asarray(domain, dtype=bool)
    reach = int(distances[-1])
    lag_y, lag_x = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    inside = (1 - np.abs(lag_y) / domain.shape[0]) * (1 - np.abs(lag_x) / domain.shape[1])
    ring, n = _rings(lag_y, lag_x, distances), len(distances)
    pairs = np.zeros((n, 2, BLOCKS**2))
    for i, part in enumerate(_parts(domain.shape)):
        # The part and its surroundings, with which its nodes pair. Zeros fill in beyond the window,
        # and keep opposite sides apart in the periodic transform.
        around = tuple(slice(max(0, along.start - reach), along.stop + reach) for along in part)
        lengths = (along.stop - along.start + 2 * reach for along in part)
        shape = [fft.next_fast_len(length, real=True) for length in lengths]
        first = np.zeros(domain.shape)
        first[part] = domain[part]
        if first.any():
            spectrum = np.conj(fft.rfft2(domain[around], shape))
            counts = np.round(fft.irfft2(fft.rfft2(first[around], shape) * spectrum, shape))
            counts = counts[lag_y, lag_x]
            for j, weighted in enumerate((counts / inside, counts)):
                by_ring = np.bincount(ring.ravel(), weights=weighted.ravel(), minlength=n + 1)
                pairs[:, j, i] = np.cumsum(by_ring[:-1])
    return pairs, np.cumsum(np.bincount(ring.ravel(), minlength=n + 1)[:-1])


def _rings(lag_y, lag_x, distances):
    """Bin of each lag's distance among the distances; lags that are no pair lie beyond."""
    lag = np.hypot(lag_y, lag_x)
    # The small number puts a lag equal to a distance into that distance's bin.
    ring = np.searchsorted(np.asarray(distances) + 1e-9, lag)
    ring[lag == 0] = len(distances)
    return ring


def _parts(shape):
    """Slices of the parts of a window."""
    edges = [np.linspace(0, n, BLOCKS + 1).astype(int) for n in shape]
    for y in range(BLOCKS):
        for x in range(BLOCKS):
            yield slice(*edges[0][y : y + 2]), slice(*edges[1][x : x + 2])


def correlation_dimension(
    domain: np.ndarray, spacing: float, fit_range: tuple[float, float] | None = None
) -> Estimate:
    """Correlation dimension D_2: pairs no farther apart than r grow as r^D_2.

    Parameters
    ----------
    domain : (ny, nx) bool array_like
        Nodes in contact.
    spacing : float
        Distance of neighbouring nodes, mm.
    fit_range : (float, float), optional
        Smallest and largest distance of the fit, mm; by default `SMALLEST_DISTANCE` cells and
        `LARGEST_DISTANCE` of the window.

    Returns
    -------
    Estimate
        D_2 with its interval, and smallest and largest distance (mm) of the fit. Distances without
        a pair are left out; NaN with too few others.

    Notes
    -----
    Pairs are taken per lag of the grid and times r^2, so that a filled window has exactly 2 at any
    distance. The interval is that of :mod:`core.slope_of_sums`.

    References
    ----------
    Grassberger, P. & Procaccia, I. 1983: Measuring the strangeness of strange attractors.
    Physica D 9.
    """
    domain = np.asarray(domain, dtype=bool)
    if fit_range is None:
        distances = pair_distances(domain.shape)
    else:
        distances = geometric_sizes(fit_range[0] / spacing, fit_range[1] / spacing)
    if distances[-1] >= min(domain.shape) or not domain.any():
        return Estimate()
    pairs, lags = pair_counts(domain, distances)
    slope = slope_of_sums(distances * float(spacing), pairs, lambda sums: sums[:, 0] / lags)
    return slope.mapped(lambda exponent: 2 + exponent).in_plane()


def pair_distances(shape: tuple[int, ...]) -> np.ndarray:
    """Distances of the fit in a window, cells, ascending."""
    return geometric_sizes(SMALLEST_DISTANCE, LARGEST_DISTANCE * min(shape))


def pairs_slope(distances: np.ndarray, pairs: np.ndarray, lags: np.ndarray) -> float:
    """Correlation dimension from the pairs of a whole window, without its interval.

    Pairs (k,) are with the translation correction, as the first of :func:`pair_counts`. NaN with
    too few distances that have a pair.
    """
    has_pairs = pairs > 0
    if np.count_nonzero(has_pairs) < MIN_SCALES:
        return np.nan
    return (
        2
        + fit_line(
            np.log(distances[has_pairs]), np.log(pairs[has_pairs] / lags[has_pairs])
        ).slope.value
    )
