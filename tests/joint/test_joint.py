"""Sliding one face over the other: signs, symmetry, limits."""

import numpy as np
import pytest
import xarray as xr

from fractalcontact.core.errors import InputError
from fractalcontact.core.mean_plane import without_mean_plane
from fractalcontact.core.window import faces, window_slices
from fractalcontact.joint import rigid_slide
from fractalcontact.joint.joint import (
    choose_offsets,
    composite_topography,
    correlation_ranges,
    face_correlation,
    prefractal,
    rigid_dilatancy,
    with_spreads,
)
from fractalcontact.joint.rigid_slide import slide
from fractalcontact.surface.specimen import largest_offset, make_specimen
from fractalcontact.surface.synthesis import self_affine

SPACING = 0.1


def specimen(heights, *, window=2.0, **options):
    ny, nx = heights.shape
    coords = {"y": np.arange(ny) * SPACING, "x": np.arange(nx) * SPACING}
    attrs = {"spacing_x": SPACING, "spacing_y": SPACING}
    scan = xr.DataArray(heights, dims=("y", "x"), coords=coords, attrs=attrs)
    return make_specimen(scan, window=window, name="test", **options)


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


def test_a_matching_face_correlates_fully_and_less_as_it_slides(rough):
    joint = specimen(rough)
    correlation = face_correlation(joint, "E", np.arange(8))
    assert correlation[0] == pytest.approx(1, abs=1e-12)
    assert (np.diff(correlation[:4]) < 0).all()


def test_correlation_of_a_wave_is_its_cosine():
    # 20 cells a wave, 20 cells of window: the mean plane of a whole wave is not level, so a wave
    # along y seen while sliding along y keeps a plane of its own; a shorter wave has less of it.
    x = np.arange(40)
    wave = np.sin(2 * np.pi * x / 4)
    joint = specimen(np.tile(wave, (40, 1)))
    joint["lower"].values[...] = np.tile(wave, (40, 1))
    expected = np.cos(2 * np.pi * np.arange(5) / 4)
    assert face_correlation(joint, "E", np.arange(5)) == pytest.approx(expected, abs=0.06)


def test_correlation_ranges_of_an_exponential():
    v = np.linspace(0, 10, 1001)
    length, uncorrelated, limit = correlation_ranges(v, [np.exp(-v / 2), np.exp(-v / 2)], 400.0)
    assert length == pytest.approx([2, 2], abs=0.01)
    assert limit == pytest.approx(1.96 * np.sqrt(np.pi * 4 / 800), rel=0.01)
    assert uncorrelated == pytest.approx(-2 * np.log([limit, limit]), abs=0.01)


def test_the_limit_is_what_chance_gives():
    def surface(seed):
        return self_affine((96, 96), SPACING, 0.8, seed=seed, rms=0.1, roll_off=1.2)

    surfaces = [surface(seed) for seed in range(40)]
    v = np.arange(30)
    own = [np.mean(surfaces[0][:, : 96 - n] * surfaces[0][:, n:]) for n in v]
    _, _, limit = correlation_ranges(v * SPACING, [np.array(own) / own[0]], (96 * SPACING) ** 2)
    found = [np.corrcoef(a.ravel(), b.ravel())[0, 1] for a in surfaces[:20] for b in surfaces[20:]]
    # Spectra without long waves leave a negative lobe, and less chance than an exponential.
    assert 1 < limit / np.quantile(np.abs(found), 0.95) < 2


def test_the_spread_expected_follows_from_both_faces_and_their_correlation(rough):
    """Faces of one spread s: none where they are alike, sqrt(2) s without correlation."""
    made = specimen(rough)
    over = ("direction", "rigid_offset")
    joint = xr.Dataset(
        {
            "face_correlation": (over, [[1.0, 0.5, 0.0, -1.0]]),
            "rigid_dilatancy": (over, [[0.0, 0.1, 0.2, 0.3]]),
            "composite_rms": (over, [[0.0, 0.1, 0.1, 0.1]]),
            "uncorrelated_offset": ("direction", [np.nan]),
        }
    )
    found = with_spreads(joint, made)
    spread = np.std(without_mean_plane(faces(made)[0][window_slices(made)]))
    expected = spread * np.array([[0, 1, np.sqrt(2), 2]])
    np.testing.assert_allclose(found["composite_rms_expected"], expected, atol=1e-9)
    np.testing.assert_allclose(found["dilatancy_over_rms"], [[np.nan, 1, 2, 3]])
    assert np.isnan(found["mean_uncorrelated_offset"])


def test_faces_that_stay_alike_have_no_such_range():
    length, uncorrelated, limit = correlation_ranges([0, 1, 2], [[1, 0.9, 0.8]], 400.0)
    assert np.isnan([*length, *uncorrelated, limit]).all()


@pytest.mark.parametrize("direction", ["E", "N", "W", "S"])
@pytest.mark.parametrize(("window", "level"), [(2.0, 0.0), (2.0, 1e5), ((2.6, 1.1), 0.0)])
def test_a_slide_in_one_pass_is_that_of_whole_arrays(monkeypatch, rough, direction, window, level):
    monkeypatch.setattr(rigid_slide, "_BLOCK", 256)  # the rows of several blocks
    joint = specimen(rough, window=window)
    joint["lower"] = joint["lower"] + level
    cells = np.arange(6)
    opened, spread = rigid_dilatancy(joint, direction, cells)
    found = face_correlation(joint, direction, cells)
    _, z_u = faces(joint)
    upper = z_u[window_slices(joint)]
    under = without_mean_plane(upper)
    for n in cells:
        composite = composite_topography(joint, direction, n)
        above = without_mean_plane(composite + upper)
        rho = np.mean(above * under) / np.sqrt(np.mean(above**2) * np.mean(under**2))
        accuracy = {"rel": 1e-9, "abs": 1e-15 * max(level, 1)}
        assert opened[n] == pytest.approx(composite.max(), **accuracy)
        assert spread[n] == pytest.approx(composite.std(), **accuracy)
        assert found[n] == pytest.approx(rho, rel=1e-9 if level == 0 else 1e-7)
    assert opened[0] == spread[0] == 0
    # Also where the slide is far shorter than either side of the window.
    assert face_correlation(joint, direction, cells[:2]) == pytest.approx(found[:2], rel=1e-7)


def test_a_plane_is_correlated_with_nothing(rough):
    y, x = np.indices(rough.shape)
    joint = specimen(rough)
    joint["lower"] = ("y", "x"), 0.3 * x + 0.1 * y
    assert np.isnan(face_correlation(joint, "E", [0, 2])).all()


@pytest.mark.parametrize("level", [0.0, 1e4])
def test_nothing_is_correlated_with_a_plane(rough, level):
    y, x = np.indices((20, 20))
    places = np.array([[5, 0], [5, 3], [5, 20]])
    tilted = 0.3 * x + 0.1 * y + level
    assert np.isnan(slide(rough, tilted, places).correlation).all()
    assert np.isfinite(slide(rough, tilted + rough[:20, :20], places).correlation).all()


def test_places_of_a_slide_lie_along_one_line():
    heights = np.zeros((8, 8))
    with pytest.raises(ValueError, match="along a row or along a column"):
        slide(heights, heights[:4, :4], np.array([[0, 0], [1, 1]]))
