"""Correction of an approximate inverse for smooth pressures, on a coarse grid.

The correction is balancing (Mandel, Comm. Numer. Methods Eng. 9 (1993) 233): what a few hat
functions on the contact set can resolve is solved with the elastic operator between them, and only
what is left goes to the approximate inverse. With P the bilinear interpolation from a coarse grid
to the contact set, the hats there are Z = P Y, and the operator is taken as P K_c P' + D: K_c on
the coarse grid, D what is then missing of each node's displacement under its own load. Numbers are
small here, and loops are compiled: a library of linear algebra would set its own threads spinning
beside those of the transforms.
"""

import numpy as np

from ..core.kernel_cache import njit

#: A coarse cell is this many fine ones across, or so much larger by powers of two that the coarse
#: grid has no more than COARSE cells along a side.
FINEST_STEP, COARSE = 8, 64
#: Fine cells between hat functions; the factor is right about what varies within them.
HAT_SPACING = 80
#: Most hat functions along a side: their number squared is the size of a dense matrix.
MOST_HATS = 17
#: Added to the coarse matrix, shares of each and of its largest diagonal: hats that hold few nodes
#: may nearly coincide.
RIDGE, LEAST_RIDGE = 1e-4, 1e-6
# Types to compare with: of what else stands for them numpy has to find the type first.
_INT32, _FLOAT32 = np.dtype(np.int32), np.dtype(np.float32)
#: The coarse operator is made anew where more than this share of the nodes around any one hat
#: changed: out of date on a few nodes that stand alone it sends them back and forth for ever.
LAG = 0.25


class SmoothCorrection:
    """The coarse operator on a contact set.

    Parameters
    ----------
    space : HalfSpace
    """

    def __init__(self, space):
        step = FINEST_STEP
        while max(space.shape) > COARSE * step:
            step *= 2
        self._coarse = space.coarser(step)
        self._step, self._shape = step, space.shape
        # A load on a coarse cell is a pressure 1/step^2 of it there, on cells step times as wide.
        self._factor = np.float32(1 / step)
        near = np.zeros((2, 2))
        known = self._coarse.influence()[:2, :2]
        near[: known.shape[0], : known.shape[1]] = known
        self._near = (near * self._factor).astype(np.float32)
        self._own = np.float32(space.influence()[0, 0])
        self._knots = _knots(self._coarse, max(space.shape))
        self._hats = _hats(self._coarse, self._knots)
        self._extents = _extents(self._hats.reshape(-1, *self._coarse.shape))
        self._made_for = np.empty(0, np.int32)

    def update(self, rows, fresh):
        """Take another contact set; the operator is made anew if it lags behind.

        Parameters
        ----------
        rows : (n,) int32 ndarray
            Nodes as numbers of cells, ascending.
        fresh : bool
            Whether to make it anew in any case.

        Raises
        ------
        ValueError
            If they are no such numbers.
        """
        check_nodes(rows, self._shape)
        self._place, self._share = _interpolation(
            rows, self._shape[1], self._step, *self._coarse.shape
        )
        self._missing = _missing(self._share, self._near, self._own)
        if fresh or _most_changed(self._made_for, rows, self._shape, self._knots) > LAG:
            self._made_for = rows
            self._make_operator()

    def forget(self):
        """Make the operator anew at the next update."""
        self._made_for = np.empty(0, np.int32)

    def _make_operator(self):
        shape = self._coarse.shape
        plain, own = _masses(self._place, self._share, self._missing, *shape)
        hats = self._hats.reshape(-1, *shape)
        loads = _nine_points(plain, hats, self._extents)
        images = self._coarse.convolve(loads) * self._factor
        self._images = images.reshape(len(hats), -1)
        matrix = _products(loads, images, self._extents)
        matrix += _products(_nine_points(own, hats, self._extents), hats, self._extents)
        self._inverse = _ridged_inverse(matrix)

    def balance(self, residual, inverse):
        """The approximate inverse, corrected; symmetric and positive definite if it is.

        Parameters
        ----------
        residual : (n,) float32 ndarray
        inverse : callable
            From (n,) float32 to (n,) float32.

        Returns
        -------
        (n,) float32 ndarray

        Raises
        ------
        ValueError
            If the residual is not one on the contact set.
        """
        check_on_set(residual, self._missing.size)
        mesh = self._place, self._share, self._missing
        loads, _ = _gather(*mesh, residual, self._hats.shape[1])
        first = times(self._inverse, times(self._hats, loads))
        smooth = _combined(self._hats, first)
        fine = inverse(_less_displacement(*mesh, residual, _combined(self._images, first), smooth))
        loads, own = _gather(*mesh, fine, self._hats.shape[1])
        second = times(self._inverse, times(self._images, loads) + times(self._hats, own))
        _add_interpolated(*mesh, smooth - _combined(self._hats, second), fine)
        return fine


def check_nodes(nodes, shape):
    """Refuse what is no set of nodes: compiled code looks up whatever it is given.

    Parameters
    ----------
    nodes : (n,) int32 ndarray
        Numbers of cells, ascending.
    shape : (int, int)
        Of the grid.

    Raises
    ------
    ValueError
    """
    if nodes.ndim != 1 or nodes.dtype != _INT32 or not _ascending(nodes, shape[0] * shape[1]):
        raise ValueError(
            f"nodes {nodes.shape} of {nodes.dtype}: expected numbers of cells (n,) of int32, "
            f"ascending, on a grid of {shape}"
        )


def check_on_set(values, n):
    """Refuse what are no float32 numbers, one for each node of a contact set of n.

    Raises
    ------
    ValueError
    """
    if values.shape != (n,) or values.dtype != _FLOAT32:
        raise ValueError(f"{values.shape} numbers of {values.dtype}: expected {(n,)} of float32")


@njit(cache=True)
def _ascending(nodes, cells):
    """Whether these are numbers from 0 to cells - 1, each larger than the one before."""
    before = -1
    for node in nodes:
        if node <= before or node >= cells:
            return False
        before = node
    return True


def _knots(coarse, cells):
    """Hats along y and along x, spread evenly along ``cells`` of the longer side."""
    sides = [n * d for n, d in zip(coarse.shape, coarse.spacing, strict=True)]
    spacing = max(sides) / (min(round(cells / HAT_SPACING) + 1, MOST_HATS) - 1)
    return tuple(max(2, round(side / spacing) + 1) for side in sides)


def _hats(coarse, knots):
    """(hats, coarse cells): bilinear hats on so many knots along y and x."""
    along = []
    for n, k in zip(coarse.shape, knots, strict=True):
        at = (np.arange(n) + 0.5) / n * (k - 1)
        along.append(np.maximum(0, 1 - np.abs(at - np.arange(k)[:, None])))
    hats = np.einsum("ay,bx->abyx", *along)
    return np.ascontiguousarray(hats.reshape(-1, coarse.shape[0] * coarse.shape[1]), np.float32)


def _extents(hats):
    """First and one past the last row and column of each hat, with the cells next to it, (n, 4)."""
    ends = []
    for along in (hats.any(axis=2), hats.any(axis=1)):
        n = along.shape[1]
        ends += [np.maximum(along.argmax(axis=1) - 1, 0)]
        ends += [np.minimum(n - along[:, ::-1].argmax(axis=1) + 1, n)]
    return np.stack(ends, axis=1)


@njit(cache=True)
def _interpolation(rows, nx, step, coarse_y, coarse_x):
    """The four coarse cells between which each node lies, and its share in each."""
    place = np.empty((rows.size, 4), np.int32)
    share = np.empty((rows.size, 4), np.float32)
    for i in range(rows.size):
        y = min(max((rows[i] // nx + 0.5) / step - 0.5, 0.0), coarse_y - 1.0)
        x = min(max((rows[i] % nx + 0.5) / step - 0.5, 0.0), coarse_x - 1.0)
        low_y, low_x = min(int(y), max(coarse_y - 2, 0)), min(int(x), max(coarse_x - 2, 0))
        high_y, high_x = min(low_y + 1, coarse_y - 1), min(low_x + 1, coarse_x - 1)
        y -= low_y
        x -= low_x
        place[i, 0], share[i, 0] = low_y * coarse_x + low_x, (1 - y) * (1 - x)
        place[i, 1], share[i, 1] = low_y * coarse_x + high_x, (1 - y) * x
        place[i, 2], share[i, 2] = high_y * coarse_x + low_x, y * (1 - x)
        place[i, 3], share[i, 3] = high_y * coarse_x + high_x, y * x
    return place, share


@njit(cache=True)
def _missing(share, near, own):
    """D: a node's displacement under its own load, less what the coarse grid has of it."""
    missing = np.empty(share.shape[0], np.float32)
    for i in range(missing.size):
        a, b, c, d = share[i]
        missing[i] = own - (
            (a * a + b * b + c * c + d * d) * near[0, 0]
            + 2 * (a * b + c * d) * near[0, 1]
            + 2 * (a * c + b * d) * near[1, 0]
            + 2 * (a * d + b * c) * near[1, 1]
        )
    return missing


@njit(cache=True, fastmath=True)
def _masses(place, share, missing, coarse_y, coarse_x):
    """P'P and P'DP: for every coarse cell its products with the eight around it and itself."""
    # First between the corners of each square of coarse cells, named after the first.
    squares = np.zeros((coarse_y * coarse_x, 2, 4, 4), np.float32)
    for i in range(place.shape[0]):
        square = squares[place[i, 0]]
        for a in range(4):
            for b in range(4):
                product = share[i, a] * share[i, b]
                square[0, a, b] += product
                square[1, a, b] += product * missing[i]
    masses = np.zeros((2, 3, 3, coarse_y * coarse_x), np.float32)
    for first in range(squares.shape[0]):
        # Corners beyond a grid of one row or column have no share.
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
def _nine_points(stencil, hats, extents):
    """Such a matrix times the hats, (hats, coarse_y, coarse_x)."""
    out = np.zeros_like(hats)
    ny, nx = hats.shape[1:]
    for f in range(hats.shape[0]):
        first_y, last_y, first_x, last_x = extents[f]
        for y in range(first_y, last_y):
            for dy in range(-1 if y else 0, 2 if y < ny - 1 else 1):
                for dx in range(-1, 2):
                    for x in range(max(-dx, first_x), min(nx - dx, last_x)):
                        out[f, y, x] += stencil[dy + 1, dx + 1, y, x] * hats[f, y + dy, x + dx]
    return out


@njit(cache=True, fastmath=True)
def _products(local, fields, extents):
    """Products of fields that vanish outside their extents with others, (n, n) float64.

    What is summed is float32.
    """
    out = np.empty((local.shape[0], fields.shape[0]))
    for i in range(out.shape[0]):
        # Whole rows: as one piece of memory they take less time than their parts.
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
def inverted(matrix):
    """Inverse by elimination; a positive definite matrix needs no pivots."""
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
def _ridged_inverse(matrix):
    """Inverse of the symmetric part with the ridge, float32."""
    n = matrix.shape[0]
    inverse = (matrix + matrix.T) / 2
    largest = np.max(np.diag(inverse))
    for k in range(n):
        inverse[k, k] += RIDGE * inverse[k, k] + LEAST_RIDGE * largest
    inverse = inverted(inverse)
    return ((inverse + inverse.T) / 2).astype(np.float32)


@njit(cache=True, fastmath=True)
def times(matrix, values):
    """matrix values."""
    if matrix.shape[1] != values.size:
        raise ValueError("expected as many values as columns")
    out = np.empty(matrix.shape[0], np.float32)
    for i in range(out.size):
        total = np.float32(0)
        for j in range(values.size):
            total += matrix[i, j] * values[j]
        out[i] = total
    return out


@njit(cache=True, fastmath=True)
def _combined(matrix, values):
    """matrix' values."""
    out = np.zeros(matrix.shape[1], np.float32)
    for i in range(values.size):
        for j in range(out.size):
            out[j] += matrix[i, j] * values[i]
    return out


@njit(cache=True, fastmath=True)
def _gather(place, share, missing, values, n):
    """P' values and P' D values."""
    plain, own = np.zeros(n, np.float32), np.zeros(n, np.float32)
    for i in range(values.size):
        for a in range(4):
            part = share[i, a] * values[i]
            plain[place[i, a]] += part
            own[place[i, a]] += missing[i] * part
    return plain, own


@njit(cache=True, fastmath=True)
def _less_displacement(place, share, missing, values, image, smooth):
    """values - P image - D P smooth."""
    out = np.empty(values.size, np.float32)
    for i in range(values.size):
        displacement, pressure = np.float32(0), np.float32(0)
        for a in range(4):
            displacement += share[i, a] * image[place[i, a]]
            pressure += share[i, a] * smooth[place[i, a]]
        out[i] = values[i] - displacement - missing[i] * pressure
    return out


@njit(cache=True, fastmath=True)
def _add_interpolated(place, share, missing, field, values):
    """values += P field."""
    for i in range(values.size):
        for a in range(4):
            values[i] += share[i, a] * field[place[i, a]]


@njit(cache=True)
def only_in_one(first, second):
    """Numbers that are in one only of two ascending arrays, ascending."""
    found = np.empty(first.size + second.size, np.int32)
    a, b, n = 0, 0, 0
    while a < first.size or b < second.size:
        in_first = b == second.size or (a < first.size and first[a] <= second[b])
        in_second = a == first.size or (b < second.size and second[b] <= first[a])
        if in_first != in_second:
            found[n] = first[a] if in_first else second[b]
            n += 1
        a += in_first
        b += in_second
    return found[:n]


def _most_changed(first, second, shape, knots):
    """Of two sets of nodes together, the share that differs around the hat where it is largest."""
    changed = _around_knots(only_in_one(first, second), shape, knots)
    both = _around_knots(first, shape, knots) + _around_knots(second, shape, knots)
    return np.max(2 * changed / np.maximum(both + changed, 1))


@njit(cache=True)
def _around_knots(nodes, shape, knots):
    """How many nodes lie nearest to each knot."""
    count = np.zeros(knots)
    per_y, per_x = (knots[0] - 1) / shape[0], (knots[1] - 1) / shape[1]
    for node in nodes:
        y, x = (node // shape[1] + 0.5) * per_y, (node % shape[1] + 0.5) * per_x
        count[int(y + 0.5), int(x + 0.5)] += 1
    return count
