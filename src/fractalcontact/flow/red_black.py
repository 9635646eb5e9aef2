"""Equations of a network of cells, the black cells of a chessboard eliminated by hand.

The star-mesh transform joins the four neighbours of an eliminated cell by conductances a b / sum.
Equations of half the size remain, and no difference of nearly equal numbers is taken.
"""

from collections.abc import Callable

import numpy as np
from scipy import sparse

from roughcontact.kernel_cache import njit

from .cholesky import factorised

#: Number of the later cell that two steps (up, left, right, down) lead to, -1 to an earlier one.
_FORWARD = ((-1, -1, -1, -1), (-1, -1, -1, 1), (-1, -1, 0, 2), (-1, 1, 2, 3))

#: Cells of a box that is not dissected further.
MAX_LEAF = 4


def red_black_solver(
    along_x: np.ndarray,
    along_y: np.ndarray,
    ends: np.ndarray,
    cells: np.ndarray,
    cholmod: bool | None,
) -> Callable[[np.ndarray], np.ndarray]:
    """Solver of the mass balance of cells in a grid.

    Parameters
    ----------
    along_x, along_y : (ny, nx - 1), (ny - 1, nx) ndarray
        Conductances as of :class:`flow.network.Network`.
    ends : (ny, nx) ndarray
        Conductance to both ends together.
    cells : (ny, nx) bool ndarray
        Cells with an equation, each with a path to an end.
    cholmod : bool or None
        As of :func:`flow.cholesky.factorised`, whose errors it raises.

    Returns
    -------
    callable
        Gives solutions (k, ny, nx) of right sides (k, ny, nx); 0 in cells without an equation.
    """
    ny, nx = cells.shape
    # A rim of closed cells: then each cell has four neighbours.
    stars, steps = np.zeros((4, ny + 2, nx + 2)), np.array([-nx - 2, -1, 1, nx + 2])
    stars[0, 2:-1, 1:-1] = stars[3, 1:-2, 1:-1] = along_y
    stars[1, 1:-1, 2:-1] = stars[2, 1:-1, 1:-2] = along_x
    stars, ends = stars.reshape(4, -1), np.pad(ends, 1).ravel()
    rows, columns = np.nonzero(np.pad(cells, 1))
    place, is_red = rows * (nx + 2) + columns, (rows + columns) % 2 == 0
    red, black = place[is_red], place[~is_red]
    ordered = red[_dissection(rows[is_red], columns[is_red])]
    over = np.zeros_like(ends)
    over[black] = 1 / (stars[:, black].sum(axis=0) + ends[black])
    values, *entries = _mesh(stars, ends, over, ordered, steps)
    lower = sparse.coo_array((values, entries), shape=(red.size, red.size))
    solve = factorised(lower, cholmod=cholmod) if red.size else np.copy

    def solution(right: np.ndarray) -> np.ndarray:
        padded = np.pad(right, ((0, 0), (1, 1), (1, 1)))
        values = padded.reshape(len(right), -1)
        values[:, black] *= over[black]
        values[:, red] += _inflow(stars, values, red, steps)
        values[:, ordered] = solve(values[:, ordered].T).T
        values[:, black] += over[black] * _inflow(stars, values, black, steps)
        return padded[:, 1:-1, 1:-1]

    return solution


def _dissection(rows, columns):
    """Order of nested dissection (George 1973) of red cells, each separating line after its halves.

    Their equations join neighbours on the diagonals too: one diagonal separates.
    """
    down, up = (rows + columns) // 2, (rows - columns) // 2
    down, up = down - down.min(initial=down.size), up - up.min(initial=up.size)
    numbers = np.full((down.max(initial=0) + 1, up.max(initial=0) + 1), -1)
    numbers[down, up] = np.arange(rows.size)
    return _dissected(numbers)[::-1]


@njit(cache=True)
def _dissected(numbers):
    """Numbers on a grid, -1 where none is: those of the middle line, then of each half alike."""
    order, n = np.empty(numbers.size, np.int64), 0
    boxes = [(0, numbers.shape[0], 0, numbers.shape[1])]
    while boxes:
        top, bottom, left, right = boxes.pop()
        if (bottom - top) * (right - left) > MAX_LEAF:
            if bottom - top >= right - left:
                middle = (top + bottom) // 2
                boxes += [(top, middle, left, right), (middle + 1, bottom, left, right)]
                top, bottom = middle, middle + 1
            else:
                middle = (left + right) // 2
                boxes += [(top, bottom, left, middle), (top, bottom, middle + 1, right)]
                left, right = middle, middle + 1
        for number in numbers[top:bottom, left:right].flat:
            if number >= 0:
                order[n] = number
                n += 1
    return order[:n]


@njit(cache=True)
def _mesh(stars, ends, over, ordered, steps):
    """Lower triangle of the equations of the red cells: values, rows and columns."""
    number = np.full(ends.size, -1)
    number[ordered] = np.arange(ordered.size)
    values, entries, n = np.empty(5 * ordered.size), np.empty((2, 5 * ordered.size), np.int64), 0
    for cell in np.flatnonzero(number >= 0):
        column, diagonal, forward = number[cell], ends[cell], np.zeros(4)
        for one in range(4):
            black = cell + steps[one]
            part = stars[one, cell] * over[black]
            diagonal += part * ends[black]
            for other in range(4):
                if one + other != 3:
                    through = part * stars[other, black]
                    diagonal += through
                    if _FORWARD[one][other] >= 0:
                        forward[_FORWARD[one][other]] += through
        values[n], entries[:, n] = diagonal, column
        n += 1
        for place in range(4):
            if forward[place] > 0:
                row = number[cell + (2, steps[3] - 1, steps[3] + 1, 2 * steps[3])[place]]
                entries[0, n], entries[1, n] = max(row, column), min(row, column)
                values[n] = -forward[place]
                n += 1
    return values[:n], entries[0, :n], entries[1, :n]


@njit(cache=True)
def _inflow(stars, values, cells, steps):
    """Sum over the neighbours of cells of conductance times value."""
    result = np.zeros((len(values), cells.size))
    for field in range(len(values)):
        for number, cell in enumerate(cells):
            for way in range(4):
                result[field, number] += stars[way, cell] * values[field, cell + steps[way]]
    return result
