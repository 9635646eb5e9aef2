"""What a stage reads of the settings: what its function's annotations name, and nothing else."""

import importlib
from dataclasses import asdict, fields, replace
from typing import get_type_hints

import pytest
from made_settings import made_settings

from fractalcontact.core import settings
from fractalcontact.core.stage import STUDY
from fractalcontact.study.configuration import solver_settings
from fractalcontact.study.stages import CONTACT, STAGES, read_by, sections_of

SOLVER = solver_settings({}, "study")
SPECIMEN, STATES, FLOW, WINDOWS, REPORT, ENSEMBLE, TESTS = (
    STAGES[name].function
    for name in ("joints", "closure", "flow", "size_test", "strength", "ensemble", "measured")
)
JOBS = (SPECIMEN, CONTACT, STATES, FLOW, WINDOWS, REPORT, ENSEMBLE, TESTS)


def taken_by(function):
    """Parameters of a function that are settings, as Python itself has them."""
    module, _, name = function.partition(":")
    made = getattr(importlib.import_module(module), name)
    return {key: of for key, of in get_type_hints(made).items() if of in vars(settings).values()}


@pytest.mark.parametrize(
    "function", sorted({CONTACT, *(s.function for s in STAGES.values() if s.grain != STUDY)})
)
def test_what_a_function_takes_is_known_without_importing_it(function):
    taken = {
        key: of for key, of in taken_by(function).items() if hasattr(of, "__dataclass_fields__")
    }
    assert sections_of(function) == taken
    assert bool(taken) == (function in JOBS)


def test_a_section_holds_what_its_class_names_and_no_more():
    read = settings.read(settings.StrengthSettings, asdict(made_settings()))
    assert [field.name for field in fields(read)] == ["material", "surface_range"]
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
    ids=str,
)
def test_only_what_reads_a_setting_is_made_again_for_it(change, again):
    before = made_settings()
    after = replace(before, **change)
    assert before != after
    for function in JOBS:
        same = repr(read_by(function, before, SOLVER)) == repr(read_by(function, after, SOLVER))
        assert same == (function not in again), function
