"""What a stage reads of the settings: what its function's annotations name, and nothing else."""

import re
from dataclasses import asdict, fields, replace
from typing import get_type_hints

import pytest
from made_settings import made_settings
from made_stages import given, is_section
from places import ROOT

from fractalcontact.core import settings
from fractalcontact.ensemble.realisations import ensemble
from fractalcontact.measured.stage import measured_stage
from fractalcontact.stages.closure_and_box_counts import state_stages
from fractalcontact.stages.flow import flow_stages
from fractalcontact.stages.specimen import stages_of_scan
from fractalcontact.stages.strength import strength_stages
from fractalcontact.stages.windows import window_stages
from fractalcontact.states.sweep import joint_states
from fractalcontact.study.configuration import solver_settings

SOLVER = solver_settings({}, "study")
SPECIMEN, CONTACT, STATES, FLOW, WINDOWS, REPORT, ENSEMBLE, TESTS = JOBS = (
    *(stages_of_scan, joint_states, state_stages, flow_stages, window_stages, strength_stages),
    *(ensemble, measured_stage),
)
#: Rules by what their scripts call.
RULES = {
    SPECIMEN: "roughness_and_composite",
    CONTACT: "contact",
    STATES: "closure_and_box_counts",
    FLOW: "flow",
    WINDOWS: "windows",
    REPORT: "strength",
    ENSEMBLE: "ensemble",
    TESTS: "measured",
}


@pytest.mark.parametrize("function", JOBS, ids=lambda function: function.__name__)
def test_a_rule_states_the_settings_that_the_function_of_its_script_takes(function):
    """And no others: a change of one makes nothing again that does not read it."""
    rules = "".join(path.read_text() for path in ROOT.glob("workflow/rules/*.smk"))
    rule = rules.partition(f"\nrule {RULES[function]}:\n")[2].partition("\n    script:")[0]
    script = (ROOT / f"workflow/scripts/{RULES[function]}.py").read_text()
    taken = {of.__name__ for of in get_type_hints(function).values() if is_section(of)}
    named = set(re.findall(r"settings_of\(settings\.(\w+)\)", rule))
    assert taken == named | ({"Solver"} if "solver=SOLVER" in rule else set())
    assert set(re.findall(r"read\((\w+), given", script)) == named
    assert f"{function.__name__}(" in script


def test_a_section_holds_what_its_class_names_and_no_more():
    read = settings.read(settings.StrengthSettings, asdict(made_settings()))
    assert [field.name for field in fields(read)] == ["material", "surface_range", "block_lengths"]
    assert set(asdict(read.material)) == {one.name for one in fields(settings.Material)}


def test_settings_that_the_atlas_keeps_are_read_back_as_they_were():
    whole = made_settings(known_dimension=2.2)
    again = settings.read(settings.Settings, asdict(whole))
    assert repr(again) == repr(whole)  # not a number is equal to none


def _material(**stated):
    return {"material": replace(made_settings().material, **stated)}


@pytest.mark.parametrize(
    ("change", "again"),
    [
        ({"label": "another"}, (REPORT,)),
        (_material(basic_friction_angle=35.0), (REPORT,)),
        (_material(joint_wall_strength=60.0), (REPORT,)),
        (_material(hardness=900.0), (CONTACT, STATES, FLOW, WINDOWS, REPORT, ENSEMBLE, TESTS)),
        (_material(name="another", modulus=1.0, poisson=0.3), (REPORT,)),
        ({"box_range": (0.2, 1.0)}, (STATES, WINDOWS, ENSEMBLE)),
        ({"seating_pressure": 1.0}, (STATES, ENSEMBLE)),
        ({"map_load": (5.0, "pressure")}, (CONTACT, STATES, ENSEMBLE)),
        ({"surface_range": (0.2, 1.0)}, (SPECIMEN, REPORT, ENSEMBLE)),
        ({"outliers": "mask"}, (SPECIMEN, ENSEMBLE)),
    ],
    ids=lambda one: ", ".join(f.__name__ for f in one) if isinstance(one, tuple) else str(one),
)
def test_only_what_reads_a_setting_is_made_again_for_it(change, again):
    before = made_settings()
    after = replace(before, **change)
    assert before != after
    for function in JOBS:
        same = repr(given(function, before, SOLVER)) == repr(given(function, after, SOLVER))
        assert same == (function not in again), function
