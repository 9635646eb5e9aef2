"""Elastic operator between few nodes, summed pair by pair: nearly without set-up.

If the pairs of a loaded and a displaced node are few, their sum takes less time than the matrices
of the multipole operator. Love's influence is read from a table near the load; further away it is
evaluated for each pair, as fast as reading it from a large table.
"""

import numpy as np

from ..kernel_cache import njit
from .halfspace import HalfSpace
from .influence import FAR, expansion

#: Most pairs, by requested precision, for which this takes less time than the multipole operator
#: and its set-up.
MAX_PAIRS = {np.dtype(np.float32): 150_000, np.dtype(np.float64): 1_000_000}


class DirectOperator:
    """K between the nodes of a set, always computed in double precision.

    ``nodes``, (n,) int32, are ascending numbers of cells; they are not checked.
    """

    def __init__(self, space: HalfSpace, nodes: np.ndarray):
        dy, dx = space.spacing[0] / space.cell, space.spacing[1] / space.cell
        near = int(np.ceil(FAR * max(dy, dx) / dy)), int(np.ceil(FAR * max(dy, dx) / dx))
        self._rows, self._columns = np.divmod(nodes, np.int32(space.shape[1]))
        self._places = self._rows * dy, self._columns * dx
        self._table = space.influence_within(near)
        self._spread = space.spread

    def __call__(self, positions: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Displacement of all nodes, (n,), under ``values`` (m,) at some ``positions`` in the set.

        The result has the precision of the values.
        """
        image = np.zeros(self._rows.size)
        cells = self._rows, self._columns
        _sum(
            positions,
            values.astype(float),
            *cells,
            *self._places,
            self._table,
            *self._spread,
            image,
        )
        return image.astype(values.dtype, copy=False)


@njit(cache=True)
def _sum(positions, values, rows, columns, y, x, table, dy, dx, area, image):
    """Add the displacements of all nodes under one loaded node after the other."""
    for k in range(positions.size):
        node = positions[k]
        # Nodes of adjacent rows are adjacent in the list.
        first = np.searchsorted(rows, rows[node] - table.shape[0] + 1)
        last = np.searchsorted(rows, rows[node] + table.shape[0])
        _add_far(values[k], y[node], x[node], y[:first], x[:first], dy, dx, area, image[:first])
        _add_far(values[k], y[node], x[node], y[last:], x[last:], dy, dx, area, image[last:])
        for i in range(first, last):
            away = abs(columns[i] - columns[node])
            if away < table.shape[1]:
                image[i] += values[k] * table[abs(rows[i] - rows[node]), away]
            else:
                image[i] += values[k] * expansion(y[i] - y[node], x[i] - x[node], dy, dx, area)


@njit(cache=True)
def _add_far(value, at_y, at_x, y, x, dy, dx, area, image):
    for i in range(image.size):
        image[i] += value * expansion(y[i] - at_y, x[i] - at_x, dy, dx, area)
