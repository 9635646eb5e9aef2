"""Files that contradict their sidecar, refused with the line and what to write."""

import netCDF4
import numpy as np
import pytest
from stated import ARRAY, COMMAS

from fractalcontact.core.errors import InputError
from fractalcontact.scan.read import read_scan

MATRIX = {**ARRAY, **COMMAS, "unit": "mm", "spacing": 0.1}
POINTS = {**COMMAS, "kind": "face", "layout": "points", "columns": [0, 1, 2], "unit": "mm",
          "heights": "up", "missing": "none"}  # fmt: skip


def heights(shape=(12, 16)):
    return np.random.default_rng(2).uniform(-0.02, 0.02, shape).round(6)


def lines_of(z):
    return [",".join(f"{value:.6f}" for value in row) for row in z]


def saved(path, lines):
    path.write_text("\n".join(lines) + "\n")
    return path


def refused(path, keys, words):
    with pytest.raises(InputError, match=words) as caught:
        read_scan(path, keys)
    assert path.name in str(caught.value)


@pytest.mark.parametrize("count", [1, 3])
def test_rows_of_heights_within_the_header_are_refused(tmp_path, count):
    path = saved(tmp_path / "rock.csv", lines_of(heights()))
    refused(path, MATRIX | {"header": count}, f"line {count}, .* as many numbers .*'header: 0'")
    named = saved(tmp_path / "named.csv", ["a title", "# remark", *lines_of(heights())])
    refused(named, MATRIX | {"header": 2 + count}, f"line {2 + count}, .*'header: 2'")
    np.testing.assert_array_equal(read_scan(named, MATRIX | {"header": 2}), heights())


def test_names_and_counts_above_the_heights_are_a_header(tmp_path):
    z = heights()
    for line in (",".join(f"c{n}" for n in range(16)), "12,16", "# " + lines_of(z)[0]):
        path = saved(tmp_path / "rock.csv", [line, *lines_of(z)])
        np.testing.assert_array_equal(read_scan(path, MATRIX | {"header": 1}), z)


@pytest.mark.parametrize("line", ["", "# summary", "% ---"])
def test_rows_below_a_line_are_refused_until_the_size_is_confirmed(tmp_path, line):
    z = heights()
    for more in (z.mean(axis=0, keepdims=True), z[:4]):
        path = saved(tmp_path / "rock.csv", [*lines_of(z), line, *lines_of(more)])
        refused(path, MATRIX, rf"line 13 holds no numbers, and {len(more)} more rows follow")
        shape = {"confirmed": {"shape": [12 + len(more), 16]}}
        assert read_scan(path, MATRIX | shape).shape == (12 + len(more), 16)


@pytest.mark.parametrize("every", [1, 3])
def test_lines_between_rows_in_even_steps_part_no_tables(tmp_path, every):
    lines = [line for n, row in enumerate(lines_of(heights()))
             for line in ([f"# row {n}", row] if n % every == 0 else [row])]  # fmt: skip
    path = saved(tmp_path / "rock.csv", lines)
    np.testing.assert_array_equal(read_scan(path, MATRIX), heights())


def test_a_smaller_cloud_at_the_places_of_the_first_is_refused(tmp_path):
    y, x = np.indices((12, 16))
    points = np.column_stack([0.1 * x.ravel(), 0.1 * y.ravel(), heights().ravel()])
    path = saved(tmp_path / "rock.csv", [*lines_of(points), "", *lines_of(points[16:-32])])
    refused(path, POINTS, "line 193 holds no numbers, and 144 more rows follow")
    path = saved(tmp_path / "two.csv", [*lines_of(points[:96]), "# second half",
                                        *lines_of(points[96:])])  # fmt: skip
    assert read_scan(path, POINTS).shape == (12, 16)


@pytest.mark.parametrize(
    "size",
    ["DIMENSIONS 32 12 1", "32 x 12", "# 32 × 12 points", "width=32 height=12",
     "# points X: 32\n# points Y: 12", "cols = 32; rows = 12"],
)  # fmt: skip
def test_wrapped_rows_are_refused_by_the_size_in_the_header(tmp_path, size):
    z = heights((12, 32))
    above = size.split("\n")
    keys = MATRIX | {"header": len(above)}
    wrapped = saved(tmp_path / "rock.csv", [*above, *lines_of(z.reshape(24, 16))])
    refused(wrapped, keys, "rows of 16 numbers were read, which are as many: rows are wrapped")
    whole = saved(tmp_path / "whole.csv", [*above, *lines_of(z)])
    np.testing.assert_array_equal(read_scan(whole, keys), z)


@pytest.mark.parametrize(
    "line", ["date: 24.12.2024 16:24:12", "camera 1024 x 768", "12 of 32 mm", "0.24 x 0.16 mm"]
)
def test_other_numbers_of_a_header_are_no_size(tmp_path, line):
    path = saved(tmp_path / "rock.csv", [line, *lines_of(heights((24, 16)))])
    assert read_scan(path, MATRIX | {"header": 1}).shape == (24, 16)


@pytest.mark.parametrize("cell", ["inf", "-Infinity", "1e400", ""])
def test_a_cell_without_a_finite_number_is_named_unless_it_is_stated(tmp_path, cell):
    rows = [line.split(",") for line in lines_of(heights())]
    rows[4][7] = cell
    path = saved(tmp_path / "rock.csv", [",".join(row) for row in rows])
    mark = cell or '""'
    refused(path, MATRIX, rf"line 5, cell 8 is .*write 'missing: {mark}'")
    missing = np.isnan(read_scan(path, MATRIX | {"missing": cell}).values)
    assert list(zip(*np.nonzero(missing), strict=True)) == [(4, 7)]


def test_an_empty_cell_in_a_column_that_is_not_used_is_no_matter(tmp_path):
    y, x = np.indices((12, 16))
    points = np.column_stack([0.1 * x.ravel(), 0.1 * y.ravel(), heights().ravel()])
    rows = [f"{line},{'' if n % 3 else 'inf'}" for n, line in enumerate(lines_of(points))]
    path = saved(tmp_path / "rock.csv", rows)
    assert np.isfinite(read_scan(path, POINTS)).all()


def write_netcdf(path, z, x=(), y=(), **attributes):
    with netCDF4.Dataset(path, "w") as file:
        for name, length, more in (("y", z.shape[0], y), ("x", z.shape[1], x)):
            file.createDimension(name, length)
            axis = file.createVariable(name, "f8", (name,))
            axis.setncatts({"units": "mm", **dict(more)})
            axis[:] = 0.1 * np.arange(length)
        variable = file.createVariable("z", "f8", ("y", "x"))
        variable.setncatts({"units": "mm", **attributes})
        variable[:] = z
    return path


@pytest.mark.parametrize("word", ["DOWN ", "downward", " Downwards", "down"])
def test_positive_is_read_in_any_case_and_ending(tmp_path, word):
    path = write_netcdf(tmp_path / "rock.nc", heights(), positive=word)
    np.testing.assert_array_equal(read_scan(path), -heights())
    other = word.lower().replace("down", "up")
    up = write_netcdf(tmp_path / "up.nc", heights(), positive=other)
    np.testing.assert_array_equal(read_scan(up), heights())


def test_positive_of_no_known_direction_is_asked_for(tmp_path):
    path = write_netcdf(tmp_path / "rock.nc", heights(), positive="below")
    refused(path, {}, "neither up nor down; write 'heights: up' or 'heights: down'")
    np.testing.assert_array_equal(read_scan(path, {"heights": "down"}), -heights())


def test_an_axis_that_contradicts_its_standard_name_is_refused(tmp_path):
    names = {letter: f"projection_{letter}_coordinate" for letter in "xy"}
    path = write_netcdf(
        tmp_path / "rock.nc",
        heights(),
        x={"axis": "X", "standard_name": names["y"]},
        y={"axis": "Y", "standard_name": names["x"]},
    )
    refused(path, {}, "which contradict each other")
    agreeing = {letter: {"axis": letter.upper(), "standard_name": f"{names[letter]} "}
                for letter in "xy"}  # fmt: skip
    path = write_netcdf(tmp_path / "sound.nc", heights(), **agreeing)
    np.testing.assert_array_equal(read_scan(path), heights())
