"""What a run was planned with, and what of it is another when a job begins."""

import pytest

from fractalcontact.core.errors import InputError
from fractalcontact.study.plan import changed_since, plan_of, read_plan, write_plan

STUDY = {"study": "x", "defaults": {"loads": ["1 MPa"]}}
SETTINGS, OPTIONS = {"a": {"loads": [1.0]}, "b": {"loads": [2.0]}}, {"a": {"unit": "mm"}, "b": {}}
SCANS = {"scans/a.npy": "0" * 64}


def plan(study=STUDY, settings=SETTINGS, options=OPTIONS, scans=SCANS):
    return plan_of(study, settings, options) | {"scans": scans}


def test_plan_is_kept_as_it_is(tmp_path):
    write_plan(tmp_path / "folder/plan.json", plan())
    kept = read_plan(tmp_path / "folder/plan.json")
    assert kept == plan()
    assert changed_since(kept, plan(), "x.yaml") == ""


@pytest.mark.parametrize(
    ("now", "said"),
    [
        (plan(study=STUDY | {"study": "y"}), "x.yaml: changed"),
        (plan(settings=SETTINGS | {"b": {"loads": [3.0]}}), "b: its sidecar"),
        (plan(options=OPTIONS | {"a": {"unit": "um"}}), "a: its sidecar"),
        (plan(settings=SETTINGS | {"new": {}}), ""),
        (plan(settings={"a": SETTINGS["a"]}, options={"a": OPTIONS["a"]}), ""),
        (plan(scans={"scans/a.npy": "1" * 64}), ""),  # its own job says so
    ],
)
def test_what_is_said_otherwise_is_named(now, said):
    found = changed_since(plan(), now, "x.yaml")
    assert found.startswith(said)
    assert bool(found) == bool(said)


@pytest.mark.parametrize("content", [None, "", "[1"])
def test_without_a_plan_there_is_one_sentence(tmp_path, content):
    path = tmp_path / "plan.json"
    if content is not None:
        path.write_text(content)
    with pytest.raises(InputError, match="cannot be read"):
        read_plan(path)
