"""Bounds of the pressure, the same on all nodes or one for each node."""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..elastic.halfspace import MAX_CELLS
from .restriction import restrict_sum


def _is_one(bound):
    # `np.ndim` would convert a plain number to an array first.
    return isinstance(bound, float) or np.ndim(bound) == 0


@lru_cache(maxsize=64)
def _everywhere(bound):
    """Read-only view of one number on all nodes of the largest grid, of which grids take a slice.

    It takes no memory. Creating a view for each grid would take as long as reading it, in small
    ones.
    """
    return np.broadcast_to(bound, (MAX_CELLS,))


@dataclass(frozen=True)
class Bounds:
    """Least and largest pressure: 0 and, where the surface yields, its hardness.

    ``lower`` and ``upper`` are floats or (n,) arrays; the upper bound may be infinite.
    """

    lower: float | np.ndarray = 0.0
    upper: float | np.ndarray = np.inf

    @property
    def uniform(self) -> bool:
        """True if the bounds are the same on all nodes."""
        return _is_one(self.lower) and _is_one(self.upper)

    @property
    def elastic(self) -> bool:
        """True if no node has an upper bound."""
        upper = self.upper
        return math.isinf(upper) if isinstance(upper, float) else bool(np.isinf(upper).all())

    def clip(self, pressure: np.ndarray) -> np.ndarray:
        """Pressure, (n,), clipped to the bounds."""
        # `np.clip` takes several times as long on few nodes.
        return np.minimum(np.maximum(pressure, self.lower), self.upper)

    def violation(self, pressure: np.ndarray) -> float:
        """Largest violation of the bounds by a pressure, (n,)."""
        return float(np.abs(self.clip(pressure) - pressure).max(initial=0.0))

    def between(self, pressure: np.ndarray) -> np.ndarray:
        """Nodes with both bounds inactive, (k,) int32, where the gap is 0."""
        inside = (pressure > self.lower) & (pressure < self.upper)
        return np.flatnonzero(inside).astype(np.int32)

    def reached_by(self, pressure: np.ndarray, rounding: float = 0.0) -> bool:
        """True if a pressure, (n,), reaches the upper bound anywhere, up to rounding."""
        return bool((pressure >= (1 - rounding) * self.upper).any())

    def over(self, unit: float) -> "Bounds":
        """Bounds in another unit of pressure."""
        return Bounds(self.lower / unit, self.upper / unit)

    def at(self, nodes: np.ndarray) -> "Bounds":
        """Bounds of some nodes, given by their numbers."""
        if self.uniform:
            return self
        lower, upper = np.broadcast_arrays(self.lower, self.upper)
        return Bounds(lower[nodes], upper[nodes])

    def on(self, n: int) -> tuple[np.ndarray, np.ndarray]:
        """Both bounds on each of n nodes for compiled code; a scalar takes no memory."""
        lower, upper = self.lower, self.upper
        if isinstance(lower, float) and isinstance(upper, float):
            return _everywhere(lower)[:n], _everywhere(upper)[:n]
        return np.broadcast_to(lower, (n,)), np.broadcast_to(upper, (n,))

    def coarser(self, shape: tuple[int, int]) -> "Bounds":
        """Bounds on the grid twice as coarse as one of a ``shape``.

        In units of the fine grid a pressure on cells twice as wide displaces them twice as much, so
        that the coarse grid doubles its number. A coarse cell carries the sum of its nodes.
        """
        if self.uniform:
            return Bounds(2 * self.lower, 2 * self.upper)
        on_nodes = (
            np.ascontiguousarray(bound).reshape(shape) for bound in self.on(shape[0] * shape[1])
        )
        return Bounds(*(restrict_sum(bound).ravel() / 2 for bound in on_nodes))
