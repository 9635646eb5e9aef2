"""What header lines of a text say, and what they do not."""

import pytest

from fractalcontact.scan.column_names import named_axes, numbers_columns, parse_name
from fractalcontact.scan.headings import read_statements


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (["# dx = 0.1 mm, dy = 0.2 mm"], {"unit_xy": "mm", "spacing": (0.1, 0.2)}),
        (["# dx = 0.1 mm", "# dy = 200 um"], {"unit_xy": "mm", "spacing": (0.1, 0.2)}),
        (["Pixel size: 0.5 x 0.25 um"], {"unit_xy": "um", "spacing": (0.5, 0.25)}),
        (
            ["PixelSizeX [um]: 0.5", "PixelSizeY [um]: 0.5"],
            {"unit_xy": "um", "spacing": (0.5, 0.5)},
        ),
        (["XY calibration\t1389\tnm/pixel"], {"unit_xy": "nm", "spacing": (1389, 1389)}),
        (["spacing 0.1"], {"spacing": (0.1, 0.1)}),
        (["10 columns, 12 rows, unit: mm"], {"unit_xy": "mm", "unit_z": "mm"}),
        (["unit: mm"], {"unit_xy": "mm", "unit_z": "mm"}),
        (["# x, y in mm, heights in um"], {"unit_xy": "mm", "unit_z": "um"}),
        (["z scale: 0.5 nm"], {"factor": 0.5, "unit_z": "nm"}),
        (["NODATA_value -9999"], {"missing": -9999}),
        (["first row: top"], {"first_row": "top"}),
        (["origin: lower left"], {"first_row": "bottom"}),
    ],
)
def test_statements_that_are_understood(lines, said):
    found = read_statements(lines)
    assert found.keys() == said.keys()
    for key, value in said.items():
        assert found[key] == (pytest.approx(value) if key == "spacing" else value)


@pytest.mark.parametrize(
    "line",
    [
        *("Temperature: 20 C", "Date: 2020-01-02 10:11:12", "made by hand", "resolution 640 x 480"),
        *(
            "missing points: 12",
            "invalid 3 of 400 cells",
            "missing 3 %",
            "scan size 640 x 480",
            "scale 1:50",
        ),
        *("vertical exaggeration 2", "gain: 2.5", "sampling 4"),
    ],
)
def test_other_lines_state_nothing(line):
    assert read_statements([line]) == {}


@pytest.mark.parametrize(
    "line",
    [
        *("Maximum height: 5 um", "optical resolution 2 um", "line spacing 5 um", "objective 5 mm"),
        *("unit: px", "Value units: V", "x step: 0.1 mm", "Scan length 10 mm", "spacing: 0,1 mm"),
    ],
)
def test_lines_that_speak_of_lengths_are_kept_in_their_own_words(line):
    (said,) = read_statements([line]).items()
    assert said[0] == "unread"
    assert said[1][0] in (line, "a spacing along x alone")


def test_two_lines_that_contradict_each_other_decide_nothing():
    said = read_statements(["unit_z: um", "heights in mm"])
    assert said == {"unread": ("unit_z: um", "heights in mm")}


@pytest.mark.parametrize(
    ("name", "word", "unit"),
    [
        *(("X [mm]", "x", "mm"), ("Height (um)", "height", "um"), ("z_um", "z", "um")),
        *(("x / mm", "x", "mm"), ('"Y"', "y", None), ("z [V]", "z", "V"), ("pos_x", "posx", None)),
    ],
)
def test_names_are_taken_apart(name, word, unit):
    column = parse_name(name)
    assert (column.word, column.unit) == (word, unit)


def test_names_decide_which_columns_are_x_y_and_z():
    named = named_axes(["Height [um]", "Row", "Col"])
    assert (named.columns, named.units, named.counted) == ((2, 1, 0), (None, None, "um"), True)
    assert named_axes(["north", "east", "elevation"]).columns == (1, 0, 2)
    assert named_axes(["x", "y", "z", "height"]).columns == (0, 1, 2)
    assert named_axes(["x [px]", "y [px]", "z"]).counted
    for names in (["x", "y"], ["time", "load", "z"], ["x", "x", "y", "z"], None):
        assert named_axes(names) is None


def test_names_that_only_number_columns():
    assert numbers_columns(["", "V1", "V2", "V3"])
    assert numbers_columns([*"ABCDEFGH"])
    assert numbers_columns(["index", *"ABCDEFGH"])
    assert not numbers_columns(["time", "load", "slip"])
