"""Captions of all figures: their length and words, verdicts, what each needs of the atlas."""

import re

import numpy as np
import pytest
import xarray as xr
from cases import representative
from markup import MARKUP
from stage_names import EXPERIMENTS, STAGES

from fractalcontact.figures.draw import drawer_of
from fractalcontact.figures.kit.drawing import print_style
from fractalcontact.figures.kit.verdicts import CIRCULAR, claim
from fractalcontact.study.figure_list import all_figures, figures_of, study_figures_of

#: A caption has fewer words than this; signs such as = and % are none.
MAX_WORDS = 70
SUBJECTS = {"sliding": "match", "pair": "match", "flat": "flat"}
SPECIMENS = [
    pytest.param(figure, name, marks=() if name == "sliding" else pytest.mark.full)
    for name, opposite in SUBJECTS.items()
    for figure in figures_of(opposite)
]
STUDY = [(figure, list(SUBJECTS)) for figure in study_figures_of([*EXPERIMENTS, "comparison"])]
#: Half of the captions of a study have fewer words than this.
MEDIAN_WORDS = 50
#: Words of a verdict on the paper, which only the tables of statements have.
VERDICT = (
    r"\b(holds|not hold|holds? in part|ill-posed|established|refut\w+|support\w*|confirm\w*|"
    r"contradict\w*|disprov\w+|proves?|proven|(as|unlike|against) (in )?(the paper|eqs?\.))(?!\w)"
)
#: Figures of experiments that decide about eq. 6 themselves: they count their own verdicts.
DECIDED = {"size_effect": {"refuted", "supported"}, "size_strength": set()}
#: Words that only those who wrote the program know.
PRIVATE = (
    r"\b(nan|told|made|share|met|arm|jobs?|seeds?|held against|scenes?|bound of the solver|"
    r"atlas group|lanes?|twiddle|hats?|knots?)\b"
)


@pytest.fixture(scope="module")
def marked(atlas):
    """The atlas with words of its own for every verdict."""
    changed = atlas.copy()
    for name in SUBJECTS:
        judged = atlas[f"statements/{name}"].to_dataset()
        said = [f"verdict number {i}" for i in range(judged.sizes["statement"])]
        judged["verdict"] = judged["verdict"].copy(data=np.array(said, object))
        changed[f"statements/{name}"] = xr.DataTree(judged)
    return changed


def words_of(caption):
    return [word for word in caption.split() if re.search(r"\w", word)]


@pytest.fixture(scope="module")
def caption_of(marked):
    """Caption of a figure, drawn once from no other stage of the atlas than those it states."""
    known = {}

    def draw(figure, subject):
        key = figure, str(subject)
        if key not in known:
            needed = marked.copy()
            for stage in set(STAGES) - set(all_figures()[figure].needs):
                if stage in needed.children:
                    del needed[stage]
            with print_style():
                drawing = drawer_of(figure)(needed, subject)
            assert not MARKUP.search(drawing.data.to_csv())
            known[key] = drawing.caption
        return known[key]

    return draw


@pytest.mark.parametrize(("figure", "subject"), [*SPECIMENS, *STUDY])
def test_caption_is_short_and_quotes_its_verdicts(caption_of, figure, subject):
    caption = caption_of(figure, subject)
    assert len(words_of(caption)) < MAX_WORDS, caption
    assert caption.startswith(("After ", "Supplementary figure"))
    assert not re.search(PRIVATE, caption), caption
    assert "WARNING" not in caption  # the page states it once
    assert "  " not in caption
    assert not MARKUP.search(caption)
    said = {found[0] for found in re.finditer(VERDICT, caption)}
    assert said <= DECIDED.get(figure, set()), caption


def test_half_of_the_captions_are_shorter_still(caption_of):
    drawn = [(name, "sliding") for name in figures_of("match")] + STUDY
    words = {one[0]: len(words_of(caption_of(*one))) for one in drawn}
    assert np.median(list(words.values())) < MEDIAN_WORDS, words


@pytest.mark.parametrize(
    "caption",
    [
        "The paper's hyperbola holds.",
        "Eq. 6 is refuted.",
        "This confirms the paper.",
        "Zero lies in 3 of 4 intervals, against eq. 5.",
        "It grows as in the paper.",
    ],
)
def test_words_of_a_verdict_are_found(caption):
    assert re.search(VERDICT, caption)


#: Figures whose captions judge a claim of the paper, and the statements that decide it.
QUOTED = {
    "fig01_strength": {"strength_falls_with_size"},
    "fig03_composite": {"no_correlation_is_left"},
    "fig04_05_closure": {"closure_is_hyperbolic", "area_is_linear"},
    "fig06_07_dilatancy": {"dilatancy_flattens", "area_falls"},
    "fig08_prefractals": {"area_is_lacunar"},
    "fig09_box_counting": {"boxes_follow_one_law", "domains_are_fractal"},
    "fig10_scaling": {"area_is_lacunar"},
    "fig11_slope_angle": {"strength_falls_with_size"},
    "fig12_evolution": {"dimension_rises_by_area", "dimension_rises_by_boxes"},
    "fig13_size_effect": {"dimension_rises_by_area", "dimension_rises_by_boxes"},
    "area_theories": {"area_is_linear"},
    "clusters": {"domains_cluster"},
    "compliance": {"compliance_rises_at_first", "curves_overlap", "compliance_rises_again"},
    "plateau": {"dilatancy_flattens"},
    "size_test": {"size_effect_follows"},
    "window_size": {"larger_samples_close_more"},
}


def test_every_figure_that_reads_statements_says_which():
    reading = {name for name, figure in all_figures().items() if "statements" in figure.needs}
    assert reading == QUOTED.keys()


@pytest.mark.parametrize("figure", representative(sorted(QUOTED), 4))
def test_captions_and_table_have_one_verdict(marked, figure):
    judged = marked["statements/sliding"].to_dataset()
    subject = ["sliding"] if all_figures()[figure].subject == "study" else "sliding"
    with print_style():
        caption = drawer_of(figure)(marked, subject).caption
    said = set(re.findall(r"verdict number \d+", caption))
    expected = {judged["verdict"].sel(statement=name).item() for name in QUOTED[figure]}
    assert said == expected


def test_a_claim_is_quoted_with_its_numbers_and_what_makes_it_circular(atlas):
    judged = atlas["statements/sliding"].to_dataset().sel(statement="area_falls")
    changed = atlas.copy()
    table = atlas["statements/sliding"].to_dataset()
    table["circular"] = table["statement"] == "area_falls"
    changed["statements/sliding"] = xr.DataTree(table)
    verdict, numbers = judged["verdict"].item(), judged["numbers"].item()
    said = claim(atlas, "sliding", "area_falls")
    assert said == f"The paper's claim that A_r falls with growing v {verdict} ({numbers})."
    assert claim(atlas, "sliding", "area_falls", numbers=False).endswith(f"growing v {verdict}.")
    circular = claim(changed, "sliding", "area_falls")
    assert circular == said.replace(f"{numbers})", f"{numbers}; {CIRCULAR})")
    assert claim(atlas, "flat", "area_falls") == ""
    with pytest.raises(KeyError):
        claim(atlas, "nobody", "area_falls")
    with pytest.raises(KeyError, match="no statement is called 'area_flows'"):
        claim(atlas, "sliding", "area_flows")
