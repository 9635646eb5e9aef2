"""Influence of a loaded cell at a distance: tables near the cell, an expansion far from it.

Near the cell it is Love's closed form, `love_displacement`. Far from it that form loses digits, as
its four corners cancel, and takes eight inverse hyperbolic sines; there the mean of 1/(pi r) over
the cell is expanded in its sides, up to the fourth power.
"""

import numpy as np

from .. import threads
from ..kernel_cache import njit

#: Least distance, in longer sides of a cell, at which the expansion is used: its first missing term
#: is below 1e-12 of the influence there.
FAR = 32
#: Fewest rows per thread.
ROWS = 64


def love_displacement(
    x: float | np.ndarray, y: float | np.ndarray, dx: float, dy: float
) -> np.ndarray:
    """Displacement E* u / p at (x, y) under uniform pressure on a rectangle centred at the origin.

    All lengths, those of the sides ``dx`` and ``dy`` and the result, are in one unit.

    Notes
    -----
    A. E. H. Love, Phil. Trans. R. Soc. A 228 (1929) 377: pi E* u / p is the sum over the four
    corners, signed, of X asinh(Y/|X|) + Y asinh(X/|Y|).
    """
    total = np.zeros(())
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


def influence_table(
    shape: tuple[int, int], sides: tuple[float, float], self_term: float | None
) -> np.ndarray:
    """Dimensionless influence E* u / (p cell) at every cell distance of ``shape``, from zero on.

    ``sides`` are those of a cell (y, x), with the product 1. ``self_term`` is None for Love's
    uniform pressure on the cell; else it is the influence of a cell on itself, and all others are
    point loads.
    """
    dy, dx = sides
    table = np.empty(shape)
    near = 1, 1
    if self_term is None:
        reach = FAR * max(sides)
        near = min(shape[0], int(np.ceil(reach / dy))), min(shape[1], int(np.ceil(reach / dx)))
        _fill_near(*near, dy, dx, table)
    load = spread(sides, self_term)
    places = np.arange(shape[0]) * dy, np.arange(shape[1]) * dx
    threads.in_parts(
        lambda start, stop: _fill_far(start, stop, *near, *places, *load, table),
        shape[0],
        smallest=ROWS,
    )
    if self_term is not None:
        table[0, 0] = self_term
    return table


def spread(sides: tuple[float, float], self_term: float | None) -> tuple[float, float, float]:
    """Sides and area of a load for `expansion`; the sides are 0 for a point load."""
    return (*sides, sides[0] * sides[1]) if self_term is None else (0.0, 0.0, 1.0)


@njit(cache=True)
def _fill_near(near_y, near_x, dy, dx, table):
    """Love's displacement, with each corner's term computed once for the four cells around it."""
    above, below = np.empty(near_x + 1), np.empty(near_x + 1)
    for i in range(near_y + 1):
        y = (i - 0.5) * dy
        for j in range(near_x + 1):
            x = (j - 0.5) * dx
            below[j] = x * np.arcsinh(y / abs(x)) + y * np.arcsinh(x / abs(y))
        if i > 0:
            for j in range(near_x):
                total = (below[j + 1] - below[j]) - (above[j + 1] - above[j])
                table[i - 1, j] = total / np.pi
        above, below = below, above


# The divisor never vanishes; "numpy" leaves out its check, which would prevent vectorisation.
@njit(cache=True, nogil=True, error_model="numpy")
def _fill_far(start, stop, near_y, near_x, y, x, dy, dx, area, table):
    """Rows of a table from the expansion, except within the ``near`` distances."""
    for i in range(start, stop):
        first = near_x if i < near_y else 0
        row, places = table[i, first:], x[first:]
        for j in range(row.size):
            row[j] = expansion(y[i], places[j], dy, dx, area)


@njit(cache=True, error_model="numpy")
def expansion(y: float, x: float, dy: float, dx: float, area: float) -> float:
    """Influence far away: an area times the mean of f = 1/(pi r) over a cell of sides dy, dx.

    Its relative error is some 1e-12 (FAR / r)^6 at a distance r, counted in longer sides. The mean
    is f + (dx^2 f_xx + dy^2 f_yy) / 24 + dx^4 f_xxxx / 1920 + dx^2 dy^2 f_xxyy / 576 + dy^4 f_yyyy
    / 1920.
    """
    squared_y, squared_x, b, a = y * y, x * x, dx * dx, dy * dy
    inverse = 1 / (squared_y + squared_x)
    v, u = squared_y * inverse, squared_x * inverse
    # Products with constants, since a vector of divisions takes as long as all the rest.
    second = (a * (1 / 24)) * (2 * v - u) + (b * (1 / 24)) * (2 * u - v)
    fourth = (a * a * (1 / 1920)) * (9 - 90 * v + 105 * v * v)
    fourth += (b * b * (1 / 1920)) * (9 - 90 * u + 105 * u * u)
    fourth += (a * b * (1 / 576)) * (105 * u * v - 12)
    return (area * (1 / np.pi)) * (1 + inverse * (second + inverse * fourth)) * np.sqrt(inverse)
