"""How well two faces determine their registration: covers the truth, and falls with the gap's."""

import json

import numpy as np
import pytest
from ensembles import ensemble
from scanned_pairs import joint, labelled, motion

from fractalcontact.registration.pairs import register
from fractalcontact.registration.registration import find_motion
from fractalcontact.registration.registration_scatter import (
    MOTIONS,
    motion_variables,
    scattered_motions,
    stored_motions,
)
from fractalcontact.registration.surface_motion import Surface, grid_nodes
from fractalcontact.surface.specimen import make_specimen
from fractalcontact.surface.synthesis import self_affine


def registered(seed, rms=0.05):
    """A pair whose gap is rough, the motion found and the true one."""
    true = motion((0.23, -0.17), 0.8, (0.003, -0.002))
    lower, upper = joint(true, 0.7, noise=0.02, seed=seed)
    rough = self_affine(lower.shape, 0.1, 0.5, rms=rms, seed=seed + 50, roll_off=1.0)
    upper = upper.copy(data=upper.values + rough)
    found, _ = find_motion(lower, upper)
    x, y = grid_nodes(lower)
    moved = lower.copy(data=Surface(upper)(*found.back(x, y)) + found.rise(x, y))
    moved.attrs["registration"] = json.dumps({"mode": "rigid", "note": ""})
    return lower, moved, found, true.about(*found.end)


def numbers(motions):
    return np.array([values for _, values, _ in motion_variables(motions).values()])


def test_the_scatter_is_that_of_the_error():
    errors, scatter = [], []
    for seed in range(1, ensemble("registered pairs") + 1):
        lower, moved, found, true = registered(seed)
        motions = scattered_motions(lower, moved)
        assert len(motions) == MOTIONS
        scatter.append(numbers(motions).std(axis=1))
        turned = np.degrees(found.rotation - true.rotation)
        errors.append([*np.subtract(found.shift, true.shift), turned])
    errors, scatter = np.abs(errors), np.array(scatter)[:, :3]
    assert np.mean(errors < 2.1 * scatter) > 0.8
    assert np.median(errors / scatter) > 0.2  # nor does it promise far too little


def test_a_smoother_gap_determines_more_and_a_rerun_the_same():
    rough, smooth = (registered(1, rms) for rms in (0.1, 0.01))
    spreads = [numbers(scattered_motions(*pair[:2])).std(axis=1) for pair in (rough, smooth)]
    assert (spreads[1] < 0.5 * spreads[0]).all()
    again = scattered_motions(*rough[:2])
    np.testing.assert_array_equal(numbers(again), numbers(scattered_motions(*rough[:2])))


def test_motions_scatter_about_none_although_the_motion_is_not_the_best():
    lower, moved, *_ = registered(1)
    x, y = grid_nodes(moved)
    beside = moved.copy(data=Surface(moved)(x - 0.03, y + 0.02))
    motions = numbers(scattered_motions(lower, beside))[:2]
    assert (np.abs(motions.mean(axis=1)) < motions.std(axis=1)).all()


def test_faces_in_one_frame_or_without_a_match_have_none():
    lower, moved, *_ = registered(1)
    for record in ({"mode": "none", "note": ""}, {"mode": "rigid", "note": "they do not match"}):
        moved.attrs["registration"] = json.dumps(record)
        assert scattered_motions(lower, moved) == []
    moved.attrs.pop("registration")
    assert scattered_motions(lower, moved) == []


def test_a_translation_scatters_without_turns():
    lower, moved, *_ = registered(1)
    moved.attrs["registration"] = json.dumps({"mode": "translation", "note": ""})
    spread = numbers(scattered_motions(lower, moved)).std(axis=1)
    assert (spread[:2] > 0).all()
    assert (spread[2:] == 0).all()


def test_a_specimen_gives_back_what_it_holds():
    z = self_affine((60, 60), 0.1, 0.7, rms=0.5, seed=1)
    rng = np.random.default_rng(1)
    faces = [labelled(z + 0.02 * rng.normal(size=z.shape) + gap) for gap in (0.0, 0.4)]
    for face in faces:
        face.attrs |= {"source": "made", "sha256": "0" * 64}
    faces = register(*faces, "rigid", "here")
    motions = scattered_motions(*faces)
    specimen = make_specimen(*faces, window=2.0)
    assert stored_motions(specimen) == []
    for kept, given in zip(
        stored_motions(specimen.assign(motion_variables(motions))), motions, strict=True
    ):
        assert kept.end == pytest.approx(given.end)
        assert kept.start == given.start
        assert kept.rotation == pytest.approx(given.rotation)
        assert kept.slope == given.slope
