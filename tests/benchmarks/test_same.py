"""The comparison of results before and after a change finds a single changed bit."""

import importlib.util
import json
import shutil
import sys
import zipfile

import numpy as np
import pytest
import xarray as xr
from places import BENCHMARKS

from fractalcontact.pages.packed_states import packed
from fractalcontact.study.atlas import write_atlas

sys.path.insert(0, str(BENCHMARKS))
SPEC = importlib.util.spec_from_file_location("same", BENCHMARKS / "same.py")
same = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(same)


def dataset(name="closure"):
    values = np.array([[0.1, np.nan, -0.0], [1 / 3, 2.0, 1e-300]])
    attrs = {"units": "mm", "long_name": "closure of the interface"}
    return xr.Dataset({name: (("offset", "load"), values, attrs)}, attrs={"seated": 1})


def write(folder, closure, table="specimen,k_ni\na,1.5\nb,2.5\n", caption="A fit of 4 points.\n"):
    (folder / "figures").mkdir(parents=True, exist_ok=True)
    parts = {"closure": {"a": closure, "b": dataset()}}
    write_atlas(parts, folder / "atlas.nc", study="x", configuration={"loads": ["1 MPa"]})
    (folder / "summary.csv").write_text(table)
    (folder / "figures/fig04.txt").write_text(caption)
    (folder / "figures/fig04.png").write_bytes(b"drawn")


#: A card, a page, an explorer, and a table in the archive.
CARD = {
    "versions": {"numpy": "1"},
    "methods": "A window was compressed. Computed with fractalcontact 1.0.0, numpy 1.2.",
    "entries": {"k_ni": {"value": 1.5, "low": 0.0}, "chi": {"values": [{"value": 2}]}},
}
PAGE = """<html><head><style>p { margin: 0; }</style></head><body>
<h1 title="Joint">Joint&nbsp;A</h1>
<p>Closure <b>0.12</b> mm.</p>
<p>2026-11-24 10:00 UTC · 3 min 12 s of work in 32 jobs · end</p><script>draw(1);</script>
<script type="application/json" id="index">{"rows": [{"name": "a", "value": 1.5}]}</script>
"""
NUMBERS = np.array([[0.1, np.nan, -0.0], [1 / 3, 2.0, 1e-300]])


def write_pages(folder, card=None, page=PAGE, numbers=NUMBERS, cell="1.5"):
    """Results with what people see of them."""
    write(folder, dataset())
    for name in ("cards", "pages"):
        (folder / name).mkdir(exist_ok=True)
    (folder / "cards/a.json").write_text(json.dumps(card or CARD))
    (folder / "pages/a.html").write_text(page)
    with zipfile.ZipFile(folder / "tables.zip", "w") as archive:
        archive.writestr("figures/fig04.csv", f"load,k_ni\n1,{cell}\n")
    arrays = {
        "other": {"units": "mm", "shape": [1], "start": 0},
        "closure/closure": {"units": "mm", "shape": [2, 3], "start": 1},
    }
    parts = np.concatenate([[7.0], np.ravel(numbers)]).astype("<f8")
    states = json.dumps({"arrays": arrays, "numbers": packed(parts)})
    explorer = f'<script type="application/json" id="states-0">{states}</script>'
    (folder / "explorer.html").write_text(explorer)


@pytest.fixture
def old(tmp_path):
    write(tmp_path / "old/x", dataset())
    return tmp_path / "old/x"


@pytest.fixture
def new(tmp_path):
    return tmp_path / "new/x"


def differences(old, new, new_names=None):
    found = same.Comparison(new_names)
    found.folders(old, new)
    return found.differences


def test_results_made_twice_are_the_same(old, new, capsys):
    write(new, dataset())
    assert same.compare(old, new)
    assert (
        "4 groups, 2 variables, 1 tables, 1 texts, 0 values: all the same"
        in capsys.readouterr().out
    )


@pytest.mark.parametrize("at", [(0, 0), (1, 2)])
def test_one_bit_of_one_value_is_told(old, new, at):
    changed = dataset()
    values = changed["closure"].values
    values[at] = np.nextafter(values[at], 1)
    write(new, changed)
    (line,) = differences(old, new)
    assert line.startswith("atlas.nc /closure/a closure: 1 of 6 values differ, first at [")
    assert f"offset {at[0]}, load {at[1]}" in line
    assert repr(float(values[at])) in line


@pytest.mark.parametrize("value", [np.nan, 0.0])
def test_a_value_that_went_missing_and_the_sign_of_zero_are_told(old, new, value):
    changed = dataset()
    changed["closure"].values[0, 2] = value
    write(new, changed)
    assert "1 of 6 values differ, first at [offset 0, load 2]" in differences(old, new)[0]


def test_a_changed_type_and_a_changed_shape_are_told(old, new):
    write(new, dataset().astype("float32"))
    assert "type float64 is now float32" in differences(old, new)[0]
    write(new, dataset().isel(load=slice(2)))
    assert "'load': 3} is now" in differences(old, new)[0]


def test_a_changed_attribute_is_told_by_what_changed_of_it(old, new):
    changed = dataset()
    changed["closure"].attrs["long_name"] = "closure of the joint"
    changed.attrs["seated"] = 2
    write(new, changed)
    seated, name = differences(old, new)
    assert "/closure/a: attribute seated: " in seated
    assert "closure of the [interface] is now [joint]" in name


def test_other_versions_of_libraries_are_no_difference(old, new, monkeypatch):
    monkeypatch.setattr("fractalcontact.study.atlas.versions", lambda: {"numpy": "0"})
    write(new, dataset())
    assert differences(old, new) == []


def test_a_lost_group_variable_and_file_are_told(old, new):
    write(new, dataset("closed"))
    (new / "figures/fig04.txt").unlink()
    shutil.copy(old / "summary.csv", new / "curves.csv")
    told = differences(old, new)
    assert "x: file figures/fig04.txt is lost" in told
    assert "x: file curves.csv is new" in told
    assert "atlas.nc /closure/a: variable closure is lost" in told
    assert "atlas.nc /closure/a: variable closed is new" in told
    write_atlas({"closure": {"b": dataset()}}, new / "atlas.nc", study="x", configuration={})
    assert "atlas.nc: group /closure/a is lost" in differences(old, new)


def test_a_changed_cell_a_lost_row_and_another_order_are_told(old, new):
    write(new, dataset(), table="specimen,k_ni\na,1.5\nb,2.6\n")
    assert differences(old, new) == [
        "summary.csv: column k_ni: 1 of 2 cells differ, first in row 2: '2.5' is now '2.6'"
    ]
    write(new, dataset(), table="specimen,k_ni\na,1.5\n")
    assert differences(old, new) == ["summary.csv: 2 rows are now 1"]
    write(new, dataset(), table="k_ni,specimen\n1.5,a\n2.5,b\n")
    assert "another order" in differences(old, new)[0]


def test_a_changed_caption_is_told_by_its_words(old, new):
    write(new, dataset(), caption="A fit of 5 points.\n")
    assert differences(old, new) == ["figures/fig04.txt: A fit of [4] is now [5] points.\\n"]


def test_a_changed_picture_is_listed_and_not_counted(old, new, capsys):
    write(new, dataset())
    (new / "figures/fig04.png").write_bytes(b"drawn otherwise")
    assert same.compare(old, new)
    assert "look at it: figures/fig04.png" in capsys.readouterr().out


def test_what_was_renamed_is_listed_and_its_numbers_are_compared(old, new, capsys):
    renamed = dataset("approach").rename(load="force")
    table = "specimen,stiffness\na,1.5\nb,2.5\n"
    write(new, renamed, table=table)
    for ending in ("txt", "png"):
        (new / f"figures/fig04.{ending}").rename(new / f"figures/closure_curves.{ending}")
    new_names = {
        "closure": "approach",
        "load": "force",
        "k_ni": "stiffness",
        "fig04": "closure_curves",
    }
    # The group "closure" and the variable of specimen b keep their names.
    assert same.compare(old, new, new_names)
    told = capsys.readouterr().out
    assert "renamed: column k_ni is now stiffness" in told
    assert "renamed: variable closure is now approach" in told
    renamed["approach"].values[0, 0] = 0.2
    write(new, renamed, table=table.replace("2.5", "2.6"))
    (new / "figures/fig04.txt").unlink()
    assert len(differences(old, new, new_names)) == 2


def test_groups_in_parts_of_an_atlas_are_compared(old, new):
    for folder, closure in ((old, dataset()), (new, dataset() + 1e-16)):
        write(folder, dataset())
        parts = {"parts_in": {"a": "atlas/a.nc"}, "study": "x", "configuration": {}}
        write_atlas({"closure": {"b": dataset()}}, folder / "atlas.nc", **parts)
        (folder / "atlas").mkdir()
        own = {
            "closure": {
                "a": closure.assign(
                    closure=closure["closure"].assign_attrs(units="mm", long_name="x")
                )
            }
        }
        write_atlas(own, folder / "atlas/a.nc", study="x", configuration={})
    assert any("/closure/a closure: " in line for line in differences(old, new))


def test_keep_copies_what_is_compared_and_drops_what_was_kept_before(old, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert same.main(["keep", str(old)]) == 0
    assert same.main(["compare", str(old)]) == 0
    (old / "figures/fig04.txt").unlink()
    assert same.main(["compare", str(old)]) == 1
    assert same.main(["keep", str(old)]) == 0
    assert same.main(["compare", str(old)]) == 0


def test_who_kept_nothing_is_told_to(old, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit, match=r"results/same/x: no atlas\.nc .* 'make keep'"):
        same.main(["compare", str(old)])


def test_cards_pages_explorer_and_archive_made_twice_are_the_same(tmp_path):
    for folder in ("old", "new"):
        write_pages(tmp_path / folder)
    assert differences(tmp_path / "old", tmp_path / "new") == []


@pytest.mark.parametrize(
    ("entry", "told"),
    [
        ({"value": np.nextafter(1.5, 2), "low": 0.0}, "value: 1.5 is now 1.5000000000000002"),
        ({"value": 1.5, "low": -0.0}, "low: 0.0 is now -0.0"),
        ({"value": 1.5, "low": None}, "low: 0.0 is now None"),
        ({"value": 1.5}, "value entries/k_ni/low is lost"),
        ({"value": 1.5, "low": 0.0, "high": 2}, "value entries/k_ni/high is new"),
    ],
)
def test_each_value_of_a_card_is_compared(tmp_path, entry, told):
    write_pages(tmp_path / "old")
    card = {**CARD, "entries": {**CARD["entries"], "k_ni": entry}}
    write_pages(tmp_path / "new", card)
    (line,) = differences(tmp_path / "old", tmp_path / "new")
    assert line.startswith("cards/a.json")
    assert line.endswith(told)


def test_a_row_of_a_card_that_changed_is_told_by_its_place(tmp_path):
    write_pages(tmp_path / "old")
    write_pages(tmp_path / "new", json.loads(json.dumps(CARD).replace('"value": 2', '"value": 3')))
    assert differences(tmp_path / "old", tmp_path / "new") == [
        "cards/a.json entries/chi/values/value: 1 of 1 values differ, first at 0: 2 is now 3"
    ]


@pytest.mark.parametrize(
    ("before", "after", "told"),
    [
        ("0.12", "0.13", "pages/a.html: Closure [0.12] is now [0.13] mm.\\n"),
        ('title="Joint"', 'title="Face"', "pages/a.html: [[Joint] is now [Face]]Joint A"),
        ("1.5", "1.6", "pages/a.html index/rows/value: 1 of 1 values differ, first at 0: 1.5 is"),
    ],
)
def test_what_a_page_says_is_compared(tmp_path, before, after, told):
    write_pages(tmp_path / "old")
    write_pages(tmp_path / "new", page=PAGE.replace(before, after))
    (line,) = differences(tmp_path / "old", tmp_path / "new")
    assert line.startswith(told)


def test_styles_times_and_versions_are_no_difference(tmp_path):
    write_pages(tmp_path / "old")
    card = {**CARD, "versions": {"numpy": "2"}, "methods": CARD["methods"].replace("1.2", "1.3.4")}
    page = PAGE.replace("10:00", "11:30").replace("3 min 12 s", "54 s").replace("(1)", "(2)")
    page = page.replace("margin: 0", "margin: 1px")
    write_pages(tmp_path / "new", card, page)
    assert differences(tmp_path / "old", tmp_path / "new") == []


def test_one_bit_of_the_explorer_is_told_by_its_array(tmp_path):
    write_pages(tmp_path / "old")
    numbers = NUMBERS.copy()
    numbers[1, 0] = np.nextafter(numbers[1, 0], 1)
    write_pages(tmp_path / "new", numbers=numbers)
    (line,) = differences(tmp_path / "old", tmp_path / "new")
    place = "explorer.html states-0/arrays/closure/closure/values"
    assert line.startswith(f"{place}: 1 of 6 values differ, first at (1, 0): ")


def test_a_cell_of_a_table_in_the_archive_is_told(tmp_path):
    write_pages(tmp_path / "old")
    write_pages(tmp_path / "new", cell="1.6")
    assert differences(tmp_path / "old", tmp_path / "new") == [
        "tables.zip figures/fig04.csv: column k_ni: 1 of 1 cells differ, "
        "first in row 1: '1.5' is now '1.6'"
    ]


def test_keep_copies_cards_pages_and_the_archive(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_pages(tmp_path / "x")
    assert same.main(["keep", "x"]) == 0
    write_pages(tmp_path / "x", page=PAGE.replace("0.12", "0.13"))
    assert same.main(["compare", "x"]) == 1
