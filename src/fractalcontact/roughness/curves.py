"""Curves from which the Hurst exponent of a surface is read, each in parts.

An estimator measures a quantity that grows as a known power of a length on a self-affine surface.
Every measure here is a mean, kept as a sum and a weight for each of several parts of the surface,
so that leaving out one part after the other gives its error. All work on surfaces
with missing cells and any outline: they use the windows, pairs or boxes complete at each length.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from roughcontact.arguments import field, whole_numbers
from roughcontact.kernel_cache import njit

#: Lengths measured in each doubling.
LENGTHS_PER_OCTAVE = 4

#: Parts of the surface: `BLOCKS` x `BLOCKS` blocks.
BLOCKS = 4

#: Least measured fraction of a window or box that counts.
WINDOW_COVER = 0.9


class Curve(NamedTuple):
    """A measure over lengths, in parts of the surface."""

    length: np.ndarray
    """Lengths (k,), mm."""
    total: np.ndarray
    """Sums (k, parts) of what is averaged."""
    weight: np.ndarray
    """Weights (k, parts): how much was summed."""

    def measure(self) -> np.ndarray:
        """Mean over all parts (k,), NaN where nothing was measured."""
        return ratio(self.total.sum(axis=1), self.weight.sum(axis=1))

    def without_each_part(self) -> np.ndarray:
        """Means (parts, k) over all parts but one, without empty parts."""
        held = self.weight.any(axis=0)
        total, weight = self.total[:, held], self.weight[:, held]
        left = weight.sum(axis=1, keepdims=True) - weight
        return ratio(total.sum(axis=1, keepdims=True) - total, left).T


def ratio(total: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Total over weight, NaN where there is no weight."""
    return np.divide(total, weight, out=np.full(np.shape(total), np.nan), where=weight > 0)


def jackknife_standard_error(without: np.ndarray) -> np.ndarray:
    """Standard error of () or (k,) values from those without each part (parts, ...).

    0 with fewer than two parts.
    """
    parts = len(without)
    if parts < 2:
        return np.zeros(without.shape[1:])
    return np.sqrt((parts - 1) / parts * np.sum((without - without.mean(axis=0)) ** 2, axis=0))


def of_both_axes(curves: dict[str, Curve]) -> dict[str, Curve]:
    """Curves along x, along y and of both axes together."""
    x, y = curves["x"], curves["y"]
    return {"both": Curve(x.length, x.total + y.total, x.weight + y.weight), **curves}


def lengths_in_cells(first: int, last: int) -> np.ndarray:
    """Whole numbers of cells from `first` to `last`, about evenly spaced on a logarithmic axis."""
    if last < first:
        return np.empty(0, int)
    octaves = np.arange(np.floor(np.log2(last / first) * LENGTHS_PER_OCTAVE) + 1)
    return np.unique(np.round(first * 2 ** (octaves / LENGTHS_PER_OCTAVE)).astype(int))


def in_blocks(
    spacing: float, lengths: np.ndarray, heights: np.ndarray, add: Callable[..., None]
) -> Curve:
    """Curve over lengths in cells: ``add(heights, length, total, weight)`` fills the blocks.

    ValueError if the heights are no (y, x) grid of real numbers, or a length is below 1 or not
    whole.
    """
    heights = field(heights, "heights")
    lengths = whole_numbers(lengths, "lengths", least=1, most=max(1, *heights.shape))
    total, weight = np.zeros((2, len(lengths), BLOCKS, BLOCKS))
    for k, length in enumerate(lengths):
        add(heights, length, total[k], weight[k])
    shape = len(lengths), BLOCKS**2
    return Curve(lengths * spacing, total.reshape(shape), weight.reshape(shape))


def along_axes(
    spacing: float, lengths: np.ndarray, heights: np.ndarray, add: Callable[..., None]
) -> dict[str, Curve]:
    """Curves of a measure of rows: along x, along y, and both."""
    x = in_blocks(spacing, lengths, heights, add)
    y = in_blocks(spacing, lengths, np.ascontiguousarray(heights.T), add)
    turned = (len(lengths), BLOCKS, BLOCKS)
    total, weight = (a.reshape(turned).swapaxes(1, 2).reshape(x.total.shape) for a in y[1:])
    return of_both_axes({"x": x, "y": Curve(x.length, total, weight)})


@njit(cache=True)
def add_squares(
    differences: np.ndarray, length: int, total: np.ndarray, weight: np.ndarray
) -> None:
    """Add squares of differences over cells `length` apart to the blocks that hold their middles.

    A kernel: (ny, nx - length) differences along x, and (BLOCKS, BLOCKS) sums and numbers of them.
    """
    ny, nx = differences.shape[0], differences.shape[1] + length
    for i in range(ny):
        row = i * BLOCKS // ny
        for column in range(BLOCKS):
            squares, n = 0.0, 0
            for j in range(*pairs_in_block(column, nx, length)):
                d = differences[i, j]
                if np.isfinite(d):
                    squares += d * d
                    n += 1
            total[row, column] += squares
            weight[row, column] += n


@njit(cache=True)
def pairs_in_block(block: int, nx: int, length: int) -> tuple[int, int]:
    """First start of a pair of cells `length` apart whose middle lies in the block, and the end.

    A kernel, of whole numbers alone.
    """
    first = (2 * nx * block // BLOCKS - length + 1) // 2
    last = (2 * nx * (block + 1) // BLOCKS - length + 1) // 2
    return max(first, 0), max(min(last, nx - length), 0)
