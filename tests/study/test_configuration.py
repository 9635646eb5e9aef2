"""A study is checked before anything runs; what is wrong is named by its key."""

import copy
import functools
import math
import operator
from pathlib import Path

import numpy as np
import pytest
import yaml
from places import ROOT

from fractalcontact.core.errors import InputError
from fractalcontact.core.keys import schema_of
from fractalcontact.study import scan_files
from fractalcontact.study.checks import check_names, check_study, read_sidecar, resolve_study
from fractalcontact.study.configuration import (
    MAX_NODES_PER_SIDE,
    resolve_embedded,
    resolve_roll_off,
    resolve_settings,
)
from fractalcontact.study.documents import read_study
from fractalcontact.study.keys import StudyKeys
from fractalcontact.study.scan_files import ScanFiles
from fractalcontact.surface.specimen import window_arguments

PAPER = yaml.safe_load((ROOT / "config/paper.yaml").read_text())


@pytest.fixture
def study():
    return copy.deepcopy(PAPER)


@pytest.mark.parametrize("change", [{"embedded": {}}, {"specimens": {}}])
def test_only_a_study_without_specimens_needs_no_materials(change):
    bare = {"study": "bare", "scans": None}
    check_study(bare, "bare")
    with pytest.raises(InputError, match=r"missing key 'materials'; expected materials by name"):
        check_study(bare | change, "bare")


def test_a_study_of_contact_maps_alone_needs_no_materials_and_one_of_heights_does(tmp_path):
    (tmp_path / "film.npy").write_text("")
    (tmp_path / "film.yaml").write_text("kind: contact-map\nlabel: a film\n")
    bare = {"study": "bare", "scans": str(tmp_path)}
    study = resolve_study(bare, "bare")
    assert (study.labels, study.settings) == ({"film": "a film"}, {})
    (tmp_path / "slab.npy").write_text("")
    with pytest.raises(InputError, match="missing key 'materials', which the specimen slab needs"):
        resolve_study(bare, "bare")


def test_the_sidecar_wins_over_the_study_and_the_study_over_its_defaults(study, tmp_path):
    sidecar = tmp_path / "concrete_twin.yaml"
    sidecar.write_text("unit: um\nspacing: 5\nwindow: 10 mm\n")
    scan, settings = read_sidecar(sidecar)
    assert scan == {"unit": "um", "spacing": 5}
    resolved = resolve_settings(study, "concrete_twin", settings, "paper.yaml")
    assert resolved.window == 10
    assert resolved.material.name == "concrete"
    assert resolved.material.e_star == pytest.approx(30e3 / (2 * (1 - 0.2**2)))
    assert resolved.directions == ["E", "N", "W", "S"]


def test_the_known_dimension_is_that_of_the_recipe(study):
    assert resolve_settings(study, "concrete_twin", {}, "paper.yaml").known_dimension == 2.24
    assert np.isnan(resolve_settings(study, "a scan", {}, "paper.yaml").known_dimension)


def test_the_window_is_cut_to_the_coarsest_prefractal(study):
    settings = resolve_settings(study, "concrete_twin", {}, "paper.yaml")
    arguments = window_arguments(settings)
    assert arguments["multiple"] == 8
    assert arguments["reach"] == dict.fromkeys("ENWS", 8.0)


def test_cleaning_reaches_the_specimen_and_registration_the_reader(study, tmp_path):
    arguments = window_arguments(resolve_settings(study, "concrete_twin", {}, "paper.yaml"))
    assert (arguments["outliers"], arguments["fill_holes"]) == ("keep", 0)
    sidecar = tmp_path / "concrete_twin.yaml"
    sidecar.write_text("outliers: mask\nfill_holes: 5\nregistration: none\nmirror_upper: x\n")
    scan, settings = read_sidecar(sidecar)
    assert scan == {"registration": "none", "mirror_upper": "x"}
    arguments = window_arguments(resolve_settings(study, "concrete_twin", settings, "paper.yaml"))
    assert (arguments["outliers"], arguments["fill_holes"]) == ("mask", 5)
    sidecar.write_text("fill_holes: true\n")
    with pytest.raises(InputError, match="fill_holes: True is not right; expected rows and col"):
        read_sidecar(sidecar)


def test_a_surface_has_as_many_nodes_per_side_wherever_a_study_asks_for_one():
    sections = schema_of(StudyKeys)["$defs"]
    limits = [
        sections["EstimatorBiasKeys"]["properties"]["sizes"]["items"],
        sections["AreaSlopeKeys"]["properties"]["nodes"],
        sections["SpeedKeys"]["properties"]["sizes"]["items"],
    ]
    assert {limit["maximum"] for limit in limits} == {MAX_NODES_PER_SIDE}


def test_embedded_lengths_are_in_millimetres(study):
    recipe = resolve_embedded({**study["embedded"]["concrete_twin"], "size": "4 cm"}, "here")
    assert (recipe["size"], recipe["outline"]) == (40, "square")


def test_strength_of_the_material_is_missing_where_it_is_not_stated(study):
    material = resolve_settings(study, "concrete_twin", {}, "paper").material
    assert (material.basic_friction_angle, material.joint_wall_strength) == (35, 40)
    del study["materials"]["concrete"]["basic_friction_angle"]
    material = resolve_settings(study, "concrete_twin", {}, "paper").material
    assert math.isnan(material.basic_friction_angle)


def test_joints_with_and_without_a_roll_off_follow_an_embedded_specimen(study):
    joints = resolve_roll_off(study, "paper")
    assert joints["window"] == 20
    assert joints["recipe"]["roll_off"] == 5


LONG = "a" * 240
DIGITS = int("9" * 400)


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (("study",), "paper\n", r"study: 'paper\\n' is not right; expected the study's name"),
        (("study",), LONG, r"study: 'aaa.*\.\.\. is not right; .* up to 100 letters"),
        (("embedded", "rock\n"), {}, r"embedded: 'rock\\n' is not right; expected the name of"),
        (("embedded", LONG), {}, r"embedded: 'aaa.* is not right; expected the name of a specimen"),
        (("embedded", 12), {}, "embedded: 12 is not right; expected the name of a specimen"),
        (("materials", "rock\n"), {}, r"materials: 'rock\\n' is not right; expected the name of a"),
        (("materials", LONG), {}, r"materials: 'aaa.* is not right; expected the name of a mater"),
        (("materials", "a$b"), {}, r"materials: 'a\$b' is not right; expected the name of a mater"),
        (("defaults", "label"), "rock\n", r"defaults.label: 'rock\\n' is not right; expected what"),
        (("embedded", "joint_2.1", "label"), "a\nb", r"joint_2.1.label: 'a\\nb' is not right"),
        (("embedded", "joint_2.1", "label"), LONG, r"joint_2.1.label: 'aaa.* up to 200 characters"),
        (("embedded", "joint_2.1", "size"), "1e9 mm", r"size: '1e9 mm' at a spacing of .* nodes"),
        (("embedded", "joint_2.1", "spacing"), "1 m", r"nodes per side; expected from 2 to 16384"),
        (("embedded", "joint_2.1", "spacing"), "1e-200 mm", "'1e-200 mm' is out of range"),
        (("embedded", "joint_2.1", "seed"), DIGITS, r"seed: 9{80}\.\.\. is not right; expected a"),
        (("embedded", "joint_2.1", "seed"), 10**18, "seed: 1000000000000000000 is not right"),
        (("embedded", "joint_2.1", "seed"), 7.0, "seed: 7.0 is not right; expected a whole number"),
        (("roll_off", "seeds"), [1, DIGITS], r"roll_off.seeds.1: 9{80}\.\.\. is not right; "),
        (("area_slope", "nodes"), DIGITS, r"area_slope.nodes: 9{80}\.\.\. is not right; "),
        (("size_effect", "arms", "S1", "sizes"), [10**6], r"sizes.0: 10+ is not right; expected"),
        (("defaults", "resolutions"), [DIGITS], r"resolutions.0: 9{80}\.\.\. is not right; "),
        (("defaults", "fill_holes"), DIGITS, "fill_holes: 9.* is not right; expected rows and col"),
        (("defaults", "loads"), ["5e-324 N"], "loads.0: '5e-324 N' is out of range"),
        (
            ("defaults", "loads"),
            ["1e200 MPa"],
            r"'1e200 MPa' is out of range, 1e-150 to 1e\+150 MPa",
        ),
        (("materials", "concrete", "modulus"), "1e300 GPa", "'1e300 GPa' is out of range"),
    ],
    ids=lambda value: "digits" if value is DIGITS else None,
)
def test_names_and_numbers_beyond_all_use_are_one_error_each(study, path, value, message):
    if value == {}:  # what any of its kind is
        value = next(iter(study[path[0]].values()))
    *parents, last = path
    functools.reduce(operator.getitem, parents, study)[last] = value
    with pytest.raises(InputError, match=r"mine\.yaml: .*") as caught:
        check_study(study, "mine.yaml")
    assert caught.match(message)
    assert len(str(caught.value)) < 350


@pytest.mark.parametrize("length", [scan_files.LONGEST_NAME, scan_files.LONGEST_NAME + 1])
def test_embedded_names_are_as_long_as_those_of_scans(study, length):
    name = "".join(str(k) for k in range(150))[:length]  # no row of repeats
    study["embedded"] = {name: study["embedded"]["joint_2.1"]}
    del study["roll_off"], study["specimens"]
    if length <= scan_files.LONGEST_NAME:
        check_study(study, "mine.yaml")
    else:
        with pytest.raises(InputError, match="up to 220 letters"):
            check_study(study, "mine.yaml")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("Joint_2.1", "embedded.Joint_2.1: differs from the embedded specimen joint_2.1 in upper"),
        ("CON", "embedded.CON: no name for files on every computer; write '_CON'"),
        ("a" * 20, r"embedded.a+: no name for files on every computer; write 'a+-[0-9a-f]{6}'"),
    ],
)
def test_embedded_names_that_files_cannot_have_are_refused(study, name, message):
    study["embedded"][name] = study["embedded"]["joint_2.1"]
    with pytest.raises(InputError, match=message):
        check_study(study, "mine.yaml")


@pytest.mark.parametrize(
    ("scan", "message"),
    [
        ("joint_2.1", "embedded.joint_2.1: has the name of a scan in rocks; rename one"),
        ("JOINT_2.1", "embedded.joint_2.1: differs from a scan in rocks JOINT_2.1 in upper and"),
    ],
)
def test_embedded_names_and_those_of_scans_are_told_apart(study, scan, message):
    check_names(["other"], study, "rocks", "mine.yaml")
    with pytest.raises(InputError, match=message):
        check_names(["other", scan], study, "rocks", "mine.yaml")


@pytest.mark.parametrize("value", ["9" * 5000, "2020-13-45"])
def test_numbers_and_dates_that_are_none_are_refused_on_reading(tmp_path, value):
    path = tmp_path / "mine.yaml"
    path.write_text(f"study: mine\nseed: {value}\n")
    with pytest.raises(InputError, match=r"mine\.yaml: an invalid date or number"):
        read_study(path)


ROCK = {
    "materials": {
        "rock": {"modulus": "20 GPa", "poisson": 0.2, "joint_wall_strength": "80 MPa"},
        "elastic": {
            **{"modulus": "20 GPa", "poisson": 0.2, "joint_wall_strength": "80 MPa"},
            "hardness": "none",
        },
        "hard": {
            **{"modulus": "20 GPa", "poisson": 0.2, "joint_wall_strength": "80 MPa"},
            "hardness": "240 MPa",
        },
        "unknown": {"modulus": "20 GPa", "poisson": 0.2},
    },
    "defaults": {
        **{"material": "rock", "resolutions": [1], "loads": ["1 MPa", "50 MPa", "78 MPa", "10 kN"]},
        **{"map_load": "78 MPa", "dilatancy_loads": ["1 MPa", "78 MPa"]},
    },
}
SCANNED = ScanFiles("one", Path("one.x3p"), None, None)
PAIR = ScanFiles("one", Path("one.lower.x3p"), Path("one.upper.x3p"), None)


@pytest.mark.parametrize(
    ("scan", "own", "expected"),
    [
        (SCANNED, {}, "fill"),
        (SCANNED, {"outliers": "keep"}, "keep"),
        (SCANNED, {"opposite": "flat"}, "keep"),
        (PAIR, {}, "keep"),
        (None, {}, "keep"),
    ],
)
def test_a_face_against_its_own_match_fills_outliers_unless_told(study, scan, own, expected):
    assert resolve_settings(study, "one", own, "study", scan).outliers == expected
    study["defaults"]["outliers"] = "mask"
    assert resolve_settings(study, "one", {}, "study", scan).outliers == "mask"


def test_the_seating_pressure_is_a_small_stress_that_a_study_may_change():
    assert resolve_settings(ROCK, None, {}, "x").seating_pressure == 0.25
    stated = ROCK | {"defaults": ROCK["defaults"] | {"seating_pressure": "10 kPa"}}
    assert resolve_settings(stated, None, {}, "x").seating_pressure == pytest.approx(0.01)
    for text, words in (("10 N", "pressure"), ("-1 MPa", "must be positive")):
        stated["defaults"]["seating_pressure"] = text
        with pytest.raises(InputError, match=rf"seating_pressure.*{words}"):
            resolve_settings(stated, None, {}, "x")


@pytest.mark.parametrize(
    ("material", "scan", "hardness"),
    [
        ("rock", SCANNED, 80.0),
        ("rock", None, math.inf),
        ("elastic", SCANNED, math.inf),
        ("hard", SCANNED, 240.0),
        ("hard", None, 240.0),
        ("unknown", SCANNED, math.inf),
    ],
)
def test_contacts_of_a_scanned_rock_crush_at_its_wall_strength(material, scan, hardness):
    found = resolve_settings(ROCK, "one", {"material": material}, "x", scan)
    assert found.material.hardness == hardness


@pytest.mark.parametrize("offsets", ["auto", ["0.2 mm", "0.4 mm"], ["0 mm", "0.4 mm"]])
def test_two_faces_are_quoted_as_they_were_scanned_whatever_the_offsets(offsets):
    """At none, which is solved too; one face, and a stated offset, keep theirs."""
    own = {"offsets": offsets}
    pair, one = (resolve_settings(ROCK, "one", own, "x", scan) for scan in (PAIR, SCANNED))
    assert pair.map_offset == 0
    stated = None if offsets == "auto" else [float(of.split()[0]) for of in offsets]
    assert pair.offsets == (stated and sorted({0.0, *stated}))
    assert one.map_offset is None
    assert one.offsets == stated
    slid = resolve_settings(ROCK, "one", own | {"map_offset": "0.4 mm"}, "x", PAIR)
    assert slid.map_offset == pytest.approx(0.4)
    assert slid.offsets == stated


def test_block_lengths_are_lengths_in_order():
    own = {"block_lengths": ["1 m", "200 mm"]}
    assert resolve_settings(ROCK, "one", own, "x", SCANNED).block_lengths == [200.0, 1000.0]
    assert resolve_settings(ROCK, "one", {}, "x", SCANNED).block_lengths == []


def test_loads_of_the_defaults_that_a_hardness_cannot_carry_are_left_out():
    """78 MPa are nearly all that 80 MPa carry; what a sidecar states itself stays."""
    crushed = resolve_settings(ROCK, "one", {}, "x", SCANNED)
    assert crushed.loads == [(1.0, "pressure"), (50.0, "pressure"), (1e4, "force")]
    assert crushed.map_load == (1e4, "force")
    assert crushed.dilatancy_loads == [(1.0, "pressure")]
    elastic = resolve_settings(ROCK, "one", {"material": "elastic"}, "x", SCANNED)
    assert elastic.map_load == (78.0, "pressure")
    own = {"loads": ["78 MPa"], "map_load": "78 MPa", "dilatancy_loads": ["78 MPa"]}
    assert resolve_settings(ROCK, "one", own, "x", SCANNED).loads == [(78.0, "pressure")]


def test_two_faces_are_reported_as_they_were_scanned():
    """One face that slides on its perfect match, at the offset that the study or the third says."""
    assert resolve_settings(ROCK, "one", {}, "x", PAIR).map_offset == 0.0
    assert resolve_settings(ROCK, "one", {}, "x", SCANNED).map_offset is None
    told = {"map_offset": "0.3 mm"}
    assert resolve_settings(ROCK, "one", told, "x", PAIR).map_offset == pytest.approx(0.3)
    slid = {"offsets": ["0.2 mm", "0.4 mm"]}
    assert resolve_settings(ROCK, "one", slid, "x", PAIR).map_offset == 0.0


def test_a_plane_is_opposite_to_no_pair_of_scanned_faces(study, tmp_path):
    for name in ("one.npy", "two.lower.npy", "two.upper.npy"):
        (tmp_path / name).write_text("")
    study["scans"] = str(tmp_path)
    study["defaults"]["opposite"] = "flat"
    settings = resolve_study(study, "here").settings
    assert (settings["one"].directions, settings["one"].offsets) == (["none"], [0.0])
    assert settings["two"].directions == study["defaults"]["directions"]
    assert settings["two"].opposite == "match"
