"""Drafts of sidecars: decided where the file decides, else empty, with the choices beside."""

import numpy as np
import pytest
import yaml
from PIL import Image

from fractalcontact.scan.raw import IncompleteSidecar
from fractalcontact.scan.read import read_scan
from fractalcontact.scan.undeclared import possible_marks


def heights(shape=(12, 16)):
    return np.random.default_rng(4).uniform(-0.2, 0.2, shape)


def drafted(path):
    """Text of the draft, and its keys."""
    with pytest.raises(IncompleteSidecar) as caught:
        read_scan(path)
    return caught.value.draft, yaml.safe_load(caught.value.draft)


def text(folder, lines=(), z=None, form="{:.6f}", between="\t", name="rock.txt"):
    z = heights() if z is None else z
    rows = [between.join(form.format(value) for value in row) for row in z]
    (folder / name).write_text("\n".join([*lines, *rows]) + "\n")
    return folder / name


def comment_of(draft, key):
    return next(line for line in draft.split("\n") if line.strip().startswith(f"{key}:"))


CLEAR = ["# dx = 0.1 mm; dy = 0.2 mm", "# z in um", "# NODATA_value -9999", "# first row: top"]


def test_what_a_clear_header_states_is_drafted(tmp_path):
    _, keys = drafted(text(tmp_path, CLEAR))
    assert None not in keys.values()
    stated = {"spacing": ["0.1 mm", "0.2 mm"], "unit_z": "um", "missing": -9999, "axes": "none"}
    stated |= {"first_row": "top", "heights": "up", "kind": "face", "header": 4, "decimal": "."}
    assert {key: keys[key] for key in stated} == stated


@pytest.mark.parametrize("line", [
    "# the stage was calibrated in um", "# spot size in um: see certificate", "# report in inch",
    "# pixel size (sensor): 3.45 um", "# joint spacing: 20 mm", "# step height of a standard: 2 um",
    "# sample size: 30 mm", "# origin: Upper Austria", "# missing: 0",
])  # fmt: skip
def test_a_word_in_prose_decides_nothing(tmp_path, line):
    _, keys = drafted(text(tmp_path, [line]))
    for key in ("unit", "unit_xy", "unit_z", "spacing", "first_row"):
        assert keys.get(key) is None
    assert keys.get("missing") in (None, "none")


@pytest.mark.parametrize(
    ("line", "key"),
    [("# gap between lines: none", "kind"), ("# depth of focus 3 um", "heights")],
)
def test_a_word_for_another_kind_or_direction_is_asked_about(tmp_path, line, key):
    draft, keys = drafted(text(tmp_path, [line]))
    assert keys[key] is None
    assert line in comment_of(draft, key)


def test_a_length_is_named_over_points_and_over_cells(tmp_path):
    z = heights((21, 21))
    draft, keys = drafted(text(tmp_path, ["# scan length X: 3.0 mm", "# scan length Y: 3.0 mm"], z))
    assert keys["spacing"] is None
    assert "0.15 mm from the first to the last, 0.142857 mm" in comment_of(draft, "spacing")


@pytest.mark.parametrize("mark", ["0", "-1", "0.25"])
def test_a_mark_near_the_relief_is_asked_about(tmp_path, mark):
    z = heights()
    path = text(tmp_path, z=z)
    assert drafted(path)[1]["missing"] == "none"
    z[4:6, 3:6] = float(mark)
    draft, keys = drafted(text(tmp_path, z=z))
    assert keys["missing"] is None
    assert f"6 cells hold {mark}" in comment_of(draft, "missing")
    z[4:6, 3:6] = -9999
    assert drafted(text(tmp_path, z=z))[1]["missing"] == -9999


def test_zeros_of_an_aperture_map_stay(tmp_path):
    z = np.maximum(heights(), 0)
    draft, keys = drafted(text(tmp_path, z=z, name="aperture.txt"))
    assert (keys["kind"], keys["missing"]) == ("aperture", "none")
    assert "zeros of an aperture map are contact" in comment_of(draft, "missing")
    _, keys = drafted(text(tmp_path, z=z, name="other.txt"))
    assert (keys["kind"], keys["missing"]) == (None, None)


@pytest.mark.parametrize("digits", [2, 4, 9])
def test_rough_heights_hold_no_possible_mark(digits):
    z = np.random.default_rng(0).normal(size=(150, 150)).cumsum(0) * 0.1 + 31.7
    assert possible_marks(np.round(z, digits)) == []


def points():
    y, x = np.indices((12, 16))
    return np.column_stack([x.ravel(), y.ravel(), heights().ravel()])


def test_columns_are_asked_unless_their_names_or_the_ending_tell(tmp_path):
    lengths = points() * [0.1, 0.2, 1]
    draft, keys = drafted(text(tmp_path, z=lengths))
    assert keys["columns"] is None
    line = comment_of(draft, "columns")
    assert "[0, 1, 2] if x comes before y, [1, 0, 2] if y comes first" in line
    _, keys = drafted(text(tmp_path, ["Y\tX\theight"], z=lengths[:, [1, 0, 2]]))
    assert keys["columns"] == [1, 0, 2]
    assert drafted(text(tmp_path, z=lengths, name="rock.xyz"))[1]["columns"] == [0, 1, 2]
    assert "spacing" not in keys


def test_whole_numbers_in_steps_of_one_may_count_cells(tmp_path):
    rows = [f"{x:.0f}\t{y:.0f}\t{z:.6f}" for x, y, z in points()]
    (tmp_path / "rock.xyz").write_text("\n".join(rows) + "\n")
    draft, keys = drafted(tmp_path / "rock.xyz")
    assert keys["spacing"] is None
    assert "delete this line if they are lengths" in comment_of(draft, "spacing")


def test_axes_are_asked_where_heights_may_ascend(tmp_path):
    z = heights()
    z[:, 0] = 0.03 * np.arange(12)
    draft, keys = drafted(text(tmp_path, z=z))
    assert keys["axes"] is None
    assert "its first column runs from" in comment_of(draft, "axes")
    framed = np.vstack([0.1 * np.arange(17) + 5, np.column_stack([0.2 * np.arange(12), heights()])])
    assert drafted(text(tmp_path, z=framed))[1]["axes"] == "both"
    counted = np.column_stack([np.arange(12), heights()])
    assert drafted(text(tmp_path, z=counted))[1]["axes"] == "column"


def test_digits_that_may_be_grouped_are_asked_about(tmp_path):
    counts = np.round(1e5 * heights() + 5e5)
    draft, keys = drafted(text(tmp_path, z=counts, form="{:,.0f}"))
    assert (keys["decimal"], keys["thousands"]) == (None, None)
    assert "may group thousands" in comment_of(draft, "decimal")
    _, keys = drafted(text(tmp_path, z=counts + 0.25, form="{:,.2f}"))
    assert (keys["decimal"], keys["thousands"]) == (".", ",")
    assert drafted(text(tmp_path))[1]["decimal"] == "."


def test_pictures_leave_their_first_row_and_zeros_open(tmp_path):
    grey = np.round(1e5 * heights() + 3e4).astype(np.uint16)
    Image.fromarray(grey).save(tmp_path / "rock.png")
    assert drafted(tmp_path / "rock.png")[1]["missing"] == "none"
    grey[3:5, 3:5] = 0
    Image.fromarray(grey).save(tmp_path / "rock.png")
    draft, keys = drafted(tmp_path / "rock.png")
    assert (keys["first_row"], keys["missing"]) == (None, None)
    assert "4 cells hold 0" in comment_of(draft, "missing")


def test_numbers_of_an_archive_without_a_unit_are_named_and_not_taken(tmp_path):
    np.savez(tmp_path / "rock.npz", Z=heights(), dx=7.0)
    draft, keys = drafted(tmp_path / "rock.npz")
    assert keys["spacing"] is None
    assert "dx = 7, without a unit" in comment_of(draft, "spacing")
