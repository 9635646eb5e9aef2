"""Tables as CSV: numbers and texts come back, and no cell is one that a spreadsheet runs."""

import csv
import io
import re

import numpy as np
import pandas as pd
from places import ROOT
from spreadsheets import FORMULA, FORMULAS, formulas_in

from fractalcontact.core.tables import table_text, write_table


def test_no_text_is_one_that_a_spreadsheet_runs_and_all_others_come_back(tmp_path):
    harmless = ["rock = 1", "a-b", "", "'=1", "-44.3", "+5e-3", "Brèche", 'a, "b"; c']
    texts = [*FORMULAS, *harmless]
    write_table(tmp_path / "t.csv", pd.DataFrame({"group": texts, "=1+1": range(len(texts))}))
    text = (tmp_path / "t.csv").read_bytes().decode()
    assert formulas_in(text) == []
    header, *rows = csv.reader(io.StringIO(text, newline=""))
    assert header == ["group", "'=1+1"]
    assert [row[1] for row in rows] == [str(number) for number in range(len(texts))]
    assert [row[0] for row in rows][len(FORMULAS) :] == harmless
    assert f"'{FORMULA}" in [row[0] for row in rows]


def test_numbers_and_verdicts_are_written_as_they_are(tmp_path):
    generator = np.random.default_rng(1)
    table = pd.DataFrame(
        {
            "value": generator.normal(size=50) * 10.0 ** generator.integers(-12, 12, 50),
            "single": generator.normal(size=50).astype("float32"),
            "nodes": generator.integers(-9, 9, 50),
            "resolved": generator.random(50) < 0.5,
            "mixed": [-1.5, "rock"] * 25,
            "missing": np.nan,
        }
    )
    before = table.copy()
    write_table(tmp_path / "t.csv", table)
    pd.testing.assert_frame_equal(table, before)
    found = pd.read_csv(tmp_path / "t.csv")
    for name in ("value", "single", "missing"):
        np.testing.assert_allclose(found[name], table[name], rtol=1e-7)
    for name in ("nodes", "resolved"):
        assert found[name].tolist() == table[name].tolist()
    assert found["mixed"].tolist() == ["-1.5", "rock"] * 25


def test_a_table_without_rows_has_its_header(tmp_path):
    write_table(tmp_path / "t.csv", pd.DataFrame({"study": [], "specimen": []}))
    assert (tmp_path / "t.csv").read_text(encoding="utf-8") == "study,specimen\n"


def test_no_other_function_writes_a_table():
    writes = re.compile(r"\bto_csv\b|\bto_excel\b|csv\.writer|DictWriter|\bsavetxt\b|\.tofile\(")
    paths = [*ROOT.glob("src/**/*.py"), *ROOT.glob("workflow/**/*"), ROOT / "Snakefile"]
    found = [
        p
        for p in paths
        if p.is_file() and p.suffix != ".pyc" and writes.search(p.read_text(encoding="utf-8"))
    ]
    assert [path.relative_to(ROOT).as_posix() for path in found] == [
        "src/fractalcontact/core/tables.py"
    ]


def test_a_table_of_floats_alone_is_written_as_pandas_would():
    rng = np.random.default_rng(1)
    values = rng.normal(size=(50, 2)) * 10.0 ** rng.integers(-320, 300, (50, 2))
    table = pd.DataFrame(values, columns=["x", "=1+1"])
    table["single"] = rng.random(50).astype(np.float32)
    table.iloc[3:8, 0] = [np.nan, np.inf, -np.inf, -0.0, 1e22]
    expected = table.rename(columns={"=1+1": "'=1+1"}).to_csv(
        index=False, float_format="%.8g", lineterminator="\n"
    )
    assert table_text(table) == expected
    alone = pd.DataFrame({"x": [1.0, np.nan]})
    assert table_text(alone) == alone.to_csv(index=False, lineterminator="\n").replace("1.0", "1")
    assert table_text(table[:0]) == "x,'=1+1,single\n"
