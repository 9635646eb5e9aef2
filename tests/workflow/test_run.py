"""Checks of workflow/run.py before and after Snakemake, part by part."""

import importlib
import os
import shutil
import signal
import sys
import time
from types import SimpleNamespace

import pytest
from places import ROOT

from fractalcontact.core.errors import InputError

SIGNALS = (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGQUIT)


@pytest.fixture
def run(monkeypatch, tmp_path):
    """The script as a module, in a folder of its own."""
    monkeypatch.syspath_prepend(str(ROOT / "workflow"))
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("FRACTALCONTACT_MAKE", raising=False)
    before = {number: signal.getsignal(number) for number in SIGNALS}
    yield importlib.import_module("run")
    for number, answer in before.items():
        signal.signal(number, answer)


def begun(run, monkeypatch, *words, status=0):
    """Arguments that a command line starts Snakemake with, and the exit code."""
    asked = {}

    def instead(command, options, results):
        asked.update(command=command, results=str(results))
        return status

    monkeypatch.setattr(run, "_run", instead)
    monkeypatch.setattr(run, "_clean", lambda options, results: None)
    study = ROOT / "config/smoke.yaml"
    monkeypatch.setattr(sys, "argv", ["run.py", str(study), *words])
    with pytest.raises(SystemExit) as ended:
        run.main()
    return asked, ended.value.code


def test_a_study_at_full_cost_stands_beside_the_other(run, monkeypatch):
    asked, code = begun(run, monkeypatch)
    assert (asked["results"], code) == ("results/smoke", 0)
    assert "accuracy=full" not in asked["command"]
    asked, _ = begun(run, monkeypatch, "--full")
    assert asked["results"] == "results/smoke_full"
    assert {"study=smoke_full", "accuracy=full"} <= set(asked["command"])


def test_words_behind_the_dashes_go_to_snakemake(run, monkeypatch):
    asked, _ = begun(run, monkeypatch, "--", "--cores", "3", "pages")
    assert asked["command"][-3:] == ["--cores", "3", "pages"]


@pytest.mark.parametrize("words", [(), ("--dry-run",)])
def test_only_a_run_that_failed_says_that_it_did_not_finish(run, monkeypatch, capsys, words):
    _, code = begun(run, monkeypatch, *words, status=1)
    assert code == 1
    assert ("did not finish" in capsys.readouterr().err) is (not words)


def test_a_scan_from_the_future_is_refused(run, tmp_path):
    scan = tmp_path / "rock.npy"
    scan.touch()
    run._require_past(tmp_path)
    os.utime(scan, (time.time() + 60,) * 2)
    with pytest.raises(InputError, match=r"rock\.npy: dated ahead"):
        run._require_past(tmp_path)


@pytest.mark.parametrize(("free", "is_enough"), [(49, False), (51, True)])
def test_a_full_disk_is_told_before_anything_runs(run, monkeypatch, tmp_path, free, is_enough):
    usage = SimpleNamespace(free=free * 2**20)
    monkeypatch.setattr(shutil, "disk_usage", lambda folder: usage)
    if is_enough:
        run._require_room(tmp_path / "results/none")
    else:
        with pytest.raises(InputError, match="49 MB free"):
            run._require_room(tmp_path / "results/none")


def test_a_folder_that_cannot_be_written_is_told(run, monkeypatch, tmp_path):
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    with pytest.raises(InputError, match="chmod"):
        run._require_room(tmp_path)


def test_specimens_that_the_study_lost_are_named(run, tmp_path, capsys):
    run._name_leftovers(tmp_path)  # nothing was made yet
    for path in ("specimens/a.nc", "specimens/c.nc", "contact_maps/d.nc"):
        (tmp_path / path).parent.mkdir(exist_ok=True)
        (tmp_path / path).touch()
    (tmp_path / "specimens.txt").write_text("a\nb\n")
    run._name_leftovers(tmp_path)
    assert "keeps files of c, d, which" in capsys.readouterr().err
    (tmp_path / "specimens.txt").write_text("a\nc\nd\n")
    run._name_leftovers(tmp_path)
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(("age", "is_named"), [(-60, False), (0, True), (60, True)])
def test_a_page_is_named_where_it_is_of_the_last_results(run, tmp_path, capsys, age, is_named):
    for name, at in (("atlas.nc", 1e9), ("index.html", 1e9 + age)):
        (tmp_path / name).touch()
        os.utime(tmp_path / name, (at, at))
    run._name_page(tmp_path)
    assert ("index.html" in capsys.readouterr().out) is is_named


def options(**stated):
    usual = {"profile": "default", "executor": "local", "dry_run": False, "verbose": True}
    return SimpleNamespace(**usual | stated)


def code_of(script):
    return [sys.executable, "-c", f"import os, signal, time; {script}"]


@pytest.mark.parametrize(
    ("script", "status"), [("pass", 0), ("os._exit(3)", 3), ("os.kill(os.getpid(), 9)", 137)]
)
def test_the_exit_code_is_that_of_snakemake_or_its_signal(run, tmp_path, script, status):
    assert run._run(code_of(script), options(), tmp_path) == status


@pytest.mark.parametrize(
    ("stated", "expected"),
    [
        ({"executor": "fractalcontact"}, True),
        ({"executor": "fractalcontact", "dry_run": True}, False),
        ({"executor": "fractalcontact", "profile": "slurm"}, False),
        ({}, False),
    ],
)
def test_only_a_run_that_forks_jobs_has_their_server_started(run, tmp_path, stated, expected):
    script = "os._exit('FRACTALCONTACT_SERVER' in os.environ)"
    assert run._run(code_of(script), options(**stated), tmp_path) == expected


def test_a_run_that_is_told_to_end_ends_its_jobs_and_says_so(run, tmp_path, capsys):
    alive = tmp_path / "alive"
    script = f"os.kill(os.getppid(), 15); time.sleep(60); open({str(alive)!r}, 'w')"
    with pytest.raises(SystemExit) as ended:
        run._run(code_of(script), options(), tmp_path)
    assert ended.value.code == 128 + signal.SIGTERM
    assert "interrupted" in capsys.readouterr().err
    assert not alive.exists()


def test_make_is_ended_only_where_the_run_failed(run, monkeypatch):
    told = []
    monkeypatch.setattr(os, "kill", lambda *of: told.append(of))
    monkeypatch.setenv("FRACTALCONTACT_MAKE", "77")
    for status in (0, 2):
        with pytest.raises(SystemExit) as ended:
            run._leave(status)
        assert ended.value.code == status
    assert told == [(77, signal.SIGPIPE)]


@pytest.fixture
def left(run, monkeypatch, tmp_path):
    """Leftovers of a killed run, and a file without a record."""
    locks, results = tmp_path / ".snakemake/locks", tmp_path / "results"
    locks.mkdir(parents=True)
    results.mkdir()
    monkeypatch.setattr(run, "left_in_queue", lambda profile: ())
    monkeypatch.setattr(run.running, "share", lambda guard: None)
    moved = []
    checked = SimpleNamespace(damaged=[results / "a.nc"], unrecorded=[results / "b.nc"])
    monkeypatch.setattr(run.checksums, "check", lambda results, digest: checked)
    monkeypatch.setattr(run.checksums, "set_aside", lambda results, path: moved.append(path.name))
    return SimpleNamespace(locks=locks, results=results, moved=moved)


def test_what_a_killed_run_left_is_taken_away_where_nothing_is_at_work(
    run, monkeypatch, left, capsys
):
    monkeypatch.setattr(run.running, "alone", lambda wait: ("guard", True))
    run._clean(options(), left.results)
    assert not left.locks.exists()
    assert left.moved == ["a.nc", "b.nc"]
    said = capsys.readouterr().err
    assert "a.nc: damaged" in said
    assert "b.nc: without a checksum" in said


def test_without_locks_nothing_is_taken_away(run, monkeypatch, left, capsys):
    monkeypatch.setattr(run.running, "alone", lambda wait: ("guard", False))
    run._clean(options(), left.results)
    assert left.locks.exists()
    assert left.moved == []
    assert "knows no locks" in capsys.readouterr().err


def test_beside_another_run_nothing_is_taken_away(run, monkeypatch, left):
    monkeypatch.setattr(run.running, "alone", lambda wait: (None, True))
    with pytest.raises(InputError, match="another run is at work"):
        run._clean(options(), left.results)
    assert left.locks.exists()


def test_jobs_in_the_queue_of_a_cluster_are_named(run, monkeypatch, left):
    monkeypatch.setattr(run.running, "alone", lambda wait: ("guard", True))
    monkeypatch.setattr(run, "left_in_queue", lambda profile: ("17", "18"))
    with pytest.raises(InputError, match="scancel 17 18"):
        run._clean(options(), left.results)
    assert left.locks.exists()
