"""Strips of large arrays: all of it, each part once, and no more at once than allowed."""

import numpy as np
import pytest

from fractalcontact.core.strips import blocks, strips


@pytest.mark.parametrize("count", [0, 1, 7, 100])
@pytest.mark.parametrize("numbers", [1, 3, 1000])
def test_blocks_take_everything_once_and_hold_no_more_than_allowed(count, numbers):
    parts = list(blocks(count, numbers, most=30))
    taken = np.concatenate([np.arange(count)[part] for part in parts] or [np.arange(0)])
    np.testing.assert_array_equal(taken, np.arange(count))
    assert all((p.stop - p.start) * numbers <= max(30, numbers) for p in parts)


def test_strips_are_whole_rows():
    assert list(strips((5, 10), 2, most=45)) == [slice(0, 2), slice(2, 4), slice(4, 5)]
