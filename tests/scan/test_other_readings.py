"""Other readings of two scans: outliers treated otherwise, and faces left as they were given."""

import numpy as np
import pytest
from scipy import ndimage
from tiny_pairs import STUDY

from fractalcontact.scan.other_readings import OTHER_FACES, READING
from fractalcontact.stages.specimen import specimen_of_files
from fractalcontact.study.configuration import resolve_settings
from fractalcontact.surface.synthesis import self_affine

DEFAULTS = STUDY["defaults"] | {"offsets": ["0 mm"]}
OPTIONS = {
    **{"kind": "face", "layout": "matrix", "delimiter": "comma", "decimal": ".", "header": 0},
    **{"missing": "none", "heights": "up", "unit": "mm", "spacing": "0.5 mm"},
    **{"axes": "none", "first_row": "bottom"},
}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Two files of one joint; the upper face lies 0.4 mm aside and has a spike."""
    folder = tmp_path_factory.mktemp("scans")
    lower = self_affine((56, 56), 0.5, 0.8, rms=0.5, seed=1, roll_off=8.0)
    upper = lower + 0.03 * self_affine((56, 56), 0.5, 0.8, rms=1.0, seed=2)
    aside = ndimage.shift(upper, (0.0, 0.8), order=3, mode="reflect") + 1.0
    aside[28, 28] += 3.0
    paths = folder / "joint.lower.csv", folder / "joint.upper.csv"
    for path, heights in zip(paths, (lower, aside), strict=True):
        np.savetxt(path, heights, delimiter=",", fmt="%.6f")
    return paths


def specimen_of(files, own=(), **options):
    settings = resolve_settings(STUDY | {"defaults": DEFAULTS}, "joint", dict(own), "tiny")
    return specimen_of_files(files, OPTIONS | options, settings, "joint")


def heights_of(specimen, **reading):
    words = ", ".join(f"{key} {value}" for key, value in reading.items())
    return specimen[OTHER_FACES].sel({READING: words})


def test_a_pair_has_every_other_reading(files):
    specimen = specimen_of(files)
    assert sorted(specimen[READING].values) == [
        "registration none, outliers fill",
        "registration none, outliers keep",
        "registration rigid, outliers fill",
    ]
    window = heights_of(specimen, registration="rigid", outliers="fill").sel(face="upper").values
    spike = np.unravel_index(np.nanargmax(specimen["upper"].values), window.shape)
    assert window[spike] < specimen["upper"].values[spike] - 1
    as_given = heights_of(specimen, registration="none", outliers="keep")
    gap, own = ((of[1] - of[0]) for of in (as_given.values, _own(specimen)))
    assert np.nanstd(gap) > 1.2 * np.nanstd(own)


def _own(specimen):
    return np.stack([specimen["lower"].values, specimen["upper"].values])


def test_each_reading_has_the_heights_that_its_own_study_would_have(files):
    first = specimen_of(files)
    for own, options in (({"outliers": "fill"}, {}), ({}, {"registration": "none"})):
        other = specimen_of(files, own, **options)
        reading = {"registration": options.get("registration", "rigid")}
        reading["outliers"] = own.get("outliers", "keep")
        found = heights_of(first, **reading)
        y, x, ny, nx = (first.attrs[f"window_{of}"] for of in ("y0", "x0", "ny", "nx"))
        there = other.sel(x=first.x[x : x + nx], y=first.y[y : y + ny], method="nearest")
        gap = (there["upper"] - there["lower"]).values
        gap_found = (found[1] - found[0]).values[y : y + ny, x : x + nx]
        np.testing.assert_allclose(gap_found, gap, atol=1e-9)


def test_faces_of_different_frames_are_not_left_as_they_were_given(files, tmp_path):
    upper = np.loadtxt(files[1], delimiter=",")
    far = tmp_path / "joint.upper.csv"
    np.savetxt(far, np.roll(upper, 6, axis=1), delimiter=",", fmt="%.6f")
    specimen = specimen_of((files[0], far))
    assert list(specimen[READING].values) == ["registration rigid, outliers fill"]
