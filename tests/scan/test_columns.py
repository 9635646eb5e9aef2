"""Tables of a laboratory: each cell is read as it was written, or refused with line and cell."""

import re

import numpy as np
import pytest

from fractalcontact.core.errors import InputError
from fractalcontact.scan.columns import read_columns

WANTED = {"pressure": "pressure", "displacement": "displacement"}
HEAD = "pressure [MPa], displacement [um]"


def read(folder, text, wanted=WANTED):
    path = folder / "load.csv"
    path.write_bytes(text.encode())
    return {name: one.values.tolist() for name, one in read_columns(path, wanted).items()}


@pytest.mark.parametrize(
    ("line", "words"),
    [
        (
            "0,25,10,35",
            "line 3: 4 cells below 2 headings, it is '0,25,10,35'; numbers with decimal",
        ),
        ("0,25;10,35", "line 3: 3 cells below 2 headings"),
        ('"0,25","10,35"', "line 3, column 'pressure [MPa]': '0,25' is no finite number"),
        ("1", "line 3, column 'displacement [um]': the line ends before this column"),
        ("1,", "line 3, column 'displacement [um]': the cell is empty"),
        ("1,2,3", "line 3: 3 cells below 2 headings"),
        ("1,nan", "line 3, column 'displacement [um]': 'nan' is no finite number"),
        ("1,inf", "'inf' is no finite number"),
        ("1,1e400", "'1e400' is no finite number"),
        ("1,1_0", "'1_0' is no finite number"),
        ("1,#DIV/0!", "'#DIV/0!' is no finite number"),
        ("01. Jan,2", "line 3, column 'pressure [MPa]': '01. Jan' is a date"),
        ("3.Mrz,2", "'3.Mrz' is a date"),
        ("1-Feb,2", "'1-Feb' is a date"),
        ("Jan 25,2", "'Jan 25' is a date"),
        ("2026-01-02,2", "'2026-01-02' is a date"),
        ("01.02.2026,2", "'01.02.2026' is a date"),
        ("1/2/2026,2", "'1/2/2026' is a date"),
        ("3 MPa,2", "'3 MPa' is no finite number"),
    ],
)
def test_a_cell_that_is_no_number_is_refused_with_its_place(tmp_path, line, words):
    with pytest.raises(InputError, match=re.escape(words)) as refusal:
        read(tmp_path, f"{HEAD}\n0.5,1\n{line}\n2,3\n")
    assert "load.csv: line 3" in str(refusal.value)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    "text",
    [
        f"{HEAD}\n0.25,10.35\n0.5,-20\n",
        f"{HEAD}\n0.25,10.35,,\n0.5,-20\n",
        f"{HEAD}\r\n0.25,10.35\r\n\r\n0.5,\u221220\r\n\x1a",
        f"{HEAD}\n0.25,10.35\n0.5,-20\x1a\n",
        "pressure [MPa];displacement [um]\n0,25;10,35\n0,5;-20\n",
        "displacement [um]\tpressure [MPa]\n10,35\t0,25\n-2,0e1\t0,5\n",
        'time;"pressure [MPa]";"displacement [um]"\n1;"0,25";"10,35"\n2;"0,5";"-20"\n',
    ],
)
def test_numbers_are_those_that_were_written(tmp_path, text):
    assert read(tmp_path, text) == {"pressure": [0.25, 0.5], "displacement": [10.35, -20]}


@pytest.mark.parametrize(
    ("heading", "stated", "unit"),
    [
        ("Normal stress (mean) [MPa]", "Normal stress (mean) [MPa]", "MPa"),
        ("Normal stress (mean) [MPa]", "normal stress (mean)", "MPa"),
        ("Normal stress (mean)", "Normal stress (mean) [MPa]", "MPa"),
        ("Sn, mean [MPa]", "Sn, mean", "MPa"),
        ("LVDT [1] (um)", "LVDT [1] (um)", "um"),
        ("Verschiebung [\u03bcm]", "Verschiebung [\u00b5m]", "\u03bcm"),
        ("Verschiebung [\u00b5m]", "Verschiebung [\u03bcm]", "\u03bcm"),
        ("Verschiebung [\u00b5m]", "Verschiebung [um]", "\u03bcm"),
        ("T [mm\u00b3]", "T [mm3]", "mm3"),
        ("\u212bngstr\u00f6m\u00a0x [mm]", "A\u030angstro\u0308m x [mm]", "mm"),
    ],
)
def test_a_heading_is_found_however_its_signs_are_coded(tmp_path, heading, stated, unit):
    path = tmp_path / "load.csv"
    path.write_text(f"n;{heading}\n1;2\n", encoding="utf-8")
    (column,) = read_columns(path, {"x": stated}).values()
    assert (column.unit, column.values.tolist(), column.heading) == (unit, [2], heading)


def test_another_unit_or_two_columns_of_a_name_are_refused(tmp_path):
    with pytest.raises(InputError, match="does not name these columns"):
        read(tmp_path, f"{HEAD}\n1,2\n", WANTED | {"pressure": "pressure [mPa]"})
    with pytest.raises(InputError, match="columns 1 and 3 are both 'pressure'; rename one, or"):
        read(tmp_path, f"{HEAD}, pressure [kPa]\n1,2,1000\n")
    wanted = WANTED | {"pressure": "PRESSURE [kPa]"}
    found = read(tmp_path, f"{HEAD}, Pressure [kPa]\n1,2,9\n", wanted)
    assert found["pressure"] == [9]


def test_every_cell_keeps_its_line(tmp_path):
    path = tmp_path / "load.csv"
    path.write_text(f"\n{HEAD}\n\n1,2\n\n3,4\n")
    column = read_columns(path, WANTED)["displacement"]
    assert column.where.endswith("load.csv: line 2, column 'displacement [um]'")
    assert column.at(1).endswith("line 6, column 'displacement [um]': 4 um")
    np.testing.assert_array_equal(column.lines, [2, 4, 6])
