"""Coverage of scanned pairs: what a scan does to a face, and what the table compares."""

import csv
import sys

import numpy as np
import pytest
from places import BENCHMARKS

sys.path.insert(0, str(BENCHMARKS))
import pair_coverage


def test_a_scan_has_noise_outliers_and_a_frame_of_its_own():
    lower, upper = pair_coverage.true_faces(3, 96)
    assert np.std(upper - lower) == pytest.approx(pair_coverage.MISMATCH, rel=0.05)
    still = pair_coverage.scanned(lower, np.random.default_rng(1), moved=False)
    apart = still - lower
    noise = np.median(np.abs(apart)) * 1.4826
    assert noise == pytest.approx(pair_coverage.NOISE, rel=0.1)
    outliers = np.count_nonzero(np.abs(apart) > 6 * pair_coverage.NOISE)
    assert 0 < outliers <= 3 * pair_coverage.OUTLIERS * lower.size
    moved = pair_coverage.scanned(lower, np.random.default_rng(1), moved=True)
    assert np.std(moved - lower) > 2 * np.std(apart)


@pytest.mark.full
def test_the_command_writes_each_interval_with_its_truth(tmp_path, capsys):
    path = tmp_path / "coverage.csv"
    options = ["--seeds", "1", "--cells", "64", "--window", "9", "--output", str(path)]
    pair_coverage.main(options)
    with path.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert {row["quantity"] for row in rows} <= set(pair_coverage.QUANTITIES)
    assert {"jrc", "mean_gap"} <= {row["quantity"] for row in rows}
    for row in rows:
        true, low, high = (float(row[key]) for key in ("true", "low", "high"))
        assert low <= high
        assert (row["holds"] == "True") == (low <= true <= high)
    assert "hold the truth" in capsys.readouterr().out
