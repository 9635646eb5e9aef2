"""The table of what each part of the solver gains, on a problem small enough for a test."""

import csv
import subprocess
import sys

from places import BENCHMARKS


def test_every_part_is_left_out_once(tmp_path):
    command = [sys.executable, BENCHMARKS / "solver_gains.py", "--sizes", "64", "--hurst", "0.8"]
    options = ["--fractions", "0.1", "--runs", "1", "--output", tmp_path]
    run = subprocess.run([*command, *options], check=True, capture_output=True, text=True)
    with (tmp_path / "solver_gains.csv").open() as file:
        rows = list(csv.DictReader(file))
    cold = {row["without"]: row for row in rows if row["loading"] == "cold"}
    parts = {"preconditioner", "coarse correction", "clipping of the steps"}
    assert cold.keys() == {"", "nested iteration", "transforms of its own"} | parts
    assert all(int(row["applications"]) > 0 for row in rows)
    assert float(cold[""]["applications ratio"]) == 1.0
    assert float(cold["preconditioner"]["applications ratio"]) > 1.5
    for how in ("by the whole solver", "without projected steps", "without safeguards"):
        assert f"20 of 20 yielding problems solved {how}" in run.stdout
