"""A sidecar's keys: those that would change nothing are refused, and the file at fault is named."""

import copy

import pytest
import yaml
from places import ROOT

from fractalcontact.core.errors import InputError
from fractalcontact.study.checks import resolve_study

PAPER = yaml.safe_load((ROOT / "config/paper.yaml").read_text())


@pytest.fixture
def study(tmp_path):
    stated = copy.deepcopy(PAPER) | {"scans": str(tmp_path), "embedded": {}, "specimens": {}}
    for key in ("roll_off",):
        stated.pop(key, None)
    return stated


def scans(folder, sidecar, *names):
    for name in names:
        (folder / name).write_text("")
    (folder / "rock.yaml").write_text(sidecar)


ONE, TWO = ("rock.npz",), ("rock.lower.npy", "rock.upper.npy")
IDLE = [
    (ONE, "threshold: 5", "threshold", "but for a contact map"),
    (ONE, "outline: disc", "outline", "but for a map of contact or aperture"),
    (ONE, "load: 5 kN", "load", "did you mean 'loads'"),
    (ONE, "registration: rigid", "registration", "for one face"),
    (ONE, "mirror_upper: x", "mirror_upper", "for one face"),
    (ONE, "opposite: flat\noffsets: [1 mm]", "offsets", "or against a rigid plane"),
    (ONE, "opposite: flat\ndirections: [E]", "directions", "or against a rigid plane"),
    (ONE, "unit: mm\nunit_xy: mm\nunit_z: um", "unit", "beside both"),
    (("rock.csv",), "variable: Z", "variable", r"for a \.csv file"),
    (("rock.stl",), "variable: Z", "variable", r"for a \.stl file"),
    (TWO, "opposite: flat", "opposite", "where both faces were scanned"),
    (ONE, "kind: contact-map\nregistration: none", "registration", "for a contact map"),
    (ONE, "kind: contact-map\nwindow: 5 mm", "window", "for a contact map"),
    (ONE, "kind: contact-map\nloads: [5 kN]", "loads", "for a contact map"),
]


@pytest.mark.parametrize(("names", "text", "key", "why"), IDLE)
def test_a_key_that_changes_nothing_is_refused(study, tmp_path, names, text, key, why):
    scans(tmp_path, text, *names)
    with pytest.raises(InputError, match=rf"rock\.yaml: key '{key}' has no meaning .*{why}"):
        resolve_study(study, "here")


@pytest.mark.parametrize(
    ("names", "text"),
    [
        (ONE, "kind: surface\nvariable: Z\nunit: mm\nunit_z: um"),
        (ONE, "missing: [-9999, 0]\noffsets: [1 mm]"),
        (ONE, "missing: none"),
        (TWO, "registration: none\nmirror_upper: x"),
        (ONE, "kind: contact-map\nlabel: film\nthreshold: 5\nload: 5 kN\nmissing: -1"),
    ],
)
def test_keys_that_change_something_are_not(study, tmp_path, names, text):
    scans(tmp_path, text, *names)
    assert list(resolve_study(study, "here").scans) == ["rock"]


@pytest.mark.parametrize("key", ["map_load", "dilatancy_loads"])
def test_loads_of_a_sidecar_do_not_blame_the_study(study, tmp_path, key):
    load = study["defaults"]["loads"][-1]
    study["defaults"][key] = [load] if key == "dilatancy_loads" else load
    keys = {"map_load", "dilatancy_loads"} - {key}
    for other in keys:
        study["defaults"].pop(other, None)
    scans(tmp_path, "loads: [1 kN, 2 kN]", *ONE)
    with pytest.raises(InputError) as error:
        resolve_study(study, "here.yaml")
    words = str(error.value)
    assert words.startswith(f"{tmp_path / 'rock.yaml'}: loads: ")
    assert (
        f"lacks '{load}', which here.yaml: defaults.{key} names; add it, or write '{key}'" in words
    )
    scans(
        tmp_path, f"loads: [1 kN]\n{key}: {'[3 kN]' if key == 'dilatancy_loads' else '3 kN'}", *ONE
    )
    with pytest.raises(InputError, match=rf"rock\.yaml: {key}: '3 kN' is not among the loads"):
        resolve_study(study, "here.yaml")


STRAY = {
    "half a pair": ("half.lower.xyz", "", "the upper face is missing"),
    "a sidecar alone": ("alone.yaml", "unit: mm", "this sidecar has no scan"),
    "an idle key": ("idle.yaml", "opposite: flat\noffsets: [1 mm]", "has no meaning"),
    "an unknown key": ("typo.yaml", "spacng: 1", "unknown key 'spacng'"),
    "two claims": ("rock.xyz", "", "both claim"),
}


@pytest.mark.parametrize("kind", STRAY)
def test_a_scan_with_which_something_is_wrong_is_left_out_alone(study, tmp_path, kind):
    name, text, said = STRAY[kind]
    (tmp_path / "good.npy").write_text("")
    scans(tmp_path, "unit: mm", *ONE)
    (tmp_path / name).write_text(text)
    if kind in ("an idle key", "an unknown key"):
        (tmp_path / name).with_suffix(".npy").write_text("")
    with pytest.raises(InputError, match=said):
        resolve_study(study, "here")
    found = resolve_study(study, "here", leave_out=True)
    (error,) = found.refused.values()
    assert said in str(error)
    good = {"good"} if kind == "two claims" else {"good", "rock"}
    assert set(found.scans) == set(found.settings) == set(found.options) == good
