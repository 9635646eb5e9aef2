"""The table of ours beside others, on problems small enough for a test."""

import argparse
import csv
import subprocess
import sys

import numpy as np
import pytest
from places import BENCHMARKS

from fractalcontact.surface.synthesis import self_affine

sys.path.insert(0, str(BENCHMARKS))
import beside_peers
import peers_tables
import peers_worker

LOAD = {"closure": 2.0, "force": 3.0}


@pytest.mark.full
def test_ours_alone_is_judged_and_timed(tmp_path):
    command = [sys.executable, BENCHMARKS / "beside_peers.py", "--alone", "--threads", "1"]
    options = ["--sizes", "24", "32", "--fractions", "8", "--pairs", "2", "--output", tmp_path]
    for _ in range(2):  # what is there is not measured again
        done = subprocess.run([*command, *options], check=True, capture_output=True, text=True)
    assert "8 % in contact" not in done.stderr
    with (tmp_path / "beside_peers.csv").open() as file:
        rows = list(csv.DictReader(file))
    names = {(row["size"], row["solver"]) for row in rows}
    expected = {(n, f"ours, {how}") for n in ("24", "32") for how in ("with set-up", "without")}
    assert names == expected
    assert len(rows) == len(expected)
    for row in rows:
        assert float(row["error"]) < 1e-6
        assert float(row["seconds"]) > 0
        assert int(row["applications"]) > 0
        assert row["path"].startswith("convolution, residual ")
        assert row["note"] == ""
    text = (tmp_path / "beside_peers.md").read_text()
    assert "ours, without, 8 %, 1 threads: seconds grow as nodes^" in text


@pytest.mark.parametrize(
    ("found", "note"),
    [
        ({}, ""),
        ({"closure": 2.0 * (1 + 2e-5)}, "disqualified: its error is off"),
        ({"force": 3.0 * (1 - 2e-5)}, "disqualified: its error is off"),
        ({"closure": np.nan}, "disqualified: its error is off"),
        ({"failed": "longer than 600 s"}, "longer than 600 s"),
    ],
)
def test_an_answer_is_judged_before_its_time_is_read(found, note):
    answer = {**LOAD, "applications": 7, "path": "", "peak": 1.0, **found}
    row = beside_peers._judged(answer, LOAD, argparse.Namespace(error=1e-5))
    assert row["note"] == note


def test_a_mode_that_took_too_long_is_not_tried_on_more():
    slow = {"solver": "a", "size": "512", "contact": "8", "threads": "2", "note": "longer than 9 s"}
    for size, percent, threads, beyond in (
        (512, 8, 2, True),
        (1024, 20, 1, True),
        (256, 8, 2, False),
        (1024, 2, 2, False),
        (512, 8, 4, False),
    ):
        assert beside_peers._beyond("a", size, percent, threads, [slow]) is beyond
    assert not beside_peers._beyond("b", 512, 8, 2, [slow])
    assert not beside_peers._beyond("a", 512, 8, 2, [slow | {"note": "it says no"}])


PEER = "ASPHER fft"
OPTIONS = argparse.Namespace(peers=[PEER], error=1e-5, pairs=3, patience=60, limit=600)


@pytest.fixture
def solvers(monkeypatch):
    """A cell whose solvers take 1 s each, the peer 3 s; which fail, and in which run, is set."""
    begun, failing = [], {}

    class Made:
        def __init__(self, name, load, threads, limit):
            self.name, self.runs = name, 0
            begun.append(name)

        def solve(self, *, warm=False):
            self.runs += 1
            if failing.get(self.name) == self.runs:
                return {"failed": "longer than 600 s"}
            seconds = 3.0 if self.name == PEER else 1.0
            rest = {"applications": 7, "path": "", "peak": 1.0}
            return {"clock": seconds, "processor": seconds, **LOAD, **rest}

        def end(self):
            pass

    monkeypatch.setattr(beside_peers, "Worker", Made)
    monkeypatch.setattr(beside_peers, "_load", lambda *which: LOAD)
    return begun, failing


def cell(before=()):
    """Rows of a cell of 512 nodes along a side, by solver."""
    return {row["solver"]: row for row in beside_peers._cell(512, 8, 1, OPTIONS, before)}


@pytest.mark.usefixtures("solvers")
def test_a_peer_is_timed_in_turn_with_ours():
    rows = cell()
    assert set(rows) == {PEER, *peers_worker.OURS}
    peer = rows[PEER]
    assert (peer["seconds"], peer["ours"], peer["pairs"], peer["note"]) == (3, 1, 3, "")
    assert [peer[name] for name in ("times", "low", "high")] == pytest.approx([3, 3, 3])
    for name in peers_worker.OURS:
        assert (rows[name]["seconds"], rows[name]["pairs"], rows[name]["note"]) == (1, 3, "")


def test_ours_is_not_tried_again_where_a_table_says_that_it_took_too_long(solvers, tmp_path):
    begun, _ = solvers
    slow = {"size": 256, "contact": 8, "threads": 1, "solver": "ours, with set-up"}
    peers_tables.write(tmp_path, [slow | {"note": "longer than 600 s"}])
    rows = cell(peers_tables.read(tmp_path))
    assert begun == ["ours, without", PEER]
    assert rows["ours, with set-up"]["note"] == beside_peers.BEYOND
    assert "seconds" not in rows["ours, with set-up"]
    assert (rows[PEER]["seconds"], rows[PEER]["pairs"], rows[PEER]["note"]) == (3, 3, "")
    assert not {"ours", "times", "low", "high"} & set(rows[PEER])
    assert rows["ours, without"]["seconds"] == 1
    text = peers_tables.write(tmp_path, list(rows.values()))
    assert "least" not in text  # a row without a ratio is in no summary of ratios


def test_a_peer_is_timed_alone_where_ours_fails_in_its_first_solve(solvers):
    solvers[1]["ours, with set-up"] = 1
    rows = cell()
    assert rows["ours, with set-up"]["note"] == "longer than 600 s"
    assert rows[PEER]["seconds"] == 3
    assert "times" not in rows[PEER]


@pytest.mark.parametrize("name", [PEER, "ours, with set-up"])
def test_whoever_fails_in_a_later_run_is_named(solvers, name):
    solvers[1][name] = 3
    rows = cell()
    assert rows[PEER]["note"] == f"{name} failed in a later run: longer than 600 s"
    assert "seconds" not in rows[PEER]


def test_growth_is_the_exponent_over_the_nodes():
    rows = [
        {"solver": "a", "contact": "2", "threads": "1", "size": n, "seconds": 3e-6 * n**2.5}
        for n in (512, 1024, 4096)
    ]
    wrong = rows[0] | {"seconds": 1e9, "note": "disqualified: its error is off"}
    ((*key, exponent, error),) = peers_tables.growth([*rows, wrong], "seconds")
    assert key == ["a", "2", "1"]
    assert exponent == pytest.approx(1.25)
    assert error < 1e-9


def test_the_summary_takes_the_fastest_mode_of_each_cell():
    rows = [
        {"size": 512, "contact": f, "threads": 1, "times": t, "note": ""}
        for f, t in ((0.05, 4.0), (0.05, 9.0), (8, 20.0), (20, 12.0), (60, 2.0))
    ]
    rows.append(rows[0] | {"times": 1.0, "note": "failed"})
    lines = list(peers_tables.summary(rows))
    assert lines[0] == "1 threads: least 2 times, in 4 cells"
    assert lines[1].endswith("4 times in the median")
    assert lines[2].endswith("12 times in the median")


def test_a_surface_in_single_precision_is_that_in_double():
    expected = self_affine((64, 64), 1 / 64, peers_worker.HURST, rms=peers_worker.RMS, seed=3)
    found = peers_worker.in_single_precision(64, 3)
    assert found.dtype == np.float32
    np.testing.assert_allclose(found, expected, atol=1e-5 * peers_worker.RMS)
