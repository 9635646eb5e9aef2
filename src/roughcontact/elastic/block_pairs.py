"""Blocks of cells that the nodes of a set occupy on every level, and which act on each other there.

Only blocks with a node of the set exist. Two of them act on each other at the lowest level on which
their parents are neighbours (`multipole`). Pairs of the same relative position have the same matrix
and are gone through together.
"""

import numpy as np

from ..kernel_cache import njit
from .block_influence import LEAF, SEPARATION, reach

#: Pairs of blocks with the same relative position that are worked on together.
TOGETHER = 4
#: Target blocks of a chunk: for each the matrices are read again.
CHUNK = 128


class MultipoleLevels:
    """Blocks, and pairs of blocks, that the nodes of a set occupy on every level.

    Parameters
    ----------
    shape : (int, int)
        Cells of the window, (ny, nx).
    nodes : (n,) int32 ndarray
        Nodes as numbers of cells, ascending; nothing checks them.

    Attributes
    ----------
    place : (n,) ndarray
        Where each node stands in the vectors of the smallest blocks.
    blocks : list of int
        On every level.
    parents : list of (n, 2) int32 ndarray
        On every level but the last, of each block: its parent, and which of its four quarters.
    """

    def __init__(self, shape: tuple[int, int], nodes: np.ndarray):
        grid = tuple(-(-n // LEAF) for n in shape)
        index = np.zeros(grid, np.int32)
        y, x = np.divmod(nodes, shape[1])
        index[y // LEAF, x // LEAF] = 1
        at = np.flatnonzero(index).astype(np.int64)
        index.ravel()[at] = np.arange(1, at.size + 1)
        self.place = (index[y // LEAF, x // LEAF] - 1).astype(np.int64) * LEAF**2
        self.place += y % LEAF * LEAF + x % LEAF
        self.blocks, self.parents, self._grids = [], [], []
        self._pairs: dict[int, list] = {}
        while True:
            rows, columns = np.divmod(at, grid[1])
            self.blocks.append(at.size)
            self._grids.append((rows, columns, index))
            if max(grid) <= 2 * reach(min(SEPARATION.values())) - 2:
                return
            grid = tuple(-(-n // 2) for n in grid)
            index = np.zeros(grid, np.int32)
            index[rows // 2, columns // 2] = 1
            at = np.flatnonzero(index).astype(np.int64)
            index.ravel()[at] = np.arange(1, at.size + 1)
            quarter = rows % 2 * 2 + columns % 2
            self.parents.append(
                np.stack([index[rows // 2, columns // 2] - 1, quarter], axis=1).astype(np.int32)
            )

    def pairs(self, separation: int) -> list[tuple[np.ndarray, np.ndarray]]:
        """Pairs of blocks that act on each other, for every level.

        Returns
        -------
        list of (batches, chunks)
            Batches (m, 1 + 2 TOGETHER): relative position, targets and sources; and where in them
            the chunks of targets begin.
        """
        if separation not in self._pairs:
            self._pairs[separation] = [
                _pairs(*grid, level == 0, separation) for level, grid in enumerate(self._grids)
            ]
        return self._pairs[separation]

    @property
    def work(self) -> int:
        """Batches of all levels, which take nearly all the time of a search's application."""
        return sum(len(batches) for batches, _ in self.pairs(SEPARATION[np.dtype(np.float32)]))


def _pairs(rows, columns, index, lowest, separation):
    """Batches of pairs of blocks, (m, 1 + 2 TOGETHER), and where their chunks begin."""
    blocks, apart = (rows, columns, index), (separation, reach(separation))
    none = np.empty((0, 1 + 2 * TOGETHER), np.int32)
    chunks = _fill_pairs(*blocks, lowest, *apart, none)
    batches = np.empty((chunks[-1], 1 + 2 * TOGETHER), np.int32)
    return batches, _fill_pairs(*blocks, lowest, *apart, batches)


@njit(cache=True)
def _fill_pairs(rows, columns, index, lowest, separation, furthest, batches):
    """Fill the batches if there is room; in any case, return where the chunks begin.

    Sources are blocks no further than the ``furthest`` whose parents are neighbours; but neighbours
    themselves only on the lowest level. Places that remain in a batch are given to a block that is
    not there.
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
