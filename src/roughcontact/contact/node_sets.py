"""Sets of nodes as ascending numbers of cells: checks and comparison."""

import numpy as np

from ..kernel_cache import njit

# dtypes to compare with; comparing with np.int32 itself is slower.
_INT32, _FLOAT32 = np.dtype(np.int32), np.dtype(np.float32)


def check_nodes(nodes: np.ndarray, shape: tuple[int, int]) -> None:
    """`ValueError` for an invalid set of nodes, since compiled code does not check indices."""
    if nodes.ndim != 1 or nodes.dtype != _INT32 or not _ascending(nodes, shape[0] * shape[1]):
        raise ValueError(
            f"nodes {nodes.shape} of {nodes.dtype}: expected numbers of cells (n,) of int32, "
            f"ascending, on a grid of {shape}"
        )


def check_on_set(values: np.ndarray, n: int) -> None:
    """`ValueError` for anything but float32 values of the n nodes of a contact set."""
    if values.shape != (n,) or values.dtype != _FLOAT32:
        raise ValueError(f"{values.shape} numbers of {values.dtype}: expected {(n,)} of float32")


@njit(cache=True)
def _ascending(nodes, cells):
    """True if these are ascending numbers from 0 to cells - 1."""
    before = -1
    for node in nodes:
        if node <= before or node >= cells:
            return False
        before = node
    return True


@njit(cache=True)
def symmetric_difference(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Nodes in exactly one of two sets, (n,) int32, ascending."""
    different = np.empty(first.size + second.size, np.int32)
    a, b, n = 0, 0, 0
    while a < first.size or b < second.size:
        in_first = b == second.size or (a < first.size and first[a] <= second[b])
        in_second = a == first.size or (b < second.size and second[b] <= first[a])
        if in_first != in_second:
            different[n] = first[a] if in_first else second[b]
            n += 1
        a += in_first
        b += in_second
    return different[:n]
