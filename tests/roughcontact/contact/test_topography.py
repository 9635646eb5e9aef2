"""Heights are read in their own precision, on any grid."""

import numpy as np
import pytest

from roughcontact.contact.restriction import restrict_minimum
from roughcontact.contact.topography import Topography


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("shape", [(1, 1), (1, 7), (6, 5), (32, 33)])
def test_coarser_heights_are_the_highest(shape, dtype):
    height = np.random.default_rng(0).random(shape).astype(dtype)
    topography = Topography(height, shape)
    assert (topography.lowest, topography.highest) == (height.min(), height.max())
    clearance = float(height.max()) - height.astype(float)
    for level in range(4):
        np.testing.assert_array_equal(topography.clearance(level), clearance)
        assert topography.height(level).dtype == dtype
        clearance = restrict_minimum(clearance)
    assert topography.height() is height


@pytest.mark.parametrize("shape", [(1, 7), (6, 5), (32, 33)])
def test_nodes_below_are_found_in_coarse_cells_too(shape):
    height = np.random.default_rng(1).random(shape)
    topography = Topography(height, shape)
    for clearance in (0.05, 0.3, 2.0):
        expected = np.flatnonzero(height.max() - height < clearance)
        cells = topography.below(clearance, 1, None)
        for found in (topography.below(clearance, 0, cells), topography.below(clearance, 0, None)):
            np.testing.assert_array_equal(found, expected)
            assert found.dtype == np.int32
        at = topography.clearance_at(found)
        np.testing.assert_array_equal(at, (height.max() - height).ravel()[expected])


@pytest.mark.parametrize("shape", [(1, 7), (6, 5)])
def test_the_clearance_of_a_bearing_area_is_that_of_its_lowest_node(shape):
    height = np.random.default_rng(2).random(shape)
    topography = Topography(height, shape)
    for count, clearance in enumerate(np.sort(height.max() - height, axis=None), start=1):
        assert topography.bearing_clearance(count) == clearance


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_a_missing_cell_is_refused(value, dtype):
    height = np.zeros((4, 4), dtype)
    height[2, 1:3] = value
    with pytest.raises(ValueError, match="2 missing or infinite cells"):
        Topography(height, (4, 4))
    with pytest.raises(ValueError, match=r"expected the grid's \(4, 5\)"):
        Topography(np.zeros((4, 4)), (4, 5))
    assert Topography([[0, 1], [2, 3]], (2, 2)).highest == 3
    assert Topography(np.zeros((2, 2), order="F"), (2, 2)).highest == 0
