"""Influence of a loaded cell at a distance, for whole tables and far away at any distance.

Near the cell it is Love's closed form, `love_displacement`. Far from it that form loses digits, as
the four corners cancel, and takes eight inverse hyperbolic sines; there the mean of 1/(pi r) over
the cell is expanded in its sides, up to the fourth power.
"""

import numpy as np

from .. import threads
from ..kernel_cache import njit

#: From this many of the longer side of a cell on the expansion holds: its first missing term is
#: below 1e-12 of the influence there.
FAR = 32
#: Rows that a thread takes at least.
ROWS = 64


def love_displacement(
    x: float | np.ndarray, y: float | np.ndarray, dx: float, dy: float
) -> np.ndarray:
    """Displacement at (x, y) under uniform pressure on a rectangle centred at the origin.

    Parameters
    ----------
    x, y : float or ndarray
        Where the displacement is wanted, mm.
    dx, dy : float
        Sides of the loaded rectangle, mm.

    Returns
    -------
    ndarray
        E* u / p in mm.

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
    """Dimensionless influence E* u / (p cell) at every cell distance.

    Parameters
    ----------
    shape : (int, int)
        Distances wanted, from zero on.
    sides : (float, float)
        Of a cell along y and x; their product is 1.
    self_term : float or None
        Of point loads on every cell but the loaded one, whose influence on itself this is; None for
        uniform pressure on the cell, of Love.

    Returns
    -------
    (ny, nx) ndarray
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
    """Sides that a load is spread over, (0, 0) for a point load, and its area: see `expansion`.

    Parameters
    ----------
    sides, self_term
        As for `influence_table`.
    """
    return (*sides, sides[0] * sides[1]) if self_term is None else (0.0, 0.0, 1.0)


@njit(cache=True)
def _fill_near(near_y, near_x, dy, dx, table):
    """Love's displacement, with terms at corners shared by four cells."""
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


# Divided by is what never vanishes, and a check of it would keep loops from being vectorised.
@njit(cache=True, nogil=True, error_model="numpy")
def _fill_far(start, stop, near_y, near_x, y, x, dy, dx, area, table):
    """Rows of a table at some distances, but for the first ``near`` ones of either."""
    for i in range(start, stop):
        first = near_x if i < near_y else 0
        row, places = table[i, first:], x[first:]
        for j in range(row.size):
            row[j] = expansion(y[i], places[j], dy, dx, area)


@njit(cache=True, error_model="numpy")
def expansion(y: float, x: float, dy: float, dx: float, area: float) -> float:
    """Influence far away: an area times the mean of f = 1/(pi r) over a cell of sides dy, dx.

    Its error is some 1e-12 (FAR / r)^6 of it at a distance r, counted in longer sides. The mean is
    f + (dx^2 f_xx + dy^2 f_yy) / 24 + dx^4 f_xxxx / 1920 + dx^2 dy^2 f_xxyy / 576 +
    dy^4 f_yyyy / 1920.
    """
    squared_y, squared_x, b, a = y * y, x * x, dx * dx, dy * dy
    inverse = 1 / (squared_y + squared_x)
    v, u = squared_y * inverse, squared_x * inverse
    # Multiplied by constants: a vector of divisions takes as long as all the rest.
    second = (a * (1 / 24)) * (2 * v - u) + (b * (1 / 24)) * (2 * u - v)
    fourth = (a * a * (1 / 1920)) * (9 - 90 * v + 105 * v * v)
    fourth += (b * b * (1 / 1920)) * (9 - 90 * u + 105 * u * u)
    fourth += (a * b * (1 / 576)) * (105 * u * v - 12)
    return (area * (1 / np.pi)) * (1 + inverse * (second + inverse * fourth)) * np.sqrt(inverse)
