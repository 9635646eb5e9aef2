"""Stages as the rules of the workflow have them: plain rules, in the atlas, on the page on it."""

import re

import pytest
from places import ROOT
from stage_names import EXPERIMENTS, STAGES

from fractalcontact.study.keys import StudyKeys

RULES = sorted(ROOT.glob("workflow/rules/*.smk"))


def test_the_page_on_the_atlas_names_every_stage():
    page = (ROOT / "docs/atlas.md").read_text(encoding="utf-8")
    assert not [name for name in STAGES if f"`{name}`" not in page]


def test_an_experiment_is_a_key_of_studies():
    assert set(EXPERIMENTS) <= set(StudyKeys.model_fields)


@pytest.mark.parametrize("path", RULES, ids=lambda path: path.stem)
def test_rules_are_written_out_with_scripts_that_fit_on_a_screen(path):
    text = path.read_text()
    made_in_a_loop = re.compile(r"(?m)^(?:for|while) |^ +rule:|name:\n|unpack\(")
    assert not made_in_a_loop.findall(text)
    for script in re.findall(r'"\.\./scripts/(\w+\.py)"', text):
        source = (path.parents[1] / "scripts" / script).read_text()
        assert len(source.splitlines()) <= 40, script
        assert not re.search(r"import_module|globals\(\)|getattr\(", source), script
