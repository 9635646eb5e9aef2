"""Sliding one face over the other: signs, symmetry, limits."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact.errors import InputError
from fractalcontact.joint import (
    choose_offsets,
    composite_topography,
    prefractal,
    rigid_dilatancy,
)
from fractalcontact.specimen import faces, largest_offset, make_specimen, window_slices
from fractalcontact.synthesis import self_affine

SPACING = 0.1


def specimen(heights, **options):
    ny, nx = heights.shape
    coords = {"y": np.arange(ny) * SPACING, "x": np.arange(nx) * SPACING}
    attrs = {"spacing_x": SPACING, "spacing_y": SPACING}
    scan = xr.DataArray(heights, dims=("y", "x"), coords=coords, attrs=attrs)
    return make_specimen(scan, window=2.0, name="test", **options)


@pytest.fixture
def rough():
    return self_affine((40, 40), SPACING, 0.8, seed=3, rms=0.2)


def test_matching_faces_at_zero_offset_leave_nothing(rough):
    assert not composite_topography(specimen(rough), "E", 0).any()


def test_the_window_slides_towards_the_direction(rough):
    joint = specimen(rough)
    z_l, z_u = faces(joint)
    y, x = window_slices(joint)
    expected = z_l[y, x.start + 3 : x.stop + 3] - z_u[y, x]
    assert np.array_equal(composite_topography(joint, "E", 3), expected)
    expected = z_l[y.start + 3 : y.stop + 3, x] - z_u[y, x]
    assert np.array_equal(composite_topography(joint, "N", 3), expected)


@pytest.mark.parametrize(("one", "other", "axis"), [("E", "W", 1), ("N", "S", 0)])
def test_mirrored_scan_slides_the_other_way(rough, one, other, axis):
    # Levelling rounds differently on the mirrored scan, so the plane is put back to none.
    here, there = specimen(rough), specimen(np.flip(rough, axis))
    here["lower"].values[...] = rough
    there["lower"].values[...] = np.flip(rough, axis)
    slid = composite_topography(here, one, 4)
    assert np.array_equal(np.flip(slid, axis), composite_topography(there, other, 4))


def test_rigid_dilatancy_of_a_known_step():
    heights = np.zeros((40, 40))
    heights[:, 20:] = 0.5
    joint = specimen(heights)
    joint["lower"].values[...] = heights
    opened, spread = rigid_dilatancy(joint, "E", [0, 1, 5])
    assert opened == pytest.approx([0, 0.5, 0.5])
    assert spread[0] == 0
    assert rigid_dilatancy(joint, "N", [5])[0] == 0


def test_an_offset_out_of_the_scan_names_the_largest_possible(rough):
    joint = specimen(rough)
    largest = largest_offset(joint, "W")
    assert choose_offsets(joint, [largest * SPACING], ["W"])["W"][0] == largest
    with pytest.raises(
        InputError, match=rf"specimen test: .* W .*possible is {largest * SPACING:g}"
    ):
        choose_offsets(joint, [(largest + 1) * SPACING], ["W"])


def test_an_offset_below_half_a_cell_is_refused(rough):
    with pytest.raises(InputError, match="less than half its spacing"):
        choose_offsets(specimen(rough), [0.04], ["E"])


def test_automatic_offsets_rise_from_one_cell_to_the_largest(rough):
    joint = specimen(rough)
    offsets = choose_offsets(joint, None, ["E", "N", "W", "S"])["E"]
    assert offsets[0] == 1
    assert offsets[-1] == min(largest_offset(joint, d) for d in "ENWS")
    assert (np.diff(offsets) > 0).all()


def test_a_plane_opposite_does_not_slide(rough):
    joint = specimen(rough, opposite="flat")
    y, x = window_slices(joint)
    assert np.array_equal(composite_topography(joint, "none", 0), faces(joint)[0][y, x])


def test_prefractal_keeps_every_kth_node():
    assert prefractal(np.arange(16).reshape(4, 4), 2).tolist() == [[0, 2], [8, 10]]
