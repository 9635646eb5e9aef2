"""Fractional Brownian surfaces, exact at the nodes of a grid."""

from functools import lru_cache

import numpy as np


@lru_cache(2)
def _amplitudes(n, hurst):
    """Roots of the eigenvalues of a periodic covariance, and the nodes of its period."""
    side = int(np.ceil(np.sqrt(2) * n)) + 1
    lag = np.minimum(np.arange(2 * side), 2 * side - np.arange(2 * side)) / side
    distance = np.hypot(lag[:, np.newaxis], lag)
    covariance = 1 - hurst + hurst * distance**2 - distance ** (2 * hurst)
    eigenvalues = np.fft.rfft2(np.where(distance <= 1, covariance, 0)).real
    assert eigenvalues.min() > -1e-9 * eigenvalues.max()
    return np.sqrt(np.maximum(eigenvalues, 0)), 2 * side


def brownian_surface(n, hurst, seed):
    """Points of a fractional Brownian surface but for a plane, H up to 3/4, (n, n).

    Intrinsic embedding: Stein, J. Comput. Graph. Stat. 11 (2002) 587. The mean square difference is
    h^(2H) less that of a plane of random slope, which levelling takes off.
    """
    amplitudes, side = _amplitudes(n, hurst)
    noise = np.random.default_rng(seed).standard_normal((side, side))
    return np.fft.irfft2(np.fft.rfft2(noise) * amplitudes, s=(side, side))[:n, :n]
