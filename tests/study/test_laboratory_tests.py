"""Laboratory tests as sidecars and studies state them."""

import json

import numpy as np
import pytest
import yaml
from code_blocks import blocks
from places import ROOT

from fractalcontact.core.errors import InputError
from fractalcontact.study.checks import resolve_study

STUDY = {
    "study": "made",
    "materials": {"rock": {"modulus": "20 GPa", "poisson": 0.2}},
    "defaults": {"material": "rock", "loads": ["1 MPa"], "resolutions": [1]},
}
TEST = {"file": "load.csv", "gauge": "joint", "seat": "0.25 MPa", "branch": "load", "cycle": 1}
SCAN = {
    **{"kind": "face", "layout": "matrix", "axes": "none", "unit": "mm", "spacing": "0.1 mm"},
    **{"first_row": "bottom", "heights": "up", "missing": "none"},
}


def study_in(folder, sidecar, files=("load.csv",), **more):
    np.save(folder / "granite.npy", np.zeros((8, 8)))
    (folder / "granite.yaml").write_text(json.dumps(SCAN | sidecar))
    for name in files:
        (folder / name).write_text("pressure [MPa], displacement [um]\n")
    return resolve_study(STUDY | {"scans": str(folder)} | more, "study.yaml")


def test_the_sidecar_of_the_document_is_read(tmp_path):
    (block,) = (one for one in blocks(ROOT / "docs/laboratory.md") if "measured:" in one.text)
    stated = yaml.safe_load(block.text)
    names = ("granite_load.csv", "granite_reload.csv", "granite_flow.csv")
    study = study_in(tmp_path, stated, names)
    tests = study.settings["granite"].measured
    assert [test.label for test in tests] == [
        *("load, cycle 1", "reload, cycle 2", "along, load, cycle 1"),
    ]
    assert tests[0].compliance == 0.004
    # No table of a test is taken for a scan.
    assert list(study.scans) == ["granite"]


def test_the_test_of_the_first_hour_is_read(tmp_path):
    (block,) = (one for one in blocks(ROOT / "docs/first_hour.md") if "measured:" in one.text)
    study = study_in(tmp_path, yaml.safe_load(block.text), ("granite_load.csv",))
    (test,) = study.settings["granite"].measured
    assert test.calibrate == "hardness"


def test_a_study_states_them_too(tmp_path):
    study = study_in(tmp_path, {}, specimens={"granite": {"measured": {"closure": TEST}}})
    assert study.settings["granite"].measured[0].file == str(tmp_path / "load.csv")
    assert list(study.scans) == ["granite"]


def test_rock_is_stated_by_length_and_modulus(tmp_path):
    rock = {"gauge": {"length": "100 mm", "modulus": "50 GPa"}}
    study = study_in(tmp_path, {"measured": {"closure": TEST | rock}})
    assert study.settings["granite"].measured[0].compliance == pytest.approx(2e-3)


@pytest.mark.parametrize(
    ("measured", "words"),
    [
        ({"closure": TEST | {"file": "none.csv"}}, "no such file, which 'measured' names"),
        ({"closure": TEST | {"file": "../load.csv"}}, "measured.closure.file"),
        ({"closures": TEST}, "did you mean 'closure'"),
        ({"closure": TEST | {"branches": "load"}}, "did you mean 'branch'"),
        (
            {"closure": [TEST | {"branches": "load"}]},
            r"'measured.closure.0.branches'; did you mean",
        ),
        (
            {"closure": [TEST | {"cycle": 0}]},
            r"closure.0.cycle: 0 .*a whole number from 1",
        ),
        (
            {"closure": [TEST | {"gauge": {"lenght": "1 mm"}}]},
            "lenght'; did you mean 'length'",
        ),
        ({"closure": [dict(TEST), dict(TEST)]}, "two tests are 'load, cycle 1'"),
        ({"flow": {"file": "load.csv", "branch": "load", "cycle": 1}}, "flow.way'; expected along"),
        ({"shear": {"file": "load.csv", "direction": "E"}}, "key 'measured.shear.pressure'; exp"),
        ({"strength": {"file": "load.csv"}}, "direction'; expected the direction of sliding"),
    ],
)
def test_what_is_wrong_is_said_before_anything_runs(tmp_path, measured, words):
    with pytest.raises(InputError, match=words):
        study_in(tmp_path, {"measured": measured})
