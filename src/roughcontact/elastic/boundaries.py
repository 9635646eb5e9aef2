"""The operator of a window that goes on beyond its edges: repeated, or reflected at them.

A periodic window is a cell of an endless surface that repeats itself. A mirrored one is the section
of a column between frictionless walls: its surface is reflected at the edges, half a cell beyond
the outermost nodes, and so repeats itself after twice its length and width. Sinusoidal pressures of
wave number q displace such a surface by 2 p / (E* q) (H. M. Westergaard, ASME J. Appl. Mech. 6
(1939) A49; K. L. Johnson, Contact Mechanics (1985), section 13.2): Fourier modes of a periodic
window, cosines of a mirrored one. Its mean pressure, of q = 0, displaces no plane of it relative to
the mean plane: displacements have the mean zero.
"""

import numpy as np
from scipy import fft

from .convolution import Convolution, cosine_transform, fast_length

FREE, PERIODIC, MIRRORED = "free", "periodic", "mirrored"


class PeriodicConvolution:
    """The operator of a periodic window in one precision.

    Parameters
    ----------
    shape : (int, int)
        Of the fields, (ny, nx). Without prime factors over 5 these take the least time.
    sides : (float, float)
        Of a cell. What presses on it does so with its pressure on an area of 1.
    dtype : type
        float32 or float64.
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
        """The dimensionless displacement, (ny, nx), of a field of this precision.

        Raises
        ------
        ValueError
            If it has another shape or type.
        """
        if self._fast is not None:
            return self._fast(values)
        _check(values, self._shape, self._symbol.dtype)
        return fft.irfft2(fft.rfft2(values) * self._symbol, self._shape)


class MirroredConvolution:
    """The same of a window that is reflected at its edges.

    Parameters
    ----------
    shape, sides, dtype
        As of :class:`PeriodicConvolution`.
    """

    def __init__(self, shape: tuple[int, int], sides: tuple[float, float], dtype: type):
        self._symbol = _symbol(shape, period(shape, MIRRORED), sides).astype(dtype)

    def __call__(self, values: np.ndarray) -> np.ndarray:
        """The dimensionless displacement, (ny, nx), of a field of this precision.

        Raises
        ------
        ValueError
            If it has another shape or type.
        """
        _check(values, self._symbol.shape, self._symbol.dtype)
        modes = values.copy()
        for axis in (0, 1):
            cosine_transform(modes, axis, 2)
        modes *= self._symbol
        for axis in (1, 0):
            cosine_transform(modes, axis, 2, back=True)
        return modes


#: By boundary.
CONVOLUTIONS = {PERIODIC: PeriodicConvolution, MIRRORED: MirroredConvolution}


def period(shape: tuple[int, int], boundary: str) -> tuple[int, int]:
    """Cells after which a surface repeats itself, (y, x).

    Parameters
    ----------
    shape : (int, int)
        Of the window.
    boundary : str
        PERIODIC or MIRRORED.
    """
    return shape if boundary == PERIODIC else (2 * shape[0], 2 * shape[1])


def repeated_influence(
    shape: tuple[int, int], cells: tuple[int, int], sides: tuple[float, float]
) -> np.ndarray:
    """Dimensionless influence of a node with all its repetitions, at every cell distance.

    Its mean over a period is zero.

    Parameters
    ----------
    shape : (int, int)
        Distances wanted, from zero on.
    cells : (int, int)
        Of a period.
    sides : (float, float)
        Of a cell. What presses on it does so with its pressure on an area of 1.

    Returns
    -------
    (my, mx) ndarray
    """
    half = even_spectrum(_symbol((cells[0] // 2 + 1, cells[1] // 2 + 1), cells, sides), cells)
    half /= cells[0] * cells[1]
    y, x = (np.arange(n) % length for n, length in zip(shape, cells, strict=True))
    return half[np.ix_(np.minimum(y, cells[0] - y), np.minimum(x, cells[1] - x))]


def even_spectrum(half: np.ndarray, lengths: tuple[int, int]) -> np.ndarray:
    """Transform of data that are even both ways on a circle: real and even.

    Parameters
    ----------
    half : (length y // 2 + 1, length x // 2 + 1) ndarray
        Their first half; may be overwritten.
    lengths : (int, int)
        Of the circle.

    Returns
    -------
    ndarray
        Of the same shape.
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
    """2 / q of some waves along y and x around a period of cells, over an area; 0 of the mean."""
    along = [np.arange(n) / (c * d) for n, c, d in zip(waves, cells, sides, strict=True)]
    number = 2 * np.pi * np.hypot(along[0][:, None], along[1])
    number[0, 0] = np.inf
    return 2 / (sides[0] * sides[1] * number)


def _check(values, shape, dtype):
    """Refuse fields of another grid or type."""
    if values.shape != tuple(shape) or values.dtype != dtype:
        raise ValueError(f"field {values.shape} of {values.dtype}: expected {shape} of {dtype}")
