"""Elastic half-space: normal displacement of a surface under a pressure, by FFT.

A free window stands alone on an infinite half-space: the convolution is zero padded, without
periodic images. Periodic and mirrored windows continue beyond their edges (`boundaries`).
"""

import warnings
from functools import partial
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import (
    field,
    number,
    pair,
    quoted,
    real_array,
    refuse_masked,
    whole_number,
)
from ..limits import MAX_INPUT, MAX_RESULT, MIN_INPUT
from ..threads import computed_once
from .boundaries import CONVOLUTIONS, FREE, even_spectrum, period, repeated_influence
from .convolution import Convolution, fast_length
from .influence import influence_table, spread
from .split_convolution import MIN_SPLIT_SIDE, SplitConvolution

#: Self-displacement E* s u / f of a node under the force f of a small contact patch: three readings
#: of the "rigid plate" of Borri-Brunetto et al. (1999), whose eq. 3 leaves the patch open. Square
#: cells only.
RIGID_PLATE_SELF_TERMS = {
    "rigid square": 1 / 1.1523,
    "equal-area disc": np.sqrt(np.pi) / 2,
    "inscribed disc": 1.0,
}
#: Most cells of a grid: compiled code numbers them in four bytes.
MAX_CELLS = 2**31 - 1
#: Largest aspect ratio of cells for the split convolution; along the longer side of more stretched
#: cells its coarse grid has too few nodes. Under random pressures it errs by 1.5e-6 of the largest
#: displacement on square cells, by 3e-6 at a ratio of 1.5, by 1e-5 at 2.5.
MAX_STRETCHED = 1.5


def rectangle_mean_displacement(a: float, b: float) -> float:
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


_E_STAR = "e_star of a HalfSpace is its modulus: write modulus, as e_star will go"


def _one_modulus(modulus, e_star):
    """Modulus of a call under either of its two names."""
    if (modulus is None) == (e_star is None):
        raise TypeError("HalfSpace: expected one modulus=E*, in MPa (10 GPa are 10e3)")
    if e_star is None:
        return modulus
    warnings.warn(_E_STAR, DeprecationWarning, stacklevel=3)
    return e_star


class HalfSpace:
    """Elastic half-space on a grid of rectangular cells: operator from pressure to displacement.

    It is immutable, and several threads may share one.

    Parameters
    ----------
    shape : (int, int)
        Number of cells (ny, nx).
    spacing : (float, float) or float
        Cell sides (dy, dx), mm; one number for square cells.
    modulus : float
        Contact modulus E*, MPa: 1/E* = sum over both bodies of (1 - nu^2)/E.
    kernel : str
        ``"love"`` (default): uniform pressure on each cell, displacement at its centre. Or one of
        the readings of the rigid plate of Borri-Brunetto et al. (1999), ``"rigid square"``,
        ``"equal-area disc"``, ``"inscribed disc"``: that self-term, and a point load on every other
        cell (free windows only).
    boundary : str
        ``"free"`` (default): the window stands alone on the half-space. ``"periodic"``: it repeats
        beyond its edges. ``"mirrored"``: it is reflected there, half a cell beyond its outermost
        nodes. The latter two have the displacement 2 p / (E* q) at each wave number q and the mean
        displacement 0, so that the closure is the approach of the mean plane.
    e_star : float, optional
        Deprecated name of ``modulus``.

    Raises
    ------
    ValueError
        If the shape, spacing, modulus, kernel or boundary is invalid.
    TypeError
        If there is not exactly one modulus.

    Examples
    --------
    >>> import numpy as np
    >>> from roughcontact import HalfSpace
    >>> space = HalfSpace((64, 64), 0.1, 20e3, boundary="periodic")  # mm, MPa
    >>> wave = 10 * np.cos(2 * np.pi * np.arange(64) / 64) * np.ones((64, 1))
    >>> wave_number = 2 * np.pi / 6.4
    >>> bool(np.allclose(space.displacement(wave), 2 / (20e3 * wave_number) * wave))
    True
    """

    _FIXED = ("shape", "spacing", "modulus", "kernel", "boundary", "cell", "_padded")

    shape: tuple[int, int]
    spacing: tuple[float, float]
    modulus: float
    kernel: str
    boundary: str
    cell: float
    _is_coarse = False

    def __init__(
        self,
        shape: tuple[int, int],
        spacing: tuple[float, float] | float,
        modulus: float | None = None,
        *,
        kernel: str = "love",
        boundary: str = FREE,
        e_star: float | None = None,
    ):
        modulus = _one_modulus(modulus, e_star)
        ny, nx = pair(shape, "shape", partial(whole_number, name="shape", least=1, most=MAX_CELLS))
        if ny * nx > MAX_CELLS:
            raise ValueError(f"shape {(ny, nx)}: expected no more than {MAX_CELLS} cells")
        sides = (spacing, spacing) if isinstance(spacing, float | Real) else spacing
        dy, dx = pair(sides, "spacing", partial(_size, name="spacing", unit="mm"))
        modulus = _size(modulus, "modulus", "MPa (10 GPa are 10e3)")
        names = ["love", *RIGID_PLATE_SELF_TERMS]
        if not isinstance(kernel, str) or kernel not in names:
            raise ValueError(f"kernel {quoted(kernel)}: expected one of {', '.join(names)}")
        if kernel != "love" and not np.isclose(dx, dy, rtol=1e-9, atol=0):
            raise ValueError("the rigid-plate kernels are known for square cells only")
        if not isinstance(boundary, str) or boundary not in (FREE, *CONVOLUTIONS):
            named = ", ".join((FREE, *CONVOLUTIONS))
            raise ValueError(f"boundary {quoted(boundary)}: expected one of {named}")
        if boundary != FREE and kernel != "love":
            raise ValueError(f"the rigid-plate kernels are those of a free window, not {boundary}")
        # Side of the square of a cell's area: the solver's unit of length in the plane.
        cell = float(np.sqrt(dy * dx))
        padded = fast_length(2 * ny - 1), fast_length(2 * nx - 1)
        vars(self).update(shape=(ny, nx), spacing=(dy, dx), modulus=modulus, kernel=kernel)
        vars(self).update(boundary=boundary, cell=cell, _padded=padded)

    def __setattr__(self, name, value):
        # Cached arrays of the old grid would be used, out of bounds, on the new one.
        if name in self._FIXED:
            raise AttributeError(f"{name} of a HalfSpace cannot be changed; make another HalfSpace")
        super().__setattr__(name, value)

    def __eq__(self, other):
        if not isinstance(other, HalfSpace):
            return NotImplemented
        return self is other or self._key == other._key

    def __hash__(self):
        return hash(self._key)

    @property
    def _key(self):
        return self.shape, self.spacing, self.modulus, self.kernel, self.boundary

    def __getstate__(self):
        return {name: vars(self)[name] for name in self._FIXED}

    def __repr__(self):
        usual = {"kernel": "love", "boundary": FREE}
        named = {name: vars(self)[name] for name in usual if vars(self)[name] != usual[name]}
        others = "".join(f", {name}={value!r}" for name, value in named.items())
        return (
            f"HalfSpace(shape={self.shape}, spacing={self.spacing}, modulus={self.modulus}{others})"
        )

    @property
    def is_free(self) -> bool:
        """True if the window stands alone; else K is singular, as constants displace nothing."""
        return self.boundary == FREE

    @property
    def e_star(self) -> float:
        """E*, MPa: deprecated name of ``modulus``."""
        warnings.warn(_E_STAR, DeprecationWarning, stacklevel=2)
        return self.modulus

    @property
    def cell_area(self) -> float:
        """Area of one cell, mm2."""
        return self.spacing[0] * self.spacing[1]

    @property
    def area(self) -> float:
        """Area of the window, mm2."""
        return self.cell_area * self.shape[0] * self.shape[1]

    def displacement(self, pressure: ArrayLike) -> np.ndarray:
        """Normal displacement of the surface under a pressure.

        Parameters
        ----------
        pressure : (ny, nx) array_like
            MPa.

        Returns
        -------
        (ny, nx) ndarray
            mm.

        Raises
        ------
        ValueError
            If the pressure is on another grid, or is not finite and real.
        """
        values = field(pressure, "pressure", self.shape)
        # Written so that it also refuses NaN, which the convolution would spread to every node.
        if not np.abs(values).max() <= MAX_RESULT:
            raise ValueError(f"pressure: expected finite numbers, none over {MAX_RESULT:g} MPa")
        return self.convolve(values) * (self.cell / self.modulus)

    def influence(self) -> np.ndarray:
        """Dimensionless influence E* u / (p cell) at every cell distance, (ny, nx), read only.

        For a periodic or mirrored window it sums all repetitions, but not the reflections.
        """
        return self._influence

    @computed_once
    def _influence(self):
        influence = self.influence_within(self.shape)
        influence.flags.writeable = False
        return influence

    def near_influence(self, side: int) -> np.ndarray:
        """Influence at distances below ``side`` cells, or the window's; cached and read only."""
        if side not in self._near:
            near = self.influence_within((min(side, self.shape[0]), min(side, self.shape[1])))
            near.flags.writeable = False
            self._near.setdefault(side, near)
        return self._near[side]

    @computed_once
    def _near(self):
        return {}

    def influence_within(self, shape: tuple[int, int]) -> np.ndarray:
        """Influence at the distances of a ``shape``, also beyond the window; not cached."""
        if not self.is_free:
            return repeated_influence(shape, period(self.shape, self.boundary), self._sides)
        return influence_table(shape, self._sides, self._self_term)

    @property
    def spread(self) -> tuple[float, float, float]:
        """Sides of the loaded area in units of `cell`, and its area: arguments of `expansion`."""
        return spread(self._sides, self._self_term)

    @property
    def _self_term(self):
        """Self-term of the rigid-plate kernels; None for Love's kernel."""
        return RIGID_PLATE_SELF_TERMS.get(self.kernel)

    @computed_once
    def _sides(self):
        """Cell sides (y, x) in units of `cell`."""
        return tuple(d / self.cell for d in self.spacing)

    def coarser(self, factor: int) -> "HalfSpace":
        """Half-space on cells ``factor`` times as long and wide, covering the window; cached.

        Distances are counted in cells, so that the influence is the same.
        """
        factor = whole_number(factor, "factor", least=1, most=MAX_CELLS)
        if factor in self._coarser:
            return self._coarser[factor]
        shape = -(-self.shape[0] // factor), -(-self.shape[1] // factor)
        sides = factor * self.spacing[0], factor * self.spacing[1]
        kernel, boundary = self.kernel, self.boundary
        coarse = HalfSpace(shape, sides, self.modulus, kernel=kernel, boundary=boundary)
        # Cell sides in units of `cell` are copied, so that the influence is the same to the bit. A
        # repeated window must keep its period, which its coarse cells may not divide.
        inside = (n / (factor * m) for n, m in zip(self.shape, shape, strict=True))
        repeated = tuple(d * part for d, part in zip(self._sides, inside, strict=True))
        within = self._sides if self.is_free else repeated
        vars(coarse).update(_sides=within, _is_coarse=True)
        return self._coarser.setdefault(factor, coarse)

    @computed_once
    def _coarser(self):
        return {}

    def convolve(self, values: np.ndarray) -> np.ndarray:
        """Dimensionless operator K on one or several fields, (..., ny, nx) float32 or float64.

        The result has the same shape and precision. NaN and infinities spread to all nodes.
        """
        if type(values) is not np.ndarray:
            refuse_masked(values, "values")
            values = real_array(values, "values")
        convolution = self._single if values.dtype.type is np.float32 else self._double
        if values.ndim == 2:
            return convolution(values)
        if values.shape[-2:] != self.shape:
            raise ValueError(f"values {values.shape}: expected (..., ny, nx) of {self.shape}")
        images = np.empty(values.shape, values.dtype)
        for index in np.ndindex(values.shape[:-2]):
            images[index] = convolution(values[index])
        return images

    @property
    def _double(self):
        return self._convolutions[0] if self._split is None else self._double_alone

    @property
    def _single(self):
        if self._split is not None:
            return self._split
        if self._is_coarse and "_convolutions" not in vars(self):
            return self._single_alone
        return self._convolutions[1]

    @computed_once
    def _convolutions(self):
        """Convolutions in double and in single precision, from one spectrum, which is not kept."""
        spectrum = self._spectrum() if self.is_free else None
        return tuple(self._convolution(dtype, spectrum) for dtype in (np.float64, np.float32))

    @computed_once
    def _single_alone(self):
        """Convolution of coarser grids, where double precision is rarely needed."""
        return self._convolution(np.float32)

    @computed_once
    def _double_alone(self):
        return self._convolution(np.float64)

    @computed_once
    def _split(self):
        """Split convolution in single precision, for large windows of nearly square cells."""
        stretched = max(self._sides) > MAX_STRETCHED * min(self._sides)
        if not self.is_free or min(self.shape) < MIN_SPLIT_SIDE or stretched:
            return None
        return SplitConvolution(self.shape, self._sides, self._self_term)

    def _convolution(self, dtype, spectrum=None):
        """Convolution in one precision."""
        if not self.is_free:
            return CONVOLUTIONS[self.boundary](self.shape, self._sides, dtype)
        spectrum = self._spectrum() if spectrum is None else spectrum
        return Convolution(spectrum, self.shape, self._padded, dtype)

    def _spectrum(self):
        """Transform of the influence on its zero-padded circle."""
        spectrum = self.influence_within(self.shape)
        for axis in (0, 1):
            n, half = self.shape[axis], self._padded[axis] // 2 + 1
            if half != n:
                spectrum = np.take(spectrum, np.minimum(np.arange(half), n - 1), axis=axis)
        return even_spectrum(spectrum, self._padded)


def _size(value, name, unit):
    """Positive size within the limits of the input."""
    size = number(value, name, unit)
    if not MIN_INPUT <= size <= MAX_INPUT:
        raise ValueError(
            f"{name} {size:g}: expected between {MIN_INPUT:g} and {MAX_INPUT:g} {unit}"
        )
    return size
