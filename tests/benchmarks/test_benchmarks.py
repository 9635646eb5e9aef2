"""The benchmark command on a problem small enough for a test."""

import csv
import subprocess
import sys

from places import BENCHMARKS

from contactlab.methods.registry import METHODS


def test_every_method_reaches_the_error_and_is_timed(tmp_path):
    command = [sys.executable, BENCHMARKS / "run.py", "--sizes", "32", "--hurst", "0.8"]
    options = ["--fractions", "0.07", "--runs", "1", "--scaling", "32", "--no-peers"]
    subprocess.run([*command, *options, "--output", tmp_path], check=True, capture_output=True)
    with (tmp_path / "solvers.csv").open() as file:
        rows = list(csv.DictReader(file))
    cold = {row["solver"].rsplit(" (", 1)[0] for row in rows if row["loading"] == "cold"}
    assert cold == {"fractalcontact", "fractalcontact at its default", *METHODS}
    for row in rows:
        assert float(row["error"]) <= 1e-6
        assert float(row["seconds"]) > 0
    applications = {row["solver"]: row["applications"] for row in rows if row["loading"] == "cold"}
    assert float(applications["fractalcontact (closure)"]) > 0
    assert applications["dense (closure)"] == ""
    tolerance = {row["solver"]: float(row["tolerance"]) for row in rows if row["loading"] == "cold"}
    default = tolerance["fractalcontact at its default (closure)"]
    assert default <= 1e-6 <= tolerance["fractalcontact (closure)"]
    text = (tmp_path / "benchmarks.md").read_text()
    assert "reference and elimination" in text
    with (tmp_path / "scaling.csv").open() as file:
        (row,) = csv.DictReader(file)
    assert float(row["growth beyond FFT"]) == 1.0
    assert float(row["warm applications"]) <= float(row["most"])
