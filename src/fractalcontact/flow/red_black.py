"""Equations of a network of cells, the black cells of a chessboard eliminated by hand.

The star-mesh transform joins the four neighbours of an eliminated cell by conductances a b / sum.
Equations of half the size remain, and no difference of nearly equal numbers is taken.
"""

import numpy as np
from scipy import sparse

from roughcontact.kernel_cache import njit

from .cholesky import factorised

#: Entry of the lower triangle where two steps (up, left, right, down) lead, -1 above it.
_ENTRIES = ((-1, -1, -1, -1), (-1, -1, -1, 1), (-1, -1, 0, 2), (-1, 1, 2, 3))

#: Cells of a box that is not dissected further.
MAX_LEAF = 4


class RedBlack:
    """Factorised mass balance of cells in a grid.

    Parameters
    ----------
    along_x, along_y : (ny, nx - 1), (ny - 1, nx) ndarray
        Conductances as of :class:`flow.network.Network`.
    ends : (ny, nx) ndarray
        Conductance to both ends together.
    cells : (ny, nx) bool ndarray
        Cells with an equation, each with a path to an end.
    cholmod : bool, optional
        As of :func:`flow.cholesky.factorised`.

    Raises
    ------
    ArithmeticError
        As :func:`flow.cholesky.factorised`.
    """

    def __init__(
        self,
        along_x: np.ndarray,
        along_y: np.ndarray,
        ends: np.ndarray,
        cells: np.ndarray,
        cholmod: bool | None,
    ):
        ny, nx = self._shape = cells.shape
        # A rim of closed cells: then each cell has four neighbours.
        stars = np.zeros((4, ny + 2, nx + 2))
        stars[0, 2:-1, 1:-1] = stars[3, 1:-2, 1:-1] = along_y
        stars[1, 1:-1, 2:-1] = stars[2, 1:-1, 1:-2] = along_x
        self._stars = stars.reshape(4, -1)
        ends, equations = np.pad(ends, 1).ravel(), np.pad(cells, 1).ravel()
        red = equations & (np.add.outer(np.arange(ny + 2), np.arange(nx + 2)) % 2 == 0).ravel()
        self._red, black = np.flatnonzero(red), equations & ~red
        total = self._stars.sum(axis=0) + ends
        self._over = np.divide(1.0, total, where=black, out=np.zeros_like(total))
        number = np.where(red, np.cumsum(red) - 1, -1)
        starts, rows, values = _mesh(self._stars, ends, self._over, number, nx + 2)
        n = self._red.size
        lower = sparse.csc_array((values, rows, starts), shape=(n, n))
        order = _dissection(_diamonds(*np.divmod(self._red, nx + 2)))
        self._solve = factorised(lower, order, cholmod=cholmod) if n else np.copy

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Solutions (k, ny, nx) of right sides (k, ny, nx); 0 in cells without an equation."""
        padded = np.pad(right, ((0, 0), (1, 1), (1, 1)))
        values = padded.reshape(len(right), -1)
        _spread(self._stars, self._over, values, self._shape[1] + 2)
        values[:, self._red] = self._solve(values[:, self._red].T).T
        _recover(self._stars, self._over, values, self._shape[1] + 2)
        return padded[:, 1:-1, 1:-1]


def _diamonds(rows, columns):
    """Numbers of red cells on the grid of their two diagonals, -1 where there is none."""
    down, up = (rows + columns) // 2, (rows - columns) // 2
    down, up = down - down.min(initial=0), up - up.min(initial=0)
    numbers = np.full((down.max(initial=0) + 1, up.max(initial=0) + 1), -1)
    numbers[down, up] = np.arange(rows.size)
    return numbers


@njit(cache=True)
def _dissection(numbers):
    """Nested dissection (George 1973): numbers of both halves of a grid, then of the line between.

    Eliminated cells are neighbours on the diagonals as well as across them: one line separates.
    """
    order = np.empty((numbers >= 0).sum(), np.int64)
    place, boxes = order.size, [(0, numbers.shape[0], 0, numbers.shape[1])]
    while boxes:
        top, bottom, left, right = boxes.pop()
        height, width = bottom - top, right - left
        if height * width > MAX_LEAF and height >= width:
            middle = (top + bottom) // 2
            boxes += [(top, middle, left, right), (middle + 1, bottom, left, right)]
            top, bottom = middle, middle + 1
        elif height * width > MAX_LEAF:
            middle = (left + right) // 2
            boxes += [(top, bottom, left, middle), (top, bottom, middle + 1, right)]
            left, right = middle, middle + 1
        for row in range(top, bottom):
            for column in range(left, right):
                if numbers[row, column] >= 0:
                    place -= 1
                    order[place] = numbers[row, column]
    return order


@njit(cache=True)
def _mesh(stars, ends, over, number, width):
    """Lower triangle of the equations of the red cells, in compressed columns."""
    n = number.max() + 1
    starts, rows, values = np.zeros(n + 1, np.int64), np.empty(5 * n, np.int64), np.empty(5 * n)
    steps, places = (-width, -1, 1, width), (2, width - 1, width + 1, 2 * width)
    lower, count = np.empty(4), 0
    for cell in range(number.size):
        if number[cell] < 0:
            continue
        lower[:], diagonal = 0, ends[cell]
        for one in range(4):
            if stars[one, cell] == 0:
                continue
            black = cell + steps[one]
            part, onward = stars[one, cell] * over[black], ends[black]
            for other in range(4):
                if one + other != 3:
                    onward += stars[other, black]
                    if _ENTRIES[one][other] >= 0:
                        lower[_ENTRIES[one][other]] += part * stars[other, black]
            diagonal += part * onward
        rows[count], values[count] = number[cell], diagonal
        count += 1
        for entry in range(4):
            if lower[entry] > 0:
                rows[count], values[count] = number[cell + places[entry]], -lower[entry]
                count += 1
        starts[number[cell] + 1] = count
    return starts, rows[:count], values[:count]


@njit(cache=True)
def _spread(stars, over, values, width):
    """Add the right sides of the black cells, as the star-mesh transform does, to those around."""
    for field in values:
        for cell in np.flatnonzero(over):
            part = over[cell] * field[cell]
            field[cell - width] += stars[0, cell] * part
            field[cell - 1] += stars[1, cell] * part
            field[cell + 1] += stars[2, cell] * part
            field[cell + width] += stars[3, cell] * part


@njit(cache=True)
def _recover(stars, over, values, width):
    """Solution of each black cell, in place of its right side, from those of its neighbours."""
    for field in values:
        for cell in np.flatnonzero(over):
            field[cell] = over[cell] * (
                field[cell]
                + stars[0, cell] * field[cell - width]
                + stars[1, cell] * field[cell - 1]
                + stars[2, cell] * field[cell + 1]
                + stars[3, cell] * field[cell + width]
            )
