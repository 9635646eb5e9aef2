"""Reasons for which a quantity cannot be."""

import pytest
import xarray as xr

from fractalcontact.core.subject import Subject
from fractalcontact.report.needs import NEEDS


@pytest.mark.parametrize("value", [None, float("nan"), float("inf")])
def test_what_the_material_does_not_state_is_named(value):
    subject = Subject({}, {"material": {"joint_wall_strength": value}})
    assert NEEDS["joint_wall_strength"](subject) == "no joint wall strength is stated"
    stated = Subject({}, {"material": {"joint_wall_strength": 80.0}})
    assert NEEDS["joint_wall_strength"](stated) == ""


@pytest.mark.parametrize(
    ("direction", "why"), [("none", "does not slide"), ("N", "too few offsets"), ("E", "")]
)
def test_what_does_not_slide_and_what_has_too_few_offsets_are_told_apart(direction, why):
    closure = xr.Dataset(
        {
            "reported_direction": direction,
            "reported_offset": 0.0,
            "reported_resolution": 1,
            "reported_load": ("normal_force", [True]),
            "reference_load": ("normal_force", [True]),
        },
        coords={"normal_force": [1.0]},
    )
    joints = xr.Dataset(coords={"direction": ["E", "none"]})
    assert NEEDS["offsets"](Subject({"closure": closure, "joints": joints}, {})) == why
