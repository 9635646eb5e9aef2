"""The benchmark of periodic contact, on a small surface."""

import runpy

import numpy as np
import pytest
from places import BENCHMARKS

SCRIPT = runpy.run_path(str(BENCHMARKS / "periodic_peers.py"))


def test_its_surface_repeats_itself_and_touches_as_far_as_asked():
    heights = SCRIPT["periodic_surface"](64, seed=1)
    assert heights.std() == pytest.approx(1e-3)
    jump = np.abs(heights[0] - heights[-1]).mean()
    assert jump < 2 * np.abs(np.diff(heights, axis=0)).mean()
    load = SCRIPT["pressure_of_fraction"](heights, 10.0)
    pressure = SCRIPT["ours"](heights, load, 1e-6)
    assert pressure.mean() == pytest.approx(load)
    assert (pressure > 0).mean() == pytest.approx(0.1, abs=0.03)


def test_its_table_has_a_row_for_each_installed_code(capsys):
    SCRIPT["main"](["--sizes", "48", "--fractions", "10", "--repeats", "1"])
    rows = capsys.readouterr().out.splitlines()[2:]
    assert len(rows) == len(SCRIPT["installed"]())
    assert rows[0].startswith("| 48² | 10 % | ours |")
    assert rows[0].endswith("| 1 |")
