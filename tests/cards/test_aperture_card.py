"""Card of an aperture map: all that needs no sliding, and why the rest is absent."""

from dataclasses import asdict

import numpy as np
import pytest
from made_stages import scan, stages_of
from page_study import STUDY
from stage_names import STAGES

from fractalcontact.cards.write import read_card, write_cards
from fractalcontact.core.window import window_slices
from fractalcontact.stages.atlas import join_stages
from fractalcontact.study.configuration import resolve_settings, solver_settings
from fractalcontact.study.figure_list import figures_of
from fractalcontact.surface.synthesis import self_affine

OPENING = 0.3 + self_affine((48, 48), 0.1, 0.8, rms=0.1, seed=4, roll_off=1.5)


@pytest.fixture(scope="module")
def stages():
    settings = resolve_settings(STUDY, "core", {"opposite": "aperture"}, "tiny")
    return settings, stages_of(
        "core", (scan(-OPENING, 0.1), None), settings, solver_settings({}, "tiny")
    )


@pytest.fixture(scope="module")
def card(stages, tmp_path_factory):
    settings, made = stages
    folder = tmp_path_factory.mktemp("aperture") / "results/tiny"
    folder.mkdir(parents=True)
    parts = {stage: {} for stage in STAGES} | {stage: {"core": one} for stage, one in made.items()}
    records = {"study": STUDY, "settings": {"core": asdict(settings)}}
    join_stages(parts, folder / "atlas.nc", records)
    assert write_cards(folder / "atlas.nc", folder) == ["core"]
    return read_card(folder / "cards/core.yaml")


def test_before_any_load_the_mean_gap_is_that_of_the_map_less_its_least_aperture(stages):
    made = stages[1]
    window = OPENING[window_slices(made["specimens"])]
    mean_gap = float(made["flow"]["unloaded_mean_gap"])
    assert mean_gap == pytest.approx(window.mean() - window.min())


def test_an_aperture_map_has_contact_stiffness_and_flow(card, stages):
    assert (stages[1]["closure"]["interface_stiffness"] > 0).any()
    assert card["faces"].startswith("aperture map")
    for name in ("contact_fraction", "mean_gap", "hydraulic_aperture"):
        values = [row.get("value", np.nan) for row in card["entries"][name]["values"]]
        assert np.isfinite(values).any(), name


def test_what_needs_two_faces_is_absent_with_a_sentence(card):
    for name in ("jrc", "z2", "peak_strength", "dilatancy_angle"):
        assert "slide" in card["entries"][name]["missing"], name
    assert figures_of("aperture") == figures_of("flat")
