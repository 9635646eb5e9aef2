"""Strips of a large array, worked on one by one so that no copy of all of it is needed."""

from collections.abc import Iterator

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
