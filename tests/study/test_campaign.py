"""How the atlas of a campaign is kept, and what is drawn of each specimen."""

import pytest

from fractalcontact.core.errors import InputError
from fractalcontact.study.campaign import (
    MAX_WHOLE,
    drawn_of,
    explored,
    in_parts,
    of_study_alone,
)
from fractalcontact.study.checks import check_study
from fractalcontact.study.figure_list import figures_of, study_figures_of

FEW, MANY = range(MAX_WHOLE), range(MAX_WHOLE + 1)


@pytest.mark.parametrize(
    ("config", "specimens", "parts"),
    [
        ({}, FEW, False),
        ({}, MANY, True),
        ({"atlas": "parts"}, FEW, True),
        ({"atlas": "whole"}, MANY, False),
    ],
)
def test_many_specimens_have_an_atlas_in_parts(config, specimens, parts):
    assert in_parts(config, specimens) == parts


def test_all_figures_are_drawn_of_few_specimens_and_those_asked_for_of_many():
    assert drawn_of({}, FEW, "match") == figures_of("match")
    assert drawn_of({}, MANY, "match") == []
    assert drawn_of({"figures": "all"}, MANY, "flat") == figures_of("flat")
    assert drawn_of({"figures": ["strength", "fig02_relief"]}, MANY, "flat") == ["fig02_relief"]
    assert drawn_of({"figures": "none"}, FEW, "match") == []


def test_the_explorer_shows_few_specimens_all_and_of_many_those_named_that_are_there():
    assert explored({}, ["a", "b"]) == ["a", "b"]
    assert explored({}, MANY) == []
    assert explored({"explorer": ["refused", "a"]}, ["a", "b"]) == ["a"]


def test_figures_of_a_campaign_read_no_specimen_for_itself():
    names = study_figures_of(["comparison", "roll_off"])
    alone = of_study_alone(names)
    assert "comparison" in alone
    assert "plateau" in names
    assert "plateau" not in alone


def test_a_figure_that_is_none_is_refused_with_the_nearest():
    with pytest.raises(InputError, match=r"figures: no figure 'strenth'.*'strength'"):
        check_study({"study": "t", "figures": ["strenth"]}, "t")


def test_the_figures_of_a_joint_are_few_and_restate_no_area_of_contacts_that_crush():
    joint = drawn_of({"figures": "joint"}, FEW, "match")
    restated = {"area_theories", *(f"fig{number}" for number in ("08", "09", "10", "12", "13"))}
    assert 5 <= len(joint) <= 15
    assert {"overview", "seated_closure", "strength"} <= set(joint) < set(figures_of("match"))
    assert not {one for one in joint if one in restated or one[:5] in restated}
    assert drawn_of({"figures": "joint"}, MANY, "flat") == [
        name for name in joint if name in figures_of("flat")
    ]
    check_study({"study": "t", "figures": "joint"}, "t")
