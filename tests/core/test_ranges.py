"""Ranges whose ends belong to them, whatever the last digits of a product."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact.core.ranges import RELATIVE_ROUNDING, within


@pytest.mark.parametrize("scale", [1e-9, 1.0, 3e12])
def test_ends_belong_to_the_range_but_for_rounding(scale):
    low, high = 3 * 0.1 * scale, 0.7 * scale  # 0.30000000000000004
    values = scale * np.array([0.3, 0.3 - 1e-6, 0.7, 0.1 * 7, 0.7 + 1e-6, 0.5])
    np.testing.assert_array_equal(within(values, low, high), [True, False, True, True, False, True])


def test_the_tolerance_is_relative_and_stated():
    inside, outside = 1 - 0.9 * RELATIVE_ROUNDING, 1 - 1.1 * RELATIVE_ROUNDING
    assert within([inside, outside], 1, 2).tolist() == [True, False]


def test_open_ranges_and_missing_values():
    values = [0.0, 1e-300, 1e300, np.nan]
    assert within(values, 0, np.inf).tolist() == [True, True, True, False]


def test_labelled_values_give_labelled_truth():
    values = xr.DataArray([1.0, 2.0, 3.0], dims="resolution", coords={"resolution": [1, 2, 4]})
    found = within(values, 2, 3)
    assert found.dims == ("resolution",)
    assert values.where(found, drop=True).resolution.values.tolist() == [2, 4]
