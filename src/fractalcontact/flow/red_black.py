"""Equations of a network of cells, the black cells of a chessboard eliminated by hand.

The star-mesh transform joins the four neighbours of an eliminated cell by conductances a b / sum.
Equations of half the size remain, and no difference of nearly equal numbers is taken.
"""

from collections.abc import Callable

import numpy as np
from scipy import sparse

from roughcontact.kernel_cache import njit

from .cholesky import factorised


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

    Their equations join neighbours on the diagonals too: one diagonal separates. Diagonals are cut
    at multiples of powers of two from the middle, those of a larger power later.
    """
    powers = []
    for diagonal in (rows + columns) // 2, (rows - columns) // 2:
        middle = (diagonal.max(initial=0) + diagonal.min(initial=0)) // 2
        from_middle = diagonal - middle + (1 << 40)
        powers.append(np.log2(from_middle & -from_middle))
    return np.argsort(np.maximum(2 * powers[0] + 1, 2 * powers[1]).astype(np.int8), kind="stable")


@njit(cache=True)
def _mesh(stars, ends, over, ordered, steps):
    """Lower triangle of the equations of the red cells: values, rows and columns."""
    number = np.full(ends.size, -1)
    number[ordered] = np.arange(ordered.size)
    values, entries, n = np.empty(13 * ordered.size), np.empty((2, 13 * ordered.size), np.int64), 0
    for cell in np.flatnonzero(number >= 0):
        column, diagonal = number[cell], ends[cell]
        for one in range(4):
            black = cell + steps[one]
            part = stars[one, cell] * over[black]
            diagonal += part * ends[black]
            for other in range(4):
                through, row = part * stars[other, black], number[black + steps[other]]
                if one + other != 3 and through > 0:
                    diagonal += through
                    if row > column:
                        values[n], entries[0, n], entries[1, n] = -through, row, column
                        n += 1
        values[n], entries[:, n] = diagonal, column
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
