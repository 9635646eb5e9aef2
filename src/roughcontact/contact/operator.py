"""Elastic operator as the solver applies it: on the whole window, or between some of its nodes.

Between few nodes it is summed pair by pair, between more by a fast multipole method; on the whole
window it is a convolution.
"""

import numpy as np

from ..elastic.block_pairs import MultipoleLevels
from ..elastic.direct import MAX_PAIRS, DirectOperator
from ..elastic.halfspace import HalfSpace
from ..elastic.multipole import MultipoleOperator
from ..kernel_cache import njit
from .preconditioner import preconditioner


class Operator:
    """K of one window with its preconditioner and the number of applications, for one thread.

    Parameters
    ----------
    space : HalfSpace
    nodes : (n,) int32 ndarray, optional
        Ascending numbers of the cells to which it is restricted; by default the whole window.
        Pressures, displacements and sets of nodes are then on these alone.
    levels : MultipoleLevels, optional
        Levels of these nodes, if known.
    """

    def __init__(
        self,
        space: HalfSpace,
        nodes: np.ndarray | None = None,
        levels: MultipoleLevels | None = None,
    ):
        self.space, self.nodes, self.inverse = space, nodes, preconditioner(space)
        self.applications = 0
        self.size = space.shape[0] * space.shape[1] if nodes is None else nodes.size
        if nodes is None:
            self._grid = np.zeros(space.shape, np.float32)
        else:
            self._levels = levels
            self._direct: DirectOperator | None = None
            self._between: dict[np.dtype, MultipoleOperator] = {}

    def precondition(self, active: np.ndarray, *, fresh: bool) -> None:
        """Update the preconditioner `inverse` to a contact set."""
        if self.nodes is None:
            self.inverse.update(active, fresh=fresh)
        else:
            self.inverse.update(self.nodes[active], fresh=fresh, scattered=True)

    def __call__(self, pressure: np.ndarray) -> np.ndarray:
        """Displacement of all nodes, (n,), in the precision of the pressure, (n,)."""
        self.applications += 1
        if self.nodes is not None:
            loaded = np.flatnonzero(pressure)
            return self._on_nodes(loaded, pressure[loaded])
        return self.space.convolve(pressure.reshape(self.space.shape)).ravel()

    def _on_nodes(self, loaded, values):
        """Displacement of all nodes, by the faster operator, which is created at its first use."""
        if loaded.size * self.size <= MAX_PAIRS[values.dtype]:
            self._direct = self._direct or DirectOperator(self.space, self.nodes)
            return self._direct(loaded, values)
        if values.dtype not in self._between:
            self._levels = self._levels or MultipoleLevels(self.space.shape, self.nodes)
            multipole = MultipoleOperator(self.space, self._levels, values.dtype)
            self._between[values.dtype] = multipole
        return self._between[values.dtype](loaded, values)

    def apply_sparse(self, *pairs: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
        """Displacement of all nodes in single precision, under (nodes, values) pairs."""
        if self.nodes is not None:
            self.applications += 1
            loaded = np.concatenate([pair[0] for pair in pairs])
            values = np.concatenate([pair[1] for pair in pairs]).astype(np.float32, copy=False)
            return self._on_nodes(loaded, values)
        grid = self._grid.ravel()
        for nodes, values in pairs:
            _scatter(grid, nodes, values)
        image = self(grid)
        for nodes, _ in pairs:
            grid[nodes] = 0
        return image


@njit(cache=True)
def _scatter(grid, nodes, values):
    """grid[nodes] = values."""
    if nodes.size != values.size:
        raise ValueError("expected as many values as nodes")
    for i in range(nodes.size):
        if nodes[i] < 0 or nodes[i] >= grid.size:
            raise ValueError("expected nodes of the grid")
        grid[nodes[i]] = values[i]
