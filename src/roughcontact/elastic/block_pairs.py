"""Blocks of cells occupied by a set of nodes on every level, and the pairs that interact there.

Only blocks with a node of the set exist. Two blocks interact on the lowest level on which their
parents are neighbours (`multipole`). Pairs of the same relative position share a matrix and are
processed together.
"""

import numpy as np

from ..kernel_cache import njit
from .block_influence import LEAF, SEPARATION, reach

#: Pairs of blocks of one relative position that are processed together.
TOGETHER = 4
#: Target blocks per chunk; each chunk reads the matrices again.
CHUNK = 128


class MultipoleLevels:
    """Occupied blocks and interacting pairs of blocks on every level.

    ``nodes``, (n,) int32, are ascending numbers of cells of a window of ``shape``; they are not
    checked.

    Attributes
    ----------
    place : (n,) ndarray
        Index of each node in the vectors of the smallest blocks.
    blocks : list of int
        Number of blocks on every level.
    parents : list of (n, 2) int32 ndarray
        Parent of each block and its quarter of the parent, on every level but the last.
    """

    def __init__(self, shape: tuple[int, int], nodes: np.ndarray):
        grid = tuple(-(-n // LEAF) for n in shape)
        index = np.zeros(grid, np.int32)
        y, x = np.divmod(nodes, shape[1])
        index[y // LEAF, x // LEAF] = 1
        occupied = np.flatnonzero(index).astype(np.int64)
        index.ravel()[occupied] = np.arange(1, occupied.size + 1)
        self.place = (index[y // LEAF, x // LEAF] - 1).astype(np.int64) * LEAF**2
        self.place += y % LEAF * LEAF + x % LEAF
        self.blocks, self.parents, self._grids = [], [], []
        self._pairs: dict[int, list] = {}
        while True:
            rows, columns = np.divmod(occupied, grid[1])
            self.blocks.append(occupied.size)
            self._grids.append((rows, columns, index))
            if max(grid) <= 2 * reach(min(SEPARATION.values())) - 2:
                return
            grid = tuple(-(-n // 2) for n in grid)
            index = np.zeros(grid, np.int32)
            index[rows // 2, columns // 2] = 1
            occupied = np.flatnonzero(index).astype(np.int64)
            index.ravel()[occupied] = np.arange(1, occupied.size + 1)
            quarter = rows % 2 * 2 + columns % 2
            self.parents.append(
                np.stack([index[rows // 2, columns // 2] - 1, quarter], axis=1).astype(np.int32)
            )

    def pairs(self, separation: int) -> list[tuple[np.ndarray, np.ndarray]]:
        """Interacting pairs of blocks as (batches, chunks), for every level.

        A row of the batches, (m, 1 + 2 TOGETHER), holds a relative position, targets and sources;
        chunks are the first rows of the chunks of targets.
        """
        if separation not in self._pairs:
            self._pairs[separation] = [
                _pairs(*grid, level == 0, separation) for level, grid in enumerate(self._grids)
            ]
        return self._pairs[separation]

    @property
    def work(self) -> int:
        """Number of batches in single precision: nearly all the time of an application."""
        return sum(len(batches) for batches, _ in self.pairs(SEPARATION[np.dtype(np.float32)]))


def _pairs(rows, columns, index, lowest, separation):
    """Batches of pairs of blocks, (m, 1 + 2 TOGETHER), and the first row of each chunk."""
    blocks, apart = (rows, columns, index), (separation, reach(separation))
    none = np.empty((0, 1 + 2 * TOGETHER), np.int32)
    chunks = _fill_pairs(*blocks, lowest, *apart, none)
    batches = np.empty((chunks[-1], 1 + 2 * TOGETHER), np.int32)
    return batches, _fill_pairs(*blocks, lowest, *apart, batches)


@njit(cache=True)
def _fill_pairs(rows, columns, index, lowest, separation, furthest, batches):
    """Fill the batches, if there is room, and return the first row of each chunk.

    Sources are blocks within the ``furthest`` distance whose parents are neighbours; neighbours
    themselves only on the lowest level. The rest of a batch is filled with a block that does not
    exist.
    """
    total, span = rows.size, 2 * furthest + 1
    chunks = np.zeros((total + CHUNK - 1) // CHUNK + 1, np.int64)
    m = 0
    for chunk in range(chunks.size - 1):
        for offset in range(span * span):
            oy, ox = offset // span - furthest, offset % span - furthest
            if not lowest and max(abs(oy), abs(ox)) <= separation:
                continue
            filled = TOGETHER
            for target in range(chunk * CHUNK, min((chunk + 1) * CHUNK, total)):
                y, x = rows[target] - oy, columns[target] - ox
                if y < 0 or x < 0 or y >= index.shape[0] or x >= index.shape[1]:
                    continue
                away = max(abs(rows[target] // 2 - y // 2), abs(columns[target] // 2 - x // 2))
                source = index[y, x] - 1
                if source < 0 or away > separation:
                    continue
                if filled == TOGETHER:
                    m, filled = m + 1, 0
                    if batches.shape[0]:
                        batches[m - 1, 0] = offset
                        batches[m - 1, 1:] = total
                if batches.shape[0]:
                    batches[m - 1, 1 + filled] = target
                    batches[m - 1, 1 + TOGETHER + filled] = source
                filled += 1
        chunks[chunk + 1] = m
    return chunks
