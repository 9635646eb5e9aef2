"""Operators of windows that continue beyond their edges: periodic, or mirrored at them.

A periodic window is one cell of an endless surface that repeats itself. A mirrored one is the
section of a column between frictionless walls: the surface is reflected at the edges, half a cell
beyond the outermost nodes, and so repeats itself after twice its length and width. A sinusoidal
pressure of wave number q displaces such a surface by 2 p / (E* q) (H. M. Westergaard, ASME J. Appl.
Mech. 6 (1939) A49; K. L. Johnson, Contact Mechanics (1985), section 13.2). The modes are Fourier
modes of a periodic window and cosines of a mirrored one. The mean pressure, q = 0, displaces
nothing relative to the mean plane: the mean displacement is 0.
"""

import numpy as np
from scipy import fft

from .convolution import Convolution, cosine_transform, fast_length

FREE, PERIODIC, MIRRORED = "free", "periodic", "mirrored"


class PeriodicConvolution:
    """Operator of a periodic window in one precision (``dtype``: float32 or float64).

    ``sides`` are those of a cell (y, x); a load is its pressure on an area of 1. Shapes without
    prime factors above 5 are the fastest.
    """

    def __init__(self, shape: tuple[int, int], sides: tuple[float, float], dtype: type):
        half = shape[0] // 2 + 1, shape[1] // 2 + 1
        symbol = _symbol(half, shape, sides)
        self._fast = None
        if all(n == fast_length(n) for n in shape):
            self._fast = Convolution(symbol, shape, shape, dtype, wrapped=True)
            return
        waves = np.minimum(np.arange(shape[0]), shape[0] - np.arange(shape[0]))
        self._shape, self._symbol = shape, symbol[waves].astype(dtype)

    def __call__(self, values: np.ndarray) -> np.ndarray:
        """Dimensionless displacement of a field of this shape and precision."""
        if self._fast is not None:
            return self._fast(values)
        _check(values, self._shape, self._symbol.dtype)
        return fft.irfft2(fft.rfft2(values) * self._symbol, self._shape)


class MirroredConvolution:
    """Operator of a window mirrored at its edges; arguments of `PeriodicConvolution`."""

    def __init__(self, shape: tuple[int, int], sides: tuple[float, float], dtype: type):
        self._symbol = _symbol(shape, period(shape, MIRRORED), sides).astype(dtype)

    def __call__(self, values: np.ndarray) -> np.ndarray:
        """Dimensionless displacement of a field of this shape and precision."""
        _check(values, self._symbol.shape, self._symbol.dtype)
        modes = values.copy()
        for axis in (0, 1):
            cosine_transform(modes, axis, 2)
        modes *= self._symbol
        for axis in (1, 0):
            cosine_transform(modes, axis, 2, back=True)
        return modes


#: Operators by name of the boundary.
CONVOLUTIONS = {PERIODIC: PeriodicConvolution, MIRRORED: MirroredConvolution}


def period(shape: tuple[int, int], boundary: str) -> tuple[int, int]:
    """Number of cells (y, x) after which a periodic or mirrored surface repeats itself."""
    return shape if boundary == PERIODIC else (2 * shape[0], 2 * shape[1])


def repeated_influence(
    shape: tuple[int, int], cells: tuple[int, int], sides: tuple[float, float]
) -> np.ndarray:
    """Dimensionless influence of a node with all its repetitions, at the distances of ``shape``.

    ``cells`` is the period (y, x) and ``sides`` those of a cell; a load is its pressure on an area
    of 1. The mean over a period is 0.
    """
    half = even_spectrum(_symbol((cells[0] // 2 + 1, cells[1] // 2 + 1), cells, sides), cells)
    half /= cells[0] * cells[1]
    y, x = (np.arange(n) % length for n, length in zip(shape, cells, strict=True))
    return half[np.ix_(np.minimum(y, cells[0] - y), np.minimum(x, cells[1] - x))]


def even_spectrum(half: np.ndarray, lengths: tuple[int, int]) -> np.ndarray:
    """Transform of data that are even along both axes of a circle: real, even, of the same shape.

    ``half`` is the first half of the data, (length y // 2 + 1, length x // 2 + 1); it may be
    overwritten.
    """
    for axis in (1, 0):
        if lengths[axis] % 2 == 0:
            half = cosine_transform(half, axis)
        else:
            place = np.arange(lengths[axis])
            circle = np.take(half, np.minimum(place, lengths[axis] - place), axis=axis)
            half = fft.rfft(circle, axis=axis).real
    return half


def _symbol(waves, cells, sides):
    """Symbol 2 / q of the operator per area, for the first waves along y and x; 0 at q = 0."""
    along = [np.arange(n) / (c * d) for n, c, d in zip(waves, cells, sides, strict=True)]
    number = 2 * np.pi * np.hypot(along[0][:, None], along[1])
    number[0, 0] = np.inf
    return 2 / (sides[0] * sides[1] * number)


def _check(values, shape, dtype):
    """`ValueError` for fields of another grid or dtype."""
    if values.shape != tuple(shape) or values.dtype != dtype:
        raise ValueError(f"field {values.shape} of {values.dtype}: expected {shape} of {dtype}")
