"""Each writer shows the number of the register: cards, tables, explorer, index, pages.

How the register reads the atlas is tested in ``tests/report``, tables of figures in
``tests/figures/test_contract.py``. ``RESULTS=results/paper`` takes the results of a
study that was made already.
"""

import base64
import json
import math
import os
import re
import shutil
import zlib
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fractalcontact.core.estimate import Estimate
from fractalcontact.core.subject import Subject
from fractalcontact.pages.captions import symbols
from fractalcontact.pages.explorer import write_explorer
from fractalcontact.report.published import published as rows_of_register
from fractalcontact.report.published import read, read_at, row_of, shown_in
from fractalcontact.study.atlas import read_atlas

#: Relative error of numbers in tables, on a card, and in words of three and of two digits.
TABLE, CARD, WORDS, TWO = 1e-6, 1e-5, 5.1e-3, 0.051
#: Units that pages print, in those of the register.
SIZES = {"µm": 1e-3, "nm": 1e-6, "GPa": 1e3, "GPa/mm": 1e3, "%": 0.01}
#: Titles of the first screen, by the row that each shows.
FIRST = {
    "normal stiffness": "interface_stiffness",
    "closure": "seated_closure",
    "mean gap": "mean_gap",
    "contact": "contact_fraction",
}


@pytest.fixture(scope="module")
def published(results, tmp_path_factory):
    """Folder of a study with its cards, tables, pages and explorer."""
    if os.environ.get("RESULTS"):
        return Path(os.environ["RESULTS"]).absolute()
    folder = shutil.copytree(results, tmp_path_factory.mktemp("published") / "tiny")
    write_explorer(folder / "atlas.nc", folder / "explorer.html")
    return folder


@pytest.fixture(scope="module")
def subjects(published):
    atlas = read_atlas(published / "atlas.nc")
    return [Subject.of(atlas, name) for name in sorted(atlas["specimens"].children)]


# -- what each writer shows: a row, its number in the register, and fields as shown ----------------


def of_card(folder, subject):
    card = json.loads((folder / f"cards/{subject.name}.json").read_text(encoding="utf-8"))
    names = {"population": "of_its_population", "hardest": "hardest"}
    for row in shown_in("section"):
        entry, numbers = card["entries"][row.name], read(row, subject)
        assert entry["unit"] == row.unit
        cells = entry.get("values", [entry])
        assert len(cells) == max(len(numbers), 1)
        for number, cell in zip(numbers, cells, strict=False):
            shown = {"missing": cell.get("missing", "")}
            if not number.missing:
                shown |= {end: cell[end] for end in ("value", "low", "high")}
                shown |= {field: cell.get(name) for field, name in names.items()}
                shown |= {"determined": cell["determined"]} if row.range else {}
            for key, place in cell.get("at", {}).items():
                assert agrees(place, number.at[key], CARD)
            yield row, number, shown, CARD
    errors = {one["quantity"]: one for one in card["errors"]}
    names = {"value": "value", "error": "of_this_surface", "population": "of_its_population"}
    for row in shown_in("errors"):
        shown = {field: errors[row.budget][name] for field, name in names.items()}
        yield row, read_at(row, subject), shown, CARD


def of_summary(folder, subject):
    table = pd.read_csv(folder / "summary.csv").set_index("specimen").loc[[subject.name]]
    assert len(table) >= len(subject.reported.quoted)
    for _, cells in table.iterrows():
        load = int(np.argmin(np.abs(subject.forces - cells["normal_force_N"])))
        assert cells["load_of_maps"] == (load == subject.reported.reference)
        for row in shown_in("summary"):
            several = "{" in row.summary
            numbers = read(row, subject) if several else [read_at(row, subject, load)]
            for number in numbers if not several or numbers[0].at else ():
                words = {
                    key: re.sub(r"\W+", "_", at) if isinstance(at, str) else at
                    for key, at in number.at.items()
                }
                start = row.summary.format(**words)
                unit = "" if row.unit == "1" else "_" + row.unit.replace("/", "_per_")
                fields = {"value": f"{start}{unit}"}
                if row.uncertain:
                    fields |= {end: f"{start}_{end}{unit}" for end in ("low", "high")}
                if row.budget:
                    fields |= {"error": f"{start}_error_surface{unit}"}
                    fields |= {"population": f"{start}_error_population{unit}"}
                    fields |= {"hardest": f"{start}_hardest{unit}"}
                if row.range or row.dimension:
                    fields["determined"] = f"{start}_determined"
                if row.why:
                    fields["remark"] = f"{start}_reason"
                if number.missing:  # what is no result is empty in the table
                    nothing = dict.fromkeys(("error", "population", "hardest"), math.nan)
                    number = number._replace(estimate=Estimate(), **nothing)
                yield row, number, {of: cells[name] for of, name in fields.items()}, TABLE


def of_curves(folder, subject):
    table = pd.read_csv(folder / "curves.csv")
    own = table[table["specimen"] == subject.name]
    resolved = subject.states("closure")["resolved"].values.astype(bool)
    for row in shown_in("curves"):
        cells = own[own["quantity"] == row.curves]
        points = [
            (number, enough and number.determined)
            for number, enough in zip(read(row, subject), resolved, strict=True)
            if number.estimate.known and not (row.zero and number.value == 0)
        ]
        assert len(points) == len(cells)
        assert set(cells["unit"]) <= {row.unit}
        for (number, full), cell in zip(points, cells.to_dict("records"), strict=True):
            assert cell["resolved"] == full
            assert cell["nominal_pressure_MPa"] == pytest.approx(number.at["pressure"])
            yield row, number, {end: cell[end] for end in ("value", "low", "high")}, TABLE


def of_explorer(folder, subject):
    page = (folder / "explorer.html").read_text(encoding="utf-8")
    index = json.loads(re.search(r'id="index">(.*?)</script>', page)[1])
    names = [one["name"] for one in index["specimens"]]
    if subject.name not in names:
        return
    start = f'id="states-{names.index(subject.name)}">'
    states = json.loads(re.search(rf"{start}(.*?)</script>", page, re.DOTALL)[1])
    packed = np.frombuffer(zlib.decompress(base64.b64decode(states["numbers"])), np.uint8)
    values = packed.reshape(8, -1).T.copy().view("<f8").ravel()
    reported = subject.reported
    place = {
        name: int(np.argmin(np.abs(np.subtract(states[name], getattr(reported, name)))))
        for name in ("offset", "resolution")
    }
    place["direction"] = states["direction"].index(reported.direction)

    def index_of(key, load):
        entry = states["arrays"][key]
        index = [(place | {"normal_force": load})[dim] for dim in entry["dims"]]
        return np.ravel_multi_index(index, entry["shape"])

    def at(key, load):
        """Number at the reported state under a load; NaN of an array that the page lacks."""
        entry = states["arrays"].get(key)
        if entry is None:
            return np.nan
        return values[entry["start"] + index_of(key, load)]

    # Where nothing slides there is no dilatancy, and no error of it.
    slides = "total/dilatancy/elastic_dilatancy" in states["arrays"]
    assert slides == (subject.direction != "none")
    solved = subject.states("closure")["solved"].values
    for row in shown_in("explorer"):
        for load, number in enumerate(read(row, subject)):
            shown = {"value": at(row.source, load)}
            if f"total/{row.source}" in states["arrays"]:
                shown["error"] = at(f"total/{row.source}", load)
            if row.dimension and number.estimate.known:
                shown["determined"] = not at(f"undetermined/{row.source}", load)
            elif row.by_scan:
                assert row.source in states["of_joint"]
                masks = ["by_scan", "at_touch"][: 1 + row.from_touch]
                shown["determined"] = not any(at(f"undetermined/{mask}", load) for mask in masks)
                most = states["most"].get(row.source, math.inf) * abs(shown["value"])
                shown["determined"] &= not shown.get("error", math.nan) > most
            if row.reason and not math.isfinite(number.value) and solved[load]:
                reasons = states["reasons"][row.source]
                shown["missing"] = reasons["words"][reasons["places"][index_of(row.source, load)]]
            yield row, number, shown, TABLE


class Cells(HTMLParser):
    """Rows of the tables of a page: texts of the cells; and of each its attributes and parts."""

    def __init__(self, path):
        super().__init__()
        self.rows, self.inside = [], False
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        if tag == "tr":
            self.rows.append([])
        elif tag == "td":
            self.rows[-1].append({"text": "", "parts": [], **dict(attrs)})
            self.inside = True
        elif tag == "span" and self.inside and "data-load" in dict(attrs):
            self.rows[-1][-1]["parts"].append({"text": "", **dict(attrs)})
        elif tag in ("small", "br") and self.inside:
            self.handle_data(" ")

    def handle_endtag(self, tag):
        self.inside = self.inside and tag != "td"

    def handle_data(self, data):
        if self.inside:
            cell = self.rows[-1][-1]
            for whole in (cell, *cell["parts"][-1:]):
                whole["text"] += data


def number_of(words):
    """The number that words such as "−84.1 µm" begin with, in the units of the register."""
    number, unit = re.match(r"([−\d.e+-]+)(?: ([^\s):]+))?", words).groups()
    return float(number.replace("−", "-")) * SIZES.get(unit, 1.0)


def plain(words):
    """Words as a page prints them, without marks."""
    return re.sub("<[^>]+>", "", symbols(words))


def of_index(folder, subject):
    rows = {
        cells[0].get("data-sort"): cells for cells in Cells(folder / "index.html").rows if cells
    }
    cells = {cell.get("data-name"): cell for cell in rows[subject.name]}
    pressures = cells["Nominal pressure"]["parts"]
    own = {"Mean pressure in contact": "sigma_n"} | {
        one.index: one.name for one in shown_in("index")
    }
    for title, name in own.items():
        row = row_of(name)
        for part, pressure in zip(cells[plain(title)]["parts"], pressures, strict=True):
            if not pressure["text"]:
                assert not part["text"]  # no load of this specimen
                continue
            of_loads = subject["closure"]["nominal_pressure"].values
            load = int(np.argmin(np.abs(of_loads - float(pressure["data-sort"]))))
            number = read_at(row, subject, load)
            shown, zero = {"sorted": part["data-sort"]}, row.zero and number.value == 0
            if (
                number.determined
                and not number.missing
                and not zero
                and math.isfinite(number.value)
            ):
                yield row, number, {"value": number_of(part["text"])}, WORDS
                if row.budget and not row.dimension and "±" in part["text"]:
                    error = part["text"].partition("± ")[2].partition(" whole")[0]
                    size = number.value if "%" in error[:8] else 1.0
                    yield row, number, {"error": abs(number_of(error) * size)}, TWO
            elif row.budget and (number.missing or zero):
                shown["dash"] = part["text"][:1]
            elif math.isfinite(number.value) and not number.missing:
                shown["undetermined"] = part["text"][:12]
            yield row, number, shown, TABLE


def of_page(folder, subject):
    rows = [cells for cells in Cells(folder / f"pages/{subject.name}.html").rows if cells]
    cells = {row[0]["text"]: [cell["text"] for cell in row[1:]] for row in rows}
    for row in shown_in("page"):
        several = "{" in row.page
        for number in read(row, subject) if several else [read_at(row, subject)]:
            title = plain(row.page.format(**number.at))
            (words,) = (found for name, found in cells.items() if name.startswith(title))
            zero = row.zero and number.value == 0
            if number.missing or zero:
                yield row, number, {"none": words[0]}, TABLE
            elif not math.isfinite(number.value):
                assert words[0].startswith("–")
            elif not number.determined:
                assert words[0].startswith("undetermined (")
                inside = words[0].removeprefix("undetermined (")
                ends = row.budget and not row.dimension
                shown = {"value": number_of(inside)} if ends else {}
                yield row, number, shown, WORDS
            else:
                yield row, number, {"value": number_of(words[0])}, WORDS
            if row.budget and not row.dimension and number.determined and not number.missing:
                errors = zip(("error", "population"), words[1:], strict=False)
                for field, said in errors if not zero else ():
                    if math.isfinite(getattr(number, field)):
                        said = said.removeprefix("± ")
                        size = abs(number.value) if said.partition(";")[0].endswith("%") else 1.0
                        assert said.partition(";")[0].endswith("%") != row.signed
                        yield row, number, {field: number_of(said) * size}, TWO


def of_first_screen(folder, subject):
    html = (folder / "index.html").read_text(encoding="utf-8")
    block = re.search(rf'id="joint-{re.escape(subject.name)}">(.*?)</article>', html, re.DOTALL)[1]
    facts = dict(re.findall(r"<dt>([^<]*?)(?: at [^<]* MPa)?</dt><dd>(.*?)</dd>", block))
    # Of a joint that slides, roughness and strength stand in place of the contact.
    first = {title: name for title, name in FIRST.items() if title in facts}
    assert len(first) == (4 if subject.direction == "none" else 3)
    for title, name in first.items():
        words = re.sub("<[^>]+>", "|", facts[title]).strip("|")
        if "counted from first touch" in words:
            name = "interface_closure"
        number = read_at(row_of(name), subject)
        if number.missing:
            assert words.startswith(f"–||{plain(number.missing)}")
        else:
            assert words.startswith("undetermined") != number.determined
            value = words.removeprefix("undetermined").strip("|").partition("|")[0]
            yield row_of(name), number, {"value": number_of(value)}, WORDS


#: Writers, and how many numbers of a study they show at least.
WRITERS = {
    "card": (of_card, 300),
    "summary.csv": (of_summary, 300),
    "curves.csv": (of_curves, 40),
    "explorer": (of_explorer, 200),
    "index": (of_index, 60),
    "page": (of_page, 40),
    "first screen": (of_first_screen, 6),
}


def expected(row, number, field):
    """A field of a number as the register has it."""
    texts = {
        "sorted": number.value if number.determined and not number.missing else math.nan,
        "dash": "–",
        "undetermined": "undetermined",
        "none": f"none ({plain(number.missing or row.zero)})",
    }
    if field in texts:
        return texts[field]
    return getattr(number.estimate if field in ("low", "high") else number, field)


def agrees(shown, wanted, digits):
    """True if a shown value is the register's; a missing one is empty in files."""
    if isinstance(wanted, str):
        return ("" if shown is None or shown != shown else shown) == wanted
    if isinstance(wanted, bool | np.bool_):
        return bool(shown) == bool(wanted)
    shown = math.nan if shown in (None, "") else float(shown)
    if not math.isfinite(wanted):
        return not math.isfinite(shown)
    return math.isclose(shown, wanted, rel_tol=digits, abs_tol=1e-12)


@pytest.mark.parametrize("writer", WRITERS)
def test_a_writer_shows_the_numbers_of_the_register(published, subjects, writer):
    numbers, least = WRITERS[writer]
    wrong, compared = [], 0
    for subject in subjects:
        for row, number, shown, digits in numbers(published, subject):
            for field, value in shown.items():
                wanted = expected(row, number, field)
                if not agrees(value, wanted, digits):
                    wrong.append((subject.name, row.name, number.at, field, value, wanted))
                compared += wanted == wanted
    assert wrong == []
    assert compared > least


def test_the_study_has_numbers_of_every_kind(subjects):
    """Missing, undetermined by the scan and by their interval, and determined ones."""
    if os.environ.get("RESULTS"):
        pytest.skip("of the small study alone")
    register = [row for row in rows_of_register() if not row.shown]
    numbers = [(row, one) for each in subjects for row in register for one in read(row, each)]
    assert any(one.missing for _, one in numbers)
    for by_scan in (True, False):
        assert any(row.by_scan == by_scan and not one.determined for row, one in numbers)
    assert sum(one.determined and one.estimate.known for _, one in numbers) > 200


#: Variables of the reported state that rows of the register are of, and their place in the budget.
SOURCES = {
    "seated_closure": ("closure", "seated_closure", ""),
    "interface_closure": ("closure", "interface_closure", "closure"),
    "separation": ("closure", "separation", "separation"),
    "interface_stiffness": ("closure", "interface_stiffness", "stiffness"),
    "tangent_stiffness": ("closure", "reference_stiffness", ""),
    "area_corrected": ("closure", "area_corrected", "area_corrected"),
    "mean_gap": ("closure", "mean_gap", ""),
    "nodes": ("closure", "nodes", ""),
    "k_ni": ("closure", "seated_k_ni", ""),
    "k_ni_change": ("closure", "seated_k_ni_change", ""),
    "delta_sigma": ("domains", "delta_sigma", "delta_sigma"),
    "sigma_n": ("scaling", "sigma_n", ""),
}


@pytest.mark.parametrize("name", SOURCES)
def test_the_register_has_the_numbers_of_the_reported_state(subjects, name):
    stage, variable, quantity = SOURCES[name]
    for subject in subjects:
        states, closure = subject[stage], subject["closure"]
        place = {"direction": closure["reported_direction"].item(), "resolution": 1}
        states = states.sel({dim: at for dim, at in place.items() if dim in states[variable].dims})
        states = states.sel(offset=closure["reported_offset"].item(), method="nearest")
        numbers = read(row_of(name), subject)
        np.testing.assert_array_equal([one.value for one in numbers], np.ravel(states[variable]))
        if f"{variable}_low" in states:
            low = [one.estimate.low for one in numbers]
            np.testing.assert_array_equal(low, np.ravel(states[f"{variable}_low"]))
        if quantity:
            budget = subject["error_budget"].sel(quantity=quantity)
            for field, total in (("error", "total"), ("population", "total_of_population")):
                errors = [getattr(one, field) for one in numbers]
                np.testing.assert_array_equal(errors, budget[total])


def test_units_of_the_register_are_those_of_the_atlas(subjects):
    compared = 0
    for subject in subjects:
        for row in rows_of_register():
            if row.stage in subject.stages and row.variable in subject[row.stage]:
                assert subject[row.stage][row.variable].attrs["units"] == row.unit, row.name
                compared += 1
    assert compared > 50
