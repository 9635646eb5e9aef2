"""The elastic half-space: normal displacement of a free surface under a pressure, by FFT.

Free space: the window stands alone on an infinite half-space, so the convolution is zero padded and
there are no periodic images.
"""

from functools import cached_property

import numpy as np
from scipy import fft

from .fourier import Convolution, fast_length
from .screening import ContactInverse

#: Self-displacement of one node, E* s u / f, under the force f of a small contact patch, for the
#: paper's "rigid plate" (its eq. 3 leaves the patch open). Square cells only.
RIGID_PLATE_SELF_TERMS = {
    "rigid square": 1 / 1.1523,
    "equal-area disc": np.sqrt(np.pi) / 2,
    "inscribed disc": 1.0,
}


def love_displacement(x, y, dx, dy):
    """Displacement at (x, y) under uniform pressure on a rectangle centred at the origin.

    Parameters
    ----------
    x, y : array_like
        Where the displacement is wanted, mm.
    dx, dy : float
        Sides of the loaded rectangle, mm.

    Returns
    -------
    ndarray
        E* u / p in mm.

    Notes
    -----
    A. E. H. Love, Phil. Trans. R. Soc. A 228 (1929) 377: pi E* u / p is the sum over the four
    corners, signed, of X asinh(Y/|X|) + Y asinh(X/|Y|).
    """
    total = 0.0
    for sign_x in (1, -1):
        for sign_y in (1, -1):
            corner = _love_corner(x + sign_x * dx / 2, y + sign_y * dy / 2)
            total = total + sign_x * sign_y * corner
    return total / np.pi


def _love_corner(x, y):
    """X asinh(Y/|X|) + Y asinh(X/|Y|), continued by its limit where X or Y vanishes."""
    x, y = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
    first, second = np.zeros(x.shape), np.zeros(x.shape)
    np.divide(y, np.abs(x), out=first, where=x != 0)
    np.divide(x, np.abs(y), out=second, where=y != 0)
    return x * np.arcsinh(first) + y * np.arcsinh(second)


def rectangle_mean_displacement(a, b):
    """Mean of E* u / p over a uniformly loaded rectangle a x b, in the unit of a and b.

    Notes
    -----
    Love's displacement integrated over the rectangle itself. For a square of side b it is
    b [4 ln(1 + sqrt 2) - (4/3)(sqrt 2 - 1)] / pi = 0.946402 b.
    """
    diagonal = np.hypot(a, b)
    return (
        2 * a**2 * b * np.arcsinh(b / a)
        + 2 * a * b**2 * np.arcsinh(a / b)
        + 2 / 3 * (a**3 + b**3 - diagonal**3)
    ) / (np.pi * a * b)


class HalfSpace:
    """The elastic operator on a grid of rectangular cells.

    Parameters
    ----------
    shape : (int, int)
        Cells (ny, nx).
    spacing : (float, float)
        Cell sides (dy, dx), mm.
    modulus : float
        E*, MPa: 1/E* = sum over both bodies of (1 - nu^2)/E.
    kernel : str
        ``"love"`` (default): uniform pressure on each cell, displacement at its centre. Or one of
        the readings of the paper's rigid plate, ``"rigid square"``, ``"equal-area disc"``,
        ``"inscribed disc"``: that self-term, and a point load on every other cell.

    Raises
    ------
    ValueError
        If the shape, spacing, modulus or kernel makes no sense.
    """

    def __init__(self, shape, spacing, modulus, *, kernel="love"):
        ny, nx = (int(n) for n in shape)
        dy, dx = (float(d) for d in spacing)
        if ny < 1 or nx < 1:
            raise ValueError(f"shape {shape}: expected at least one cell each way")
        if not (np.isfinite([dy, dx, modulus]).all() and min(dy, dx, modulus) > 0):
            raise ValueError(f"spacing {spacing} and modulus {modulus} must be positive and finite")
        if kernel != "love" and kernel not in RIGID_PLATE_SELF_TERMS:
            names = ", ".join(["love", *RIGID_PLATE_SELF_TERMS])
            raise ValueError(f"kernel {kernel!r}: expected one of {names}")
        if kernel != "love" and not np.isclose(dx, dy, rtol=1e-9, atol=0):
            raise ValueError("the rigid-plate kernels are known for square cells only")
        self.shape = (ny, nx)
        self.spacing = (dy, dx)
        self.modulus = float(modulus)
        self.kernel = kernel
        #: Side of the square as large as a cell: the solver's unit of length in the plane.
        self.cell = float(np.sqrt(dy * dx))
        self._padded = (fast_length(2 * ny - 1), fast_length(2 * nx - 1))

    def __eq__(self, other):
        if not isinstance(other, HalfSpace):
            return NotImplemented
        return self._key == other._key

    def __hash__(self):
        return hash(self._key)

    @property
    def _key(self):
        return self.shape, self.spacing, self.modulus, self.kernel

    def __getstate__(self):
        kept = ("shape", "spacing", "modulus", "kernel", "cell", "_padded")
        return {name: self.__dict__[name] for name in kept}

    @cached_property
    def inverse(self):
        """Approximate inverse of K on a contact set, kept because the next set is much the same."""
        return ContactInverse(self)

    def forget(self):
        """Drop the approximate inverse, to save the memory or to start anew."""
        vars(self).pop("inverse", None)

    @property
    def cell_area(self):
        """Area of one cell, mm2."""
        return self.spacing[0] * self.spacing[1]

    def displacement(self, pressure):
        """Normal displacement of the surface, mm, under a pressure (ny, nx), MPa."""
        return self.convolve(np.asarray(pressure, float)) * (self.cell / self.modulus)

    def influence(self):
        """Dimensionless influence E* u / (p cell) at every cell distance, (ny, nx), read only."""
        return self._influence

    @cached_property
    def _influence(self):
        dy, dx = (d / self.cell for d in self.spacing)
        y = np.arange(self.shape[0])[:, None] * dy
        x = np.arange(self.shape[1])[None, :] * dx
        if self.kernel == "love":
            influence = love_displacement(x, y, dx, dy)
        else:
            distance = np.hypot(x, y)
            distance[0, 0] = 1.0
            influence = 1 / (np.pi * distance)
            influence[0, 0] = RIGID_PLATE_SELF_TERMS[self.kernel]
        influence.flags.writeable = False
        return influence

    def coarser(self, factor):
        """The same half-space on cells ``factor`` times as long and as wide, covering the window.

        Distances counted in cells are the same, and so is the influence. Made once and kept.
        """
        if factor in self._coarser:
            return self._coarser[factor]
        shape = tuple(-(-n // factor) for n in self.shape)
        sides = tuple(factor * d for d in self.spacing)
        coarse = HalfSpace(shape, sides, self.modulus, kernel=self.kernel)
        coarse._influence = self.influence()[: shape[0], : shape[1]]
        return self._coarser.setdefault(factor, coarse)

    @cached_property
    def _coarser(self):
        return {}

    def convolve(self, values):
        """Dimensionless operator K on fields (..., ny, nx), in the precision of ``values``."""
        convolution = self._single if values.dtype == np.float32 else self._double
        if values.ndim == 2:
            return convolution(values)
        fields = [convolution(field) for field in values.reshape(-1, *self.shape)]
        return np.stack(fields).reshape(values.shape)

    @cached_property
    def _double(self):
        return Convolution(self._spectrum(), self.shape, self._padded, np.float64)

    @cached_property
    def _single(self):
        return Convolution(self._spectrum(), self.shape, self._padded, np.float32)

    def _spectrum(self):
        """Transform of the influence in its circulant: even both ways, and so real and even."""
        spectrum = self.influence()
        for axis in (1, 0):
            n, padded = self.shape[axis], self._padded[axis]
            distance = np.minimum(np.arange(padded), padded - np.arange(padded))
            circulant = np.take(spectrum, np.minimum(distance, n - 1), axis=axis)
            spectrum = fft.rfft(circulant, axis=axis).real
        return spectrum
