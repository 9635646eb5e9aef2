"""Restriction to the grid twice as coarse, each of whose cells holds 2 x 2 nodes."""

import numpy as np

from ..kernel_cache import njit

# Compiled, since numpy takes twenty times as long for axes of length two.


@njit(cache=True)
def restrict_minimum(values: np.ndarray) -> np.ndarray:
    """Minimum of each 2 x 2 nodes; an odd last row or column stands alone."""
    ny, nx = values.shape
    coarse_values = np.full(((ny + 1) // 2, (nx + 1) // 2), np.inf)
    for y in range(ny):
        for x in range(nx):
            coarse_values[y // 2, x // 2] = min(coarse_values[y // 2, x // 2], values[y, x])
    return coarse_values


@njit(cache=True)
def restrict_sum(values: np.ndarray) -> np.ndarray:
    """Sum of each 2 x 2 nodes; an odd last row or column stands alone."""
    ny, nx = values.shape
    coarse_values = np.zeros(((ny + 1) // 2, (nx + 1) // 2))
    for y in range(ny):
        for x in range(nx):
            coarse_values[y // 2, x // 2] += values[y, x]
    return coarse_values
