"""Memory and time that jobs ask for: more for larger grids and at a retry, and enough."""

import os

import numpy as np
import pytest
from made_settings import made_settings
from samples import scan_of

from fractalcontact.study.resources import (
    AROUND,
    COSTS,
    MIN_MEMORY,
    memory,
    minutes,
    nodes_of_files,
    nodes_of_window,
    reading_memory,
    seconds,
    states_of,
)
from fractalcontact.surface.specimen import make_specimen

#: Largest resident memory of the scripts of jobs: rule, nodes along a side, states, MB. The last
#: column of the table in docs/scaling.md.
MEASURED = [
    ("roughness_and_composite", 128, 3, 306),
    ("roughness_and_composite", 256, 3, 307),
    ("roughness_and_composite", 512, 3, 352),
    ("contact", 128, 3, 248),
    ("contact", 256, 3, 263),
    ("contact", 512, 3, 410),
    ("closure_and_box_counts", 128, 3, 253),
    ("closure_and_box_counts", 256, 3, 525),
    ("closure_and_box_counts", 512, 3, 581),
    ("windows", 128, 3, 259),
    ("windows", 256, 3, 276),
    ("windows", 512, 3, 763),
    ("strength", 128, 3, 184),
    ("strength", 512, 3, 195),
    ("specimen_atlas", 128, 3, 214),
    ("specimen_atlas", 512, 3, 251),
    ("roughness_and_composite", 1024, 3, 374),
    ("contact", 1024, 3, 554),
    ("closure_and_box_counts", 1024, 3, 1011),
    ("windows", 1024, 3, 977),
    ("strength", 1024, 3, 217),
    ("specimen_atlas", 1024, 3, 360),
    ("roughness_and_composite", 2048, 3, 599),
    ("contact", 2048, 3, 1249),
    ("synthetic_scan", 1024, 1, 196),
    ("synthetic_scan", 2048, 1, 581),
    # Grids that no model was fitted to.
    ("roughness_and_composite", 384, 3, 327),
    ("roughness_and_composite", 768, 3, 367),
    ("contact", 384, 3, 285),
    ("contact", 768, 3, 496),
    ("closure_and_box_counts", 384, 3, 497),
    ("windows", 384, 3, 301),
    ("windows", 768, 3, 766),
    ("strength", 384, 3, 188),
    ("strength", 768, 3, 200),
    ("specimen_atlas", 384, 3, 231),
    ("specimen_atlas", 768, 3, 297),
    # The paper's study, whose joints slide in four directions, at 13 offsets, under ten loads.
    ("contact", 248, 560, 289),
    ("contact", 512, 10, 357),
    ("closure_and_box_counts", 248, 560, 459),
    ("closure_and_box_counts", 200, 33, 373),
    ("closure_and_box_counts", 512, 10, 557),
    ("flow", 200, 560, 297),
    ("flow", 512, 12, 547),
    ("windows", 512, 10, 434),
    ("figures", 248, 520, 853),
    ("figures", 200, 33, 574),
    ("figures", 512, 10, 446),
    ("size_effect_part", 512, 1, 519),
    ("size_effect_part", 512, 1, 314),
]

#: Seconds of processor of jobs on grids that the models were not fitted to: rule, nodes along a
#: side, states, seconds.
TIMED = [
    ("synthetic_scan", 768, 1, 0.53),
    ("roughness_and_composite", 384, 3, 3.5),
    ("roughness_and_composite", 768, 3, 5.4),
    ("contact", 384, 3, 2.1),
    ("contact", 768, 3, 2.9),
    ("closure_and_box_counts", 384, 3, 4.3),
    ("closure_and_box_counts", 768, 3, 8.8),
    ("windows", 384, 3, 9.2),
    ("windows", 768, 3, 28.4),
    ("strength", 768, 3, 1.3),
    ("specimen_atlas", 768, 3, 2.7),
    # Of the paper's study, of the clock of a quiet machine: the concrete twin and a capped one.
    ("contact", 248, 520, 5.4),
    ("closure_and_box_counts", 248, 520, 12.8),
    ("windows", 248, 520, 8.2),
    ("figures", 248, 520, 15.6),
    ("contact", 200, 33, 3.5),
    ("closure_and_box_counts", 200, 33, 12.8),
    ("windows", 200, 33, 9.2),
]


def sized(path, size):
    path.touch()
    os.truncate(path, size)  # a file with nothing in it takes no room
    return path


@pytest.mark.parametrize(("rule", "side", "states", "used"), MEASURED)
def test_what_is_asked_for_is_between_1_2_and_3_times_what_was_used(rule, side, states, used):
    asked = memory(rule, side**2, states=states)
    assert 1.2 <= asked / (AROUND + used) <= 3


@pytest.mark.parametrize(("rule", "side", "states", "used"), TIMED)
def test_time_of_grids_that_no_model_was_fitted_to_is_within_a_factor(rule, side, states, used):
    assert 0.6 <= seconds(rule, side**2, states=states) / used <= 2.4
    assert 60 * minutes(rule, side**2, states=states) >= 3 * used


@pytest.mark.parametrize("rule", COSTS)
def test_more_is_asked_for_larger_grids(rule):
    assert memory(rule, 4096**2) >= memory(rule, 128**2) >= MIN_MEMORY
    assert minutes(rule, 4096**2, states=10) >= minutes(rule, 128**2, states=10)


def test_more_is_asked_for_large_files_and_for_two_faces(tmp_path):
    small = sized(tmp_path / "rock.npy", 10**5)
    absent = reading_memory([tmp_path / "absent.npy"])
    assert absent <= reading_memory([small]) <= 1.05 * absent
    text = sized(tmp_path / "rock.xyz", 315 * 10**6)
    assert reading_memory([text]) > 2700
    packed = sized(tmp_path / "rock.x3p", 10**8)
    assert reading_memory([packed]) > 5000  # packed heights unfold to many times the file
    assert reading_memory([packed, packed]) >= reading_memory([packed])


def test_nodes_follow_from_files_and_windows(tmp_path):
    file = sized(tmp_path / "rock.npy", 4 * 128**2)
    assert nodes_of_files([file]) == 128**2
    settings = made_settings(window=5.0)
    assert nodes_of_window(settings, 0.1, 1e6) == pytest.approx(2500)
    assert nodes_of_window(settings, "100 um", 1e6) == pytest.approx(2500)
    assert nodes_of_window(made_settings(window=[5.0, 10.0]), 0.1, 1e6) == pytest.approx(5000)
    for window, spacing in ((5.0, None), (5.0, ["1 mm", "2 mm"]), (500.0, 0.1)):
        assert nodes_of_window(made_settings(window=window), spacing, 4000.0) == 4000


def test_an_automatic_window_has_no_more_nodes_than_are_asked_for():
    """Half the side of the face where it slides, all of it against a plane."""
    scan = scan_of(np.random.default_rng(1).normal(size=(24, 24)))
    for opposite in ("match", "flat"):
        specimen = make_specimen(scan, opposite=opposite)
        nodes = specimen.attrs["window_ny"] * specimen.attrs["window_nx"]
        settings = made_settings(opposite=opposite)
        assert nodes == nodes_of_window(settings, None, 24**2)


def test_states_are_directions_offsets_and_loads():
    assert states_of(made_settings(contact_directions=["W", "E"], loads=[1, 2, 3]), 5) == 30
