"""Composite topography as the solver reads it: in its own precision, and on coarser grids.

Large topographies are neither copied nor converted as a whole: they may be in single precision, or
a file mapped to memory.
"""

from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import field
from ..kernel_cache import njit

_KEPT_TYPES = (np.dtype(np.float32), np.dtype(np.float64))


class HasHeights(Protocol):
    """Object with heights, (ny, nx), such as a topography of SurfaceTopography."""

    def heights(self) -> ArrayLike:
        """Heights, mm."""


def heights_of(composite: Any) -> Any:
    """Heights of an object with ``heights()``; anything else unchanged."""
    heights = getattr(composite, "heights", None)
    return heights() if callable(heights) else composite


class Topography:
    """Heights of the nodes, mm, and of the highest node of ever larger cells.

    ``highest`` and ``lowest`` are the extremes of all heights. Missing, masked and infinite cells
    and other shapes are refused.
    """

    def __init__(self, composite: ArrayLike | HasHeights, shape: tuple[int, int]):
        name = "composite topography"
        values = heights_of(composite)
        if isinstance(values, np.memmap):
            values = values.view(np.ndarray)
        if type(values) is np.ndarray and _is_as_wanted(values, shape):
            height = values
        else:
            height = field(values, name, shape)
        missing, self.lowest, self.highest = _extent(height.ravel())
        if missing:
            raise ValueError(f"the {name} has {missing} missing or infinite cells")
        self._levels = [height]

    def height(self, level: int = 0) -> np.ndarray:
        """Highest of each 2^level x 2^level nodes, mm, (my, mx), in their precision."""
        while len(self._levels) <= level:
            self._levels.append(_restrict_maximum(self._levels[-1]))
        return self._levels[level]

    def clearance(self, level: int = 0) -> np.ndarray:
        """Clearance at first touch, mm, (my, mx) float64."""
        return self.highest - self.height(level).astype(float, copy=False)

    def clearance_at(self, nodes: np.ndarray, level: int = 0) -> np.ndarray:
        """Clearance of some nodes alone, given by their numbers, (n,)."""
        return self.highest - self.height(level).ravel()[nodes].astype(float)

    def below(self, clearance: float, level: int, cells: np.ndarray | None) -> np.ndarray:
        """Nodes whose clearance is less than the one given, mm: (n,) int32, ascending.

        Only ``cells`` of the next coarser level are searched, (m,) int32 ascending; all if None.
        """
        height = self.height(level)
        if cells is None:
            return _all_below(height.ravel(), self.highest, clearance)
        return _children_below(cells, height, self.highest, clearance)

    def bearing_clearance(self, count: int, level: int = 0) -> float:
        """Clearance of the bearing area: that of the count-th highest node (from 1), mm."""
        height = self.height(level).ravel()
        rank = height.size - count
        return self.highest - float(np.partition(height, rank)[rank])


def _is_as_wanted(array, shape):
    """True if compiled code can read the array as it is."""
    return array.dtype in _KEPT_TYPES and array.shape == shape and array.flags.c_contiguous


@njit(cache=True)
def _extent(height):
    """Number of heights that are not finite, and extremes of the others."""
    missing, lowest, highest = 0, np.inf, -np.inf
    for value in height:
        if np.isfinite(value):
            lowest, highest = min(lowest, float(value)), max(highest, float(value))
        else:
            missing += 1
    return missing, lowest, highest


@njit(cache=True)
def _restrict_maximum(height):
    """Maximum of each 2 x 2 nodes; an odd last row or column stands alone."""
    ny, nx = height.shape
    coarse = np.empty(((ny + 1) // 2, (nx + 1) // 2), height.dtype)
    for y in range(coarse.shape[0]):
        above, below = height[2 * y], height[min(2 * y + 1, ny - 1)]
        for x in range(nx // 2):
            first, second = max(above[2 * x], above[2 * x + 1]), max(below[2 * x], below[2 * x + 1])
            coarse[y, x] = max(first, second)
        if nx % 2:
            coarse[y, nx // 2] = max(above[nx - 1], below[nx - 1])
    return coarse


@njit(cache=True)
def _all_below(height, highest, clearance):
    """All nodes less than a clearance below the highest."""
    n = 0
    for value in height:
        n += highest - float(value) < clearance
    nodes = np.empty(n, np.int32)
    n = 0
    for i in range(height.size):
        if highest - float(height[i]) < clearance:
            nodes[n] = i
            n += 1
    return nodes


@njit(cache=True)
def _children_below(cells, height, highest, clearance):
    """Nodes of some coarse cells within a clearance of the highest, row by row."""
    ny, nx = height.shape
    width = (nx + 1) // 2
    nodes = np.empty(4 * cells.size, np.int32)
    n, first = 0, 0
    while first < cells.size:
        # The cells of one row are read twice, for its two rows of nodes.
        row = cells[first] // width
        last = first
        while last < cells.size and cells[last] // width == row:
            last += 1
        for y in range(2 * row, min(2 * row + 2, ny)):
            for i in range(first, last):
                x = 2 * (cells[i] % width)
                for k in range(x, min(x + 2, nx)):
                    if highest - float(height[y, k]) < clearance:
                        nodes[n] = y * nx + k
                        n += 1
        first = last
    return nodes[:n].copy()
