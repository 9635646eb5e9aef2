"""Constants for other codes: read back, each is the number of the card under the code's own law."""

import ast
import copy
import csv
import io
import sys
from dataclasses import dataclass
from types import SimpleNamespace
from xml.etree import ElementTree as xml

import numpy as np
import pytest
import yaml

from fractalcontact.cards.exports import ags4, geos, opengeosys, porepy
from fractalcontact.cards.exports.csv import table_of
from fractalcontact.cards.write import write_card
from fractalcontact.commands.export_constants import CODES, exported, main

#: Constants of ``porepy.SolidConstants`` with their units, as PorePy 1.10 documents them.
SOLID = {
    "density": "kg * m^-3",
    "biot_coefficient": "-",
    "dilation_angle": "rad",
    "fracture_gap": "m",
    "fracture_normal_stiffness": "Pa * m^-1",
    "fracture_tangential_stiffness": "Pa * m^-1",
    "friction_coefficient": "-",
    "lame_lambda": "Pa",
    "maximum_elastic_fracture_opening": "m",
    "residual_aperture": "m",
    "shear_modulus": "Pa",
}
K_NI, V_M, PRESSURE = 14.2, 0.31, np.array([0.25, 1.0, 5.0, 25.0])  # MPa/mm, mm, MPa


def closure(pressure):
    """Hyperbola of the card, mm."""
    return pressure / (K_NI + pressure / V_M)


@pytest.fixture(scope="module")
def card(cards):
    """A card whose hyperbola, apertures and stiffness are known."""
    made = copy.deepcopy(cards["pair"])
    for key, value in (("k_ni", K_NI), ("v_m", V_M)):
        entry = made["entries"][key]
        entry.pop("missing", None)
        entry.pop("note", None)
        entry |= {"value": value, "low": 0.9 * value, "high": 1.1 * value, "determined": True}
    for key, factor in (("mean_gap", 1.0), ("hydraulic_aperture", 0.5)):
        made["entries"][key] = {
            "title": key,
            "section": "aperture",
            "unit": "mm",
            "model": "elastic",
            "at_units": {"pressure": "MPa"},
            "values": [
                {
                    "at": {"pressure": at},
                    "value": factor * float(1 - closure(at)),
                    "low": None,
                    "high": None,
                }
                for at in PRESSURE.tolist()
            ],
        }
    made["geometry"]["reference_pressure"]["value"] = 5.0
    made["entries"]["interface_stiffness"]["values"] = [
        {
            "at": {"pressure": at},
            "value": K_NI * (1 + at / (K_NI * V_M)) ** 2,
            "low": None,
            "high": None,
        }
        for at in (1.0, 5.0, 10.0)
    ]
    return made


def solid_of(text):
    """Keywords that the file for PorePy passes to a class of its documented ones."""

    @dataclass(kw_only=True)
    class Solid:
        name: str
        constants: dict

    def made(*, name, **constants):
        assert constants.keys() <= SOLID.keys()
        return Solid(name=name, constants=constants)

    module = SimpleNamespace(SolidConstants=made)
    known, sys.modules["porepy"] = sys.modules.get("porepy"), module
    try:
        space = {}
        exec(compile(text, "constants.py", "exec"), space)
    finally:
        sys.modules.pop("porepy")
        if known:
            sys.modules["porepy"] = known
    return space["solid"]


def test_porepy_gets_the_hyperbola_of_the_card_in_its_own_law(card):
    solid = solid_of(porepy.text_of(card))
    assert solid.name == "pair"
    largest = solid.constants["maximum_elastic_fracture_opening"]
    stiffness = solid.constants["fracture_normal_stiffness"]
    traction = 1e6 * PRESSURE
    # Its class BartonBandis: opening less under a compressive traction, m.
    opening = largest - traction * largest / (largest * stiffness + traction)
    np.testing.assert_allclose(1e3 * (largest - opening), closure(PRESSURE), rtol=1e-12)
    modulus, poisson = (card["entries"][key]["value"] for key in ("modulus", "poisson"))
    shear, lame = (solid.constants[key] for key in ("shear_modulus", "lame_lambda"))
    assert shear * (3 * lame + 2 * shear) / (lame + shear) == pytest.approx(1e6 * modulus)
    assert lame / (2 * (lame + shear)) == pytest.approx(poisson)


def test_every_key_named_for_porepy_is_one_that_it_has(card):
    found = porepy.constants_of(card)
    assert {*found.values, *found.left_out} <= SOLID.keys()
    assert not set(found.values) & set(found.left_out)


def test_geos_gets_the_opening_of_the_hyperbola_and_the_table_of_apertures(card):
    root = xml.fromstring(geos.text_of(card))
    law = root.find("Constitutive/BartonBandis")
    zero, reference = (float(law.get(k)) for k in ("referenceAperture", "referenceNormalStress"))
    opening = zero / (1 + 9 * 1e6 * PRESSURE / reference)
    np.testing.assert_allclose(1e3 * opening, V_M - closure(PRESSURE), rtol=1e-4)
    table = root.find("Functions/TableFunction")
    name = root.find("Constitutive/HydraulicApertureTable").get("apertureTableName")
    assert name == table.get("name")
    mean, hydraulic = (
        np.array([float(one) for one in table.get(key).strip("{ }").split(",")])
        for key in ("coordinates", "values")
    )
    assert (np.diff(mean) > 0).all()
    np.testing.assert_allclose(hydraulic, 0.5 * mean, rtol=1e-4)
    np.testing.assert_allclose(1e3 * mean[::-1], 1 - closure(PRESSURE), rtol=1e-4)


def test_geos_says_which_law_to_take_and_how_far_the_other_is_off(card):
    text = geos.text_of(card)
    assert "take ONE of the two laws: pair_table" in text
    opening = V_M - closure(5.0)  # mm; the table has half of the mean gap
    ratio = float(text.partition("BartonBandis, is ")[2].split()[0])
    assert ratio == pytest.approx(opening / (0.5 * (1 - closure(5.0))), rel=0.02)
    alone = copy.deepcopy(card)
    alone["entries"]["hydraulic_aperture"] = {"missing": "not solved", "unit": "mm"}
    assert "take ONE" not in geos.text_of(alone)


_NAMES = ("stiffness-normal", "stiffness-shear", "friction", "dilation")
#: Command of each code of Itasca, and the names of the constants behind it.
ITASCA = {
    "3dec": ("block contact property", *_NAMES),
    "flac3d": ("zone interface node property", *_NAMES),
    "udec": ("prop jmat=1", "jkn", "jks", "jfric", "jdil"),
}
TAU, ANGLE, JRC = 6.0, 12.0, 10.0  # MPa, degrees, 1


@pytest.fixture(scope="module")
def sheared(card):
    """The card with a known strength, dilatancy angle and JRC."""
    made = copy.deepcopy(card)
    known = (("peak_strength", TAU, "MPa"), ("peak_dilatancy_angle", ANGLE, "degree"))
    for key, value, unit in known:
        rows = [
            {"at": {"pressure": at}, "value": value * at / 5, "low": None, "high": None}
            for at in (1.0, 5.0, 10.0)
        ]
        made["entries"][key] = {"title": key, "unit": unit, "model": "elastic", "values": rows}
    at = {"sampling": "1.27 mm", "direction": made["direction"], "step": 1.2}
    made["entries"]["jrc"] = {"title": "JRC", "values": [{"at": at, "value": JRC}]}
    made["geometry"] |= {f"window_{axis}": {"value": 50.0, "unit": "mm"} for axis in "xy"}
    return made


@pytest.mark.parametrize("code", ITASCA)
def test_codes_of_itasca_get_a_coulomb_joint_of_the_reference_load(sheared, code):
    command, normal, shear, friction, dilation = ITASCA[code]
    lines = exported(sheared, code).splitlines()
    commands = [line for line in lines if not line.startswith(";")]
    (assigned,) = (line for line in commands if line.startswith(command))
    words = assigned.removeprefix(command).split()
    values = dict(zip(words[::2], map(float, words[1::2]), strict=True))
    assert values[normal] == pytest.approx(1e9 * K_NI * (1 + 5 / (K_NI * V_M)) ** 2, rel=1e-3)
    assert np.tan(np.radians(values[friction])) == pytest.approx(TAU / 5, rel=1e-3)
    assert values[dilation] == pytest.approx(ANGLE, rel=1e-3)
    # Barton and Bandis 1990: peak displacement L/500 (JRC/L)^0.33, L in m.
    displacement = 0.05 / 500 * (JRC / 0.05) ** 0.33
    assert values[shear] == pytest.approx(1e6 * TAU / displacement, rel=1e-3)
    assert [line for line in lines if line.startswith(f"; {shear}: ") and "NOT COMPUTED" in line]
    # Versions of UDEC with these names know no table by its name.
    table = "; table 'pair_" if code == "udec" else "table 'pair_"
    tables = [line for line in lines if line.startswith(table)]
    assert len(tables) == 2
    points = tables[0].split(" add ")[1].split()
    pairs = [tuple(map(float, one.strip("()").split(","))) for one in points]
    expected = [(1e6 * at, 1e9 * K_NI * (1 + at / (K_NI * V_M)) ** 2) for at in (1.0, 5.0, 10.0)]
    np.testing.assert_allclose(pairs, expected, rtol=1e-3)


def test_a_joint_without_strength_or_roughness_has_no_shear_stiffness(sheared):
    made = copy.deepcopy(sheared)
    made["entries"]["jrc"]["values"][0]["value"] = 25.0
    text = exported(made, "3dec")
    assert "left out: stiffness-shear: not computed; the empirical rule needs a JRC" in text
    made["entries"]["peak_strength"] = {"unit": "MPa", "missing": "nothing slides"}
    text = exported(made, "udec")
    assert "left out: jfric: peak strength at 5 MPa: nothing slides" in text
    assert "prop jmat=1 jkn " in text


def test_dfnworks_gets_the_hydraulic_aperture_in_metres(card):
    space = {}
    exec(exported(card, "dfnworks"), space)
    assert space["aperture"] == pytest.approx(0.5e-3 * (1 - closure(5.0)))
    assert list(space["apertures"]) == PRESSURE.tolist()
    made = copy.deepcopy(card)
    for row in made["entries"]["hydraulic_aperture"]["values"]:
        row |= {"determined": False, "note": "suspicious cells"}
    text = exported(made, "dfnworks")
    assert "# left out: aperture: hydraulic aperture at 5 MPa is undetermined" in text
    assert "apertures = {}" in text


def test_opengeosys_gets_a_stiffness_and_the_aperture_under_the_same_pressure(card):
    root = xml.fromstring(opengeosys.text_of(card))
    values = {one.findtext("name"): float(one.findtext("value")) for one in root.iter("parameter")}
    stiffness = values[root.findtext("fracture_model/normal_stiffness")]
    assert 1e-9 * stiffness == pytest.approx(K_NI * (1 + 5 / (K_NI * V_M)) ** 2, rel=1e-4)
    aperture = values[root.findtext("fracture_properties/initial_aperture")]
    assert 1e3 * aperture == pytest.approx(1 - closure(5.0), rel=1e-4)


def test_ags4_is_groups_of_quoted_fields_with_the_card_s_roughness(card):
    text = ags4.text_of(card)
    assert text.isascii()
    assert text.endswith("\r\n")
    groups, heading = {}, []
    for row in csv.reader(io.StringIO(text)):
        if row and row[0] == "GROUP":
            groups[name := row[1]] = []
        elif row and row[0] == "HEADING":
            heading = row[1:]
        elif row:
            assert len(row) == len(heading) + 1
            groups[name].append((row[0], dict(zip(heading, row[1:], strict=True))))
    assert set(groups) == {"PROJ", "TRAN", "LOCA", "DISC", "UNIT", "TYPE"}
    (disc,) = (fields for kind, fields in groups["DISC"] if kind == "DATA")
    assert disc["LOCA_ID"] == "pair"
    assert float(disc["DISC_APT"]) == pytest.approx(1 - closure(5.0), rel=1e-2)
    rows = card["entries"]["jrc"]["values"]
    wanted = [
        row["value"]
        for row in rows
        if row["at"]["sampling"] == "1.27 mm" and row["at"]["direction"] == card["direction"]
    ]
    kept = wanted and 0 <= wanted[0] <= 20
    assert disc["DISC_JRC"] == (f"{wanted[0]:.0f}" if kept else "")


def test_a_table_has_every_number_once_with_unit_and_model(card):
    table = table_of(card)
    count = sum(len(entry.get("values", [0])) for entry in card["entries"].values())
    assert len(table) == count
    assert (table["unit"] != "").all()
    assert (table["model"] != "").all()
    assert (table["value"].notna() ^ (table["missing"] != "")).all()


def test_what_is_undetermined_is_left_out_with_its_reason(card):
    made = copy.deepcopy(card)
    made["entries"]["k_ni"] |= {"determined": False, "note": "the hyperbola misses the curve"}
    assert "fracture_normal_stiffness" not in porepy.constants_of(made).values
    assert "misses the curve" in porepy.text_of(made)
    assert xml.fromstring(geos.text_of(made)).find("Constitutive/BartonBandis") is None


@pytest.mark.parametrize("code", CODES)
@pytest.mark.parametrize("name", ["pair", "flat.1"])
def test_a_card_without_constants_is_still_written_and_read(cards, name, code):
    text = exported(cards[name], code)
    if code == "porepy":
        ast.parse(text)
    elif code in ("geos", "opengeosys"):
        xml.fromstring(text)
    assert name in text


def test_the_command_writes_a_file_or_says_what_is_no_card(tmp_path, card, capsys):
    write_card(card, tmp_path)
    out = tmp_path / "pair.py"
    arguments = [str(tmp_path / "cards/pair.yaml"), "--to", "porepy", "--out", str(out)]
    assert main(arguments) == 0
    assert out.read_text() == porepy.text_of(card)
    assert main([str(tmp_path / "none.yaml"), "--to", "csv"]) == 1
    assert "expected a card" in capsys.readouterr().err
    out.with_name("file").write_text("no folder")
    assert main([*arguments[:-1], str(out.with_name("file") / "pair.py")]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("error: ")
    assert "cannot be written" in line


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"study": None}, "study: None is not of type 'string'"),
        ({"trust": {}}, "trust: 'word' is a required property"),
        ({"entries": {"k_ni": {}}}, "entries.k_ni"),
    ],
)
def test_a_card_that_is_not_whole_is_refused_in_one_line(tmp_path, card, capsys, change, words):
    write_card(card, tmp_path)
    path = tmp_path / "cards/pair.yaml"
    path.write_text(yaml.safe_dump(dict(card) | change))
    for code in CODES:
        assert main([str(path), "--to", code]) == 1
        (line,) = capsys.readouterr().err.splitlines()
        assert "pair.yaml: no whole card: " in line
        assert words in line
    path.write_text(yaml.safe_dump({key: card[key] for key in card if key != "study"}))
    assert main([str(path), "--to", "csv"]) == 1
    assert "'study' is a required property" in capsys.readouterr().err
