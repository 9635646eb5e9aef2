"""Aperture maps written for other programs, and read back."""

import re

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from fractalcontact.cards.apertures import aperture_at, write_aperture
from fractalcontact.commands.export_aperture import main
from fractalcontact.core.errors import InputError
from fractalcontact.scan.read import read_scan
from fractalcontact.study.atlas_parts import open_atlas


def read_vtk(path):
    """Values (ny, nx), x and y of structured points in the legacy format of VTK."""
    raw = path.read_bytes()
    header, _, data = raw.partition(b"LOOKUP_TABLE default\n")
    lines = header.decode().splitlines()
    assert lines[0] == "# vtk DataFile Version 3.0"
    assert lines[2:4] == ["BINARY", "DATASET STRUCTURED_POINTS"]
    stated = {words[0]: words[1:] for words in map(str.split, lines[4:])}
    nx, ny, _ = map(int, stated["DIMENSIONS"])
    assert stated["POINT_DATA"] == [str(nx * ny)]
    assert stated["SCALARS"] == ["aperture", "float", "1"]
    x, y = (
        float(start) + float(step) * np.arange(n)
        for start, step, n in zip(stated["ORIGIN"], stated["SPACING"], (nx, ny), strict=False)
    )
    return np.frombuffer(data[: 4 * nx * ny], ">f4").reshape(ny, nx), x, y


@pytest.fixture(scope="module")
def contact(folder):
    return open_atlas(folder)["contact/pair"]


def test_every_card_has_its_aperture_in_three_forms_that_agree(folder, contact):
    reference = contact["map_gap"].sel(normal_force=contact.attrs["map_load"], method="nearest")
    table = pd.read_csv(folder / "apertures/pair.csv")
    assert list(table) == ["x_mm", "y_mm", "aperture_mm"]
    of_table = table.pivot(index="y_mm", columns="x_mm", values="aperture_mm")
    np.testing.assert_allclose(of_table, reference, rtol=1e-6)
    with xr.open_dataset(folder / "apertures/pair.nc") as of_netcdf:
        assert of_netcdf["aperture"].attrs["units"] == of_netcdf["x"].attrs["units"] == "mm"
        assert "computed at 125 MPa" in of_netcdf["aperture"].attrs["source"]
        np.testing.assert_array_equal(of_netcdf["aperture"], reference)
    values, x, y = read_vtk(folder / "apertures/pair.vtk")
    np.testing.assert_array_equal(values, reference)
    np.testing.assert_allclose(x, reference["x_1"], rtol=1e-6)
    np.testing.assert_allclose(y, reference["y_1"], rtol=1e-6)
    assert (values >= 0).all()


def test_an_exported_map_is_read_again_as_an_aperture_map(folder, contact):
    again = -read_scan(folder / "apertures/pair.nc", {"kind": "aperture", "outline": "rectangle"})
    exported = aperture_at(contact, None, "pair")
    np.testing.assert_array_equal(again, exported)
    assert float(again.x[1] - again.x[0]) == pytest.approx(0.1)


def test_between_two_loads_the_aperture_is_interpolated_in_the_logarithm(contact):
    low, high = (aperture_at(contact, p, "pair") for p in (125, 250))
    middle, nearer = (aperture_at(contact, 125 * 2**part, "pair") for part in (0.5, 0.25))
    np.testing.assert_allclose(middle, (low + high) / 2, rtol=1e-5, atol=1e-9)
    np.testing.assert_allclose(nearer, (3 * low + high) / 4, rtol=1e-5, atol=1e-9)
    assert middle.attrs["source"] == "interpolated in ln(pressure) between 125 and 250 MPa"
    with pytest.raises(InputError, match=r"no aperture at 0\.5 MPa; its maps are kept at 1, 125"):
        aperture_at(contact, 0.5, "pair")


def test_where_the_states_are_kept_all_loads_have_their_map_as_solved(contact, tmp_path):
    gaps = contact["map_gap"]
    solved = np.random.default_rng(1).random(gaps.shape, np.float32)
    part = xr.Dataset({"map_gap": (gaps.dims, solved)}, {"normal_force": gaps["normal_force"]})
    (tmp_path / "contact/pair").mkdir(parents=True)
    part.drop_vars("map_gap").to_netcdf(tmp_path / "contact/pair/0.0.0.nc")
    part.to_netcdf(tmp_path / "contact/pair/0.1.0.nc")
    for pressure, gap in zip(gaps["nominal_pressure"].values, solved, strict=True):
        np.testing.assert_array_equal(aperture_at(contact, pressure, "pair", tmp_path), gap)
    kept = aperture_at(contact, 125, "flat.1", tmp_path)
    np.testing.assert_array_equal(kept, aperture_at(contact, 125, "pair"))


def test_a_missing_aperture_is_an_empty_cell_of_the_table(contact, tmp_path):
    aperture = aperture_at(contact, None, "pair").copy()
    aperture[1, 2] = np.nan
    write_aperture(aperture, tmp_path / "map.csv")
    lines = (tmp_path / "map.csv").read_text("utf-8").splitlines()
    assert len(lines) == aperture.size + 1
    assert lines[1 + aperture.shape[1] + 2].endswith(",")
    assert sum(line.endswith(",") for line in lines) == 1


def test_apertures_at_ones_own_points(folder, contact, tmp_path, capsys):
    grid = aperture_at(contact, 125, "pair")
    x, y = grid.x.values, grid.y.values
    points = pd.DataFrame({"x": [x[3], (x[3] + x[4]) / 2, x[-1] + 5], "y": [y[2], y[2], y[0]]})
    points.to_csv(tmp_path / "points.csv", index=False)
    asked = ["--points", str(tmp_path / "points.csv"), "--pressure", "125 MPa"]
    out = tmp_path / "apertures.csv"
    assert main([str(folder), "pair", "--out", str(out), *asked]) == 0
    said = capsys.readouterr().out
    assert "aperture in mm, computed at 125 MPa; x and y in mm, in the coordinates" in said
    assert "points.csv: 1 of 3 points lie outside the map, which covers x = " in said
    found = pd.read_csv(out)["aperture_mm"].values
    at = grid.values[2]
    np.testing.assert_allclose(found, [at[3], (at[3] + at[4]) / 2, np.nan], rtol=1e-5, atol=1e-9)
    # From the corner of the window the same points lie at other places, and columns may have units.
    moved = points - [x[0] - 0.05, y[0] - 0.05]
    moved.add_suffix("_mm").to_csv(tmp_path / "points.csv", index=False)
    assert main([str(folder), "pair", "--out", str(out), *asked, "--frame", "window"]) == 0
    assert "x and y in mm, from the corner of the window" in capsys.readouterr().out
    again = pd.read_csv(out)["aperture_mm"].values
    np.testing.assert_allclose(again, found, rtol=1e-4, atol=1e-6)


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (["pear", "--out", "a.csv"], "no specimen 'pear'; it has flat.1, pair"),
        (["pair", "--out", "a.txt"], r"a\.txt: .*ends in \.csv or \.nc or \.vtk"),
        (["pair", "--out", "a.vtk", "--points", "{points}"], r"ends in \.csv"),
        (["pair", "--out", "a.csv", "--points", "none.csv"], "none.csv: cannot be read as points"),
        (["pair", "--out", "a.csv", "--pressure", "5 mm"], "pressure"),
        (["pair", "--out", "a.csv", "--pressure", "900 MPa"], "no aperture at 900 MPa"),
    ],
)
def test_what_cannot_be_written_is_refused_in_a_sentence(folder, tmp_path, capsys, words, error):
    points = tmp_path / "points.csv"
    points.write_text("x,y\n1,1\n")
    words = [word.format(points=points) for word in words]
    assert main([str(folder), *words]) == 1
    said = capsys.readouterr().err
    assert said.startswith("error: ")
    assert re.search(error, said)


def test_a_map_at_points_has_no_other_form_than_csv(tmp_path):
    with pytest.raises(InputError, match=r"apertures at points: write a file that ends in \.csv"):
        write_aperture(pd.DataFrame({"x": [0], "y": [0], "aperture": [0]}), tmp_path / "a.nc")


def test_every_form_has_the_nodes_of_oblong_cells_at_their_places(tmp_path):
    y, x = 0.3 + 0.25 * np.arange(4), -1.0 + 0.1 * np.arange(7)
    values = np.arange(28, dtype=np.float32).reshape(4, 7)
    aperture = xr.DataArray(values, {"y": y, "x": x}, ("y", "x"), "aperture", {"source": "made"})
    for ending in ("csv", "nc", "vtk"):
        write_aperture(aperture, tmp_path / f"map.{ending}")
    table = pd.read_csv(tmp_path / "map.csv")
    table = table.pivot(index="y_mm", columns="x_mm", values="aperture_mm")
    with xr.open_dataset(tmp_path / "map.nc") as stored:
        netcdf = stored["aperture"].load()
    found = {
        "csv": (table.values, table.columns.values, table.index.values),
        "nc": (netcdf.values, netcdf["x"].values, netcdf["y"].values),
        "vtk": read_vtk(tmp_path / "map.vtk"),
    }
    for ending, (read, at_x, at_y) in found.items():
        np.testing.assert_allclose(read, values, err_msg=ending)
        np.testing.assert_allclose(at_x, x, err_msg=ending)
        np.testing.assert_allclose(at_y, y, err_msg=ending)


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("configuration", "{settings: ", "'configuration' is no JSON"),
        ("configuration", "[1]", "'configuration' holds no mapping"),
        ("parts", "x", "'parts' is no JSON"),
    ],
)
def test_an_atlas_with_a_damaged_attribute_is_refused_in_a_line(
    tmp_path, capsys, name, text, words
):
    attrs = {"study": "a", "configuration": "{}"} | {name: text}
    xr.Dataset(attrs=attrs).to_netcdf(tmp_path / "atlas.nc")
    assert main([str(tmp_path / "atlas.nc"), "pair", "--out", "a.csv"]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert words in line
