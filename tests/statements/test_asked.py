"""What a study says of its specimens: which were chosen for a statement, which repeat another."""

from pathlib import Path

import pytest
import yaml

from fractalcontact.core.claims import claims_of
from fractalcontact.core.errors import InputError
from fractalcontact.study.checks import check_study
from fractalcontact.study.configuration import resolve_embedded, resolve_settings
from fractalcontact.study.selection import is_capped_variant

ROOT = Path(__file__).parents[2]
NAMES = set(claims_of("one"))


@pytest.fixture
def paper():
    return yaml.safe_load((ROOT / "config/paper.yaml").read_text())


def chosen_for(study, name):
    return resolve_settings(study, name, {}, "paper").chosen_for


def test_a_statement_that_there_is_not_is_refused_with_the_nearest(paper):
    check_study(paper, "paper.yaml")
    paper["embedded"]["joint_2.1"]["chosen_for"] = {"area_fall": "by hand"}
    words = r"paper.yaml: embedded.joint_2.1.chosen_for: no statement 'area_fall'.*'area_falls'\?"
    with pytest.raises(InputError, match=words):
        check_study(paper, "paper.yaml")


def test_the_twins_were_chosen_for_their_plateaus(paper):
    assert "dilatancy_flattens" in chosen_for(paper, "sandstone_twin")
    assert "dilatancy_flattens_in_two" in chosen_for(paper, "concrete_twin")
    assert chosen_for(paper, "joint_2.1") == {}
    assert chosen_for(paper, "a scan") == {}
    for name in paper["embedded"]:
        assert chosen_for(paper, name).keys() <= NAMES


def test_how_a_specimen_was_chosen_or_its_ensemble_makes_no_other_surface(paper):
    recipe = paper["embedded"]["sandstone_twin"]
    beside = ("chosen_for", "realisations")
    without = {key: value for key, value in recipe.items() if key not in beside}
    assert resolve_embedded(recipe, "here") == resolve_embedded(without, "here")


def test_the_capped_twin_repeats_the_other(paper):
    variants = [name for name in paper["embedded"] if is_capped_variant(paper, name)]
    assert variants == ["sandstone_capped", "concrete_capped"]
    assert not is_capped_variant(paper, "a scan")


def test_settings_hold_it_for_the_atlas_that_figures_of_one_specimen_are_drawn_from(paper):
    twin, capped = (
        resolve_settings(paper, name, {}, "paper")
        for name in ("sandstone_twin", "sandstone_capped")
    )
    assert twin.chosen_for == paper["embedded"]["sandstone_twin"]["chosen_for"]
    assert (twin.capped_variant, capped.capped_variant) == (False, True)


def test_another_surface_or_no_other_hardness_repeats_nothing(paper):
    other = paper["embedded"]["sandstone_capped"]
    paper["embedded"]["sandstone_capped"] = {**other, "seed": 7}
    assert not is_capped_variant(paper, "sandstone_capped")
    paper["embedded"]["sandstone_capped"] = other
    paper["specimens"]["sandstone_twin"]["material"] = "sandstone_capped"
    assert not is_capped_variant(paper, "sandstone_capped")
    paper["specimens"]["sandstone_twin"]["material"] = {"modulus": "1 GPa", "poisson": 0.2}
    assert is_capped_variant(paper, "sandstone_capped")
