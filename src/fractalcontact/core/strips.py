"""Strips of a large array, processed one by one so that no copy of all of it is needed."""

from collections.abc import Iterator

#: Most numbers in memory at once: 32 MB.
_NUMBERS = 4_000_000


def blocks(count: int, numbers: int = 1, most: int = _NUMBERS) -> Iterator[slice]:
    """Consecutive slices of ``count`` items of ``numbers`` numbers each, at most ``most`` at once.

    No slice without items.
    """
    step = max(1, most // max(numbers, 1))
    for start in range(0, count, step):
        yield slice(start, min(start + step, count))


def strips(shape: tuple[int, ...], numbers: int = 1, most: int = _NUMBERS) -> Iterator[slice]:
    """Consecutive rows of a grid (ny, nx) whose cells take ``numbers`` numbers each."""
    return blocks(shape[0], numbers * shape[1], most)
