"""No published number stands with two values: atlas, tables, numbers of figures, pages, explorer.

``RESULTS=results/paper`` takes the results of a study that was made already.
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
from published import (
    DIGITS,
    SUMMARY,
    against_the_atlas,
    between_tables,
    specimen_of,
    stages_of,
    tables_of,
)

from fractalcontact.core.subject import Subject
from fractalcontact.figures.draw import drawer_of
from fractalcontact.figures.kit.drawing import print_style
from fractalcontact.pages.captions import symbols
from fractalcontact.pages.explorer import write_explorer
from fractalcontact.report.published import BY_SCAN
from fractalcontact.report.published import published as published_rows
from fractalcontact.study.atlas import read_atlas
from fractalcontact.study.figure_list import figures_of


@pytest.fixture(scope="module")
def published(results, tmp_path_factory):
    """Folder of a study with the numbers of its figures, its pages and its explorer."""
    if os.environ.get("RESULTS"):
        return Path(os.environ["RESULTS"]).absolute()
    folder = shutil.copytree(results, tmp_path_factory.mktemp("published") / "tiny")
    atlas = read_atlas(folder / "atlas.nc")
    for name in atlas["specimens"].children:
        numbers = folder / "figures" / name
        for figure in figures_of(atlas[f"specimens/{name}"].attrs["opposite"]):
            with print_style():
                drawing = drawer_of(figure)(atlas, name)
            drawing.data.to_csv(numbers / f"{figure}.csv", index=False, float_format="%.8g")
    write_explorer(folder / "atlas.nc", folder / "explorer.html")
    return folder


@pytest.fixture(scope="module")
def atlas(published):
    return read_atlas(published / "atlas.nc")


@pytest.fixture(scope="module")
def specimens(atlas):
    return [specimen_of(atlas, name) for name in sorted(atlas["specimens"].children)]


# -- tables ----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def compared(published, atlas, specimens):
    """Columns of all tables with how often each was compared, and where its values differ."""
    counts, faults = {}, {}
    for one in specimens:
        tables = tables_of(published, one)
        stages = stages_of(atlas, one.name, {name for table in tables for name in table.keys_of})
        for column, common, wrong in (*between_tables(tables), *against_the_atlas(tables, stages)):
            counts[column] = counts.get(column, 0) + common
            faults.setdefault(column, []).extend(f"{one.name}, {words}" for words in wrong)
    return counts, faults


def test_a_column_has_one_value_at_one_state_in_all_tables_and_in_the_atlas(compared):
    counts, faults = compared
    assert sum(count > 0 for count in counts.values()) > 60
    wrong = [words for column in sorted(faults) for words in faults[column]]
    assert wrong == []


# -- pages and explorer ----------------------------------------------------------------------------

#: Columns of the table of specimens that have a value for each load, by their words.
COLUMNS = {
    "Nominal pressure": "nominal_pressure_MPa",
    "Mean pressure in contact": "real_pressure_MPa",
    "Closure from the seat": "seated_closure_mm",
    "Closure from first touch": "interface_closure_mm",
    "Tangent stiffness": "stiffness_MPa_per_mm",
    "Δσ by boxes": "delta_sigma_boxes",
    "Δσ by area": "delta_sigma_areas",
    "Contact nodes": "contact_nodes",
    "Mean gap": "mean_gap_mm",
    "Transmissivity (mm³)": "transmissivity_along_mm3",
}
#: Columns with the reason why a number is no result.
REASONS = {"stiffness_MPa_per_mm": "stiffness_reason"}
#: Of these, what suspicious cells of the scans leave undetermined.
SCANNED = {
    *("seated_closure_mm", "interface_closure_mm", "stiffness_MPa_per_mm"),
    *("mean_gap_mm", "transmissivity_along_mm3"),
}
#: Of the error budget: column of the summary, its unit, and that of its errors on the page.
BUDGET = {
    "closure": ("interface_closure", "mm", "%"),
    "area_corrected": ("area_corrected", "mm2", "%"),
    "stiffness": ("stiffness", "MPa_per_mm", "%"),
}
#: Units that pages print, in those of the summary.
SIZES = {"µm": 1e-3, "nm": 1e-6, "GPa": 1e3, "GPa/mm": 1e3, "%": 0.01}


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

    def handle_endtag(self, tag):
        self.inside = self.inside and tag != "td"

    def handle_data(self, data):
        if self.inside:
            cell = self.rows[-1][-1]
            for whole in (cell, *cell["parts"][-1:]):
                whole["text"] += data


def number_of(words):
    """The number that words such as "−84.1 µm" begin with, in the units of the summary."""
    number, unit = re.match(r"([−\d.e]+)(?: ([^\s)]+))?", words).groups()
    return float(number.replace("−", "-")) * SIZES.get(unit, 1.0)


def summary_of(published, name):
    table = pd.read_csv(published / "summary.csv").set_index("specimen").loc[[name]]
    return table.assign(by_scan=table["suspect_load_share"] > 0.5)


def test_the_table_of_specimens_has_the_values_of_the_summary(published, specimens):
    compared = 0
    rows = {row[0].get("data-sort"): row for row in Cells(published / "index.html").rows if row}
    for one in specimens:
        summary = summary_of(published, one.name)
        cells = {cell["data-name"]: cell["parts"] for cell in rows[one.name] if cell["parts"]}
        for i, nominal in enumerate(cells["Nominal pressure"]):
            if not nominal["text"]:
                continue  # no load of this specimen
            pressure = float(nominal["data-sort"])
            near = np.isclose(summary["nominal_pressure_MPa"], pressure, rtol=DIGITS)
            (row,) = summary[near].to_dict("records")
            for words, parts in cells.items():
                column, part = COLUMNS[words], parts[i]
                reason = row.get(REASONS.get(column))
                if isinstance(reason, str) and reason != BY_SCAN:
                    assert part["text"].startswith("–")
                    assert part["data-sort"] == ""
                    continue
                known = row.get(f"{column}_determined", True) and not math.isnan(row[column])
                scanned = column in SCANNED
                by_scan = scanned and row["by_scan"]
                assert part["text"].startswith("undetermined") == bool(
                    not math.isnan(row[column]) and (by_scan or not known)
                ), (one.name, words)
                if known and not by_scan:
                    assert math.isclose(float(part["data-sort"]), row[column], rel_tol=DIGITS)
                    compared += 1
                else:
                    assert part["data-sort"] == ""
    assert compared > 15


def test_the_page_of_a_specimen_has_the_values_and_errors_of_the_summary(
    published, atlas, specimens
):
    undetermined = 0
    for one in specimens:
        (row,) = summary_of(published, one.name).query("load_of_maps").to_dict("records")
        path = published / f"pages/{one.name}.html"
        shown = {cells[0]["text"]: cells[1:] for cells in Cells(path).rows if len(cells) > 1}
        budget = atlas[f"error_budget/{one.name}"].to_dataset()
        for quantity, (column, unit, unit_of_error) in BUDGET.items():
            meaning = budget["meaning"].sel(quantity=quantity).item()
            words = re.sub("<[^>]+>", "", symbols(meaning))
            value = row[f"{column}_{unit}"]
            errors = [row[f"{column}_error_{of}_{unit}"] for of in ("surface", "population")]
            cells = [cell["text"] for cell in shown[words]]
            why = row.get(f"{column}_reason")
            if math.isnan(value) or (isinstance(why, str) and why != BY_SCAN):
                assert cells[0].startswith("none (")
                continue
            assert cells[0].startswith("undetermined (") == row["by_scan"]
            if row["by_scan"]:
                undetermined += 1
                cells = cells[0].removeprefix("undetermined (").split(" ± ")
                errors = errors[:1]
            assert number_of(cells[0]) == pytest.approx(value, rel=5.1e-3)
            for said, error in zip(cells[1:], errors, strict=True):
                if math.isnan(error):
                    continue
                said = said.removeprefix("± ").partition(")")[0]
                assert said.endswith(unit_of_error), (one.name, words, said)
                size = abs(value) if unit_of_error == "%" else 1.0
                assert number_of(said) * size == pytest.approx(error, rel=0.051)
        (pressure,) = (
            cells for words, cells in shown.items() if "mean pressure in contact" in words
        )
        if math.isnan(row["real_pressure_MPa"]):
            assert pressure[0]["text"] == f"none ({row['real_pressure_reason']})"
        else:
            assert number_of(pressure[0]["text"]) == pytest.approx(row["real_pressure_MPa"], 5.1e-3)
        assert float(shown["nodes in contact"][0]["text"]) == row["contact_nodes"]
    assert undetermined or os.environ.get("RESULTS")


def nearest(values, value):
    return int(np.argmin(np.abs(np.subtract(values, value))))


class Explorer:
    """Arrays of the explorer of one specimen."""

    def __init__(self, page, number):
        data = re.search(rf'id="states-{number}">(.*?)</script>', page, re.DOTALL)[1]
        self.states = json.loads(data)
        packed = np.frombuffer(zlib.decompress(base64.b64decode(self.states["numbers"])), np.uint8)
        self.numbers = packed.reshape(8, -1).T.copy().view("<f8").ravel()

    def at(self, key, one, force):
        """Number at the offset of the contact maps under a force; NaN of an array it lacks."""
        entry, states = self.states["arrays"].get(key), self.states
        if entry is None:
            return np.nan
        place = {
            "direction": states["direction"].index(one.maps["direction"]),
            "offset": nearest(states["offset"], one.maps["offset_mm"]),
            "resolution": states["resolution"].index(one.maps["resolution"]),
            "normal_force": nearest(states["normal_force"], force),
        }
        index = [place[dimension] for dimension in entry["dims"]]
        return self.numbers[entry["start"] :][np.ravel_multi_index(index, entry["shape"])]


def test_the_explorer_has_the_values_errors_and_words_of_the_summary(published, specimens):
    page = (published / "explorer.html").read_text(encoding="utf-8")
    index = json.loads(re.search(r'id="index">(.*?)</script>', page)[1])
    names = [one["name"] for one in index["specimens"]]
    compared, words = 0, set()
    for one in specimens:
        explorer = Explorer(page, names.index(one.name))
        for row in summary_of(published, one.name).rename(columns=SUMMARY).to_dict("records"):
            force = row["normal_force_N"]
            area_error = row["area_corrected_error_surface_mm2"] / one.area
            values = {
                "total/closure/area_corrected_share": area_error,
                "closure/interface_closure": row["interface_closure_mm"],
                "closure/interface_stiffness": row["interface_stiffness_MPa_per_mm"],
                "closure/nodes": row["contact_nodes"],
                "scaling/sigma_n": row["real_pressure_MPa"],
                "domains/delta_sigma": row["delta_sigma_box"],
                "scaling/delta_sigma_area": row["delta_sigma_area"],
                "total/closure/closure": row["interface_closure_error_surface_mm"],
                "total/closure/interface_closure": row["interface_closure_error_surface_mm"],
                "closure/seated_closure": row["seated_closure_mm"],
                "total/closure/seated_closure": row["seated_closure_error_surface_mm"],
                "total/closure/interface_stiffness": row["stiffness_error_surface_MPa_per_mm"],
                "undetermined/by_scan": float(row["by_scan"]),
            }
            for key, value in values.items():
                assert explorer.at(key, one, force) == pytest.approx(
                    value, rel=DIGITS, nan_ok=True
                ), key
                compared += not math.isnan(value)
            by = {"domains/delta_sigma": "boxes", "scaling/delta_sigma_area": "areas"}
            for key, name in by.items():
                undetermined = bool(explorer.at(f"undetermined/{key}", one, force))
                assert undetermined != row[f"delta_sigma_{name}_determined"], key
            words.add(row["by_scan"])
    assert compared > 50
    assert words == {True, False} or os.environ.get("RESULTS")


def test_units_of_the_register_are_those_of_the_atlas(atlas, specimens):
    compared = 0
    for one in specimens:
        subject = Subject.of(atlas, one.name)
        for row in published_rows():
            if row.stage in subject.stages and row.variable in subject[row.stage]:
                assert subject[row.stage][row.variable].attrs["units"] == row.unit, row.name
                compared += 1
    assert compared > 50
