"""Coarse correction of the preconditioner for smooth pressures (balancing, two-level Schwarz).

The error of the sparse factor is smooth: it displaces too little under widespread pressures.
Balancing (J. Mandel, Balancing domain decomposition, Comm. Numer. Methods Eng. 9 (1993) 233) solves
the part that a few coarse basis functions on the contact set can resolve, with the elastic operator
between them, and leaves the rest to the factor. With P the bilinear interpolation from a coarse
grid to the contact set and Y piecewise bilinear functions on that grid, the basis is Z = P Y, and
the operator is approximated by P K_c P' + D: K_c on the coarse grid, and D the part of each node's
displacement under its own load that P K_c P' lacks. Matrices are small here and loops compiled: the
threads of a linear-algebra library would compete with those of the transforms.
"""

from collections.abc import Callable

import numpy as np

from ..elastic.halfspace import HalfSpace
from ..kernel_cache import njit
from .dense import inverted, times
from .node_sets import check_nodes, check_on_set, symmetric_difference

#: Fine cells along a coarse cell, doubled until the coarse grid has at most COARSE cells along a
#: side.
FINEST_STEP, COARSE = 8, 64
#: Fine cells between coarse basis functions; variations over less are left to the factor.
BASIS_SPACING = 80
#: Most basis functions along a side: their number squared is the size of a dense matrix.
MAX_ALONG_SIDE = 17
#: Ridge of the coarse matrix, as fractions of each diagonal entry and of the largest: basis
#: functions with few nodes may nearly coincide.
RIDGE, MIN_RIDGE = 1e-4, 1e-6
#: Largest fraction of changed nodes around any basis function before the coarse operator is
#: rebuilt: an outdated operator makes a few isolated nodes cycle.
LAG = 0.25


class CoarseCorrection:
    """Coarse operator of a contact set, and the preconditioner balanced with it."""

    def __init__(self, space: HalfSpace):
        step = FINEST_STEP
        while max(space.shape) > COARSE * step:
            step *= 2
        self._coarse = space.coarser(step)
        self._step, self._shape = step, space.shape
        # A load on a coarse cell is 1/step^2 of its pressure, on a cell step times as wide.
        self._factor = np.float32(1 / step)
        near = np.zeros((2, 2))
        influence = self._coarse.near_influence(2)
        near[: influence.shape[0], : influence.shape[1]] = influence
        self._near = (near * self._factor).astype(np.float32)
        self._own = np.float32(space.near_influence(1)[0, 0])
        self._counts = _basis_counts(self._coarse, max(space.shape))
        self._basis = _basis_functions(self._coarse, self._counts)
        self._extents = _extents(self._basis.reshape(-1, *self._coarse.shape))
        self._made_for = np.empty(0, np.int32)

    def update(self, nodes: np.ndarray, fresh: bool) -> None:
        """Move to another contact set, (n,) int32 ascending numbers of cells.

        The coarse operator is rebuilt if ``fresh``, or if the set differs too much (`LAG`).
        """
        check_nodes(nodes, self._shape)
        self._cells, self._weights = _interpolation(
            nodes, self._shape[1], self._step, *self._coarse.shape
        )
        self._missing = _missing(self._weights, self._near, self._own)
        if fresh or _most_changed(self._made_for, nodes, self._shape, self._counts) > LAG:
            self._made_for = nodes
            self._make_operator()

    def forget(self) -> None:
        """Rebuild the operator at the next update."""
        self._made_for = np.empty(0, np.int32)

    def _make_operator(self):
        shape = self._coarse.shape
        mass, own = _mass_matrices(self._cells, self._weights, self._missing, *shape)
        basis = self._basis.reshape(-1, *shape)
        loads = _nine_point_products(mass, basis, self._extents)
        images = self._coarse.convolve(loads) * self._factor
        self._images = images.reshape(len(basis), -1)
        matrix = _products(loads, images, self._extents)
        matrix += _products(_nine_point_products(own, basis, self._extents), basis, self._extents)
        self._inverse = _ridged_inverse(matrix)

    def balance(
        self, residual: np.ndarray, inverse: Callable[[np.ndarray], np.ndarray]
    ) -> np.ndarray:
        """Balanced approximate inverse applied to a residual, (n,) float32 on the contact set.

        It is symmetric and positive definite if ``inverse`` is.
        """
        check_on_set(residual, self._missing.size)
        mesh = self._cells, self._weights, self._missing
        loads, _ = _restrict(*mesh, residual, self._basis.shape[1])
        first = times(self._inverse, times(self._basis, loads))
        smooth = _combined(self._basis, first)
        fine = inverse(
            _subtract_displacement(*mesh, residual, _combined(self._images, first), smooth)
        )
        loads, own = _restrict(*mesh, fine, self._basis.shape[1])
        second = times(self._inverse, times(self._images, loads) + times(self._basis, own))
        _add_prolonged(*mesh, smooth - _combined(self._basis, second), fine)
        return fine


def _basis_counts(coarse, cells):
    """Number of basis functions along y and x, evenly spaced; ``cells`` along the longer side."""
    sides = [n * d for n, d in zip(coarse.shape, coarse.spacing, strict=True)]
    spacing = max(sides) / (min(round(cells / BASIS_SPACING) + 1, MAX_ALONG_SIDE) - 1)
    return tuple(max(2, round(side / spacing) + 1) for side in sides)


def _basis_functions(coarse, counts):
    """Piecewise bilinear functions, (functions, coarse cells), ``counts`` along y and x."""
    along = []
    for n, k in zip(coarse.shape, counts, strict=True):
        positions = (np.arange(n) + 0.5) / n * (k - 1)
        along.append(np.maximum(0, 1 - np.abs(positions - np.arange(k)[:, None])))
    basis = np.einsum("ay,bx->abyx", *along)
    return np.ascontiguousarray(basis.reshape(-1, coarse.shape[0] * coarse.shape[1]), np.float32)


def _extents(basis):
    """First and last row and column (exclusive) of each function with its adjacent cells."""
    ends = []
    for along in (basis.any(axis=2), basis.any(axis=1)):
        n = along.shape[1]
        ends += [np.maximum(along.argmax(axis=1) - 1, 0)]
        ends += [np.minimum(n - along[:, ::-1].argmax(axis=1) + 1, n)]
    return np.stack(ends, axis=1)


@njit(cache=True)
def _interpolation(nodes, nx, step, coarse_y, coarse_x):
    """The four coarse cells around each node, and its weight in each."""
    cells = np.empty((nodes.size, 4), np.int32)
    weights = np.empty((nodes.size, 4), np.float32)
    for i in range(nodes.size):
        y = min(max((nodes[i] // nx + 0.5) / step - 0.5, 0.0), coarse_y - 1.0)
        x = min(max((nodes[i] % nx + 0.5) / step - 0.5, 0.0), coarse_x - 1.0)
        low_y, low_x = min(int(y), max(coarse_y - 2, 0)), min(int(x), max(coarse_x - 2, 0))
        high_y, high_x = min(low_y + 1, coarse_y - 1), min(low_x + 1, coarse_x - 1)
        y -= low_y
        x -= low_x
        cells[i, 0], weights[i, 0] = low_y * coarse_x + low_x, (1 - y) * (1 - x)
        cells[i, 1], weights[i, 1] = low_y * coarse_x + high_x, (1 - y) * x
        cells[i, 2], weights[i, 2] = high_y * coarse_x + low_x, y * (1 - x)
        cells[i, 3], weights[i, 3] = high_y * coarse_x + high_x, y * x
    return cells, weights


@njit(cache=True)
def _missing(weights, near, own):
    """D: displacement of a node under its own load, minus that on the coarse grid."""
    missing = np.empty(weights.shape[0], np.float32)
    for i in range(missing.size):
        a, b, c, d = weights[i]
        missing[i] = own - (
            (a * a + b * b + c * c + d * d) * near[0, 0]
            + 2 * (a * b + c * d) * near[0, 1]
            + 2 * (a * c + b * d) * near[1, 0]
            + 2 * (a * d + b * c) * near[1, 1]
        )
    return missing


@njit(cache=True, fastmath=True)
def _mass_matrices(cells, weights, missing, coarse_y, coarse_x):
    """P'P and P'DP as nine-point stencils of the coarse cells."""
    # Products between the corners of each square of coarse cells, indexed by its first cell.
    squares = np.zeros((coarse_y * coarse_x, 2, 4, 4), np.float32)
    for i in range(cells.shape[0]):
        square = squares[cells[i, 0]]
        for a in range(4):
            for b in range(4):
                product = weights[i, a] * weights[i, b]
                square[0, a, b] += product
                square[1, a, b] += product * missing[i]
    masses = np.zeros((2, 3, 3, coarse_y * coarse_x), np.float32)
    for first in range(squares.shape[0]):
        # Corners outside a grid of one row or column have no weight.
        if squares[first, 0].any():
            for a in range(4):
                cell = first + a // 2 * coarse_x + a % 2
                if cell < squares.shape[0]:
                    for b in range(4):
                        dy, dx = b // 2 - a // 2, b % 2 - a % 2
                        masses[0, dy + 1, dx + 1, cell] += squares[first, 0, a, b]
                        masses[1, dy + 1, dx + 1, cell] += squares[first, 1, a, b]
    shape = (3, 3, coarse_y, coarse_x)
    return masses[0].reshape(shape), masses[1].reshape(shape)


@njit(cache=True, fastmath=True)
def _nine_point_products(stencil, basis, extents):
    """Product of a stencil matrix with the basis, (functions, coarse_y, coarse_x)."""
    out = np.zeros_like(basis)
    ny, nx = basis.shape[1:]
    for f in range(basis.shape[0]):
        first_y, last_y, first_x, last_x = extents[f]
        for y in range(first_y, last_y):
            for dy in range(-1 if y else 0, 2 if y < ny - 1 else 1):
                for dx in range(-1, 2):
                    for x in range(max(-dx, first_x), min(nx - dx, last_x)):
                        out[f, y, x] += stencil[dy + 1, dx + 1, y, x] * basis[f, y + dy, x + dx]
    return out


@njit(cache=True, fastmath=True)
def _products(local, fields, extents):
    """Products of functions that vanish outside their extents with other fields, (n, n) float64.

    Sums are in float32.
    """
    out = np.empty((local.shape[0], fields.shape[0]))
    for i in range(out.shape[0]):
        # Whole rows, since contiguous memory is faster than the parts within the extent.
        first, last = extents[i, 0], extents[i, 1]
        own = local[i, first:last].reshape(-1)
        for j in range(out.shape[1]):
            other = fields[j, first:last].reshape(-1)
            total = np.float32(0)
            for k in range(own.size):
                total += own[k] * other[k]
            out[i, j] = total
    return out


@njit(cache=True, fastmath=True)
def _ridged_inverse(matrix):
    """Inverse of the symmetric part plus the ridge, float32."""
    n = matrix.shape[0]
    inverse = (matrix + matrix.T) / 2
    largest = np.max(np.diag(inverse))
    for k in range(n):
        inverse[k, k] += RIDGE * inverse[k, k] + MIN_RIDGE * largest
    inverse = inverted(inverse)
    return ((inverse + inverse.T) / 2).astype(np.float32)


@njit(cache=True, fastmath=True)
def _combined(matrix, values):
    """Product of the transposed matrix and the values."""
    out = np.zeros(matrix.shape[1], np.float32)
    for i in range(values.size):
        for j in range(out.size):
            out[j] += matrix[i, j] * values[i]
    return out


@njit(cache=True, fastmath=True)
def _restrict(cells, weights, missing, values, n):
    """P' values and P' D values."""
    plain, own = np.zeros(n, np.float32), np.zeros(n, np.float32)
    for i in range(values.size):
        for a in range(4):
            weighted = weights[i, a] * values[i]
            plain[cells[i, a]] += weighted
            own[cells[i, a]] += missing[i] * weighted
    return plain, own


@njit(cache=True, fastmath=True)
def _subtract_displacement(cells, weights, missing, values, image, smooth):
    """values - P image - D P smooth."""
    out = np.empty(values.size, np.float32)
    for i in range(values.size):
        displacement, pressure = np.float32(0), np.float32(0)
        for a in range(4):
            displacement += weights[i, a] * image[cells[i, a]]
            pressure += weights[i, a] * smooth[cells[i, a]]
        out[i] = values[i] - displacement - missing[i] * pressure
    return out


@njit(cache=True, fastmath=True)
def _add_prolonged(cells, weights, missing, field, values):
    """values += P field."""
    for i in range(values.size):
        for a in range(4):
            values[i] += weights[i, a] * field[cells[i, a]]


def _most_changed(first, second, shape, counts):
    """Largest fraction of nodes around one basis function by which two sets differ."""
    changed = _around_functions(symmetric_difference(first, second), shape, counts)
    both = _around_functions(first, shape, counts) + _around_functions(second, shape, counts)
    return np.max(2 * changed / np.maximum(both + changed, 1))


@njit(cache=True)
def _around_functions(nodes, shape, counts):
    """Number of nodes nearest to the centre of each basis function."""
    count = np.zeros(counts)
    per_y, per_x = (counts[0] - 1) / shape[0], (counts[1] - 1) / shape[1]
    for node in nodes:
        y, x = (node // shape[1] + 0.5) * per_y, (node % shape[1] + 0.5) * per_x
        count[int(y + 0.5), int(x + 0.5)] += 1
    return count
