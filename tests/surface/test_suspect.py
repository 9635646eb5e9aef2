"""Lone spikes and overlaps are found where they are, and filled only when the study says so."""

import json

import numpy as np
import pytest
from ensembles import ensemble
from hypothesis import given, settings
from hypothesis import strategies as st
from samples import scan_of

from fractalcontact.core.errors import InputError
from fractalcontact.core.window import window_slices
from fractalcontact.surface.specimen import make_specimen
from fractalcontact.surface.suspect import find_suspects, overlap_statistics, typical_deviation
from fractalcontact.surface.synthesis import self_affine

SPIKES = [(10, 20), (25, 7), (33, 33)]


def surface(seed=1, hurst=0.7, cells=48):
    return self_affine((cells, cells), 0.5, hurst, rms=1.0, seed=seed)


def pair(gap=0.5, noise=0.02, seed=1):
    """Two faces of one joint, their gap no smaller than some 0.4 of it."""
    z, rng = surface(seed), np.random.default_rng(seed)
    lower, upper = (z + noise * rng.normal(size=z.shape) for _ in range(2))
    return lower, upper + gap


def spiked(z, height):
    z = z.copy()
    for cell in SPIKES:
        z[cell] += height
    return z


def found_in(cells):
    return sorted(map(tuple, np.argwhere(cells)))


@pytest.mark.parametrize("hurst", [0.3, 0.8])
def test_nothing_stands_alone_on_self_affine_surfaces(hurst):
    side, seeds = ensemble("outlier surfaces")
    for seed in seeds:
        spikes = find_suspects([scan_of(surface(seed, hurst, side))]).spikes[0]
        assert spikes.mean() < 1e-5


@pytest.mark.parametrize("sign", [1, -1])
def test_a_lone_spike_is_found_in_one_face_alone(sign):
    z = surface()
    found = find_suspects([scan_of(spiked(z, 2.0 * sign))])
    assert found_in(found.spikes[0]) == SPIKES
    assert not found.overlap.any()
    assert not find_suspects([scan_of(z)]).spikes[0].any()


def test_the_other_face_confirms_what_one_face_leaves_open():
    z = surface()
    for y, x in SPIKES:  # level with their neighbours before they are raised
        z[y, x] = np.median(np.delete(z[y - 1 : y + 2, x - 1 : x + 2].ravel(), 4))
    height = 6 * typical_deviation(z)  # less than a face alone needs
    lower, upper = z, z + 0.4 * height + 0.01 * surface(2)
    alone = find_suspects([scan_of(spiked(lower, height))])
    both = find_suspects([scan_of(spiked(lower, height)), scan_of(upper)])
    assert not alone.spikes[0].any()
    assert found_in(both.spikes[0]) == SPIKES
    assert not both.spikes[1].any()
    assert found_in(both.overlap) == found_in(both.deep) == SPIKES


def test_an_overlap_all_around_is_no_error_of_single_cells():
    lower, upper = pair(gap=-0.5)
    found = find_suspects([scan_of(lower), scan_of(upper)])
    assert found.overlap.all()
    assert found.deep.mean() < 0.005


def test_faces_set_down_until_they_touch_overlap_by_choice():
    lower, upper = pair(gap=0.0)
    upper = scan_of(upper)
    assert 0.4 < find_suspects([scan_of(lower), upper]).overlap.mean() < 0.6
    upper.attrs["registration"] = json.dumps({"gap_mean_before_mm": None})
    assert not find_suspects([scan_of(lower), upper]).overlap.any()


def test_flat_and_stepped_faces_have_no_spikes():
    steps = np.round(surface() / 0.5) * 0.5
    for z in (np.zeros((20, 20)), np.full((20, 20), np.nan), np.add.outer(np.arange(20.0), steps)):
        if np.isfinite(z).any():
            assert not find_suspects([scan_of(z.reshape(z.shape[0], -1))]).spikes[0].any()
    assert not find_suspects([scan_of(steps), scan_of(steps)]).overlap.any()


@settings(deadline=None, max_examples=10)
@given(
    factor=st.floats(1e-6, 1e6),
    offset=st.floats(-100, 100),
    turns=st.integers(0, 3),
)
def test_unit_level_and_orientation_do_not_matter(factor, offset, turns):
    lower, upper = pair(gap=0.2)
    lower = spiked(lower, 0.7)
    plain = find_suspects([scan_of(lower), scan_of(upper)])
    faces = [np.rot90(factor * (z + offset), turns) for z in (lower, upper)]
    again = find_suspects([scan_of(z) for z in faces])
    for cells, others in zip(
        (*plain.spikes, plain.overlap), (*again.spikes, again.overlap), strict=True
    ):
        np.testing.assert_array_equal(np.rot90(cells, turns), others)
    assert set(SPIKES) <= set(found_in(plain.overlap))


def test_holes_and_rims_are_judged_by_what_is_there():
    z = spiked(surface(), 2.0)
    z[11, 20], z[:4], z[20:23, 40:] = np.nan, np.nan, np.nan
    assert found_in(find_suspects([scan_of(z)]).spikes[0]) == SPIKES


# --- specimens ----------------------------------------------------------------------------------


def specimen(lower, upper, **options):
    return make_specimen(scan_of(lower), scan_of(upper), name="rock", window=12.0, **options)


def test_a_specimen_keeps_what_is_suspicious_and_changes_nothing():
    lower, upper = pair()
    made = specimen(spiked(lower, 1.2), upper)
    assert found_in(made["overlap"].values) == found_in(made["spike"].values) == SPIKES
    assert set(found_in(made["suspect_lower"].values)) == set(SPIKES)
    assert made.attrs["spike_count"] == 3
    assert "3 lone spikes" in made.attrs["cleaning"]
    gap = (made["upper"] - made["lower"]).values
    np.testing.assert_allclose(gap, upper - spiked(lower, 1.2), atol=1e-12)


def test_the_statistics_of_the_overlap_are_those_of_the_gap():
    lower, upper = pair(noise=0.0)
    lower = spiked(lower, 1.2)
    made = specimen(lower, upper)
    numbers = overlap_statistics(made, window_slices(made))
    assert numbers["cells"][0] == 3
    assert numbers["fraction"][0] == 3 / lower.size
    assert numbers["depth"][0] == pytest.approx(0.7)
    assert numbers["gap_mean"][0] == pytest.approx(0.5 - 3 * 1.2 / lower.size)
    assert numbers["cells"][1] == 1  # 24 x 24 cells about the middle hold the third spike alone
    assert numbers["fraction"][1] == 1 / 24**2


def test_the_depth_of_overlaps_is_that_of_the_deepest():
    lower, upper = pair(noise=0.0)
    depths = [0.7, 0.2, 0.4]
    for cell, depth in zip(SPIKES, depths, strict=True):
        lower[cell] += 0.5 + depth
    made = specimen(lower, upper)
    whole, window = overlap_statistics(made, window_slices(made))["depth"]
    assert whole == pytest.approx(max(depths))
    assert window == pytest.approx(depths[2])  # that of the third cell alone


@pytest.mark.parametrize("face", ["lower", "upper"])
def test_fill_takes_spikes_away_from_the_face_that_has_them(face):
    lower, upper = pair()
    faces = {"lower": lower, "upper": upper}
    faces[face] = spiked(faces[face], 1.2 if face == "lower" else -1.2)
    made = specimen(**faces, outliers="fill")
    assert found_in(made["filled"].values) == SPIKES
    assert not made["overlap"].any()
    gap = (made["upper"] - made["lower"]).values
    # As well as a cell is known from those around it.
    assert np.abs(gap - 0.5)[tuple(zip(*SPIKES, strict=True))].max() < 0.4
    untouched = ~made["filled"].values
    np.testing.assert_allclose(gap[untouched], (upper - lower)[untouched], atol=1e-12)


def test_fill_leaves_holes_of_the_scan_alone():
    lower, upper = pair()
    lower = spiked(lower, 1.2)
    lower[40:43, 5:8] = np.nan
    made = specimen(lower, upper, outliers="fill")
    assert np.isnan(made["lower"].values[40:43, 5:8]).all()
    assert found_in(made["filled"].values) == SPIKES


def test_only_known_words_are_taken():
    with pytest.raises(InputError, match="expected one of 'keep', 'mask', 'fill'"):
        specimen(*pair(), outliers="remove")
