"""Arrays of different length as rows of one table."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike


def padded(arrays: Sequence[ArrayLike], length: int | None = None) -> np.ndarray:
    """Arrays of different length as rows of one float64 table, the rest NaN.

    ``length`` is the number of columns, by default that of the longest array.
    """
    rows = [np.asarray(values) for values in arrays]
    length = max((len(row) for row in rows), default=0) if length is None else length
    table = np.full((len(rows), length), np.nan)
    for row, values in zip(table, rows, strict=True):
        row[: len(values)] = values
    return table
