"""Arrays of different length as rows of one table."""

import numpy as np

from fractalcontact.core.arrays import padded


def test_rows_keep_their_values_and_are_filled_with_nan():
    table = padded([[1, 2, 3], [], np.array([4.0])])
    np.testing.assert_array_equal(table, [[1, 2, 3], [np.nan] * 3, [4, np.nan, np.nan]])
    assert table.dtype == np.float64


def test_a_length_may_be_given():
    assert padded([[1.0]], 4).shape == (1, 4)
    assert padded([]).shape == (0, 0)
