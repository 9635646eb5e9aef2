"""Strips of a large array, worked on one by one so that no copy of all of it is needed."""

from collections.abc import Iterator

import numpy as np

#: Numbers held at once: 32 MB of them.
_NUMBERS = 4_000_000


def blocks(count: int, numbers: int = 1, most: int = _NUMBERS) -> Iterator[slice]:
    """Consecutive slices of this many things that take ``numbers`` numbers each.

    Parameters
    ----------
    count : int
        Things in all.
    numbers : int
        Numbers that one of them takes while it is worked on.
    most : int, optional
        Numbers held at once.

    Yields
    ------
    slice
        Together all things, each once; none of no things.
    """
    step = max(1, most // max(numbers, 1))
    for start in range(0, count, step):
        yield slice(start, min(start + step, count))


def strips(shape: tuple[int, ...], numbers: int = 1, most: int = _NUMBERS) -> Iterator[slice]:
    """Consecutive rows of a grid whose cells take ``numbers`` numbers each, as :func:`blocks`.

    Parameters
    ----------
    shape : (int, int)
        (ny, nx).
    numbers, most : int
        As for :func:`blocks`.
    """
    return blocks(shape[0], numbers * shape[1], most)


def stacked(parts: list[np.ndarray]) -> np.ndarray:
    """Tables one above the other, as ``numpy.concatenate`` has them, in hardly more memory.

    Parameters
    ----------
    parts : list of (n_i, columns) ndarray
        Of one type; the list is emptied, so that each part is freed once it is copied.

    Returns
    -------
    (sum of n_i, columns) ndarray
    """
    if len(parts) == 1:
        return np.ascontiguousarray(parts.pop())
    rows = sum(len(part) for part in parts)
    table = np.empty((rows, parts[0].shape[1]), parts[0].dtype)
    parts.reverse()
    start = 0
    while parts:
        part = parts.pop()
        table[start : start + len(part)] = part
        start += len(part)
    return table
