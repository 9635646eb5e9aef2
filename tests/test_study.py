"""A study is checked before anything runs; what is wrong is named by its key."""

import copy
import math
from pathlib import Path

import pytest
import yaml

from fractalcontact.errors import InputError
from fractalcontact.study import (
    check_study,
    read_sidecar,
    resolve_embedded,
    resolve_roll_off,
    resolve_settings,
    window_arguments,
)

ROOT = Path(__file__).parents[1]
SCHEMA = yaml.safe_load((ROOT / "config/schema/study.schema.yaml").read_text())
PAPER = yaml.safe_load((ROOT / "config/paper.yaml").read_text())


@pytest.fixture
def study():
    return copy.deepcopy(PAPER)


@pytest.mark.parametrize("name", ["paper", "smoke", "accuracy", "accuracy_small"])
def test_the_studies_that_ship_are_valid(name):
    check_study(yaml.safe_load((ROOT / f"config/{name}.yaml").read_text()), SCHEMA, name)


@pytest.mark.parametrize("change", [{"scans": "scans"}, {"embedded": {}}, {"specimens": {}}])
def test_only_a_study_without_specimens_needs_no_materials(change):
    bare = {"study": "bare", "scans": None}
    check_study(bare, SCHEMA, "bare")
    with pytest.raises(InputError, match=r"missing key 'materials'; expected materials by name"):
        check_study(bare | change, SCHEMA, "bare")


def broken(study, path, value):
    *parents, last = path
    for key in parents:
        study = study[key]
    if value is None:
        del study[last]
    else:
        study[last] = value


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (("defaults", "ofsets"), "auto", r"unknown key 'defaults.ofsets'; did you mean 'offsets'"),
        (("materials", "concrete", "modulus"), None, r"missing key 'materials.concrete.modulus'"),
        (("materials", "concrete", "modulus"), "30 mm", r"materials.concrete.modulus: '30 mm'"),
        (("materials", "concrete", "poisson"), 0.7, r"materials.concrete.poisson: 0.7"),
        (("defaults", "window"), "20 MPa", r"defaults.window: '20 MPa' is not a length"),
        (("defaults", "window"), 20, r"defaults.window: 20 is not right; expected auto, or"),
        (("defaults", "loads"), ["3 mm"], r"defaults.loads: '3 mm' is neither"),
        (("defaults", "loads"), None, r"missing key 'defaults.loads'"),
        (("defaults", "directions"), ["X"], r"defaults.directions.0: 'X' is not right; expected E"),
        (("defaults", "material"), "sandston", r"no material 'sandston'; did you mean 'sandstone'"),
        (("specimens", "concrete_twin", "map_load"), "7 kN", r"map_load: '7 kN' is not among"),
        (
            ("materials", "concrete", "basic_friction_angle"),
            "35 mm",
            r"angle: '35 mm' is not an ang",
        ),
        (("materials", "concrete", "basic_friction_angle"), "95 deg", r"an angle below 90"),
        (("materials", "concrete", "joint_wall_strength"), "40", r"strength: '40' has no unit"),
        (("roll_off", "embedded"), "sandstone", r"no embedded 'sandstone'; did you mean 'sandst"),
        (("roll_off", "embedded"), "joint_2.1", r"roll_off.embedded: joint_2.1 has no roll_off"),
        (("roll_off", "seeds"), [1], r"roll_off.seeds: \[1\]"),
        (("area_slope", "loads"), [0.5], r"area_slope.loads.0: 0.5 is not right"),
        (("speed",), {"sizes": [8]}, r"missing key 'speed.hurst'"),
        (("solver", "rtol"), "1e-6", r"solver.rtol: '1e-6' is not right; expected a number"),
        (("embedded", "concrete_twin", "size"), "4 N", r"embedded.concrete_twin.size: '4 N'"),
        (("embedded", "concrete_twin", "dimension"), 3.2, r"embedded.concrete_twin.dimension: 3.2"),
    ],
)
def test_what_is_wrong_is_one_error_that_names_the_key(study, path, value, message):
    broken(study, path, value)
    with pytest.raises(InputError, match=r"mine\.yaml: .*") as caught:
        check_study(study, SCHEMA, "mine.yaml")
    assert caught.match(message)


def test_the_sidecar_wins_over_the_study_and_the_study_over_its_defaults(study, tmp_path):
    sidecar = tmp_path / "concrete_twin.yaml"
    sidecar.write_text("unit: um\nspacing: 5\nwindow: 10 mm\n")
    scan, settings = read_sidecar(sidecar, SCHEMA)
    assert scan == {"unit": "um", "spacing": 5}
    resolved = resolve_settings(study, "concrete_twin", settings, "paper.yaml")
    assert resolved["window"] == 10
    assert resolved["material"]["name"] == "concrete"
    assert resolved["material"]["e_star"] == pytest.approx(30e3 / (2 * (1 - 0.2**2)))
    assert resolved["directions"] == ["E", "N", "W", "S"]


def test_a_sidecar_with_an_unknown_key_is_refused_by_file_and_key(tmp_path):
    sidecar = tmp_path / "mine.yaml"
    sidecar.write_text("units: mm\n")
    with pytest.raises(InputError, match=r"mine\.yaml: unknown key 'units'; did you mean 'unit'"):
        read_sidecar(sidecar, SCHEMA)


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
    scan, settings = read_sidecar(sidecar, SCHEMA)
    assert scan == {"registration": "none", "mirror_upper": "x"}
    arguments = window_arguments(resolve_settings(study, "concrete_twin", settings, "paper.yaml"))
    assert (arguments["outliers"], arguments["fill_holes"]) == ("mask", 5)
    sidecar.write_text("fill_holes: true\n")
    with pytest.raises(InputError, match="fill_holes: True is not right; expected rows and col"):
        read_sidecar(sidecar, SCHEMA)


def test_embedded_lengths_are_in_millimetres(study):
    recipe = resolve_embedded({**study["embedded"]["concrete_twin"], "size": "4 cm"}, "here")
    assert (recipe["size"], recipe["outline"]) == (40, "square")


def test_strength_of_the_material_is_missing_where_it_is_not_stated(study):
    material = resolve_settings(study, "concrete_twin", {}, "paper")["material"]
    assert (material["basic_friction_angle"], material["joint_wall_strength"]) == (35, 40)
    del study["materials"]["concrete"]["basic_friction_angle"]
    material = resolve_settings(study, "concrete_twin", {}, "paper")["material"]
    assert math.isnan(material["basic_friction_angle"])


def test_joints_with_and_without_a_roll_off_follow_an_embedded_specimen(study):
    joints = resolve_roll_off(study, "paper")
    assert joints["window"] == 20
    assert joints["recipe"]["roll_off"] == 5
    del study["roll_off"]
    assert resolve_roll_off(study, "paper") is None
