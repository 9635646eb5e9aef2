"""Figures as print has them: no letters too small, no words over words, none cut off."""

import json

import numpy as np
import pytest
import xarray as xr
from cases import representative
from matplotlib.figure import Figure
from places import ROOT
from print_size import faults, faults_of_study

from fractalcontact.figures.draw import draw_figure, drawer_of
from fractalcontact.figures.kit import maps
from fractalcontact.figures.kit.drawing import print_style
from fractalcontact.figures.kit.maps import MAX_BLACK, MIN_DOT, enlargement
from fractalcontact.study.figure_list import all_figures, figures_of

#: Those that changed last, or are crowded, come first: the quick suite draws them alone.
FIRST = ("fig12_evolution", "fig04_05_closure", "size_strength", "errors", "estimator_bias")
#: Keys whose figures are drawn from measurements, in test_accuracy_figures.py.
MEASURED = ("speed", "convergence", "stability")
KINDS = [
    *FIRST,
    *sorted(
        name
        for name, figure in all_figures().items()
        if name not in FIRST and figure.key not in ("contact_maps", *MEASURED)
    ),
]
#: Those with titles and legends full of numbers come first.
LONG = sorted(KINDS, key=lambda name: name not in ("fig13_size_effect", "area_theories"))
#: Ends of an interval that leaves everything open are this many times apart from their value.
WIDE = 31.7
NUMBERS = (
    "+0.25 [-0.52, +1.02] a decade of F, less that of as many random nodes -0.17 [-0.88, +0.55]"
)
#: 200 letters that are wider than most, among them a word longer than a line and no formula.
CAPITALS = ("MITTELKÖRNIGER SANDSTEIN, KLUFT 3A, FÜR $5 $ VERMESSEN AM " + "M" * 80 + " " * 1) * 2
CAPITALS = CAPITALS[:200]


def drawn(atlas, name, subject="sliding"):
    of_study = all_figures()[name].subject == "study"
    return draw_figure(atlas, name, ["sliding", "pair", "flat"] if of_study else subject).figure


@pytest.mark.parametrize("name", representative(KINDS, len(FIRST)))
def test_every_word_can_be_read_in_print(atlas, name):
    assert faults(drawn(atlas, name)) == []


@pytest.mark.full
@pytest.mark.parametrize("subject", ["pair", "flat"])
@pytest.mark.parametrize("name", figures_of("match"))
def test_words_of_other_specimens_can_be_read(atlas, name, subject):
    if subject == "flat" and name not in figures_of("flat"):
        pytest.skip("of joints that slide")
    assert faults(drawn(atlas, name, subject)) == []


@pytest.fixture(scope="module")
def long_winded(atlas):
    """The atlas with the widest intervals and labels, and long numbers behind every verdict."""
    changed = atlas.copy()
    for node in changed.subtree:
        found = node.to_dataset()
        for name in list(found.data_vars):
            ends = {f"{name}_low", f"{name}_high"} <= set(found.data_vars)
            if ends and found[name].dtype.kind == "f":
                value, ends = found[name], (found[name] / WIDE, found[name] * WIDE)
                found[f"{name}_low"] = np.minimum(*ends).where(value.notnull())
                found[f"{name}_high"] = np.maximum(*ends).where(value.notnull())
        if node.path.startswith("/statements/"):
            for name, words in (("verdict", "undetermined"), ("numbers", NUMBERS)):
                found[name] = xr.full_like(found[name], words)
        node.dataset = found
    configuration = json.loads(changed.attrs["configuration"])
    for settings in configuration["settings"].values():
        settings["label"] = CAPITALS
    changed.attrs["configuration"] = json.dumps(configuration)
    return changed


@pytest.mark.parametrize("name", representative(LONG, 2))
def test_words_find_room_however_long_they_are(long_winded, name):
    assert faults(drawn(long_winded, name)) == []


@pytest.mark.full
@pytest.mark.parametrize("study", ["paper", "smoke"])
def test_every_word_of_a_study_that_was_made_here_can_be_read(study):
    path = ROOT / "results" / study / "atlas.nc"
    if not path.is_file():
        pytest.skip(f"`make STUDY=config/{study}.yaml` was not run in this checkout")
    assert faults_of_study(path) == {}


def test_faults_are_found():
    with print_style():
        figure = Figure(figsize=(3, 2))
        axes = figure.subplots()
        axes.set(xlim=(0, 1), ylim=(0, 1))
        axes.set_xticks([0.5, 0.58, 0.9], ["3.25", "3.5", "4"])
        axes.text(0.5, 0.5, "tiny", fontsize=5)
        axes.text(0.5, 0.7, "one over the other")
        axes.text(0.5, 0.7, "another of the two")
        figure.text(0.9, 0.01, "which leaves the figure", fontsize=9)
        axes.legend([axes.plot(0)[0]], ["a"], bbox_to_anchor=(-1, 0.5))
        figure.set_layout_engine("none")
        found = " ".join(faults(figure))
    assert "a legend is cut off" in found
    assert "5 pt: 'tiny'" in found
    assert "overlap: 'one over the other' and 'another of the two'" in found
    assert "run together: '3.25' and '3.5'" in found
    assert "run together: '3.5' and '4'" not in found
    assert "cut off: 'which leaves the figure'" in found


def test_titles_say_what_every_figure_shows(atlas):
    with print_style():
        figure = drawer_of("size_effect")(atlas, ["sliding"]).figure
    assert "".join(figure.get_suptitle().split("\n")).startswith("Size effect of the contact area")
    assert all(len(one.title) > 15 for one in all_figures().values())


def test_a_single_panel_has_no_letter(atlas):
    with print_style():
        figure = drawer_of("size_effect")(atlas, ["sliding"]).figure
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert len(titles) > 1 or not titles[0].startswith("(")


def test_nodes_are_enlarged_for_print_alone():
    domain = np.zeros((200, 200), bool)
    domain[50, 60] = domain[120, 130] = True

    def enlarged(domain, points):
        return maps.enlarged(domain, maps.enlargement([domain], points))

    assert enlarged(domain, MIN_DOT) is domain
    for points in (0.5, 0.3, 0.1):
        drawn = enlarged(domain, points)
        times = np.sqrt(drawn.sum() / 2)
        assert times == pytest.approx(np.ceil(MIN_DOT / points))
        assert drawn[domain].all()
    full = np.random.default_rng(1).random((200, 200)) < 0.2
    drawn = enlarged(full, 0.1)
    assert drawn is full or drawn.mean() <= MAX_BLACK
    # Maps that are compared: where one would fill, all are drawn at their true size.
    assert enlargement([domain], 0.3) == 3
    assert enlargement([domain], 0.3, 2) == 2
    assert enlargement([domain, np.random.default_rng(1).random((50, 50)) < 0.31], 0.3) == 1
    empty = np.zeros((8, 8), bool)
    assert not enlarged(empty, 0.1).any()
