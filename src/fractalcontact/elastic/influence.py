"""Influence of a loaded cell at a distance, for whole tables and far away at any distances.

Near the cell it is Love's closed form, `love_displacement`. Far from it that form loses digits, as
the four corners cancel, and takes eight inverse hyperbolic sines; there the mean of 1/(pi r) over
the cell is expanded in its sides, up to the fourth power.
"""

import numpy as np

from ..core import threads
from ..core.kernel_cache import njit

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
    places = np.arange(shape[0]) * dy, np.arange(shape[1]) * dx
    threads.in_parts(
        lambda start, stop: _fill_far(
            *(start, stop, *near, *places, dy, dx, self_term is None, table)
        ),
        shape[0],
        smallest=ROWS,
    )
    if self_term is not None:
        table[0, 0] = self_term
    return table


def far_influence(
    y: np.ndarray, x: np.ndarray, sides: tuple[float, float], self_term: float | None
) -> np.ndarray:
    """The same at distances (y, x) from the centre of the loaded cell, by the expansion alone.

    Its error there is some 1e-12 (FAR / r)^6 of it, at a distance r counted in longer sides.

    Parameters
    ----------
    y : (m,) ndarray
    x : (n,) ndarray
        Distances, counted in cells.
    sides, self_term
        As for `influence_table`.

    Returns
    -------
    (m, n) ndarray
        Not finite where both are zero.
    """
    dy, dx = sides
    table = np.empty((y.size, x.size))
    _fill_far(0, y.size, 0, 0, y * dy, x * dx, dy, dx, self_term is None, table)
    return table


@njit(cache=True)
def _fill_near(near_y, near_x, dy, dx, table):
    """Love's displacement: what is at the corners is shared by four cells."""
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


# Divided by is what never vanishes, and a check of it would keep the loop from being vectorised.
@njit(cache=True, nogil=True, error_model="numpy")
def _fill_far(start, stop, near_y, near_x, y, x, dy, dx, spread, table):
    """Rows of a table at some distances, but for the first ``near`` ones of either.

    The mean of f = 1/r over a cell is f + (dx^2 f_xx + dy^2 f_yy) / 24 + dx^4 f_xxxx / 1920 +
    dx^2 dy^2 f_xxyy / 576 + dy^4 f_yyyy / 1920; without ``spread`` the load is at its centre.
    """
    area = dy * dx if spread else 1.0
    a, b = (dy * dy / 24, dx * dx / 24) if spread else (0.0, 0.0)
    c, d = 24 * a * a * 24 / 1920, 24 * b * b * 24 / 1920
    e = a * b
    for i in range(start, stop):
        row, squared_y = table[i], y[i] * y[i]
        for j in range(near_x if i < near_y else 0, x.size):
            squared_x = x[j] * x[j]
            inverse = 1 / (squared_y + squared_x)
            v, u = squared_y * inverse, squared_x * inverse
            second = a * (2 * v - u) + b * (2 * u - v)
            fourth = c * (9 - 90 * v + 105 * v * v) + d * (9 - 90 * u + 105 * u * u)
            fourth += e * (105 * u * v - 12)
            total = 1 + inverse * (second + inverse * fourth)
            row[j] = area * total * np.sqrt(inverse) / np.pi
