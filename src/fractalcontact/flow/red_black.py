"""Equations of the open cells of a grid, the black cells of a chessboard eliminated by hand.

The star-mesh transform joins the four neighbours of an eliminated cell by conductances a b / sum.
Equations of half the size remain, and no difference of nearly equal numbers is taken.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from roughcontact.kernel_cache import njit

from .cholesky import factorised

#: Steps in rows and columns to the neighbours of a cell: up, left, right, down.
_WAYS = ((-1, 0), (0, -1), (0, 1), (1, 0))
#: Place of the later of two neighbours of a black cell, seen from the earlier: each of the two has
#: four later ones within two steps.
_LATER = ((-1, 1, 2, 3), (-1, -1, 0, 2), (-1, -1, -1, 1))
#: Cells of a box that is not dissected further.
MAX_LEAF = 16


@dataclass(frozen=True, eq=False)
class Stars:
    """Cells with an equation: n_red red ones, numbered as they are eliminated, then the black ones.

    Attributes
    ----------
    numbers : (ny, nx) int ndarray
        Of the cells; -1 where no equation is.
    faces : (n_black, 4) ndarray
        Conductances of a black cell to its neighbours up, left, right, down; 0 where none is.
    neighbours : (n_black, 4) int ndarray
        Numbers of these; 0 where none is.
    ends : (2, n) ndarray
        Conductances of the cells to the inlet and to the outlet.
    """

    numbers: np.ndarray
    faces: np.ndarray
    neighbours: np.ndarray
    ends: np.ndarray


def stars_of(
    conductivity: np.ndarray, ends: np.ndarray, cells: np.ndarray, spacing: tuple[float, float]
) -> Stars:
    """Cells of a grid and the conductances between them, harmonic means of both sides.

    Parameters
    ----------
    conductivity : (ny, nx) ndarray
        Of the cells.
    ends : (2, ny, nx) ndarray
        Conductance to the inlet and to the outlet over the conductivity of the cell.
    cells : (ny, nx) bool ndarray
        Cells with an equation: of positive conductivity, each joined to an end.
    spacing : (float, float)
        Sides (dy, dx) of a cell, mm.
    """
    numbers, n_red, n = _numbered(cells)
    dy, dx = spacing
    ratios = np.array([dx / dy, dy / dx, dy / dx, dx / dy])
    return Stars(numbers, *_assembled(conductivity, ends, numbers, n_red, n, ratios))


@njit(cache=True)
def _numbered(cells):
    """Numbers of the cells, -1 for none, how many are red, and how many there are.

    Red cells are numbered in the order of nested dissection (George 1973), the line that separates
    two halves after both. Their equations join neighbours on the diagonals too: one diagonal
    separates.
    """
    ny, nx = cells.shape
    numbers = np.full((ny, nx), -1, np.int32)
    n = n_red = sum([cells[row, row % 2 :: 2].sum() for row in range(ny)])
    for row in range(ny):
        for column in range(1 - row % 2, nx, 2):
            if cells[row, column]:
                numbers[row, column] = n
                n += 1
    left = n_red
    # Boxes of diagonals: row + column = 2 down and row - column = 2 up.
    boxes = [(0, (ny + nx) // 2, -((nx - 1) // 2), (ny + 1) // 2)]
    while boxes:
        top, bottom, first, last = boxes.pop()
        if (bottom - top) * (last - first) > MAX_LEAF:
            if bottom - top >= last - first:
                middle = (top + bottom) // 2
                boxes += [(top, middle, first, last), (middle + 1, bottom, first, last)]
                top, bottom = middle, middle + 1
            else:
                middle = (first + last) // 2
                boxes += [(top, bottom, first, middle), (top, bottom, middle + 1, last)]
                first, last = middle, middle + 1
        for down in range(top, bottom):
            for up in range(max(first, -down, down - nx + 1), min(last, down + 1, ny - down)):
                if cells[down + up, down - up]:
                    left -= 1
                    numbers[down + up, down - up] = left
    return numbers, n_red, n


@njit(cache=True)
def _assembled(conductivity, ends, numbers, n_red, n, ratios):
    """Faces and neighbours of the black cells, and the ends of all."""
    faces, neighbours = np.zeros((n - n_red, 4)), np.zeros((n - n_red, 4), np.int32)
    of_ends = np.empty((2, n))
    ny, nx = numbers.shape
    for row in range(ny):
        for column in range(nx):
            number, here = numbers[row, column], conductivity[row, column]
            if number >= 0:
                of_ends[:, number] = ends[:, row, column] * here
            if number >= n_red:
                for way in range(4):
                    i, j = row + _WAYS[way][0], column + _WAYS[way][1]
                    if 0 <= i < ny and 0 <= j < nx and numbers[i, j] >= 0:
                        # The product of both would underflow where gaps are small: divide first.
                        face = 2 * here / (1 + here / conductivity[i, j])
                        faces[number - n_red, way] = ratios[way] * face
                        neighbours[number - n_red, way] = numbers[i, j]
    return faces, neighbours, of_ends


def red_black_solver(stars: Stars, cholmod: bool | None) -> Callable[[np.ndarray], np.ndarray]:
    """Solver of the mass balance of cells.

    Parameters
    ----------
    stars : Stars
    cholmod : bool or None
        As of :func:`flow.cholesky.factorised`, whose errors it raises.

    Returns
    -------
    callable
        Gives solutions (k, n) of right sides (k, n).
    """
    n_red = stars.ends.shape[1] - len(stars.faces)
    ends = stars.ends.sum(axis=0)
    over = 1 / (stars.faces.sum(axis=1) + ends[n_red:])
    values, *entries = _mesh(stars.faces, stars.neighbours, ends, over)
    lower = sparse.coo_array((values, entries), shape=(n_red, n_red))
    solve = factorised(lower, cholmod=cholmod) if n_red else np.copy

    def solution(right: np.ndarray) -> np.ndarray:
        values = right.copy()
        values[:, n_red:] *= over
        _spread(stars.faces, stars.neighbours, values)
        values[:, :n_red] = solve(values[:, :n_red].T).T
        _gather(stars.faces, stars.neighbours, over, values)
        return values

    return solution


@njit(cache=True)
def _mesh(faces, neighbours, ends, over):
    """Lower triangle of the equations of the red cells: values, rows and columns."""
    n_red = ends.size - over.size
    diagonal, later = ends[:n_red].copy(), np.zeros((n_red, 4))
    joined = np.zeros((n_red, 4), np.int32)
    n = n_red
    for black in range(over.size):
        for one in range(4):
            part, red = faces[black, one] * over[black], neighbours[black, one]
            diagonal[red] += part * ends[n_red + black]
            for other in range(one + 1, 4):
                through = part * faces[black, other]
                if through > 0:
                    place, beside = _LATER[one][other], neighbours[black, other]
                    n += later[red, place] == 0
                    later[red, place] += through
                    joined[red, place] = beside
                    diagonal[red] += through
                    diagonal[beside] += through
    values, rows, columns = np.empty(n), np.empty(n, np.int32), np.empty(n, np.int32)
    n = 0
    for red in range(n_red):
        values[n], rows[n], columns[n] = diagonal[red], red, red
        n += 1
        for place in range(4):
            if later[red, place] > 0:
                beside = joined[red, place]
                values[n] = -later[red, place]
                rows[n], columns[n] = max(red, beside), min(red, beside)
                n += 1
    return values, rows, columns


@njit(cache=True)
def _spread(faces, neighbours, values):
    """Add to red cells the values of black ones times the conductances between them."""
    n_red = values.shape[1] - len(faces)
    for field in range(len(values)):
        for black in range(len(faces)):
            value = values[field, n_red + black]
            for way in range(4):
                values[field, neighbours[black, way]] += faces[black, way] * value


@njit(cache=True)
def _gather(faces, neighbours, over, values):
    """Add to black cells the values of red ones times the conductances between them, and over."""
    n_red = values.shape[1] - len(faces)
    for field in range(len(values)):
        for black in range(len(faces)):
            inflow = 0.0
            for way in range(4):
                inflow += faces[black, way] * values[field, neighbours[black, way]]
            values[field, n_red + black] += over[black] * inflow
