"""The comparison of results before and after a change finds a single changed bit."""

import importlib.util
import shutil

import numpy as np
import pytest
import xarray as xr
from places import BENCHMARKS

from fractalcontact.study.atlas import write_atlas

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
    assert "4 groups, 2 variables, 1 tables, 1 texts: all the same" in capsys.readouterr().out


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
