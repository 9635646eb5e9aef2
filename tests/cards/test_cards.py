"""Cards of joints: of the stated form, the atlas's numbers, each with unit, interval and model."""

import json
import re
from html.parser import HTMLParser

import jsonschema
import numpy as np
import pytest
import xarray as xr
from code_blocks import run_code
from made_tests import PART
from page_study import HOSTILE

from fractalcontact.cards import page
from fractalcontact.cards.card import _by_source, geometry_of, is_synthetic
from fractalcontact.cards.entries import entries, entry_of, number, row_at
from fractalcontact.cards.methods import _contact, _laws, scan_words
from fractalcontact.cards.page import page_of, permeability_words
from fractalcontact.cards.write import SCHEMA, read_card, write_card
from fractalcontact.core.errors import InputError
from fractalcontact.core.estimate import Estimate
from fractalcontact.core.labels import BOUNDARIES, printable
from fractalcontact.core.subject import Subject
from fractalcontact.core.text import with_unit
from fractalcontact.laws.strength import OFF_LENGTHS
from fractalcontact.report.published import Number, Row
from fractalcontact.study.atlas import read_atlas

NAMES = ("flat.1", "pair")


@pytest.fixture(scope="module")
def subjects(folder):
    atlas = read_atlas(folder / "atlas.nc")
    return {name: Subject.of(atlas, name) for name in NAMES}


def numbers_of(card):
    """Every number of a card with the entry that it stands in."""
    for key, entry in card["entries"].items():
        for row in entry.get("values", [entry]):
            yield key, entry, row


@pytest.mark.parametrize("name", NAMES)
def test_a_card_is_of_the_stated_form_in_both_files(folder, cards, name):
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.Draft202012Validator(schema).validate(cards[name])
    assert json.loads((folder / f"cards/{name}.json").read_text(encoding="utf-8")) == cards[name]


def test_the_form_refuses_a_number_without_unit_model_or_reason(cards):
    validator = jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text(encoding="utf-8")))
    for key in ("unit", "model", "title"):
        broken = json.loads(json.dumps(cards["pair"]))
        del broken["entries"]["delta_g"][key]
        assert not validator.is_valid(broken)
    broken = json.loads(json.dumps(cards["pair"]))
    broken["entries"]["grasselli"]["missing"] = ""
    assert not validator.is_valid(broken)


@pytest.mark.parametrize("name", NAMES)
def test_every_number_has_a_unit_a_model_and_an_interval_around_it_or_a_reason(cards, name):
    assert set(cards[name]["entries"]) == {row.name for row in entries()}
    known = 0
    for _, entry, row in numbers_of(cards[name]):
        assert entry["unit"]
        assert entry["model"]
        if "missing" in row:
            assert len(row["missing"]) > 8
            continue
        known += 1
        assert np.isfinite(row["value"])
        if row["low"] is not None:
            assert row["low"] <= row["value"]
            # A ratio has no upper end where the measured value may be 0.
            assert row["high"] is None or row["value"] <= row["high"]
            assert entry["interval"]
    assert known > 20


def test_tests_and_grasselli_s_parameters_stand_on_the_card(folder, cards):
    """Measured is 0.9 of what is computed; the surface against a plane has neither."""
    entries = cards["pair"]["entries"]
    for key in ("closure_over_measured", "dilatancy_over_measured"):
        (row,) = entries[key]["values"]
        assert row["value"] == pytest.approx(1 / PART, rel=0.02), key
    page = (folder / "cards/pair.html").read_text(encoding="utf-8")
    assert "Laboratory tests" in page
    assert "Grasselli, towards" in page
    (row,) = entries["grasselli"]["values"]
    law = [entries[f"grasselli_{name}"]["values"][0]["value"] for name in ("theta_max", "c")]
    assert row["value"] == pytest.approx(law[0] / (law[1] + 1), rel=1e-4)
    assert "Laboratory tests" not in (folder / "cards/flat.1.html").read_text(encoding="utf-8")
    assert "missing" in cards["flat.1"]["entries"]["grasselli"]


def test_a_fit_has_its_range_and_says_whether_it_determines_its_number(cards, subjects):
    for name, card in cards.items():
        closure = subjects[name].states("closure")
        for key in ("k_ni", "v_m"):
            found = card["entries"][key]
            assert found["range"]["low"] == pytest.approx(float(closure["seating_pressure"]))
            if "value" in found:
                says = bool(subjects[name]["error_budget"]["k_ni_determined"])
                assert found["determined"] <= says
                assert says or found["note"]


def test_what_does_not_slide_has_no_strength_and_says_so(cards):
    for key in ("jrc", "peak_strength", "barton_strength"):
        assert "values" not in cards["flat.1"]["entries"][key]
        assert "slid" in cards["flat.1"]["entries"][key]["missing"]


def test_of_several_possible_reasons_a_card_prints_the_one_that_holds(subjects):
    pair, flat = subjects["pair"], subjects["flat.1"]
    by_key = {row.name: row for row in entries()}

    def stated(**material):
        settings = pair.settings | {"material": pair.settings["material"] | material}
        return Subject(pair.stages, settings, "pair")

    for subject, key, reason in (
        (flat, "barton_strength", "nothing slides: one face given, against a rigid plane"),
        (stated(joint_wall_strength=None), "barton_strength", "no joint wall strength is stated"),
        (
            stated(basic_friction_angle=float("nan")),
            "peak_strength",
            "no basic friction angle is stated",
        ),
    ):
        assert entry_of(by_key[key], subject, "elastic")["missing"] == reason
    known = stated(joint_wall_strength=80.0, basic_friction_angle=30.0)
    rough = {"barton_scaled_strength": pair["strength"]["barton_scaled_strength"] * np.nan}
    known = Subject(
        dict(known.stages) | {"strength": pair["strength"].assign(rough)}, known.settings, "pair"
    )
    rows = entry_of(by_key["barton_scaled_strength"], known, "elastic")["values"]
    # The window of the pair is shorter than any joint that the law was measured on.
    assert {row["missing"] for row in rows} <= {
        OFF_LENGTHS,
        "not solved under this load",
    }


def test_numbers_of_contact_name_the_model_that_they_are_of(cards, subjects):
    for name, card in cards.items():
        hardness = subjects[name].settings["material"]["hardness"]
        assert card["model"] == ("elastic" if np.isinf(hardness) else card["model"])
        assert card["entries"]["k_ni"]["model"] == card["model"]
        assert card["entries"]["delta_g"]["model"] == "geometry"


def test_a_card_is_as_trusted_as_its_worst_light(cards):
    words = {"poor": "low", "partly": "limited", "good": "good"}
    for card in cards.values():
        present = [light["word"] for light in card["lights"]]
        worst = next(word for word in words if word in present)
        assert card["trust"]["word"] == words[worst]
        deciding = {light["key"]: light for light in card["lights"] if light["word"] == worst}
        cause = next(key for key in ("faces", "scan", "model", "nodes", "grid") if key in deciding)
        _, _, advice = card["trust"]["help"].rpartition("times the strength by Barton's law); ")
        assert advice == deciding[cause]["help"]
        assert card["trust"]["reason"].startswith(deciding[cause]["title"])


class Cells(HTMLParser):
    """Tags and texts of a page."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.texts = [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data):
        self.texts.append(data)


@pytest.mark.parametrize("name", NAMES)
def test_the_page_prints_the_numbers_of_the_card_and_asks_for_nothing(folder, cards, name):
    page = Cells((folder / f"cards/{name}.html").read_text(encoding="utf-8"))
    text = " ".join(page.texts)
    assert not [tag for tag, _ in page.tags if tag in ("script", "img")]
    assert "MPa/mm" in text
    assert f"Trust: {cards[name]['trust']['word']}" in text
    assert cards[name]["methods"] in text
    tables = page_of(cards[name])["tables"]
    assert tables
    for at, row in (row for _, _, rows in tables for row in rows):
        assert f"{at:g}" in text
        assert all("value" in one or "missing" in one for one in row)


def test_a_hostile_label_is_text_on_the_page_and_in_the_files(folder, cards):
    assert cards["pair"]["label"] == printable(HOSTILE)
    assert "<script>alert" not in (folder / "cards/pair.html").read_text(encoding="utf-8")


def test_methods_name_versions_and_references_of_what_they_say(cards):
    for card in cards.values():
        assert f"fractalcontact {card['versions']['fractalcontact']}" in card["methods"]
        years = set(re.findall(r"\d{4}(?=\))", card["methods"]))
        cited = " ".join(card["references"])
        assert years
        assert all(f"({year})" in cited for year in years)


def test_what_is_no_card_is_refused_in_a_sentence(tmp_path):
    for text in ("a: 1", "[1, 2]", "form: 2\nentries: {}", "a: [", "\x00"):
        path = tmp_path / "card.yaml"
        path.write_text(text, encoding="utf-8")
        with pytest.raises(InputError, match="card"):
            read_card(path)
    with pytest.raises(InputError, match="cannot be read"):
        read_card(tmp_path / "none.yaml")


def test_the_documented_lines_read_a_card(tmp_path, cards, monkeypatch):
    write_card(cards["pair"] | {"name": "small_twin"}, tmp_path / "results/smoke")
    monkeypatch.chdir(tmp_path)
    assert run_code("docs/card.md")["card"]["entries"] == cards["pair"]["entries"]


def test_the_window_of_oblong_cells_has_its_own_sides(subjects):
    pair = subjects["pair"]
    sides = {"spacing_y": 0.25, "spacing_x": 0.1, "window_ny": 40, "window_nx": 30}
    oblong = {**pair.stages, "specimens": pair["specimens"].assign_attrs(sides)}
    found = geometry_of(Subject(oblong, pair.settings, pair.name))
    lengths = [found[name]["value"] for name in ("window_x", "window_y", "spacing")]
    assert lengths == [3.0, 10.0, 0.25]


def test_what_a_study_makes_itself_is_synthetic_and_a_scan_of_a_like_name_is_not(cards):
    study = {"embedded": {"granite": {}}}
    assert is_synthetic("granite", study)
    assert not is_synthetic("granite_b", study)
    assert not is_synthetic("granite", {})
    assert not cards["pair"]["synthetic"]


def curve(section="strength", unit="MPa", **values):
    """Entry of a card over pressures, MPa: numbers, or the reasons why they are missing."""
    rows = [
        {"at": {"pressure": float(at[1:])}, **({"missing": one} if isinstance(one, str) else one)}
        for at, one in values.items()
    ]
    return {"title": f"title of {section}", "section": section, "unit": unit, "values": rows}


def of(value, low=None, high=None):
    return {"value": value, "low": low, "high": high}


def test_a_row_of_an_entry_is_that_of_the_pressure_itself():
    entry = curve(p1=of(2.0), p5=of(3.0))
    assert row_at(entry, 5.0)["value"] == 3
    assert row_at(entry, 2.0) == {"missing": "not solved there"}
    assert row_at({"missing": "it does not slide"}, 2.0) == {"missing": "it does not slide"}


def test_the_misfit_of_a_law_is_noted_where_its_number_is_determined():
    keys = {"all": True, "misfit": "closure/misfit", "range": ("closure/a", "closure/b")}
    row = Row("k", "k", "closure/k", "mm", **keys)
    subject = Subject({"closure": xr.Dataset({"misfit": 0.021})}, {})
    known, wide = Estimate(1.0, 0.9, 1.1), Estimate(1.0, 0.1, 9.0, reason="too wide")
    assert number(row, subject, Number({}, known))["note"] == "misses the curve by 2.1 %"
    assert number(row, subject, Number({}, wide, determined=False))["note"] == "too wide"


def test_two_rules_for_the_strength_have_a_range_in_the_first_column():
    rules = {"peak_strength": curve(p1=of(3.0)), "barton_strength": curve(p1=of(2.0), p5="none")}
    ((title, heads, rows),) = page._tables(rules)
    assert title == "Shear strength"
    assert heads[0] == ("peak τ, range of all rules", "MPa")
    assert page.in_words(rows[0][1][0]) == "2 to 3"
    assert page.in_words(rows[1][1][0]) == "–"
    alone = {"peak_strength": curve(p1=of(3.0))}
    ((_, heads, _),) = page._tables(alone)
    assert len(heads) == 1


def test_what_is_missing_at_some_pressures_is_listed_in_part():
    entries = {"a": curve(p1=of(3.0), p5="too few nodes"), "b": curve("aperture", p1="no flow")}
    assert page.missing_of(entries) == {
        "too few nodes": ["title of strength (in part)"],
        "no flow": ["title of aperture"],
    }


def test_a_fraction_has_the_digits_of_its_interval():
    assert page.in_words(of(0.12345) | {"unit": "1"}) == "12"
    assert page.in_words(of(0.12345, 0.12, 0.13) | {"unit": "1"}) == "12.3"


def test_errors_that_are_rounding_are_zero_and_unknown_ones_are_left_out():
    errors = xr.DataArray(
        [[1e-12, 0.5, np.nan]],
        coords={"quantity": ["gap"], "source": ["solver", "numerical", "window"]},
        dims=("quantity", "source"),
    )
    found = _by_source(xr.Dataset({"error": errors}), "gap", 2.0)
    assert found == {"solver": 0.0, "numerical": 0.5}
    assert _by_source(xr.Dataset({"error": errors}), "other", 2.0) == {}


def test_the_permeability_has_its_range_and_says_what_is_undetermined():
    def curve(value, determined):
        ends = {"low": 0.9 * value, "high": 1.1 * value, "determined": determined}
        branches = ("load", "unload", "reload")
        values = [{"at": {"branch": branch}, "value": value} | ends for branch in branches]
        values[2] = {"at": {"branch": "reload"}, "missing": "a free window"}
        return {"range": {"low": 1.0, "high": 10.0, "unit": "MPa"}, "values": values}

    entries = {
        "permeability_k_0": curve(2e-4, True),
        "permeability_alpha": curve(0.04, False),
    }
    words = permeability_words(entries)
    assert "from 1 to 10 MPa" in words
    assert "on loading k_0 = 0.0002 [0.000180, 0.000220], alpha = undetermined" in words
    assert "reloading" not in words
    assert permeability_words({}) == ""


def test_methods_name_the_laws_that_were_fitted():
    range_of = {"range": {"low": 0.25, "high": 10.0}}
    entries = {"k_ni": {"missing": "too few states"}, "chi": {"value": 1.0} | range_of}
    assert _laws({"entries": entries}).startswith("A logarithm (Bandis et al. 1983) was fitted")
    entries["k_ni"] = {"value": 2.0} | range_of
    assert _laws({"entries": entries}).startswith("A hyperbola and a logarithm")
    entries = {name: {"missing": "too few states"} for name in ("k_ni", "chi")}
    assert _laws({"entries": entries}) == "No closure law was fitted: too few states."


def test_a_card_is_written_whole(tmp_path, cards):
    write_card(cards["pair"], tmp_path)
    assert read_card(tmp_path / "cards/pair.json") == cards["pair"]


def test_a_card_says_what_lies_beyond_its_window_and_how_phi_b_is_known(cards):
    """In a field, in the methods, and first in what would help where phi_b is assumed."""
    for card in cards.values():
        free = card["boundary"] == BOUNDARIES["free"]
        assert ("elastic half-spaces" in card["methods"]) == free
        assert (card["boundary"] in card["methods"]) != free
        friction = card["entries"]["basic_friction_angle"]
        assumed = friction.get("note") == "assumed" and card["direction"] != "none"
        assert card["trust"]["help"].startswith("measure phi_b") == assumed
        strength = card["entries"]["barton_strength"]
        for row in strength.get("values", ()):
            if assumed and "value" in row:
                # The interval holds phi_b, 0.9 to 1.9 times, and the profiles of the face.
                assert row["low"] <= 0.9 * row["value"] * (1 + 1e-4)
                assert row["value"] <= row["high"]


def test_methods_say_what_was_read_of_the_scans(cards):
    text = cards["pair"]["methods"]
    assert re.search(r"The window is [\d.]+ % of the scan; outlying cells were kept", text)
    rows = [row["at"] for row in cards["pair"]["entries"]["jrc"]["values"]]
    step = next(at["step"] for at in rows if at["sampling"] == "1.27 mm")
    assert f"at a step of {with_unit(step, 'mm')}" in text


def test_methods_state_registration_and_the_reason_of_the_hardness():
    specimen = xr.Dataset(
        {"valid": (("y", "x"), np.ones((10, 20), bool))},
        attrs={"spacing_y": 0.5, "spacing_x": 0.5, "window_ny": 5, "window_nx": 10}
        | {"registration": '{"applied": false, "mode": "none"}'},
    )
    assert scan_words(specimen, "fill") == (
        "The window is 25 % of the scan; outlying cells were filled; the faces were not registered."
    )
    moved = {"applied": True, "mode": "rigid", "shift_x_mm": 0.25, "shift_y_mm": -0.5}
    specimen.attrs["registration"] = json.dumps(moved | {"rotation_degrees": 1.5})
    words = scan_words(specimen, "keep")
    assert (
        "(rigid) by moving it by 0.25 mm in x and \u22120.5 mm in y and turning it by 1.5" in words
    )
    stated = {key: {"value": 60.0} for key in ("modulus", "poisson", "joint_wall_strength")}
    for hardness, reason in ((60.0, "the joint wall strength"), (90.0, "stated for this joint")):
        entries = stated | {"hardness": {"value": hardness}}
        card = {"entries": entries, "model": "crushing at H = 60 MPa"}
        card["boundary"] = BOUNDARIES["free"]
        assert f"bounded by the hardness, 60 MPa, {reason}." in _contact(card)
