"""What every figure must be; what is special to one stands in the tests of that figure."""

import numpy as np
import pytest
from cases import representative
from drawings import breaches, content_of, draw, words_of
from matplotlib.text import Text
from stage_names import EXPERIMENTS

from fractalcontact.core.subject import Subject
from fractalcontact.figures.draw import ENDINGS
from fractalcontact.figures.kit.drawing import print_style, save
from fractalcontact.study.atlas import read_atlas
from fractalcontact.study.figure_list import figures_of, study_figures_of

SUBJECTS = {"sliding": "match", "pair": "match", "flat": "flat"}
STUDY = [(figure, list(SUBJECTS)) for figure in study_figures_of([*EXPERIMENTS, "comparison"])]
#: Figures of each specimen and of the study. Those of maps, of accuracy and of elastic and capped
#: pairs, which need other atlases, have tests of their own.
FIGURES = [(one, name) for name, kind in SUBJECTS.items() for one in figures_of(kind)] + STUDY
FIRST = [(figure, of) for figure, of in FIGURES if of not in ("pair", "flat")]
#: Every fifth comes first: these stand for all in the quick suite.
EVERY_FIFTH = sorted(FIRST, key=lambda one: FIRST.index(one) % 5 > 0)
#: Half of the captions of a study have fewer words than this.
MEDIAN_WORDS = 50


@pytest.mark.parametrize(("figure", "subject"), FIGURES)
def test_a_figure_keeps_the_contract(marked, drawn, figure, subject):
    """Units on all axes, a short caption, a table of numbers that the atlas has at their places."""
    drawing = drawn(figure, subject)
    assert breaches(drawing, marked, figure, subject) == []
    if isinstance(subject, str):
        label = Subject.of(marked, subject).settings["label"]
        words = " ".join(text.get_text() for text in drawing.figure.findobj(Text))
        assert label in " ".join(words.split())


@pytest.mark.parametrize(("figure", "subject"), representative(EVERY_FIFTH, 7))
def test_a_figure_is_the_same_twice(marked, drawn, figure, subject):
    assert content_of(draw(marked, figure, subject)) == content_of(drawn(figure, subject))


def test_no_figure_changes_the_atlas_that_it_is_drawn_from(atlas_file, marked, drawn):
    for figure, subject in FIGURES:
        drawn(figure, subject)
    stored = read_atlas(atlas_file)
    for node in marked.subtree:
        if not node.path.startswith("/statements/"):  # whose verdicts have words of their own
            assert node.to_dataset().identical(stored[node.path].to_dataset()), node.path


@pytest.mark.full
@pytest.mark.parametrize(("figure", "subject"), FIGURES)
def test_its_files_are_the_same_twice(atlas, figure, subject, tmp_path):
    for folder in ("first", "second"):
        with print_style():
            save(draw(atlas.copy(), figure, subject), tmp_path / folder, figure)
    first, second = (
        {path.name: path.read_bytes() for path in (tmp_path / folder).iterdir()}
        for folder in ("first", "second")
    )
    assert first == second
    assert first.keys() == {f"{figure}.{ending}" for ending in ENDINGS}
    assert all(first.values())


def test_half_of_the_captions_are_shorter_still(drawn):
    words = {figure: len(words_of(drawn(figure, of).caption)) for figure, of in FIRST}
    assert np.median(list(words.values())) < MEDIAN_WORDS, words
