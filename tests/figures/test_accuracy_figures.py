"""Figures of accuracy and speed: labels, numbers beside them, and captions that say who leads."""

import re

import numpy as np
import pytest
from ensembles import ensemble
from print_size import faults

from contactlab.accuracy.convergence import error_over_spacing, richardson_trials
from contactlab.accuracy.elimination import elimination
from contactlab.accuracy.growth import growth
from contactlab.accuracy.reference import problems_of
from contactlab.accuracy.speed import OURS, error_against_time
from contactlab.accuracy.stability import HONEST, SILENT, stability
from fractalcontact.figures.draw import draw_figure, draw_study_figures, drawer_of
from fractalcontact.figures.kit.drawing import print_style
from fractalcontact.study.atlas import read_atlas, write_atlas
from fractalcontact.study.figure_list import study_figures_of

RECIPE = {
    "sizes": ensemble("accuracy_figure_sizes"),
    "hurst": ensemble("accuracy_figure_hurst"),
    "contact": [0.1],
    "seed": 1,
    "tolerances": [1e-1, 1e-4],
    "runs": 1,
    "longest": 1.0,
    "slow_nodes": 200,
}
FIGURES = study_figures_of(("speed", "convergence", "stability"))


@pytest.fixture(scope="module")
def atlas_file(tmp_path_factory):
    scenes = {n: error_against_time(s(), RECIPE) for n, s in problems_of(RECIPE).items()}
    parts = {
        "speed": scenes,
        "speed_growth": {"surfaces": growth(list(scenes.values()), 1e-2)},
        "convergence": {
            "hertz": error_over_spacing("hertz", (5, 8, 12), 2),
            "punch": error_over_spacing("punch", (5, 8, 12), 2),
            "richardson": richardson_trials(3, (16, 20), seed=0),
        },
        "stability": {"scenes": stability(["H = 0.8", "one node, by force", "missing cell"], 3)},
        "elimination": {"scenes": elimination(4)},
    }
    path = tmp_path_factory.mktemp("atlas") / "accuracy.nc"
    write_atlas(parts, path, study="tiny", configuration={"study": {}, "settings": {}})
    return path


@pytest.fixture(scope="module")
def atlas(atlas_file):
    return read_atlas(atlas_file)


def drawn(atlas, name):
    with print_style():
        return drawer_of(name)(atlas, [])


@pytest.mark.parametrize("name", FIGURES)
def test_axes_have_units_and_captions_no_gaps(atlas, name):
    drawing = drawn(atlas, name)
    drawing.figure.draw_without_rendering()
    labels = [t for a in drawing.figure.axes for t in (a.get_xlabel(), a.get_ylabel()) if t]
    assert labels
    assert all(re.search(r"\(.+\)$", label) for label in labels)
    assert not re.search(r"\bnan\b", drawing.caption)
    assert drawing.caption.startswith(("Supplementary figure. ", "After section 4 of "))
    assert len([word for word in drawing.caption.split() if re.search(r"\w", word)]) < 70
    assert len(drawing.data)
    assert faults(draw_figure(atlas, name, []).figure) == []


@pytest.mark.full
def test_the_same_atlas_gives_the_same_files(atlas_file, tmp_path):
    chosen = ("time_size", "convergence")
    for run in ("first", "second"):
        draw_study_figures(atlas_file, [], tmp_path / run, chosen)
    for name in chosen:
        for ending in ("png", "svg", "csv", "txt"):
            first, second = (
                (tmp_path / run / f"{name}.{ending}").read_bytes() for run in ("first", "second")
            )
            assert first == second


def test_every_point_stands_in_the_table(atlas):
    table = drawn(atlas, "error_time").data
    assert set(table["test_problem"]) == set(problems_of(RECIPE))
    for name, rows in table.groupby("test_problem"):
        scene = atlas[f"speed/{name}"]
        assert rows["seconds_s"].to_numpy() == pytest.approx(scene["seconds"].values, nan_ok=True)


@pytest.mark.parametrize(("factor", "leads"), [(1e-6, 1), (1e6, 0)])
def test_caption_states_on_how_many_problems_ours_leads(atlas, factor, leads):
    """With seconds of ours a million times smaller, or larger, there is no doubt."""
    other = atlas.copy(deep=True)
    for node in other["speed"].children.values():
        ours = node["method"].values == OURS
        seconds = np.where(ours, factor * node["seconds"].values, node["seconds"].values)
        node["seconds"] = node["seconds"].copy(data=seconds)
    caption = drawn(other, "error_time").caption
    total = len(RECIPE["sizes"]) * len(RECIPE["hurst"])
    assert f"every error below 0.01 on {leads * total} of {total} test problems" in caption


def test_table_of_the_orders_is_what_was_measured(atlas):
    table = drawn(atlas, "convergence").data
    hertz = table[table["problem"] == "hertz"]
    exact = atlas["convergence/hertz"]
    assert hertz["force_error"].to_numpy() == pytest.approx(exact["force_error"].values)
    assert (hertz["force_order"] == float(exact["force_order"])).all()


def test_scenes_not_solved_are_named(atlas):
    other = atlas.copy(deep=True)
    verdict = other["stability/scenes"]["verdict"]
    verdict.loc[{"kind": "H = 0.8", "solver": "dense", "draw": [0, 2]}] = SILENT
    verdict.loc[{"kind": "H = 0.8", "solver": "nnls", "draw": 1}] = HONEST
    drawing = drawn(other, "stability")
    table = drawing.data.set_index(["kind", "solver"])
    assert table.loc[("H = 0.8", "dense"), "draws_silently_wrong"] == "0 2"
    assert table.loc[("H = 0.8", "nnls"), "draws_honest_failure"] == "1"
    assert table.loc[("H = 0.8", "dense"), "silently wrong (test problems)"] == 2
    named = table[["draws_honest_failure", "draws_silently_wrong"]].to_numpy()
    assert (named != "").sum() == 2
    assert "dense 7/9 (2)" in drawing.caption


def test_the_signs_of_the_inverse_depend_on_the_kernel(atlas):
    caption = drawn(atlas, "elimination").caption
    assert "Love's kernel has none; rigid square and equal-area disc, readings of" in caption
    assert "none of 4 per case" in caption
