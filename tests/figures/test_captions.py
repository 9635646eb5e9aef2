"""Captions of all figures: their length and words, and what each figure needs of the atlas."""

import re

import pytest

from fractalcontact.figures.draw import drawer_of
from fractalcontact.figures.kit.drawing import print_style
from fractalcontact.study.atlas import STAGES
from fractalcontact.study.figure_list import all_figures, figures_of, study_figures_of
from fractalcontact.study.stages import EXPERIMENT, paths_of

#: A caption has fewer words than this; signs such as = and % are none.
MOST_WORDS = 70
SUBJECTS = {"sliding": "match", "pair": "match", "flat": "flat"}
SPECIMENS = [
    pytest.param(figure, name, marks=() if name == "sliding" else pytest.mark.full)
    for name, opposite in SUBJECTS.items()
    for figure in figures_of(opposite)
]
STUDY = [(figure, list(SUBJECTS)) for figure in study_figures_of(paths_of(EXPERIMENT))]


def words_of(caption):
    return [word for word in caption.split() if re.search(r"\w", word)]


@pytest.mark.parametrize(("figure", "subject"), [*SPECIMENS, *STUDY])
def test_caption_is_short_and_says_whose_figure_it_is(atlas, figure, subject):
    """And the figure needs no stage of the atlas but those it states."""
    needed = atlas.copy()
    for stage in STAGES.keys() - set(all_figures()[figure].needs):
        if stage in needed.children:
            del needed[stage]
    with print_style():
        caption = drawer_of(figure)(needed, subject).caption
    assert len(words_of(caption)) < MOST_WORDS, caption
    assert caption.startswith(("After ", "Supplementary figure"))
    assert not re.search(r"\b(nan|told|made|share|met)\b", caption)
    assert "  " not in caption
