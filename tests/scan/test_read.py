"""Scan files as heights in mm: exact round trips, bad input, real scans."""

import io
import os
import re
import socket
import zipfile

import numpy as np
import pytest
from places import SCANS
from scipy.interpolate import griddata
from stated import ARRAY, CORONA, GRANITE, NANOVEA, POINTS, SURFDIFF, read_faces, read_scan

from fractalcontact.core.errors import InputError
from fractalcontact.scan import read
from fractalcontact.scan.confined import read_confined
from fractalcontact.scan.options import ScanOptions
from fractalcontact.scan.readers import text

scans = pytest.mark.scans
needs_scans = pytest.mark.skipif(not SCANS.is_dir(), reason="the folder of real scans is absent")


#: Extensions, one of each reader.
KINDS = ["npy", "npz", "txt", "csv", "stl", "ply", "x3p", "nc", "h5", "mat", "tif", "gwy"]
KINDS += ["sur", "dat", "di", "nms"]
ONE_OF_EACH = {"npy", "txt", "ply", "x3p", "nc", "mat", "tif", "gwy", "sur"}


def surface(shape=(12, 15), seed=1):
    """Rough heights with two missing cells, in file units."""
    z = np.round(np.random.default_rng(seed).uniform(-0.5, 0.5, shape), 4)
    z[3, 4] = z[7, 2] = np.nan
    return z


def lattice_points(z, pitch=(0.5, 0.25), origin=(-3.0, 100.0)):
    y, x = np.indices(z.shape)
    points = np.column_stack(
        [origin[0] + pitch[0] * x.ravel(), origin[1] + pitch[1] * y.ravel(), z.ravel()]
    )
    return points[np.isfinite(points[:, 2])]


def save_npy(path, values):
    np.save(path, values)
    return path


def save_text(path, rows, delimiter=" ", header="", end="", decimal="."):
    lines = [delimiter.join("nan" if np.isnan(v) else f"{v:.10g}" for v in row) for row in rows]
    text = "\n".join(line.replace(".", decimal) + end for line in lines)
    path.write_text(header + text + "\n", encoding="utf-8")
    return path


def plane_cloud(n=3000, seed=2, side=20.0):
    """Scattered points of a plane: linear interpolation must give it back exactly.

    Its tilt of 3.8 degrees is one at which clouds are left as they lie.
    """
    xy = np.random.default_rng(seed).uniform(0, side, (n, 2))
    return np.column_stack([xy, 0.06 * xy[:, 0] - 0.03 * xy[:, 1] + 2.0])


# --- exact round trips -------------------------------------------------------------------------


@pytest.mark.parametrize(("unit", "factor"), [("mm", 1.0), ("m", 1e-3), ("um", 1e3)])
def test_the_unit_of_the_file_does_not_change_the_surface(tmp_path, unit, factor):
    z = surface()
    path = save_npy(tmp_path / "rock.npy", z * factor)
    heights = read_scan(path, {"unit": unit, "spacing": 0.1 * factor})
    np.testing.assert_allclose(heights.values, z, rtol=1e-12)
    np.testing.assert_allclose(heights.x, 0.1 * (np.arange(15) + 0.5), rtol=1e-12)
    assert heights.attrs["spacing_x"] == pytest.approx(0.1, rel=1e-12)
    assert (heights.dims, heights.name, heights.attrs["units"]) == (("y", "x"), "height", "mm")
    assert heights.attrs["file_unit"] == unit


def test_unit_of_heights_may_differ_and_spacing_may_be_a_pair(tmp_path):
    path = save_npy(tmp_path / "rock.npy", surface())
    heights = read_scan(path, {"unit_z": "um", "spacing": ["0.1 mm", "50 um"]})
    np.testing.assert_allclose(heights.values, surface() * 1e-3, rtol=1e-12)
    assert heights.attrs["spacing_x"] == pytest.approx(0.1)
    assert heights.attrs["spacing_y"] == pytest.approx(0.05)


def test_first_row_at_the_top_is_flipped_once(tmp_path):
    path = save_npy(tmp_path / "rock.npy", surface())
    options = {"unit": "mm", "spacing": 0.1}
    bottom = read_scan(path, options | {"first_row": "bottom"})
    top = read_scan(path, options | {"first_row": "top"})
    np.testing.assert_array_equal(bottom.values, surface())
    np.testing.assert_array_equal(top.values, surface()[::-1])
    np.testing.assert_array_equal(top.y, bottom.y)
    assert (np.diff(top.y) > 0).all()


def test_missing_number_and_infinity_are_missing_cells(tmp_path):
    z = surface()
    marked = np.where(np.isnan(z), -9999.0, z)
    marked[0, 0] = np.inf
    heights = read_scan(
        save_npy(tmp_path / "rock.npy", marked), {"unit": "um", "spacing": "1 um", "missing": -9999}
    )
    z[0, 0] = np.nan
    np.testing.assert_allclose(heights.values, z * 1e-3, rtol=1e-12)


TEXT_FORMS = {
    "blanks": {"delimiter": "  "},
    "commas": {"delimiter": ","},
    "comma and blank": {"delimiter": ", "},
    "trailing commas": {"delimiter": ",", "end": ","},
    "tabs, Windows": {"delimiter": "\t", "end": "\r"},
    "semicolons": {"delimiter": ";"},
    "German": {"delimiter": ";", "decimal": ","},
    "German blanks": {"delimiter": " ", "decimal": ","},
    "German tabs": {"delimiter": "\t", "decimal": ","},
    "comments": {"delimiter": " ", "header": "# made by hand\n# 12 Mai\n\n% more\n"},
    "byte order mark": {"delimiter": ",", "header": "\ufeff"},
}


@pytest.mark.parametrize("form", TEXT_FORMS.values(), ids=TEXT_FORMS.keys())
def test_text_matrices_of_all_styles_read_the_same(tmp_path, form):
    path = save_text(tmp_path / "rock.txt", surface(), **form)
    heights = read_scan(path, {"unit": "mm", "spacing": 0.1})
    np.testing.assert_allclose(heights.values, surface(), rtol=1e-9)
    assert heights.attrs["layout"] == "matrix"


def test_named_columns_are_found_in_any_order(tmp_path):
    x, y, z = lattice_points(surface()).T
    table = np.column_stack([np.arange(len(x)), z, 9 * z, y, x])
    path = save_text(tmp_path / "rock.csv", table, ",", header=",z,error,Y [mm],x\n")
    np.testing.assert_array_equal(read_scan(path, {"unit": "mm"}).values, surface())
    path = save_text(tmp_path / "rock2.csv", table, ",", header="n,h,error,north,east\n")
    for columns in (["east", "north", "h"], [4, 3, 1]):
        heights = read_scan(path, {"unit": "mm", "columns": columns})
        np.testing.assert_array_equal(heights.values, surface())
    with pytest.raises(InputError, match=r"no single column 'x'.*east"):
        read_scan(path, {"unit": "mm", "columns": ["x", "north", "h"]})


def test_a_header_line_of_numbers_is_no_header(tmp_path):
    """One header for two files would silently drop points of the one without."""
    points = lattice_points(surface())
    path = save_text(tmp_path / "rock.xyz", points)
    keys = POINTS | {"delimiter": "blank"}
    np.testing.assert_array_equal(read.read_scan(path, keys).values, surface())
    with pytest.raises(InputError, match=r"line 2, .* numbers .*'header: 0'"):
        read.read_scan(path, keys | {"header": 2})


def test_repeated_header_and_short_last_line(tmp_path):
    points = lattice_points(surface())
    lines = [",".join(f"{v:.10g}" for v in row) for row in points]
    lines = ["x,y,z", "x,y,z", *(f"{line}," for line in lines[:50]), "x,y,z", *lines[50:], "1.5,2"]
    path = tmp_path / "rock.txt"
    path.write_text("\r\n".join(lines), encoding="utf-8")
    heights = read_scan(path, {"unit": "mm"})
    np.testing.assert_array_equal(heights.values, surface())
    assert "cut short" in heights.attrs["notes"]


#: Forms of numbers, and what is left where the file breaks off inside the last one.
CUT = {
    "exponent": ("%.6e", -4),
    "digits of an exponent": ("%.6e", -1),
    "decimals": ("%.6f", -2),
    "counts": ("%d", -2),
    "varying decimals": ("%.6g", -5),
}


@pytest.mark.parametrize(("form", "end"), CUT.values(), ids=CUT.keys())
@pytest.mark.parametrize("layout", ["matrix", "points"])
def test_a_text_that_ends_inside_its_last_number(tmp_path, form, end, layout):
    """1.234567e-03 would be read as 1.234567: no point of it is kept, and no matrix is read."""
    z = np.round(surface() * 1e3) if form == "%d" else surface()
    z = np.nan_to_num(z, nan=0.1234) + (20_000 if form == "%d" else 1.0)
    z[-1, -1] = 12_345 if form == "%d" else 1.23456789
    rows = z if layout == "matrix" else lattice_points(z, pitch=(2, 1))
    path = tmp_path / "rock.txt"
    text = "\n".join(" ".join(form % value for value in row) for row in rows)
    stated = {"unit": "um", "spacing": "1 mm", "axes": "none", "first_row": "bottom"}
    if layout == "points":
        stated = {"unit_xy": "mm", "unit_z": "um", "columns": [0, 1, 2]}
    stated |= {"kind": "face", "layout": layout, "delimiter": "blank", "decimal": ".", "header": 0}
    stated |= {"heights": "up", "missing": "none"}
    path.write_text(text)
    whole = read.read_scan(path, stated)
    assert "cut" not in whole.attrs["notes"]
    path.write_text(text[:end])
    if layout == "matrix":
        with pytest.raises(InputError, match=r"last line \(12\) breaks off within a number"):
            read.read_scan(path, stated)
        return
    heights = read.read_scan(path, stated)
    assert "the last line (180) was cut short and is left out" in heights.attrs["notes"]
    np.testing.assert_array_equal(heights.values.ravel()[:-1], whole.values.ravel()[:-1])
    assert np.isnan(heights.values[-1, -1])


def test_a_mark_of_missing_cells_at_the_end_is_no_cut_number(tmp_path):
    """It has a form of its own, and other marks hide no number that is cut."""
    z = np.nan_to_num(surface(), nan=0.1234)
    rows = [[f"{value:.4f}" for value in row] for row in z]
    rows[-1][-1] = rows[-2][3] = "-9999"
    path = tmp_path / "rock.txt"
    stated = ARRAY | {"delimiter": "blank", "decimal": ".", "header": 0, "unit": "mm"}
    stated |= {"spacing": 1, "missing": -9999}
    path.write_text("\n".join(map(" ".join, rows)))
    heights = read.read_scan(path, stated)
    assert np.isnan(heights.values[-1, -1])
    assert heights.attrs["warnings"] == ""
    rows[-1][-1] = "0.12"
    path.write_text("\n".join(map(" ".join, rows)))
    with pytest.raises(InputError, match="breaks off within a number"):
        read.read_scan(path, stated)


def test_a_last_number_shorter_than_most_is_warned_of_without_a_line_end(tmp_path):
    """12 may be all of a number, or the beginning of 12345."""
    z = np.full((12, 15), 12_345) + np.arange(180).reshape(12, 15) ** 2 % 97
    z[-2, 3], z[-1, -1] = 7, 12
    path = tmp_path / "rock.txt"
    stated = ARRAY | {"delimiter": "blank", "decimal": ".", "header": 0, "unit": "um"}
    text = "\n".join(" ".join(map(str, row)) for row in z)
    for end, warned in (("", True), ("\n", False)):
        path.write_text(text + end)
        heights = read.read_scan(path, stated | {"spacing": "10 mm"})
        assert ("compare it with its source" in heights.attrs["warnings"]) == warned


@pytest.mark.parametrize("language", [("Width", "Height"), ("Breite", "Höhe")])
def test_gwyddion_export_states_its_size_and_runs_from_the_top(tmp_path, language):
    header = f"# Kanal: a 1\n# {language[0]}: 30,0 µm\n# {language[1]}: 12.0 µm\n# Value units: m\n"
    path = save_text(tmp_path / "rock.txt", surface() * 1e-6, "\t", header, decimal=",")
    heights = read_scan(path)
    np.testing.assert_allclose(heights.values, surface()[::-1] * 1e-3, rtol=1e-9)
    assert heights.attrs["spacing_x"] == pytest.approx(0.002)
    assert heights.attrs["spacing_y"] == pytest.approx(0.001)


def test_an_esri_grid_is_a_matrix_under_six_lines(tmp_path):
    z = surface()
    header = "ncols 15\nnrows 12\nxllcorner 0.0\nyllcorner 0.0\ncellsize 2.5\nNODATA_value -9999\n"
    path = save_text(tmp_path / "rock.asc", np.where(np.isnan(z), -9999, z), header=header)
    heights = read_scan(path, {"unit": "cm", "spacing": 2.5, "first_row": "top"})
    np.testing.assert_allclose(heights.values, z[::-1] * 10)
    assert heights.attrs["spacing_x"] == pytest.approx(25.0)


def test_npz_opens_the_wanted_array_and_never_a_pickled_one(tmp_path):
    path = tmp_path / "rock.npz"
    pickled = np.array([{"a": 1}], dtype=object)
    np.savez(path, z=surface(), x=np.arange(15.0), meta=pickled)
    options = {"unit": "mm", "spacing": 0.1}
    np.testing.assert_array_equal(read_scan(path, options).values, surface())
    with pytest.raises(InputError, match="'meta', no 2-D array"):
        read_scan(path, options | {"variable": "meta"})
    np.savez(path, z=surface(), raw=surface(seed=2), meta=pickled)
    with pytest.raises(InputError, match="lacks variable"):
        read.read_scan(path, {**ARRAY, **options})
    heights = read_scan(path, options | {"variable": "raw"})
    np.testing.assert_array_equal(heights.values, surface(seed=2))


# --- scattered points --------------------------------------------------------------------------


def test_a_plane_of_scattered_points_comes_back_exactly(tmp_path):
    path = save_npy(tmp_path / "rock.npy", plane_cloud())
    heights = read_scan(path, {"unit": "mm", "grid": "0.4 mm"})
    exact = 0.06 * heights.x - 0.03 * heights.y + 2.0 + 0.0 * heights
    assert float(np.abs(heights - exact).max()) < 1e-9
    assert float(heights.isnull().mean()) < 0.02
    np.testing.assert_allclose(heights.x / 0.4, np.round(heights.x / 0.4), atol=1e-9)
    assert "Delaunay" in heights.attrs["gridding"]


def test_default_grid_is_the_median_neighbour_distance(tmp_path):
    across, along = (axis.ravel() for axis in np.indices((20, 20)))
    points = plane_cloud(n=400)
    points[:, :2] = np.column_stack([along, across]) + points[:, :2] / 100
    apart = np.linalg.norm(points[:, None, :2] - points[None, :, :2], axis=-1)
    np.fill_diagonal(apart, np.inf)
    heights = read_scan(save_npy(tmp_path / "rock.npy", points), {"unit": "mm"})
    assert heights.attrs["spacing_x"] == pytest.approx(np.median(apart.min(axis=1)), rel=1e-12)


def test_outline_and_holes_stay_missing(tmp_path):
    points = plane_cloud(n=8000)
    x, y = points[:, 0] - 10, points[:, 1] - 10
    ring = (np.hypot(x, y) > 3.0) & ((x < 0) | (y < 0))  # a hole, and a corner cut out
    path = save_npy(tmp_path / "rock.npy", points[ring])
    heights = read_scan(path, {"unit": "mm", "grid": "0.25 mm"})
    x, y = np.meshgrid(heights.x - 10, heights.y - 10)
    present = np.isfinite(heights.values)
    margin = 0.5
    assert not present[np.hypot(x, y) < 3.0 - margin].any()
    assert not present[(x > margin) & (y > margin)].any()
    inside = (np.hypot(x, y) > 3.0 + margin) & (np.maximum(abs(x), abs(y)) < 10 - margin)
    inside &= (x < -margin) | (y < -margin)
    assert present[inside].all()


def test_a_grid_of_zero_is_refused(tmp_path):
    path = save_npy(tmp_path / "rock.npy", plane_cloud())
    with pytest.raises(InputError, match=r"rock\.npy: .*grid.*positive"):
        read_scan(path, {"unit": "mm", "grid": "0 mm"})


def test_a_stray_point_does_not_ask_for_all_memory(tmp_path):
    path = save_npy(tmp_path / "rock.npy", np.vstack([plane_cloud(), [1e7, 1e7, 0]]))
    with pytest.raises(InputError, match="stray points"):
        read_scan(path, {"unit": "mm"})


# --- two faces ---------------------------------------------------------------------------------


def test_two_clouds_share_one_grid_and_keep_their_gap(tmp_path):
    lower = plane_cloud(seed=1)
    upper = plane_cloud(seed=2, n=2000) + np.array([0, 0, 0.3])
    upper = upper[upper[:, 0] > 5]
    z_l, z_u = read_faces(
        save_npy(tmp_path / "rock.lower.npy", lower),
        save_npy(tmp_path / "rock.upper.npy", upper),
        {"unit": "mm"},
    )
    assert z_l.x.equals(z_u.x)
    assert z_l.y.equals(z_u.y)
    assert float(z_l.x[0]) >= 5
    assert z_l.attrs["spacing_x"] == z_u.attrs["spacing_x"]
    gap = (z_u - z_l).values
    np.testing.assert_allclose(gap[np.isfinite(gap)], 0.3, atol=1e-9)
    assert z_u.attrs["source"] == "rock.upper.npy"


def test_two_lattices_are_cropped_to_what_both_cover(tmp_path):
    z = surface((30, 40))
    lower = lattice_points(z[:25, :35], origin=(0.0, 0.0))
    upper = lattice_points(z[4:, 10:] + 1.0, origin=(10 * 0.5, 4 * 0.25))
    z_l, z_u = read_faces(
        save_npy(tmp_path / "rock.lower.npy", lower),
        save_npy(tmp_path / "rock.upper.npy", upper),
        {"unit": "mm"},
    )
    np.testing.assert_array_equal(z_l.values, z[4:25, 10:35])
    np.testing.assert_allclose((z_u - z_l).values, np.where(np.isnan(z_l), np.nan, 1.0))
    assert float(z_l.x[0]) == pytest.approx(5.0)


def test_two_matrices_need_the_same_spacing_and_are_cropped(tmp_path):
    lower = save_npy(tmp_path / "rock.lower.npy", surface((12, 15)))
    upper = save_npy(tmp_path / "rock.upper.npy", surface((14, 11)))
    z_l, z_u = read_faces(lower, upper, {"unit": "mm", "spacing": 0.1})
    assert z_l.shape == z_u.shape == (12, 11)
    other = {**ARRAY, "unit": "mm", "spacing": 0.1, "upper": {"spacing": [0.11, 0.1]}}
    with pytest.raises(InputError, match=r"rock\.lower\.npy and .*spacings along x differ"):
        read.read_faces(lower, upper, other)


def test_one_face_has_no_upper(tmp_path):
    lower, upper = read_faces(save_npy(tmp_path / "rock.npy", plane_cloud()), None, {"unit": "mm"})
    assert upper is None
    assert lower.ndim == 2


# --- bad input: one clear error ----------------------------------------------------------------


def test_no_unit_shows_the_lines_to_write(tmp_path):
    path = save_npy(tmp_path / "rock.lower.npy", surface())
    with pytest.raises(InputError) as error:
        read.read_scan(path)
    message = str(error.value)
    for part in ("rock.lower.npy", "rock.yaml", "unit: ", "spacing: "):
        assert part in message
    cloud = save_npy(tmp_path / "cloud.npy", plane_cloud())
    with pytest.raises(InputError) as error:
        read.read_scan(cloud, {"unit_z": "um"})
    assert "spacing" not in str(error.value)
    assert "unit_xy:" in str(error.value)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"units": "mm"}, "unknown scan key 'units'"),
        ({"unit": "kg"}, "unit.*not a length"),
        ({"unit": 3}, "unit: 3 is not right"),
        ({"spacing": 0.0}, "spacing: 0.0 is not right"),
        ({"spacing": "-1 mm"}, "key 'spacing'.*above zero"),
        ({"spacing": float("nan")}, "spacing: nan is not right"),
        ({"spacing": [1, 2, 3]}, "a pair"),
        ({"layout": "grid"}, "matrix or points"),
        ({"first_row": "left"}, "bottom or top"),
        ({"missing": "nothing"}, "key 'missing'"),
        ({"columns": [0, 1]}, "columns: .* is not right"),
        ({"grid": "0.1 mm"}, "key 'grid' has no meaning"),
    ],
)
def test_a_wrong_option_names_file_and_key(tmp_path, options, message):
    path = save_npy(tmp_path / "rock.npy", surface())
    with pytest.raises(InputError, match=rf"rock\.npy.*{message}"):
        read_scan(path, {"unit": "mm", "spacing": 0.1} | options)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (np.full((10, 10), 2.5), "constant surface"),
        (np.full((10, 10), np.nan), "all cells are missing"),
        (np.full((10, 10), np.inf), "all cells are missing"),
        (np.random.default_rng(0).normal(size=(7, 30)), "at least 8 x 8"),
        (np.random.default_rng(0).normal(size=(10, 10)) * 100, "not plausible"),
        (np.zeros((3, 4, 5)), "expected a 2-D array"),
        (np.array([["a"] * 9] * 9), "expected a 2-D array"),
        (np.array([[{}] * 9] * 9, dtype=object), "pickled Python objects, which are never opened"),
    ],
)
def test_what_is_no_rough_surface_is_refused(tmp_path, values, message):
    path = save_npy(tmp_path / "rock.npy", values)
    with pytest.raises(InputError, match=rf"rock\.npy.*{message}"):
        read_scan(path, {"unit": "mm", "spacing": 0.1})


@pytest.mark.parametrize(
    "extension",
    [pytest.param(kind, marks=() if kind in ONE_OF_EACH else pytest.mark.full) for kind in KINDS],
)
@pytest.mark.parametrize("content", [b"", b"\x00\x01\xfe no \x00" * 40], ids=["empty", "damaged"])
def test_empty_and_damaged_files_are_named(tmp_path, extension, content):
    path = tmp_path / f"rock.{extension}"
    path.write_bytes(content)
    with pytest.raises(InputError, match=rf"rock\.{extension}"):
        read_scan(path, {"unit": "mm", "spacing": 0.1})


def test_numbers_no_instrument_measures_are_refused_with_the_key_that_may_be_missing(tmp_path):
    z = surface()
    z[5, 5] = 1.70141e38  # a mark of missing cells, and no other program's secret
    path = save_npy(tmp_path / "rock.npy", z)
    with pytest.raises(InputError, match=r"rock\.npy: 1 x 1\.70141e\+38.*'missing: "):
        read_scan(path, {"unit": "mm", "spacing": 0.1, "missing": -1})
    heights = read_scan(path, {"unit": "mm", "spacing": 0.1, "missing": 1.70141e38})
    assert np.isnan(heights.values[5, 5])
    points = plane_cloud()
    points[7, 0] = -1e300
    with pytest.raises(InputError, match=r"it holds -1e\+300 mm"):
        read_scan(save_npy(path, points), {"unit": "mm"})


@pytest.mark.parametrize("change", ["append", "replace", "touch", "remove"])
def test_a_file_that_changes_while_it_is_read_is_refused(tmp_path, monkeypatch, change):
    path = save_npy(tmp_path / "rock.npy", surface())

    def read_while_it_changes(path, options):
        raw = read_confined(path, options)
        if change == "append":
            with open(path, "ab") as stream:
                stream.write(b"more")
        elif change == "replace":
            save_npy(tmp_path / "other.npy", surface(seed=2)).replace(path)
        elif change == "touch":
            os.utime(path, (1, 1))
        else:
            path.unlink()
        return raw

    monkeypatch.setattr("fractalcontact.scan.read.read_confined", read_while_it_changes)
    message = "no such file" if change == "remove" else "changed while it was read; wait"
    with pytest.raises(InputError, match=rf"rock\.npy: .*{message}"):
        read_scan(path, {"unit": "mm", "spacing": 0.1})


def test_what_only_has_the_name_of_a_scan_is_refused_unopened(tmp_path):
    (tmp_path / "folder.x3p").mkdir()
    os.mkfifo(tmp_path / "pipe.x3p")
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind(str(tmp_path / "s.x3p"))
    for name, what in {"folder": "a folder", "pipe": "a pipe", "s": "a pipe, socket"}.items():
        with pytest.raises(InputError, match=rf"{name}\.x3p: {what}"):
            read_scan(tmp_path / f"{name}.x3p")
    with pytest.raises(InputError, match="device"):
        read_scan("/dev/zero")
    for name in ("gone.x3p", "x" * 300 + ".x3p", "nul\0.x3p"):
        with pytest.raises(InputError, match="no such file"):
            read_scan(tmp_path / name)


@pytest.mark.parametrize("end", ["", "\n"])
def test_a_matrix_in_a_text_reads_the_same_in_blocks_of_any_size(tmp_path, monkeypatch, end):
    """Ends of blocks are no lines without numbers, and a line of those keeps its own number."""
    lines = [";".join(f"{value:.4f}" for value in row) for row in surface((40, 15))]
    lines = ["# by hand", ";".join(map(str, range(15))), *lines]
    lines[20:20] = ["", "# remark"]
    path = tmp_path / "rock.txt"
    path.write_text("\n".join(lines) + end)
    stated = ARRAY | {"delimiter": "semicolon", "decimal": ".", "header": 1, "axes": "row"}
    options = ScanOptions(**stated, unit="mm", spacing=1.0).but(missing="nan")
    confirmed = options.but(confirmed={})
    whole = text.read_text(path, confirmed)
    np.testing.assert_allclose(whole.values, surface((40, 15)))
    for size in (1, 100, 700):
        monkeypatch.setattr(text, "_BLOCK", size)
        parts = text.read_text(path, confirmed)
        np.testing.assert_array_equal(parts.values, whole.values)
        assert parts.notes == whole.notes
        with pytest.raises(InputError, match="line 22 holds no numbers, and 22 more rows"):
            text.read_text(path, options)


@pytest.mark.parametrize("wrong", ["0.5.1", "1,25", "1e", "n/a"])
def test_a_cell_that_is_no_number_is_named_with_its_line(tmp_path, wrong):
    rows = [[f"{value:.4f}" for value in row] for row in np.nan_to_num(surface((40, 9)))]
    rows[30][4] = wrong
    path = tmp_path / "rock.txt"
    path.write_text("\n".join(map(";".join, rows)) + "\n")
    stated = ARRAY | {"delimiter": "semicolon", "decimal": ".", "header": 0, "unit": "mm"}
    with pytest.raises(InputError, match=rf"rock\.txt: line 31 holds '{re.escape(wrong)}'"):
        read.read_scan(path, stated | {"spacing": 1})


def test_an_unknown_extension_lists_the_known(tmp_path):
    (tmp_path / "rock.docx").write_bytes(b"text")
    with pytest.raises(InputError, match=r"unknown extension '\.docx'.*\.npy.*\.x3p"):
        read_scan(tmp_path / "rock.docx")


def test_an_archive_that_would_inflate_without_end_is_refused(tmp_path):
    path = tmp_path / "rock.npz"
    np.savez_compressed(path, z=np.zeros((200, 200)), more=np.ones((200, 200)))
    content = bytearray(path.read_bytes())
    for entry in re.finditer(b"PK\x01\x02", content):  # sizes stand in the central directory
        content[entry.start() + 24 : entry.start() + 28] = (4_000_000_000).to_bytes(4, "little")
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"rock\.npz: 7\.5 GiB to read, .*allowed"):
        read_scan(path, {"unit": "mm", "spacing": 0.1})


def x3p_bytes(z, main="main.xml", data_xml=None, xml_head=""):
    """A minimal X3P file with its heights in a binary member or in the XML."""
    axis = "<C{0}><AxisType>{1}</AxisType><DataType>D</DataType><Increment>{2}</Increment></C{0}>"
    axes = axis.format("X", "I", 2e-6) + axis.format("Y", "I", 3e-6) + axis.format("Z", "A", 1e-6)
    link = data_xml or "<DataLink><PointDataLink>bindata/data.bin</PointDataLink></DataLink>"
    xml = (
        f"{xml_head}<ISO5436_2><Record1><FeatureType>SUR</FeatureType><Axes>{axes}</Axes></Record1>"
        f"<Record3><MatrixDimension><SizeX>{z.shape[1]}</SizeX><SizeY>{z.shape[0]}</SizeY>"
        f"<SizeZ>1</SizeZ></MatrixDimension>{link}</Record3></ISO5436_2>"
    )
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        archive.writestr(main, xml)
        archive.writestr(main.replace("main.xml", "bindata/data.bin"), z.astype("<f8").tobytes())
    return buffer.getvalue()


def test_x3p_binary_xml_and_in_a_subfolder(tmp_path):
    z = surface()
    datum = "".join(
        "<Datum/>" if np.isnan(v) else f"<Datum>{v!r}</Datum>" for v in z.ravel().tolist()
    )
    files = {
        "binary": x3p_bytes(z),
        "folder": x3p_bytes(z, main="scan/main.xml"),
        "xml": x3p_bytes(z, data_xml=f"<DataList>{datum}</DataList>"),
    }
    for name, content in files.items():
        path = tmp_path / f"{name}.x3p"
        path.write_bytes(content)
        heights = read_scan(path)
        np.testing.assert_allclose(heights.values, z * 1e-3, rtol=1e-12)
        assert heights.attrs["spacing_x"] == pytest.approx(0.002)
        assert heights.attrs["spacing_y"] == pytest.approx(0.003)


def test_x3p_with_entities_or_too_few_points_is_refused(tmp_path):
    path = tmp_path / "rock.x3p"
    path.write_bytes(x3p_bytes(surface(), xml_head='<!DOCTYPE a [<!ENTITY b "c">]>'))
    with pytest.raises(InputError, match="entities"):
        read_scan(path)
    path.write_bytes(x3p_bytes(surface(), data_xml="<DataList><Datum>1</Datum></DataList>"))
    with pytest.raises(InputError, match="1 Datum elements, but 180 needed"):
        read_scan(path)


# --- an instrument's file, written by its own library ------------------------------------------


def test_an_instrument_file_keeps_its_orientation_and_holes(tmp_path):
    from SurfaceTopography import Topography

    z = surface()  # rows are y
    masked = np.ma.masked_invalid(z.T)  # SurfaceTopography wants [x, y]
    Topography(masked, (1500.0, 600.0), unit="µm").to_netcdf(tmp_path / "rock.nc")
    heights = read_scan(tmp_path / "rock.nc")
    np.testing.assert_allclose(heights.values, z * 1e-3, rtol=1e-12)
    assert heights.attrs["spacing_x"] == pytest.approx(0.1)
    assert heights.attrs["spacing_y"] == pytest.approx(0.05)
    overridden = read_scan(tmp_path / "rock.nc", {"spacing": "0.2 mm"})
    assert overridden.attrs["spacing_x"] == pytest.approx(0.2)
    assert "the file says 0.1 x 0.05 mm" in overridden.attrs["overrides"]


# --- real scans --------------------------------------------------------------------------------


@scans
@needs_scans
@pytest.mark.full
def test_granite_gap_agrees_with_its_authors_table():
    folder = SCANS / "cnl_granite_pair"
    pair = (
        folder / "Extracted_M_CNL_SideA_bottom.txt",
        folder / "Extracted_M_CNL_SideB_top.txt",
    )
    _, x, y, aperture = np.loadtxt(
        folder / "Extracted_M_CNL_Aperture.csv", delimiter=",", skiprows=1
    ).T
    aperture *= 1e3  # m in the file
    # The table is on the points of side A and holds |gap|. Read back at those points, a grid at the
    # points' own spacing smooths the steps of the fracture; a grid three times finer does not.
    as_given = GRANITE | {"registration": "none"}
    for options, least in ((as_given, 0.97), (as_given | {"grid": "0.1 mm"}, 0.99)):
        z_l, z_u = read_faces(*pair, options)
        gap = (z_u - z_l).interp(x=("point", x), y=("point", y)).values
        inside = np.isfinite(gap)
        assert inside.mean() > 0.95
        assert np.corrcoef(np.abs(gap[inside]), aperture[inside])[0, 1] >= least
        assert gap[inside].mean() == pytest.approx(0.6365, abs=0.01)
    # On the grid's own nodes both are smoothed alike.
    z_l, z_u = read_faces(*pair, as_given)
    assert z_l.attrs["spacing_x"] == pytest.approx(0.304, abs=0.001)
    table = griddata((x, y), aperture, tuple(np.meshgrid(z_l.x, z_l.y)))
    gap = (z_u - z_l).values
    both = np.isfinite(table) & np.isfinite(gap)
    assert both.mean() > 0.98
    assert np.corrcoef(np.abs(gap[both]), table[both])[0, 1] >= 0.99


@scans
@needs_scans
def test_corona_fault_in_metres_with_its_pickled_key_untouched():
    path = SCANS / "corona_fault" / "coronaA_grids.npz"
    with pytest.raises(InputError, match="Z_grid, Z_detrended"):
        read.read_scan(path, {"unit": "m"})
    heights = read.read_scan(path, CORONA)
    assert heights.shape == (388, 537)
    assert float(heights.isnull().mean()) == pytest.approx(0.007, abs=0.001)
    assert heights.attrs["spacing_x"] == pytest.approx(5.6858, abs=1e-4)
    assert float(heights.max() - heights.min()) == pytest.approx(216.725, abs=0.001)


@scans
@needs_scans
@pytest.mark.full
def test_grasselli_mesh_keeps_its_wedge_outline():
    heights = read_scan(SCANS / "grasselli_joint" / "example_surface.stl", {"unit": "mm"})
    assert heights.attrs["spacing_x"] == pytest.approx(0.196, abs=0.001)
    # The mesh's own triangles leave 23.4 % of their bounding box outside, their hull 19.7 %.
    assert 0.20 < float(heights.isnull().mean()) < 0.26


@scans
@needs_scans
def test_text_profilometers_are_placed_exactly():
    options = NANOVEA
    heights = read_scan(SCANS / "nanovea" / "test1.txt", options)
    assert heights.shape == (101, 101)
    assert heights.attrs["spacing_x"] == pytest.approx(0.005)
    assert float(heights[0, 1]) == pytest.approx(0.4783340)
    assert read_scan(SCANS / "nanovea" / "test4.txt", options).shape == (101, 101)
    folder = SCANS / "surfdiff_rock"
    z_l, z_u = read_faces(folder / "BottomBlue.csv", folder / "TopRed.csv", SURFDIFF)
    assert z_l.shape == (88, 104)
    assert not z_l.isnull().any()
    assert float(np.abs(z_u - z_l).max()) == 0.0


@scans
@needs_scans
def test_x3p_in_binary_and_in_xml_hold_the_same_surface():
    binary, xml = (
        read_scan(SCANS / "instruments" / "x3p" / f"surface_{kind}.x3p")
        for kind in ("binary", "xml")
    )
    np.testing.assert_array_equal(binary.values, xml.values)
