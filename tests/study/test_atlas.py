"""What is written comes back, the same twice, and says with which versions it was made."""

import json
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr

from fractalcontact.core import netcdf
from fractalcontact.core.arrays import padded
from fractalcontact.core.netcdf import read, read_with_versions, versions, write
from fractalcontact.study.atlas import read_atlas, write_atlas


def test_the_same_dataset_gives_the_same_bytes(tmp_path):
    data = xr.Dataset({"a": ("x", [1.0, float("nan")], {"units": "mm", "long_name": "a"})})
    write(data, tmp_path / "1.nc")
    write(data, tmp_path / "2.nc")
    assert (tmp_path / "1.nc").read_bytes() == (tmp_path / "2.nc").read_bytes()
    assert read(tmp_path / "1.nc").identical(data)


def test_words_are_not_cut_to_the_length_of_those_read_first(tmp_path):
    for name in ("comb", "start from a wrong state"):
        write(xr.Dataset(coords={"kind": [name]}), tmp_path / f"{name}.nc")
    first, second = (read(path) for path in sorted(tmp_path.iterdir()))
    write(xr.concat([first, second], "kind"), tmp_path / "whole.nc")
    names = read(tmp_path / "whole.nc")["kind"].values
    assert names.tolist() == ["comb", "start from a wrong state"]


def test_padded_rows():
    table = padded([[1, 2], [3]])
    assert table[0].tolist() == [1, 2]
    assert table[1, 0] == 3
    assert table[1, 1] != table[1, 1]


def test_an_atlas_comes_back_as_it_was_however_often_it_is_read(tmp_path):
    def labelled(values):
        return xr.Dataset({"a": ("x", values, {"units": "mm", "long_name": "a"})})

    parts = {
        "specimens": {"rock": labelled([1.0, 2.0]), "joint_2.1": labelled([3.0])},
        "contact": {"rock": labelled([True, False])},
    }
    path = tmp_path / "atlas.nc"
    write_atlas(parts, path, study="test", configuration={"n": 1})
    for _ in range(3):
        atlas = read_atlas(path)
        assert atlas["specimens/joint_2.1"].to_dataset().identical(parts["specimens"]["joint_2.1"])
        assert atlas["contact/rock"].to_dataset().identical(parts["contact"]["rock"])
        assert atlas.attrs["study"] == "test"
    assert "contact" not in read_atlas(path, without=("contact",)).children


def test_nothing_without_a_unit_enters_the_atlas(tmp_path):
    bare = {"specimens": {"rock": xr.Dataset({"a": ("x", [1.0])})}}
    with pytest.raises(
        ValueError, match="specimens/rock: variable a has no units and no long_name"
    ):
        write_atlas(bare, tmp_path / "atlas.nc", study="test", configuration={})
    assert not list(tmp_path.iterdir())


def test_parts_made_with_other_versions_are_named_in_the_atlas(tmp_path, monkeypatch):
    labelled = xr.Dataset({"a": ("x", [1.0], {"units": "mm", "long_name": "a"})})
    write(labelled, tmp_path / "new.nc")
    older = versions() | {"numpy": "1.0"}
    with monkeypatch.context() as patched:
        patched.setattr(netcdf, "versions", lambda: older)
        write(labelled, tmp_path / "old.nc")
    read_back = {name: read_with_versions(tmp_path / f"{name}.nc") for name in ("old", "new")}
    assert [made for _, made in read_back.values()] == [older, versions()]
    parts = {"specimens": {name: dataset for name, (dataset, _) in read_back.items()}}
    made_with = {"specimens": {name: made for name, (_, made) in read_back.items()}}
    path, asked = tmp_path / "atlas.nc", {"study": "test", "configuration": {}}
    differing = write_atlas(parts, path, **asked, made_with=made_with)
    (other,) = [words for words in differing if "numpy 1.0," in words]
    assert differing[other] == ["specimens/old"]
    attributes = read_atlas(path).attrs
    assert json.loads(attributes["versions_differ"]) == differing
    assert json.loads(attributes["versions"]) == versions()
    del made_with["specimens"]["old"]
    assert write_atlas(parts, path, **asked, made_with=made_with) == {}
    assert "versions_differ" not in read_atlas(path).attrs


#: What a notebook does: the atlas open, read again by the package, and a cell run once more.
OPENED_TWICE = """
import sys
import xarray as xr
from fractalcontact.study.atlas import read_atlas

path, kept = sys.argv[1], []
for _ in range(5):
    kept.append(xr.open_datatree(path))
    assert read_atlas(path)["specimens/rock"].equals(kept[0]["specimens/rock"])
    with xr.open_datatree(path) as again:
        assert again["contact/rock"].load().equals(kept[-1]["contact/rock"])
    xr.open_dataset(path, group="contact/rock").load()
for tree in kept[::2]:
    tree.close()
print([str(word) for word in xr.open_datatree(path)["specimens/rock"]["face"].values])
"""


def test_an_atlas_is_opened_again_and_again_in_one_process(tmp_path):
    """Strings of variable length would end the process: netcdf4-python issues 261 and 1444."""
    words = {"face": ["lower", "upper", "größer", ""]}
    values = ("face", np.arange(4.0), {"units": "mm", "long_name": "a"})
    named = xr.Dataset({"a": values}, coords=words)
    parts = {"specimens": {"rock": named}, "contact": {"rock": named}}
    path = tmp_path / "atlas.nc"
    write_atlas(parts, path, study="test", configuration={})
    assert read_atlas(path)["specimens/rock"].to_dataset().equals(named)
    command = [sys.executable, "-c", OPENED_TWICE, path]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, f"{words['face']}\n"), done.stderr[-2000:]


def test_no_string_of_variable_length_is_in_an_atlas(tmp_path):
    import netCDF4

    labels = {"units": "1", "long_name": "a word"}
    words = xr.Dataset(
        {
            "one": ((), "word", labels),
            "none": ("x", np.array([], dtype="U3"), labels),
            "objects": ("y", np.array(["a", "bcd"], dtype=object), labels),
        }
    )
    path = tmp_path / "atlas.nc"
    write_atlas({"specimens": {"rock": words}}, path, study="test", configuration={})
    with netCDF4.Dataset(path) as file:
        kinds = {variable.dtype for variable in file["specimens/rock"].variables.values()}
    assert kinds == {np.dtype("S1")}
    assert read_atlas(path)["specimens/rock"].to_dataset().equals(words)


def test_single_precision_keeps_three_digits_and_all_else_every_digit(tmp_path):
    chance = np.random.default_rng(4)
    attrs = {"units": "mm", "long_name": "height"}
    heights = chance.normal(size=(200, 200))
    heights[3, 5] = np.nan
    rock = xr.Dataset(
        {
            "other": (("y", "x"), heights, attrs),
            "map_gap": (("y", "x"), heights.astype("f4"), attrs),
            "profile": (("y",), heights[0], attrs),
            "none": (("y", "nothing"), heights[:, :0], attrs),
        }
    )
    path = tmp_path / "atlas.nc"
    write_atlas({"specimens": {"rock": rock}}, path, study="s", configuration={})
    found = read_atlas(path)["specimens/rock"]
    for name in ("other", "profile", "none"):
        np.testing.assert_array_equal(found[name], rock[name])
    np.testing.assert_allclose(found["map_gap"], heights, rtol=5e-3)
    assert not np.array_equal(found["map_gap"], rock["map_gap"], equal_nan=True)
    bare = rock.drop_vars("map_gap")
    write_atlas({"specimens": {"rock": bare}}, tmp_path / "bare.nc", study="s", configuration={})
    kept = path.stat().st_size - (tmp_path / "bare.nc").stat().st_size
    assert kept < 0.65 * rock["map_gap"].nbytes


@pytest.mark.parametrize(("name", "steps"), [("composite", 65532), ("lower", 1048572)])
def test_heights_are_kept_in_steps_far_below_their_range(tmp_path, name, steps):
    generator = np.random.default_rng(1)
    heights = np.cumsum(generator.normal(size=(80, 90)), axis=0)
    heights[3, 5] = np.nan
    attrs = {"units": "mm", "long_name": "height"}
    data = xr.Dataset({name: (("y", "x"), heights, attrs), "other": (("y", "x"), heights, attrs)})
    flat = xr.Dataset({name: (("y", "x"), np.full((80, 90), 2.5), attrs)})
    path = tmp_path / "atlas.nc"
    write_atlas({"specimens": {"a": data, "b": flat}}, path, study="t", configuration={})
    atlas = read_atlas(path)
    found = atlas[f"specimens/a/{name}"].values
    step = np.ptp(heights[np.isfinite(heights)]) / steps
    assert np.nanmax(np.abs(found - heights)) <= 0.51 * step + 1e-6 * np.nanmax(np.abs(heights))
    assert np.array_equal(np.isnan(found), np.isnan(heights))
    assert np.array_equal(atlas["specimens/a/other"], heights, equal_nan=True)
    assert (atlas[f"specimens/b/{name}"] == 2.5).all()
    assert atlas[f"specimens/a/{name}"].attrs == attrs
