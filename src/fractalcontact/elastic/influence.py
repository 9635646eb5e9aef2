"""Influence of a loaded cell at a distance, for whole tables and at any distances.

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
    if self_term is not None:
        distance = np.hypot(np.arange(shape[0])[:, None] * dy, np.arange(shape[1])[None, :] * dx)
        distance[0, 0] = 1.0
        table = 1 / (np.pi * distance)
        table[0, 0] = self_term
        return table
    table = np.empty(shape)
    near = [
        min(n, int(np.ceil(FAR * max(sides) / side))) for n, side in zip(shape, sides, strict=True)
    ]
    y, x = np.arange(near[0])[:, None] * dy, np.arange(near[1])[None, :] * dx
    table[: near[0], : near[1]] = love_displacement(x, y, dx, dy)
    threads.in_parts(
        lambda start, stop: _fill_far(start, stop, *near, dy, dx, table), shape[0], smallest=ROWS
    )
    return table


def influence_at(
    y: np.ndarray, x: np.ndarray, sides: tuple[float, float], self_term: float | None
) -> np.ndarray:
    """The same at any distances from the centre of the loaded cell, none of which is zero.

    Parameters
    ----------
    y, x : (n,) ndarray
        Distances, counted in cells.
    sides, self_term
        As for `influence_table`.

    Returns
    -------
    (n,) ndarray
    """
    dy, dx = sides
    y, x = y * dy, x * dx
    if self_term is not None:
        return 1 / (np.pi * np.hypot(y, x))
    values = np.empty(y.shape)
    near = np.maximum(np.abs(y), np.abs(x)) < FAR * max(sides)
    values[near] = love_displacement(x[near], y[near], dx, dy)
    values[~near] = _far(y[~near], x[~near], dy, dx)
    return values


@njit(cache=True)
def far_influence(y: float, x: float, dy: float, dx: float) -> float:
    """Displacement at (y, x), far from a cell of sides dy, dx under pressure one, both over E*.

    The mean of f = 1/r over the cell is f + (dx^2 f_xx + dy^2 f_yy) / 24 + dx^4 f_xxxx / 1920 +
    dx^2 dy^2 f_xxyy / 576 + dy^4 f_yyyy / 1920.
    """
    square = x * x + y * y
    inverse = 1 / square
    a, b = dx * dx * inverse, dy * dy * inverse
    u, v = x * x * inverse, y * y * inverse
    total = 1 + (a * (2 * u - v) + b * (2 * v - u)) / 24
    total += a * a * (9 - 90 * u + 105 * u * u) / 1920
    total += b * b * (9 - 90 * v + 105 * v * v) / 1920
    total += a * b * (105 * u * v - 12) / 576
    return dx * dy * total / (np.pi * np.sqrt(square))


@njit(cache=True)
def _far(y, x, dy, dx):
    values = np.empty(y.size)
    for i in range(y.size):
        values[i] = far_influence(y[i], x[i], dy, dx)
    return values


@njit(cache=True, nogil=True)
def _fill_far(start, stop, near_y, near_x, dy, dx, table):
    """Rows of a table, where they are far."""
    for i in range(start, stop):
        for j in range(near_x if i < near_y else 0, table.shape[1]):
            table[i, j] = far_influence(i * dy, j * dx, dy, dx)
