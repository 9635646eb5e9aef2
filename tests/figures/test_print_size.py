"""Figures as print has them: no letters too small, no words over words, none cut off."""

import numpy as np
import pytest
from cases import representative
from matplotlib.figure import Figure
from print_size import faults, laid_out

from fractalcontact.figures.draw import drawer_of
from fractalcontact.figures.kit.drawing import WIDTH, print_style
from fractalcontact.figures.kit.maps import LEAST_DOT, MOST_BLACK, enlarged
from fractalcontact.study.figure_list import accuracy_figures_of, all_figures, figures_of

#: Those that changed last, or are crowded, come first: the quick suite draws them alone.
FIRST = ("fig12_evolution", "fig04_05_closure", "size_strength", "errors", "dimension_difference")
KINDS = [
    *FIRST,
    *sorted(
        name
        for name, figure in all_figures().items()
        if name not in FIRST and figure.subject != "accuracy" and figure.key != "contact_maps"
    ),
]


def drawn(atlas, name, subject="sliding"):
    of_study = all_figures()[name].subject == "study"
    with print_style():
        drawing = drawer_of(name)(atlas, ["sliding", "pair", "flat"] if of_study else subject)
        return laid_out(drawing.figure)


@pytest.mark.parametrize("name", representative(KINDS, len(FIRST)))
def test_every_word_can_be_read_in_print(atlas, name):
    figure = drawn(atlas, name)
    assert figure.get_figwidth() <= WIDTH
    assert faults(figure) == []


@pytest.mark.full
@pytest.mark.parametrize("subject", ["pair", "flat"])
@pytest.mark.parametrize("name", figures_of("match"))
def test_words_of_other_specimens_can_be_read(atlas, name, subject):
    if subject == "flat" and name not in figures_of("flat"):
        pytest.skip("of joints that slide")
    assert faults(drawn(atlas, name, subject)) == []


def test_faults_are_found():
    with print_style():
        figure = Figure(figsize=(3, 2))
        axes = figure.subplots()
        axes.text(0.5, 0.5, "tiny", fontsize=5)
        axes.text(0.5, 0.7, "one over the other")
        axes.text(0.5, 0.7, "another of the two")
        figure.text(0.9, 0.01, "which leaves the figure", fontsize=9)
        found = " ".join(faults(laid_out(figure)))
    assert "5 pt: 'tiny'" in found
    assert "overlap: 'one over the other' and 'another of the two'" in found
    assert "cut off: 'which leaves the figure'" in found


def test_titles_say_what_every_figure_shows(atlas):
    with print_style():
        figure = drawer_of("size_effect")(atlas, ["sliding"]).figure
    assert "".join(figure.get_suptitle().split("\n")).startswith("Size effect of the contact area")
    assert all(len(one.title) > 15 for one in all_figures().values())
    assert accuracy_figures_of({one.key for one in all_figures().values()})


def test_a_single_panel_has_no_letter(atlas):
    with print_style():
        figure = drawer_of("size_effect")(atlas, ["sliding"]).figure
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert len(titles) > 1 or not titles[0].startswith("(")


def test_nodes_are_enlarged_for_print_alone():
    domain = np.zeros((200, 200), bool)
    domain[50, 60] = domain[120, 130] = True
    assert enlarged(domain, LEAST_DOT) is domain
    for points in (0.5, 0.3, 0.1):
        drawn = enlarged(domain, points)
        times = np.sqrt(drawn.sum() / 2)
        assert times == pytest.approx(np.ceil(LEAST_DOT / points))
        assert drawn[domain].all()
    full = np.random.default_rng(1).random((200, 200)) < 0.2
    drawn = enlarged(full, 0.1)
    assert drawn is full or drawn.mean() <= MOST_BLACK
    empty = np.zeros((8, 8), bool)
    assert not enlarged(empty, 0.1).any()
