"""What does not describe itself is read only as its sidecar says; what does needs none."""

import dialects_of_matrices
import dialects_of_meaning
import dialects_of_points
import numpy as np
import pytest
import yaml
from foreign_words import WORDS, foreign_lines
from scan_writers import WRITERS, write
from stated import POINTS, array_sidecar, sidecar

from fractalcontact.core.errors import InputError
from fractalcontact.scan.raw import IncompleteSidecar
from fractalcontact.scan.read import read_faces, read_scan

assert all((dialects_of_matrices, dialects_of_meaning, dialects_of_points))  # their dialects
DX, DY = 0.1, 0.25
#: Files that describe themselves, or lack nothing but a unit.
COMPLETE = {".x3p", ".xml.x3p", ".cloud.x3p", ".nc", ".classic.nc", ".instrument.nc", ".gwy"}
OF_UNIT = {".stl", ".ply", ".obj"}
STATED = sorted(WRITERS.keys() - COMPLETE - OF_UNIT)


def surface(shape=(9, 14), seed=3):
    """Heights in mm without symmetry; one cell is missing."""
    heights = np.random.default_rng(seed).uniform(-0.2, 0.2, shape)
    heights[1, 2] = np.nan
    return heights


@pytest.mark.parametrize("ending", STATED)
def test_a_file_without_a_sidecar_is_refused_with_the_sidecar_to_write(tmp_path, ending):
    path = tmp_path / f"rock{ending}"
    keys = write(path, surface(), DX, DY)
    with pytest.raises(IncompleteSidecar, match="and it has no sidecar") as error:
        read_scan(path)
    draft = yaml.safe_load(error.value.draft)
    assert str(error.value).endswith(error.value.draft)
    # Its empty lines filled in, by who knows, it is complete.
    filled = {k: keys.get(k) if value is None else value for k, value in draft.items()}
    heights = read_scan(path, {k: value for k, value in filled.items() if value is not None})
    assert np.nanmax(np.abs(heights.values - surface())) < 1e-6


@pytest.mark.parametrize("ending", STATED)
def test_a_sidecar_that_lacks_any_key_is_refused_and_the_key_named(tmp_path, ending):
    path = tmp_path / f"rock{ending}"
    keys = write(path, surface(), DX, DY)
    read_scan(path, keys)
    for key in keys:
        lacking = {other: value for other, value in keys.items() if other != key}
        with pytest.raises(IncompleteSidecar, match=rf"lacks ([a-z_]+, )*{key}"):
            read_scan(path, lacking)


@pytest.mark.parametrize("ending", sorted(COMPLETE))
def test_a_file_that_describes_itself_needs_no_sidecar(tmp_path, ending):
    path = tmp_path / f"rock{ending}"
    assert write(path, surface(), DX, DY) == {}
    assert np.nanmax(np.abs(read_scan(path).values - surface())) < 1e-6


def test_words_of_a_header_never_change_what_is_read(tmp_path):
    assert len(set(WORDS)) >= 200
    rng = np.random.default_rng(0)
    path = tmp_path / "rock.csv"
    keys = write(path, surface(), DX, DY)
    plain, numbers = read_scan(path, keys), path.read_text(encoding="utf-8")
    for mark in ("# ", "", "% "):
        lines = [f"{mark}{line}" for line in foreign_lines(rng, len(WORDS))]
        path.write_text("\n".join(lines) + "\n" + numbers, encoding="utf-8")
        under = read_scan(path, keys | {"header": len(lines)})
        np.testing.assert_array_equal(under, plain)
        with pytest.raises(IncompleteSidecar):
            read_scan(path)


def table(names, form="{:.4f};{:.4f};{:.5f}", end=""):
    """Points under a line of names."""
    y, x = np.indices((9, 14))
    z = np.nan_to_num(surface())
    lines = [form.format(*row) for row in zip(0.1 * x.ravel(), 0.1 * y.ravel(), 1e3 * z.ravel(),
                                              strict=True)]  # fmt: skip
    return "\n".join([names, *lines]) + end


def test_columns_named_with_their_units_need_no_sidecar(tmp_path):
    path = tmp_path / "rock.csv"
    for names in (
        "x [mm];y [mm];z [um]",
        "# X [mm];Y [mm];Z [µm]",
        'made by hand\n"x (mm)";y (mm);z(um)',
    ):
        path.write_text(table(names), encoding="utf-8")
        heights = read_scan(path)
        np.testing.assert_allclose(heights, np.nan_to_num(surface()), atol=1e-8)
        assert heights.attrs["spacing_x"] == pytest.approx(0.1)


@pytest.mark.parametrize(
    "text",
    [
        table("x;y;z"),
        table("x [mm];y [mm];z"),
        table("x [mm];y [mm];z [V]"),
        table("x [mm];y [mm];height [um]"),
        table("x [mm];y [mm];z [um]\nremark"),
        table("x [mm];y [mm];z [um]").replace(".", ","),
        table("x [mm];y [mm];z [um]", "{:.3f};{:.3f};{:.3f}").replace("0.", "1."),
    ],
    ids=["no units", "no unit of z", "volts", "height", "a line between", "commas", "thousands?"],
)
def test_columns_that_leave_anything_open_need_one(tmp_path, text):
    path = tmp_path / "rock.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(IncompleteSidecar):
        read_scan(path)


def test_what_was_confirmed_is_compared(tmp_path):
    path = tmp_path / "rock.npy"
    keys = write(path, surface(), DX, DY)
    relief = float(np.nanmax(surface()) - np.nanmin(surface()))
    keys |= {"confirmed": {"shape": [9, 14], "relief": relief}}
    read_scan(path, keys)
    write(path, surface((9, 15)), DX, DY)
    with pytest.raises(InputError, match=r"confirms shape \[9, 14\], the file holds \[9, 15\]"):
        read_scan(path, keys)
    write(path, 2 * surface(), DX, DY)
    with pytest.raises(InputError, match=r"confirms relief .*, the file holds .*'relief: "):
        read_scan(path, keys)


def test_a_profile_is_refused_in_a_sentence(tmp_path):
    path = tmp_path / "rock.npy"
    keys = write(path, surface(), DX, DY)
    with pytest.raises(InputError, match=r"a profile and no surface"):
        read_scan(path, keys | {"kind": "profile"})


def test_what_is_said_of_one_face_holds_for_it_alone(tmp_path):
    z, paths = np.nan_to_num(surface()), {}
    y, x = np.indices(z.shape)
    for face, header in (("lower", "x,y,z\n" * 2), ("upper", "")):
        gap = 0.5 * (face == "upper")
        points = np.column_stack([0.1 * x.ravel(), 0.1 * y.ravel(), z.ravel() + gap])
        paths[face] = tmp_path / f"rock.{face}.txt"
        lines = "\n".join(",".join(f"{v:.9g}" for v in row) for row in points)
        paths[face].write_text(header + lines, encoding="utf-8")
    stated = {**POINTS, "header": 2, "upper": {"header": 0}, "registration": "none"}
    lower, upper = read_faces(paths["lower"], paths["upper"], stated)
    np.testing.assert_allclose(upper - lower, 0.5, atol=1e-8)
    assert lower.shape == z.shape


def test_depths_are_turned_over_and_x_and_y_are_not(tmp_path):
    path = tmp_path / "rock.npy"
    keys = write(path, surface(), DX, DY)
    down = read_scan(path, keys | {"heights": "down"})
    np.testing.assert_array_equal(down, -surface())


def test_texts_of_sidecars_are_yaml():
    assert yaml.safe_load(array_sidecar(0.1, missing=-1))["missing"] == -1
    assert yaml.safe_load(sidecar(POINTS))["decimal"] == "."


def test_a_cell_of_a_thousand_signs_does_not_fill_the_message(tmp_path):
    path = tmp_path / "rock.xyz"
    path.write_text("0 0 0.1\n1 0 0.2\n2 0 " + "0.3" + "," * 1000 + "\n", encoding="utf-8")
    keys = {"kind": "face", "unit": "mm", "heights": "up", "missing": "none", "layout": "points"}
    keys |= {"delimiter": "blank", "decimal": ".", "header": 0, "columns": [0, 1, 2]}
    with pytest.raises(InputError, match="do not fit its sidecar") as caught:
        read_scan(path, keys)
    assert len(str(caught.value)) < 500
