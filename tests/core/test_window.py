"""Window of a specimen: what its attributes state, on cells that are not square."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact.core.directions import APERTURE
from fractalcontact.core.window import (
    cell_side,
    face_words,
    faces,
    nominal_area,
    window_sides,
    window_slices,
)

LOWER = np.array([[1.0, 2.0, np.nan], [0.5, -1.0, 3.0]], np.float32)
UPPER = LOWER + 0.25
PLANE = np.zeros(LOWER.shape)


def specimen(opposite):
    attrs = {"opposite": opposite, "spacing_y": 0.5, "spacing_x": 2.0}
    attrs |= {"window_y0": 3, "window_x0": 1, "window_ny": 8, "window_nx": 6}
    return xr.Dataset({"lower": (("y", "x"), LOWER), "upper": (("y", "x"), UPPER)}, attrs=attrs)


@pytest.mark.parametrize(
    ("opposite", "upper"),
    [("scanned", UPPER), ("match", LOWER), ("flat", PLANE), (APERTURE, PLANE)],
)
def test_a_face_that_was_not_scanned_is_the_lower_one_or_a_plane(opposite, upper):
    below, above = faces(specimen(opposite))
    np.testing.assert_array_equal(below, LOWER)
    np.testing.assert_array_equal(above, upper)


@pytest.mark.parametrize("opposite", ["scanned", "match", "flat"])
def test_a_face_is_named_unless_it_is_a_map_of_the_aperture(opposite):
    assert face_words(specimen(opposite), "upper") == "upper face"
    assert face_words(specimen(APERTURE), "lower") == "negative of the aperture"


def test_lengths_of_the_window_follow_its_cells():
    made = specimen("match")
    assert window_slices(made) == (slice(3, 11), slice(1, 7))
    assert window_sides(made) == (4.0, 12.0)
    assert nominal_area(made) == 48.0
    assert cell_side(made) == 1.0
