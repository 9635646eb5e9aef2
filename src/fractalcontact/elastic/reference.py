"""Plain twin of the convolution: what `convolution.Convolution` computes, in a few lines of scipy.

It documents the hand-written transforms, and is what the tests compare them with.
"""

import numpy as np
from scipy import fft


def convolution(kernel: np.ndarray, field: np.ndarray) -> np.ndarray:
    """Zero-padded convolution of a field with an even kernel.

    Parameters
    ----------
    kernel : (ny, nx) ndarray
        At distances from zero on; it is the same at negative ones.
    field : (ny, nx) ndarray

    Returns
    -------
    (ny, nx) ndarray
        At (y, x) the sum over all (j, i) of kernel(abs(y - j), abs(x - i)) field(j, i).
    """
    ny, nx = field.shape
    # Long enough that what is periodic in the transform does not reach round into the window.
    padded = [fft.next_fast_len(2 * n - 1, real=True) for n in field.shape]
    circulant = np.zeros(padded)
    y, x = np.arange(1 - ny, ny)[:, None], np.arange(1 - nx, nx)
    circulant[y, x] = kernel[np.abs(y), np.abs(x)]
    product = fft.rfft2(circulant) * fft.rfft2(field, s=padded)
    return fft.irfft2(product, s=padded)[:ny, :nx]
