"""The table of ours beside others, on problems small enough for a test."""

import argparse
import csv
import subprocess
import sys

import numpy as np
import pytest
from places import BENCHMARKS

from contactlab.methods.method import Method
from contactlab.methods.peers import PublicCode
from contactlab.methods.registry import METHODS, PEERS
from fractalcontact import solve_contact
from fractalcontact.surface.synthesis import self_affine

sys.path.insert(0, str(BENCHMARKS))
import beside_peers
import peers_tables
import peers_worker
from beside_peers import Cell

LOAD = {"closure": 2.0, "force": 3.0}
KIND = {"contact": "2", "threads": "1", "hurst": "0.8", "loads": "1"}


def measured(folder, *options):
    """Rows of the table that the command writes, and what it prints."""
    command = [sys.executable, BENCHMARKS / "beside_peers.py", *options, "--output", folder]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    with (folder / "beside_peers.csv").open() as file:
        return list(csv.DictReader(file)), done


def test_every_method_reaches_the_error_and_is_timed(tmp_path):
    options = ["--sizes", "32", "--fractions", "8", "--pairs", "2", "--error", "1e-6"]
    rows, _ = measured(tmp_path, *options, "--peers", *METHODS)
    assert {row["solver"] for row in rows} == {*METHODS, *peers_worker.OURS}
    for row in rows:
        assert float(row["error"]) <= 1e-6
        assert float(row["seconds"]) > 0
        assert row["note"] == ""
    applications = {row["solver"]: row["applications"] for row in rows}
    assert float(applications["ours, without"]) > 0
    assert applications["dense"] == ""


def test_a_sweep_takes_who_starts_from_the_load_before_and_spares_ours_work(tmp_path):
    options = ["--sizes", "32", "--fractions", "20", "--pairs", "1", "--peers", *METHODS]
    sweep, _ = measured(tmp_path, *options, "--loads", "4")
    warm = {name for name, method in METHODS.items() if method.warm}
    assert {row["solver"] for row in sweep} == {*warm, *peers_worker.OURS}
    assert all(float(row["error"]) <= 1e-5 for row in sweep)


@pytest.mark.full
def test_ours_alone_is_judged_and_timed(tmp_path):
    options = ["--alone", "--sizes", "24", "32", "--fractions", "8", "--pairs", "2"]
    for _ in range(2):  # what is there is not measured again
        rows, done = measured(tmp_path, *options)
    assert "contact 8" not in done.stderr
    names = {(row["size"], row["solver"]) for row in rows}
    expected = {(n, f"ours, {how}") for n in ("24", "32") for how in ("with set-up", "without")}
    assert names == expected
    assert len(rows) == len(expected)
    for row in rows:
        assert float(row["error"]) < 1e-6
        assert float(row["seconds"]) > 0
        assert float(row["applications"]) > 0
        assert row["path"].startswith("convolution, residual ")
        assert row["note"] == ""
    text = (tmp_path / "beside_peers.md").read_text()
    assert "ours, without, contact 8, threads 1, hurst 0.8, loads 1: seconds grow as nodes^" in text


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
    answer = {**LOAD, "tolerance": 1e-6, "applications": 7, "path": "", "peak": 1.0, **found}
    row = beside_peers._judged(answer, {"steps": [LOAD]}, argparse.Namespace(error=1e-5))
    assert row["note"] == note


def test_a_mode_that_took_too_long_is_not_tried_on_more():
    where = KIND | {"size": "512", "contact": "8", "threads": "2"}
    slow = where | {"solver": "a", "note": "longer than 9 s"}
    for size, percent, threads, beyond in (
        (512, 8, 2, True),
        (1024, 20, 1, True),
        (256, 8, 2, False),
        (1024, 2, 2, False),
        (512, 8, 4, False),
    ):
        assert beside_peers._beyond("a", Cell(size, percent, threads), [slow]) is beyond
    assert not beside_peers._beyond("b", Cell(512, 8, 2), [slow])
    assert not beside_peers._beyond("a", Cell(512, 8, 2), [slow | {"note": "it says no"}])


@pytest.mark.parametrize(("reached", "tolerance"), [(1e-2, 1e-2), (1e-6, 1e-6), (0, 1e-10)])
def test_the_loosest_tolerance_that_reaches_the_error_is_taken(reached, tolerance):
    class Made:
        def judge(self, rtol):
            return {"closure": 2.0, "force": 3.0 * (1 if rtol <= 1.01 * reached else 1.1)}

    found = beside_peers._first(Made(), 1e-2, {"steps": [LOAD]}, 1e-5)
    assert found["tolerance"] == pytest.approx(tolerance)


PEER = "polonsky-keer"
OPTIONS = argparse.Namespace(peers=[PEER], error=1e-5, pairs=3, patience=60, limit=600)


@pytest.fixture
def solvers(monkeypatch):
    """A cell whose solvers take 1 s each, the peer 3 s; which fail, and in which run, is set."""
    begun, failing = [], {}

    class Made:
        def __init__(self, name, load, threads, limit):
            self.name, self.runs = name, 0
            begun.append(name)

        def judge(self, rtol):
            return self.solve()

        def solve(self):
            self.runs += 1
            if failing.get(self.name) == self.runs:
                return {"failed": "longer than 600 s"}
            seconds = 3.0 if self.name == PEER else 1.0
            rest = {"applications": 7, "path": "", "peak": 1.0}
            return {"clock": seconds, "processor": seconds, **LOAD, **rest}

        def end(self):
            pass

    monkeypatch.setattr(beside_peers, "Worker", Made)
    monkeypatch.setattr(beside_peers, "_load", lambda *which: {"steps": [LOAD]})
    return begun, failing


def cell(before=()):
    """Rows of a cell of 512 nodes along a side, by solver."""
    return {row["solver"]: row for row in beside_peers._rows(Cell(512, 8), OPTIONS, before)}


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
    slow = Cell(256, 8).row() | {"solver": "ours, with set-up"}
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


@pytest.mark.parametrize("control", ["closure", "force"])
def test_a_public_code_is_given_its_load_and_the_pressure_before(monkeypatch, tmp_path, control):
    given = []

    class Code(PublicCode):
        applications = 5

        def solve(self, load, rtol):
            given.append(load)
            by = {control: getattr(load, control)}
            return solve_contact(self.height, self.space, rtol=rtol, **by).pressure

    method = Method(name="made", solver=Code, loads=(control,), packages=("numpy",))
    monkeypatch.setitem(PEERS, "made", method)
    what = Cell(16, 20.0, loads=2)._asdict() | {"make": str(tmp_path / "h.npy"), "seed": 1}
    found = peers_worker._made(what | {"judge": True})
    task = {"solver": "made", "heights": str(tmp_path / "h.npy"), **found}
    answer = peers_worker._timed(peers_worker._peer(task), task, 1e-6, True)
    assert answer["applications"] == 5
    for name, exact in found["steps"][-1].items():
        if name != "nodes":
            assert answer[name] == pytest.approx(exact, rel=1e-5)
    assert [load.start is None for load in given] == [True, False]


def test_growth_is_the_exponent_over_the_nodes():
    rows = [KIND | {"solver": "a", "size": n, "seconds": 3e-6 * n**2.5} for n in (512, 1024, 4096)]
    wrong = rows[0] | {"seconds": 1e9, "note": "disqualified: its error is off"}
    ((*key, exponent, error),) = peers_tables.growth([*rows, wrong], "seconds")
    assert key == ["a", "2", "1", "0.8", "1"]
    assert exponent == pytest.approx(1.25)
    assert error < 1e-9


def test_the_summary_takes_the_fastest_mode_of_each_cell():
    rows = [
        KIND | {"size": 512, "contact": f, "times": t, "note": ""}
        for f, t in ((0.05, 4.0), (0.05, 9.0), (8, 20.0), (20, 12.0), (60, 2.0))
    ]
    rows.append(rows[0] | {"times": 1.0, "note": "failed"})
    lines = list(peers_tables.summary(rows))
    assert lines[0] == "1 threads: least 2 times, in 4 cells"
    assert lines[1].endswith("4 times in the median")
    assert lines[2].endswith("12 times in the median")


def test_a_surface_in_single_precision_is_that_in_double():
    expected = self_affine((64, 64), 1 / 64, 0.8, rms=peers_worker.RMS, seed=3)
    found = peers_worker.in_single_precision(64, 0.8, 3)
    assert found.dtype == np.float32
    np.testing.assert_allclose(found, expected, atol=1e-5 * peers_worker.RMS)
