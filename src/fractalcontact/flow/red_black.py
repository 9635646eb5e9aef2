"""Equations of the open cells of a grid, the black cells of a chessboard eliminated by hand.

The star-mesh transform joins the four neighbours of an eliminated cell by conductances a b / sum.
Equations of half the size remain, and no difference of nearly equal numbers is taken.
The others are solved by CHOLMOD, which comes with `cvxopt`: that is under the GPL and therefore an
optional dependency (the extra ``flow``). Without it SuperLU of scipy solves the same equations.
"""

from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from roughcontact.kernel_cache import njit

try:
    import cvxopt
    import cvxopt.cholmod
except ImportError:
    cvxopt = None

#: Steps in rows and columns to the neighbours of a cell: up, left, right, down.
NEIGHBOURS = ((-1, 0), (0, -1), (0, 1), (1, 0))
#: Place of the later of two neighbours of a black cell, seen from the earlier: each of the two has
#: four later ones within two steps.
_LATER = ((-1, 1, 2, 3), (-1, -1, 0, 2), (-1, -1, -1, 1))
#: Cells of a box that is not dissected further.
MAX_LEAF = 32


class RedBlackCells:
    """Cells with an equation, and the solver of their mass balance.

    Parameters
    ----------
    gap : (ny, nx) ndarray
        g of the cells, whose conductivity is g^3.
    ends : (2, ny, nx) ndarray
        Conductance to the inlet and to the outlet over the conductivity of the cell.
    cells : (ny, nx) bool ndarray
        Cells with an equation: of positive conductivity, each joined to an end.
    spacing : (float, float)
        Sides (dy, dx) of a cell, mm.
    linear : bool
        Whether faces have the conductance :func:`face_conductivity` of an aperture that is linear
        between the cells, in place of the harmonic mean of their conductivities.

    Attributes
    ----------
    numbers : (ny, nx) int ndarray
        Of the cells: the red ones as they are eliminated, then the black ones; -1 for none.
    faces : (n_black, 4) ndarray
        Conductances of a black cell to its neighbours up, left, right, down; 0 where none is.
    neighbours : (n_black, 4) int ndarray
        Numbers of these; 0 where none is.
    ends : (2, n) ndarray
        Conductances of the cells to the inlet and to the outlet.

    Raises
    ------
    ArithmeticError
        If a pivot is not positive: the equations are singular to the precision of the numbers.
    """

    def __init__(
        self,
        gap: np.ndarray,
        ends: np.ndarray,
        cells: np.ndarray,
        spacing: tuple[float, float],
        *,
        linear: bool = False,
    ):
        self.numbers, n_red = _numbered(cells)
        dy, dx = spacing
        ratios = np.array([dx / dy, dy / dx, dy / dx, dx / dy])
        self.faces, self.neighbours, self.ends = _assembled(
            gap, ends, self.numbers, n_red, cells.sum(), ratios, linear
        )
        both = self.ends.sum(axis=0)
        self._over = 1 / (self.faces.sum(axis=1) + both[n_red:])
        diagonal, later, joined = _mesh(self.faces, self.neighbours, both, self._over)
        held = np.flatnonzero(later)
        pair = held // 4, joined.ravel()[held]
        entries = [np.append(np.arange(n_red), of(*pair)) for of in (np.maximum, np.minimum)]
        values = np.append(diagonal, -later.ravel()[held])
        lower = sparse.coo_array((values, entries), shape=(n_red, n_red))
        self._solve_red = _factorised(lower) if n_red else np.copy
        each = np.arange(0, self.faces.size + 1, 4)
        self._joins = sparse.csr_array(
            (self.faces.ravel(), self.neighbours.ravel(), each), shape=(len(each) - 1, both.size)
        )

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Solution (n,) of a right side (n,)."""
        n_red = right.size - self._over.size
        values = right.copy()
        values[n_red:] *= self._over
        values += self._joins.T @ values[n_red:]
        values[:n_red] = self._solve_red(values[:n_red])
        values[n_red:] += self._over * (self._joins @ values)
        return values


def _factorised(lower):
    """Solver of A x = b by the lower triangle of A, its rows eliminated as they are."""
    return _by_cholmod(lower) if cvxopt else _by_superlu(lower)


def _by_cholmod(lower):
    cholmod, matrix = cvxopt.cholmod, cvxopt.spmatrix(lower.data, *lower.coords, lower.shape)
    # Otherwise CHOLMOD would compare the order with that of AMD, which takes as long as the factor.
    stated = cholmod.options
    cholmod.options = {**stated, "nmethods": 1, "postorder": False}
    try:
        factor = cholmod.symbolic(matrix, p=cvxopt.matrix(np.arange(lower.shape[0])))
    finally:
        cholmod.options = stated
    cholmod.numeric(matrix, factor)

    def solve(right: np.ndarray) -> np.ndarray:
        solution = cvxopt.matrix(right)
        cholmod.solve(factor, solution)
        return np.array(solution)[:, 0]

    return solve


def _by_superlu(lower):
    triangle = lower.tocsc()
    matrix = (triangle + sparse.tril(triangle, -1, format="csc").T).tocsc()
    options = {"SymmetricMode": True}
    try:
        return splu(matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, options=options).solve
    except RuntimeError as error:
        raise ArithmeticError(str(error)) from error


@njit(cache=True)
def _numbered(cells):
    """Numbers of the cells, -1 for none, and how many of them are red.

    Red cells are numbered in the order of nested dissection (George 1973), the line that separates
    two halves after both. Their equations join neighbours on the diagonals too: one diagonal
    separates.
    """
    ny, nx = cells.shape
    numbers, n = np.full(cells.shape, -1, np.int32), cells.sum()
    # Places of the red cells on the grid of their diagonals.
    places = np.full(((ny + nx) // 2, (ny + nx + 1) // 2), -1, np.int32)
    for (row, column), is_open in np.ndenumerate(cells):
        if is_open and (row + column) % 2:
            n -= 1
            numbers[row, column] = n
        elif is_open:
            places[(row + column) // 2, (row - column + nx) // 2] = row * nx + column
    n_red, is_red = n, places >= 0
    boxes = [(0, places.shape[0], 0, places.shape[1])]
    while boxes:
        top, bottom, left, right = line = boxes.pop()
        if (bottom - top) * (right - left) > MAX_LEAF:
            line = _separator(is_red, line)
            if bottom - top >= right - left:
                boxes += [(top, line[0], left, right), (line[1], bottom, left, right)]
            else:
                boxes += [(top, bottom, left, line[2]), (top, bottom, line[3], right)]
        for place in places[line[0] : line[1], line[2] : line[3]].flat:
            if place >= 0:
                n -= 1
                numbers[place // nx, place % nx] = n
    return numbers, n_red


@njit(cache=True)
def _separator(is_red, box):
    """Line across the longer side of a box, near its middle, that meets the fewest red cells."""
    top, bottom, left, right = box
    size, fewest, separator = max(bottom - top, right - left), np.inf, box
    for at in range(size // 2 - size // 10, size // 2 + size // 10 + 1):
        if size == bottom - top:
            line = (top + at, top + at + 1, left, right)
        else:
            line = (top, bottom, left + at, left + at + 1)
        # Among equal lines the middle one is taken.
        met = is_red[line[0] : line[1], line[2] : line[3]].sum() + abs(at - size // 2) / size
        if met < fewest:
            fewest, separator = met, line
    return separator


@njit(cache=True)
def face_conductivity(a: Any, b: Any, linear: bool) -> Any:
    """Conductivity of the face between two cells of apertures a and b > 0, or of many faces.

    The harmonic mean of the cubes, 2 a^3 b^3 / (a^3 + b^3), is that of two half-cells in series.
    An aperture linear from a to b has 1 / mean(g^-3) = 2 a^2 b^2 / (a + b), which is never less.
    """
    # The product of both would underflow where gaps are small: divide first.
    ratio = a / b
    if linear:
        return 2 * a * a * b / (1 + ratio)
    return 2 * a * a * a / (1 + ratio * ratio * ratio)


@njit(cache=True)
def _assembled(gap, ends, numbers, n_red, n, ratios, linear):
    """Faces and neighbours of the black cells, and the ends of all."""
    faces, neighbours = np.zeros((n - n_red, 4)), np.zeros((n - n_red, 4), np.int32)
    of_ends = np.empty((2, n))
    ny, nx = numbers.shape
    for (row, column), number in np.ndenumerate(numbers):
        here = gap[row, column]
        if number >= 0:
            of_ends[:, number] = ends[:, row, column] * (here * here * here)
        if number >= n_red:
            for way in range(4):
                i, j = row + NEIGHBOURS[way][0], column + NEIGHBOURS[way][1]
                if 0 <= i < ny and 0 <= j < nx and numbers[i, j] >= 0:
                    face = face_conductivity(here, gap[i, j], linear)
                    faces[number - n_red, way] = ratios[way] * face
                    neighbours[number - n_red, way] = numbers[i, j]
    return faces, neighbours, of_ends


@njit(cache=True)
def _mesh(faces, neighbours, ends, over):
    """Diagonal of the equations of the red cells, and conductances to later cells with these."""
    n_red = ends.size - over.size
    diagonal, later = ends[:n_red].copy(), np.zeros((n_red, 4))
    joined = np.zeros((n_red, 4), np.int32)
    for black in range(over.size):
        for one in range(4):
            part, red = faces[black, one] * over[black], neighbours[black, one]
            diagonal[red] += part * ends[n_red + black]
            for other in range(one + 1, 4):
                through = part * faces[black, other]
                if through > 0:
                    place, beside = _LATER[one][other], neighbours[black, other]
                    later[red, place] += through
                    joined[red, place] = beside
                    diagonal[red] += through
                    diagonal[beside] += through
    return diagonal, later, joined
