"""Verdicts in captions: which figures quote which statements."""

import re

import pytest
from cases import representative
from drawings import VERDICT, changed, draw

from fractalcontact.figures.kit.verdicts import CIRCULAR, claim
from fractalcontact.study.figure_list import all_figures


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
    "fig09_box_counting": {"domains_are_fractal"},
    "fig10_scaling": {"area_is_lacunar"},
    "fig11_slope_angle": {"friction_angle_falls_with_size"},
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
    caption = draw(marked, figure, subject).caption
    said = set(re.findall(r"verdict_\d+", caption))
    expected = {judged["verdict"].sel(statement=name).item() for name in QUOTED[figure]}
    assert said == expected


def test_a_claim_is_quoted_with_its_numbers_and_what_makes_it_circular(atlas):
    judged = atlas["statements/sliding"].to_dataset().sel(statement="area_falls")
    chosen = changed(
        atlas,
        "statements/sliding",
        lambda table: table.assign(circular=table["statement"] == "area_falls"),
    )
    verdict, numbers = judged["verdict"].item(), judged["numbers"].item()
    said = claim(atlas, "sliding", "area_falls")
    assert said == f"The paper's claim that A_r falls with growing v {verdict} ({numbers})."
    assert claim(atlas, "sliding", "area_falls", numbers=False).endswith(f"growing v {verdict}.")
    circular = claim(chosen, "sliding", "area_falls")
    assert circular == said.replace(f"{numbers})", f"{numbers}; {CIRCULAR})")
    assert claim(atlas, "flat", "area_falls") == ""
    with pytest.raises(KeyError):
        claim(atlas, "nobody", "area_falls")
    with pytest.raises(KeyError, match="no statement is called 'area_flows'"):
        claim(atlas, "sliding", "area_flows")
