"""The table of stages: whole, in order, and true of the functions that it names."""

import importlib
import inspect
import re
import subprocess
import sys

import pytest
import yaml
from places import ROOT

from contactlab.jobs import jobs_of
from fractalcontact.core.settings import Solver
from fractalcontact.core.stage import (
    EXPERIMENT,
    GRAINS,
    JOINT,
    MAP,
    MEASUREMENT,
    SPECIMEN,
    STUDY,
    module_of,
)
from fractalcontact.study.keys import StudyKeys
from fractalcontact.study.stages import STAGES, made_together, needed_by, paths_of


def function_of(stage):
    module, _, name = stage.function.partition(":")
    return getattr(importlib.import_module(module), name)


@pytest.mark.parametrize("stage", STAGES.values(), ids=STAGES)
def test_a_stage_names_a_function_that_takes_what_the_stage_needs(stage):
    taken = inspect.signature(function_of(stage)).parameters
    takes_any = any(one.kind is one.VAR_KEYWORD for one in taken.values())
    if stage.grain in (SPECIMEN, JOINT, MAP, EXPERIMENT) and not takes_any:
        assert set(stage.needs) <= set(taken)
    assert (ROOT / f"src/{module_of(stage.function)}").is_file()
    assert stage.grain in GRAINS
    assert stage.title


def test_stages_need_only_stages_before_them_and_those_of_one_function_the_same():
    before = set()
    needs = {}
    for name, stage in STAGES.items():
        shared = set(made_together(name)) - {name}
        assert set(stage.needs) <= before - shared
        assert needs.setdefault(stage.function, stage.needs) == stage.needs
        before.add(name)


def test_a_stage_has_a_rule_but_those_of_all_specimens_together():
    rules = "".join(path.read_text() for path in (ROOT / "workflow/rules").glob("*.smk"))
    for name, stage in STAGES.items():
        if stage.grain not in (STUDY, EXPERIMENT, MEASUREMENT):
            together = "|".join(made_together(name))
            made = rf'(calling|StageJob)\(\s*"({together})"|RESULTS}}/({together})/'
            assert re.search(made, rules), f"no rule in workflow/rules makes {name}"


def test_a_stage_of_the_laboratory_has_jobs_that_call_its_function_with_what_it_takes():
    study = {"embedded": {}}
    for name in ("smoke", "accuracy_small"):
        study |= yaml.safe_load((ROOT / f"config/{name}.yaml").read_text())
    jobs = jobs_of(study, Solver(1e-6, "", None), "study.yaml")
    made = {}
    for name, job in jobs.items():
        taken = inspect.signature(function_of(job)).parameters
        assert {*job.arguments, *job.parts} <= set(taken)
        assert {*job.arguments, *job.parts} >= {
            key for key, one in taken.items() if one.default is one.empty
        }
        assert {part for parts in job.parts.values() for part in parts} <= set(jobs)
        made.setdefault(name.partition("/")[0], set()).add(job.function)
    for name, stage in STAGES.items():
        if stage.grain in (EXPERIMENT, MEASUREMENT):
            assert made.pop(name) == {stage.function}
    assert set(made) == {"size_effect_parts", "stability_parts"}
    assert jobs_of({"study": "x"}, Solver(1e-6, "", None), "study.yaml") == {}


def test_an_experiment_is_a_key_of_studies():
    assert set(paths_of(EXPERIMENT)) <= set(StudyKeys.model_fields)


def test_files_of_a_job_are_those_of_the_stages_of_its_function():
    assert made_together("joints") == {
        stage: f"{stage}/{{specimen}}.nc"
        for stage in ("specimens", "quality", "surface_dimension", "joints")
    }
    assert set(made_together("windows")) - set(made_together("windows", [SPECIMEN])) == {"strength"}
    assert needed_by("window_states") == {
        stage: f"{stage}/{{specimen}}.nc" for stage in ("specimens", "joints")
    }
    assert paths_of(MAP) == {"contact_maps": "contact_maps/{specimen}.nc"}
    assert paths_of(EXPERIMENT)["roll_off"] == "roll_off/surfaces.nc"
    assert made_together("statements") == made_together("windows")


def test_the_table_imports_none_of_the_functions_that_it_names():
    code = (
        "import sys, fractalcontact.study.stages\n"
        "print({'numpy', 'numba', 'xarray'} & set(sys.modules),"
        " [name for name in sys.modules if name.startswith('fractalcontact.stages')])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "set() []\n"


def test_the_page_on_the_atlas_names_every_stage():
    page = (ROOT / "docs/atlas.md").read_text(encoding="utf-8")
    assert not [name for name in STAGES if f"`{name}`" not in page]
