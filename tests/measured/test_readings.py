"""Readings of a laboratory as they are written: order, signs, columns that are another one."""

import re

import numpy as np
import pytest
from made_tests import stated_tests

from fractalcontact.core.errors import InputError
from fractalcontact.measured.readings import read_test

HELD = {"file": "test.csv", "pressure": "2 MPa", "direction": "E"}
CLOSURE = {"file": "test.csv", "gauge": "joint", "seat": "0.25 MPa", "branch": "load", "cycle": 1}
HEADS = {
    "closure": "pressure [MPa],displacement [um]",
    "flow": "pressure [MPa],hydraulic_aperture [um]",
    "dilatancy": "displacement [mm],dilation [mm]",
    "shear": "displacement [mm],shear_stress [MPa]",
    "strength": "pressure [MPa],shear_strength [MPa]",
}
STATED = {
    "closure": CLOSURE,
    "flow": {
        **{"file": "test.csv", "way": "along", "branch": "load", "cycle": 1},
        "columns": {"hydraulic_aperture": "hydraulic_aperture [um]"},
    },
    "dilatancy": HELD,
    "shear": HELD,
    "strength": {"file": "test.csv", "direction": "E"},
}
SLID = np.linspace(0, 3, 61)


def read(folder, kind, x, y, **said):
    rows = "".join(f"{a:.4f},{b:.4f}\n" for a, b in zip(x, y, strict=True))
    (folder / "test.csv").write_text(f"{HEADS[kind]}\n{rows}")
    (test,) = stated_tests({kind: STATED[kind] | said}, "made.yaml: measured", folder)
    return read_test(test)


def strength(slid):
    return 1.5 * slid / (0.2 + np.abs(slid))


@pytest.mark.parametrize("kind", ["shear", "dilatancy"])
def test_a_displacement_that_goes_back_is_refused_with_its_lines(tmp_path, kind):
    """The box moves back by 0.3 mm, before or after it slides."""
    back = -np.linspace(0, 0.3, 31)
    after = np.concatenate([SLID, 3 + back])
    for slid, line, words in (
        (np.concatenate([back, SLID - 0.3]), 3, "from 0 mm (line 2) to -0.3 mm (line 32)"),
        (after, 63, "from 3 mm (line 62) to 2.7 mm (line 93)"),
    ):
        with pytest.raises(InputError, match=re.escape(words)) as refusal:
            read(tmp_path, kind, slid, 0.1 * slid + 1)
        assert f"test.csv: line {line}: the displacement falls back" in str(refusal.value)


def test_noise_of_a_gauge_is_sorted_with_a_sentence(tmp_path):
    """Of 1 % of the travel, so that nearly every other step goes back; the curve is the same."""
    slid = np.linspace(0, 3, 400)
    noisy = slid + np.random.default_rng(1).uniform(-0.03, 0.03, slid.size)
    found = read(tmp_path, "shear", noisy, strength(noisy))
    assert (np.diff(found.curve.x) >= 0).all()
    np.testing.assert_allclose(found.curve.y, strength(found.curve.x), atol=1e-3)
    count = np.count_nonzero(np.diff(np.round(noisy, 4)) < 0)
    assert f"falls back from one reading to the next in {count} of 399 steps" in found.note
    assert found.warning == ""
    assert read(tmp_path, "shear", slid, strength(slid)).said == ""


@pytest.mark.parametrize("kind", ["closure", "flow"])
@pytest.mark.parametrize("branch", ["load", "unload"])
def test_a_branch_in_the_midst_of_another_is_refused(tmp_path, kind, branch):
    """Unloaded and loaded again: more than three quarters of the steps go the right way."""
    pressure = np.concatenate([np.arange(1, 11), [8, 6, 4], np.arange(5, 21)]).astype(float)
    y = np.log(pressure) if kind == "closure" else 100 / pressure
    turned, words = slice(None), "falls back from 10 MPa (line 11) to 4 MPa (line 14)"
    if branch == "unload":
        turned, words = slice(None, None, -1), "rises again from 4 MPa (line 18) to 10 MPa"
    with pytest.raises(InputError, match=re.escape(words)) as refusal:
        read(tmp_path, kind, pressure[turned], y[turned], branch=branch)
    assert "write each branch into a file of its own" in str(refusal.value)


@pytest.mark.parametrize(
    ("kind", "x", "y", "words"),
    [
        ("dilatancy", SLID, -0.25 * SLID, "line 1, column 'dilation [mm]': the dilation falls"),
        ("dilatancy", -SLID, 0.25 * SLID, "line 3: the displacement falls back from"),
        ("shear", SLID, -strength(SLID), "line 1, column 'shear_stress [MPa]': the shear stress"),
        ("closure", SLID + 1, -np.log(SLID + 1), "line 1, column 'displacement [um]'"),
        ("closure", SLID - 1, SLID, "line 2, column 'pressure [MPa]': -1 MPa is below 0"),
        ("closure", 0 * SLID, SLID, "0 readings at a pressure above 0"),
        ("closure", 0 * SLID + 2, SLID, "every reading is 2 MPa; check which column"),
        ("flow", SLID + 1, 10 - 5 * SLID, "line 43, column 'hydraulic_aperture [um]': -0.25 um"),
        ("strength", SLID + 1, -SLID - 1, "line 2, column 'shear_strength [MPa]': -1 MPa is"),
    ],
)
def test_a_sign_that_cannot_be_is_refused_with_its_line(tmp_path, kind, x, y, words):
    with pytest.raises(InputError, match=re.escape(words)):
        read(tmp_path, kind, x, y)


def test_a_joint_that_closes_first_or_stays_level_is_read(tmp_path):
    """A smooth joint dilates by nothing but noise; any joint may close before it opens."""
    rng = np.random.default_rng(2)
    level = read(tmp_path, "dilatancy", SLID, 1e-3 * rng.standard_normal(SLID.size))
    closes = read(tmp_path, "dilatancy", SLID, 0.05 * SLID * (SLID - 0.5))
    assert (level.said, closes.said) == ("", "")
    assert closes.curve.y.min() < 0


def test_a_dilation_that_is_the_displacement_is_warned_of(tmp_path):
    """45 degrees over the whole test; a steep joint flattens and is not warned of."""
    found = read(tmp_path, "dilatancy", SLID, SLID + 0.01)
    assert "the dilation equals the displacement" in found.warning
    assert read(tmp_path, "dilatancy", SLID, SLID * (1 - SLID / 9)).warning == ""
    assert read(tmp_path, "dilatancy", SLID, 0.7 * SLID).warning == ""


def test_strengths_may_stand_in_any_order(tmp_path):
    found = read(tmp_path, "strength", [4, 1, 8, 2, 6], [3, 1, 5, 2, 4])
    assert found.curve.y.tolist() == [1, 2, 3, 4, 5]
    assert found.note == ""
