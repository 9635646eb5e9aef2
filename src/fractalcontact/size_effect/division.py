"""Division of a window into sub-windows: equal, without overlap."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

#: Sub-windows along each side of the window, by default: octaves and halves.
PARTS = (1, 2, 3, 4, 6, 8)
#: Fewest cells per side of a sub-window that is solved.
MIN_CELLS = 16


def divisions(shape: tuple[int, int]) -> tuple[int, ...]:
    """Divisions of a window along a side: :data:`PARTS`, or thirds and ninths of 3^n cells.

    A surface built in thirds is cut through by any other division. Ninths need `MIN_CELLS` cells.
    """
    side = min(shape)
    is_of_thirds = 3 ** round(np.log(side) / np.log(3)) == side
    return (1, 3, 9) if is_of_thirds and side >= 9 * MIN_CELLS else PARTS


def solvable_parts(parts: Sequence[int], shape: tuple[int, int]) -> list[int]:
    """Divisions that are solved: the whole window, and those of `MIN_CELLS` per side or more."""
    return [n for n in parts if n == 1 or min(shape) // n >= MIN_CELLS]


def split(heights: ArrayLike, parts: int) -> np.ndarray:
    """Parts x parts equal sub-windows of a grid, without overlap.

    (parts**2, ny // parts, nx // parts), row by row. Cells that do not divide are left at the
    edges, as evenly as can be.
    """
    heights = np.asarray(heights)
    ny, nx = (n // parts for n in heights.shape)
    first_y, first_x = _first_cells(heights.shape, parts)
    middle = heights[first_y : first_y + parts * ny, first_x : first_x + parts * nx]
    return middle.reshape(parts, ny, parts, nx).swapaxes(1, 2).reshape(parts**2, ny, nx)


def occupied_windows(domain: np.ndarray, parts: int) -> np.ndarray:
    """Sub-windows of :func:`split` in which the contact domain (ny, nx) of the whole has a node."""
    return np.asarray(split(domain, parts).any(axis=(1, 2)))


def _first_cells(shape: tuple[int, ...], parts: int) -> list[int]:
    return [(n - parts * (n // parts)) // 2 for n in shape]


def spread_windows(parts: int, most: int) -> np.ndarray:
    """Indices of at most ``most`` of the sub-windows of :func:`split`, on an even lattice."""
    along = min(parts, max(1, int(np.sqrt(most))))
    place = ((np.arange(along) + 0.5) * parts / along).astype(int)
    return (place[:, np.newaxis] * parts + place).ravel()
