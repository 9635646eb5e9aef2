"""Arrays of different length as rows of one table."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike


def padded(arrays: Sequence[ArrayLike], length: int | None = None) -> np.ndarray:
    """Arrays of different length as rows of one table, the rest NaN.

    Parameters
    ----------
    arrays : sequence of (n_i,) array_like
    length : int, optional

    Returns
    -------
    (len(arrays), length) float64 ndarray
    """
    rows = [np.asarray(values) for values in arrays]
    length = max((len(row) for row in rows), default=0) if length is None else length
    table = np.full((len(rows), length), np.nan)
    for row, values in zip(table, rows, strict=True):
        row[: len(values)] = values
    return table
