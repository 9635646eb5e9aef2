"""The correlation dimension of a contact domain, from the distances of its pairs of nodes."""

import numpy as np
from scipy import fft

from ..core.slope_of_sums import BLOCKS, NO_SLOPE, Slope, slope_of_sums
from .box_counts import geometric_sizes

#: Smallest and largest distance of the fit: cells, and fraction of the window's shorter side.
SMALLEST_DISTANCE = 2
LARGEST_DISTANCE = 1 / 8


def pair_counts(domain: np.ndarray, distances: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of nodes no farther apart than some distances, by the part that holds the first.

    Exact, by fast Fourier transform.

    Parameters
    ----------
    domain : (ny, nx) bool array_like
    distances : (k,) array_like
        Cells, ascending, smaller than the window.

    Returns
    -------
    pairs : (k, 2, BLOCKS**2) float64
        First with the translation correction: pairs at a lag h over the fraction of the window that
        h leaves inside, as if the domain went on beyond the window. Then as they are.
    lags : (k,) int64
        How many lags but 0 there are: pairs that a filled window has, for each of its nodes.
    """
    domain = np.asarray(domain, dtype=bool)
    reach = int(distances[-1])
    # Zeros as wide as the largest lag keep opposite sides of the window apart.
    shape = [fft.next_fast_len(n + reach, real=True) for n in domain.shape]
    spectrum = np.conj(fft.rfft2(domain, shape))
    lag_y, lag_x = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    inside = (1 - np.abs(lag_y) / domain.shape[0]) * (1 - np.abs(lag_x) / domain.shape[1])
    lag = np.hypot(lag_y, lag_x)
    # Lag 0 is no pair; the small number keeps a lag at its own distance.
    ring = np.searchsorted(np.asarray(distances) + 1e-9, lag.ravel())
    ring[lag.ravel() == 0] = len(distances)
    rings = len(distances) + 1
    pairs = np.zeros((len(distances), 2, BLOCKS**2))
    for i, part in enumerate(_parts(domain.shape)):
        first = np.zeros(domain.shape)
        first[part] = domain[part]
        if first.any():
            counts = np.round(fft.irfft2(fft.rfft2(first, shape) * spectrum, shape))
            counts = counts[lag_y, lag_x]
            for j, weighted in enumerate((counts / inside, counts)):
                by_ring = np.bincount(ring, weights=weighted.ravel(), minlength=rings)
                pairs[:, j, i] = np.cumsum(by_ring[:-1])
    return pairs, np.cumsum(np.bincount(ring, minlength=rings)[:-1])


def _parts(shape):
    """Slices of the parts of a window."""
    edges = [np.linspace(0, n, BLOCKS + 1).astype(int) for n in shape]
    for y in range(BLOCKS):
        for x in range(BLOCKS):
            yield slice(*edges[0][y : y + 2]), slice(*edges[1][x : x + 2])


def correlation_dimension(
    domain: np.ndarray, spacing: float, fit_range: tuple[float, float] | None = None
) -> Slope:
    """Correlation dimension D_2: pairs no farther apart than r grow as r^D_2.

    Parameters
    ----------
    domain : (ny, nx) bool array_like
        Nodes in contact.
    spacing : float
        mm.
    fit_range : (float, float), optional
        Smallest and largest distance of the fit, mm; by default `SMALLEST_DISTANCE` cells and
        `LARGEST_DISTANCE` of the window.

    Returns
    -------
    Slope
        D_2 with its interval, and smallest and largest distance (mm) of the fit. Distances without
        a pair are left out; `NO_SLOPE` with too few others.

    Notes
    -----
    Pairs are taken per lag of the grid and times r^2, so that a filled window has exactly 2 at any
    distance. The interval is that of :mod:`core.slope_of_sums`: the jackknife over parts of
    the window, the two halves of the range, and the value of a domain that ends at the window.

    References
    ----------
    Grassberger, P. & Procaccia, I. 1983: Measuring the strangeness of strange attractors.
    Physica D 9.
    """
    domain = np.asarray(domain, dtype=bool)
    if fit_range is None:
        fit_range = SMALLEST_DISTANCE * spacing, LARGEST_DISTANCE * min(domain.shape) * spacing
    distances = geometric_sizes(fit_range[0] / spacing, fit_range[1] / spacing)
    if distances[-1] >= min(domain.shape) or not domain.any():
        return NO_SLOPE
    pairs, lags = pair_counts(domain, distances)
    slope = slope_of_sums(
        distances * float(spacing),
        pairs,
        lambda sums: sums[:, 0] / lags,
        lambda sums: sums[:, 1] / lags,
    )
    return slope._replace(value=2 + slope.value, low=2 + slope.low, high=2 + slope.high)
