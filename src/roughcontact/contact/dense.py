"""Small dense matrices in compiled loops; a linear-algebra library would start its own threads."""

import numpy as np

from ..kernel_cache import njit


@njit(cache=True, fastmath=True)
def inverted(matrix: np.ndarray) -> np.ndarray:
    """Inverse by elimination without pivots, for positive definite matrices."""
    inverse = matrix.copy()
    n = inverse.shape[0]
    if inverse.shape[1] != n:
        raise ValueError("expected a square matrix")
    for k in range(n):
        pivot = 1 / inverse[k, k]
        inverse[k, k] = 1.0
        for b in range(n):
            inverse[k, b] *= pivot
        for a in range(n):
            if a != k:
                factor = inverse[a, k]
                inverse[a, k] = 0.0
                for b in range(n):
                    inverse[a, b] -= factor * inverse[k, b]
    return inverse


@njit(cache=True, fastmath=True)
def times(matrix: np.ndarray, values: np.ndarray) -> np.ndarray:
    """matrix values, float32."""
    if matrix.shape[1] != values.size:
        raise ValueError("expected as many values as columns")
    out = np.empty(matrix.shape[0], np.float32)
    for i in range(out.size):
        total = np.float32(0)
        for j in range(values.size):
            total += matrix[i, j] * values[j]
        out[i] = total
    return out
