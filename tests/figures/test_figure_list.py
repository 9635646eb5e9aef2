"""Register of the figures: every module states what it is, read without importing it."""

import subprocess
import sys

import pytest
from stage_names import EXPERIMENTS, STAGES

from fractalcontact.figures.draw import drawer_of
from fractalcontact.study import figure_list
from fractalcontact.study.figure_list import (
    all_figures,
    figures_of,
    read_figure,
    study_figures_of,
)

STATED = """
TITLE = (
    "A title that takes "
    "two lines"
)
SUBJECT = "study"
NEEDS = ("closure",)
KEY = "speed"
ORDER = 1.5
"""


def module_of(tmp_path, text):
    path = tmp_path / "rocks/figures/joint/example.py"
    path.parent.mkdir(parents=True)
    path.write_text(text)
    return path


def test_constants_are_read_as_they_stand(tmp_path):
    figure = read_figure(module_of(tmp_path, STATED))
    assert figure.name == "example"
    assert figure.module == "rocks/figures/joint/example"
    assert figure.title == "A title that takes two lines"
    assert (figure.subject, figure.needs) == ("study", ("closure",))
    assert (figure.key, figure.order) == ("speed", 1.5)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('KEY = "speed"\n', "", "states KEY"),
        ("ORDER = 1.5\n", "", "states ORDER"),
        ("1.5", "place()", "ORDER is no literal"),
        ('"study"', '"nobody"', "SUBJECT 'nobody'"),
    ],
)
def test_what_is_missing_or_wrong_is_named(tmp_path, old, new, words):
    with pytest.raises(ValueError, match=words):
        read_figure(module_of(tmp_path, STATED.replace(old, new)))


def test_every_figure_needs_stages_that_there_are_and_can_be_drawn():
    figures = all_figures()
    assert {stage for figure in figures.values() for stage in figure.needs} <= set(STAGES)
    assert all(callable(drawer_of(name)) for name in figures)
    assert len({figure.title for figure in figures.values()}) == len(figures)
    with pytest.raises(KeyError):
        drawer_of("no_such_figure")


def test_every_figure_is_of_some_subject_and_every_experiment_has_one():
    keys = {figure.key for figure in all_figures().values()}
    drawn = [*figures_of("match"), *study_figures_of(keys)]
    assert sorted(drawn) == sorted(all_figures())
    assert set(figures_of("flat")) < set(figures_of("match"))
    assert all(study_figures_of([experiment]) for experiment in EXPERIMENTS)
    assert study_figures_of([]) == []


def test_the_register_imports_nothing_heavy():
    code = (
        "import sys; from fractalcontact.study.figure_list import all_figures; all_figures(); "
        "print(sorted({'xarray', 'numba', 'matplotlib', 'numpy'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_two_figures_of_one_name_are_refused(tmp_path, monkeypatch):
    for group in ("joint", "paper"):
        (tmp_path / group).mkdir()
        (tmp_path / group / "twice.py").write_text(STATED)
    monkeypatch.setattr(figure_list, "FOLDERS", [tmp_path])
    with pytest.raises(ValueError, match=r"joint/twice\.py and .*paper/twice\.py: two figures"):
        all_figures.__wrapped__()
