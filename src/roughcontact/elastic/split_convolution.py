"""Convolution with the influence in single precision, split into a near and a smooth part.

A zero-padded convolution transforms a window twice as long and wide as the field, as the influence
reaches from edge to edge. But its far part is smooth. With the splitting of P. P. Ewald (Ann. Phys.
369 (1921) 253) the influence is a near part that ends within some hundred cells, for which so much
padding is enough, and erf(r / s) / (pi r), which is smooth and evaluated between the nodes of a
coarse grid (U. Essmann et al., J. Chem. Phys. 103 (1995) 8577). This takes half the time of the
padded convolution and a third of its memory.
"""

import numpy as np
from scipy import special

from .. import threads
from ..kernel_cache import njit
from .convolution import Convolution, cosine_transform, fast_length
from .influence import influence_table

#: Cells between coarse nodes; coarse nodes along each axis that interpolate a value; length s of
#: the smooth part, and cut-off of the near part, both in roots of a cell's area. The displacement
#: then errs by some 1e-6 of the largest. The loops over STEP and ORDER are written out below:
#: change both places.
STEP, ORDER, SMOOTH, NEAR = 8, 6, 42, 126
#: Fewest nodes along the shorter side for which it saves time.
MIN_SPLIT_SIDE = 768
#: Time of a pass of each radix, relative to that of 4, for the choice of lengths.
_PASSES = {4: 1.0, 2: 0.7, 3: 0.9, 5: 1.5}
#: Largest length to be compared, relative to the one needed.
_LONGER = 1.1


class SplitConvolution:
    """Convolution of float32 fields of one shape with the influence.

    ``sides`` are those of a cell of area 1, ``self_term`` as in `influence_table`.
    """

    def __init__(self, shape: tuple[int, int], sides: tuple[float, float], self_term: float | None):
        # The cut-off takes more cells along their shorter side.
        near_y, near_x = (int(np.ceil(NEAR / side)) for side in sides)
        padded = _length(shape[0] + near_y), _length(shape[1] + near_x)
        half = padded[0] // 2 + 1, padded[1] // 2 + 1
        near = influence_table(half, sides, self_term)
        near -= _smooth(np.arange(half[0]), np.arange(half[1]), sides)
        self._near = Convolution(_even_spectrum(near), shape, padded, np.float32, wrapped=True)
        ny, nx = (-(-n // STEP) + ORDER - 1 for n in shape)
        padded = _length(2 * ny - 1), _length(2 * nx - 1)
        y = STEP * np.minimum(np.arange(padded[0] // 2 + 1), ny - 1)
        x = STEP * np.minimum(np.arange(padded[1] // 2 + 1), nx - 1)
        self._far = Convolution(_even_spectrum(_smooth(y, x, sides)), (ny, nx), padded, np.float32)
        self._coarse, self._weights = (ny, nx), _interpolation().astype(np.float32)

    def __call__(self, values: np.ndarray) -> np.ndarray:
        """Convolution of a field, (ny, nx) float32."""
        values = np.ascontiguousarray(values)
        result = self._near(values)
        rows = np.zeros((self._coarse[0], values.shape[1]), np.float32)
        threads.in_parts(
            lambda *part: _columns_to_coarse(*part, values, self._weights, rows),
            self._coarse[0],
            smallest=ORDER,
        )
        coarse = np.zeros(self._coarse, np.float32)
        _rows_to_coarse(rows, self._weights, coarse)
        coarse = self._far(coarse)
        transposed = np.ascontiguousarray(self._weights.T)
        threads.in_parts(
            lambda *part: _add_from_coarse(*part, coarse, self._weights, transposed, result),
            values.shape[0],
            smallest=STEP,
        )
        return result


def _length(least):
    """Fastest even transform length from ``least`` on."""
    lengths: list[int] = []
    length = fast_length(least)
    while length <= _LONGER * least or not lengths:
        if length % 2 == 0:
            lengths.append(length)
        length = fast_length(length + 1)
    return min(lengths, key=_time)


def _time(length):
    """Relative time of a transform of a length."""
    total, rest = 0.0, length
    for radix, time in _PASSES.items():
        while rest % radix == 0:
            rest //= radix
            total += time
    return length * total


def _smooth(y, x, sides):
    """Smooth part erf(r / s) / (pi r) at distances in cells along y and x, (ny, nx)."""
    distance = np.hypot(sides[0] * y[:, None], sides[1] * x)
    at_zero = distance == 0
    distance[at_zero] = 1.0
    values = special.erf(distance / SMOOTH) / (np.pi * distance)
    values[at_zero] = 2 / (np.pi**1.5 * SMOOTH)
    return values


def _even_spectrum(half):
    """Transform of a kernel that is even along both axes, from its first half, in place."""
    for axis in (1, 0):
        half = cosine_transform(half, axis)
    return half


def _interpolation():
    """Lagrange weights of the coarse nodes around each position, (STEP, ORDER)."""
    places = np.arange(ORDER) - (ORDER // 2 - 1)
    offsets = np.arange(STEP)[:, None] / STEP
    weights = np.ones((STEP, ORDER))
    for j in range(ORDER):
        for i in range(ORDER):
            if i != j:
                weights[:, j] *= ((offsets - places[i]) / (places[j] - places[i]))[:, 0]
    return weights


@njit(cache=True, nogil=True, fastmath=True)
def _columns_to_coarse(start, stop, values, weights, coarse):
    """Restriction of each column to the coarse nodes from ``start`` to ``stop``."""
    ny, nx = values.shape
    for cell in range(max(start - ORDER + 1, 0), min(stop, (ny + STEP - 1) // STEP)):
        first = cell * STEP
        for j in range(max(start - cell, 0), min(stop - cell, ORDER)):
            row = coarse[cell + j]
            if first + STEP <= ny:
                a, b, c, d = weights[0, j], weights[1, j], weights[2, j], weights[3, j]
                e, f, g, h = weights[4, j], weights[5, j], weights[6, j], weights[7, j]
                for x in range(nx):
                    row[x] += (
                        a * values[first, x]
                        + b * values[first + 1, x]
                        + c * values[first + 2, x]
                        + d * values[first + 3, x]
                        + e * values[first + 4, x]
                        + f * values[first + 5, x]
                        + g * values[first + 6, x]
                        + h * values[first + 7, x]
                    )
            else:
                for y in range(first, ny):
                    for x in range(nx):
                        row[x] += weights[y - first, j] * values[y, x]


@njit(cache=True, fastmath=True)
def _rows_to_coarse(values, weights, coarse):
    """Restriction of each row to the coarse nodes."""
    for y in range(values.shape[0]):
        for x in range(values.shape[1]):
            for j in range(ORDER):
                coarse[y, x // STEP + j] += weights[x % STEP, j] * values[y, x]


@njit(cache=True, nogil=True, fastmath=True)
def _add_from_coarse(start, stop, coarse, weights, transposed, values):
    """Add the displacement interpolated from the coarse nodes to some rows."""
    nx = values.shape[1]
    row = np.empty(coarse.shape[1], np.float32)
    for y in range(start, stop):
        row[:] = 0
        for j in range(ORDER):
            weight = weights[y % STEP, j]
            for x in range(row.size):
                row[x] += weight * coarse[y // STEP + j, x]
        for cell in range(nx // STEP):
            a, b, c = row[cell], row[cell + 1], row[cell + 2]
            d, e, f = row[cell + 3], row[cell + 4], row[cell + 5]
            for k in range(STEP):
                values[y, cell * STEP + k] += (
                    transposed[0, k] * a
                    + transposed[1, k] * b
                    + transposed[2, k] * c
                    + transposed[3, k] * d
                    + transposed[4, k] * e
                    + transposed[5, k] * f
                )
        for x in range(nx // STEP * STEP, nx):
            for j in range(ORDER):
                values[y, x] += transposed[j, x % STEP] * row[x // STEP + j]
