"""Arrays of different length as rows of one table."""

import numpy as np


def padded(arrays, length=None):
    """Arrays of different length as rows of one table, the rest NaN.

    Parameters
    ----------
    arrays : sequence of (n_i,) array_like
    length : int, optional

    Returns
    -------
    (len(arrays), length) float64 ndarray
    """
    length = max((len(a) for a in arrays), default=0) if length is None else length
    table = np.full((len(arrays), length), np.nan)
    for row, values in zip(table, arrays, strict=True):
        row[: len(values)] = values
    return table
