"""Files appear whole or not at all, and the same twice."""

import pytest
import xarray as xr

from fractalcontact.store import padded, read, write, written_whole


def test_a_broken_write_leaves_the_old_file_and_nothing_else(tmp_path):
    path = tmp_path / "x.txt"
    path.write_text("old")
    with pytest.raises(UnicodeEncodeError), written_whole(path) as temporary:
        temporary.write_text("half \ud800", encoding="utf-8")
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_the_same_dataset_gives_the_same_bytes(tmp_path):
    data = xr.Dataset({"a": ("x", [1.0, float("nan")], {"units": "mm", "long_name": "a"})})
    write(data, tmp_path / "1.nc")
    write(data, tmp_path / "2.nc")
    assert (tmp_path / "1.nc").read_bytes() == (tmp_path / "2.nc").read_bytes()
    assert read(tmp_path / "1.nc").identical(data)


def test_padded_rows():
    table = padded([[1, 2], [3]])
    assert table[0].tolist() == [1, 2]
    assert table[1, 0] == 3
    assert table[1, 1] != table[1, 1]
