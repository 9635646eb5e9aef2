"""Lines of a run: jobs, errors and warnings, from Snakemake's events alone."""

import io
import os
import sys
import time
from types import SimpleNamespace

import pytest
from places import ROOT

sys.path += [str(ROOT / "workflow"), str(ROOT / "workflow/engine")]
import snakemake_logger_plugin_fractalcontact as terminal

LONG = "x" * 220


def stream(encoding="utf-8"):
    return io.TextIOWrapper(io.BytesIO(), encoding=encoding)


class Run:
    """A run of jobs of some rules, numbered from 0, and its lines on both streams."""

    def __init__(self, *rules, dry_run=False, out=None, err=None):
        self.handler = terminal.LogHandler(SimpleNamespace(dryrun=dry_run), None)
        out, err = out or stream(), err or stream()
        for one_of_both in (out, err):
            one_of_both.reconfigure(errors=self.handler.out.errors)
        self.handler.out, self.handler.err = self.out, self.err = out, err
        self.rules = rules
        if rules:
            counts = {rule: rules.count(rule) for rule in rules}
            self.tell("run_info", stats=counts | {"total": len(rules)})

    def tell(self, kind, **keys):
        """An event of Snakemake."""
        event = {"event": kind, "levelname": "INFO", "msg": "None"} | keys
        self.handler.emit(SimpleNamespace(**event))

    def start(self, number, title="rock: scan", log=()):
        self.tell("job_started", jobs=[number])
        keys = {"rule_name": self.rules[number], "rule_msg": title, "log": list(log)}
        self.tell("job_info", jobid=number, reason="Forced execution", **keys)

    def fail(self, number, log=()):
        rule = self.rules[number]
        self.tell("job_error", jobid=number, rule_name=rule, rule_msg=None, log=list(log))

    def make(self, number, title="rock: scan", log=()):
        """A job from its start to its end."""
        self.start(number, title, log)
        self.tell("job_finished", job_id=number)

    def close(self):
        self.handler.close()

    @property
    def lines(self):
        return self._text(self.out)

    @property
    def errors(self):
        return self._text(self.err)

    def _text(self, out):
        out.flush()
        return out.buffer.getvalue().decode(out.encoding).splitlines()


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv(terminal.RESULTS, "results/test")


def write_log(name, text, age=0):
    path = f"results/test/logs/{name}.log"
    os.makedirs("results/test/logs", exist_ok=True)
    with open(path, "w") as file:
        file.write(text)
    os.utime(path, (time.time() - age, time.time() - age))
    return path


def test_a_job_is_one_line_that_fits_whatever_its_specimen_is_called():
    run = Run(*["specimen"] * 12)
    for number, title in enumerate(["rock: levelled scan", f"{LONG}: levelled scan"]):
        run.make(number, title)
    assert run.lines[0] == "12 jobs; what is made goes to results/test"
    assert run.lines[1] == "[ 1/12] rock: levelled scan (0 s)"
    assert run.lines[2].startswith("[ 2/12] xxx")
    assert len(run.lines[2]) == terminal.WIDTH
    assert run.errors == []


def test_what_only_asks_for_others_is_no_job():
    run = Run("specimen", "all")
    for number in range(2):
        run.make(number, None)
    run.close()
    assert run.lines == [
        "1 job; what is made goes to results/test",
        "[1/1] specimen (0 s)",
        "1 job done in 0 s",
    ]
    assert run.errors == []


def test_a_failed_job_says_its_own_sentence_and_where_its_log_is():
    run = Run("specimen", "specimen", "contact", "contact")
    sentence = "scans/rock.npy: a constant surface"
    fault = "a fault of the program, not of the input: KeyError: 'x'"
    cases = {
        "said": (f"levelled\nerror: {sentence}\n", f"error: {sentence}"),
        "fault": ("error in the program\nTraceback ...\nKeyError: 'x'\n", f"error: {fault}"),
        "killed": ("", "error: ended without an error message: killed, or out of memory"),
    }
    for number, (name, (text, expected)) in enumerate(cases.items()):
        log = write_log(name, text)
        run.start(number, f"rock {number}", [log])
        for _ in range(2):  # Snakemake reports one twice where it gives up
            run.fail(number, [log])
        assert run.errors[-3].startswith(expected)
        assert run.errors[-2:] == [f"  job: rock {number}", f"  log: {log}"]
    run.close()
    assert run.errors[9:] == ["0 of 4 jobs done, 3 failed; 1 more were not begun"]


def test_a_run_whose_jobs_all_failed_leaves_none_that_were_not_begun():
    run = Run("specimen")
    run.start(0)
    run.fail(0)
    run.close()
    assert run.errors[-1] == "0 of 1 job done, 1 failed"


def test_the_log_of_an_earlier_run_explains_nothing():
    run = Run("specimen")
    log = write_log("old", "error: scans/rock.npy: what was wrong yesterday\n", age=3600)
    run.start(0, "rock", [log])
    run.fail(0, [log])
    assert "yesterday" not in "\n".join(run.errors)


def test_a_full_disk_is_one_sentence_where_the_log_found_no_place_on_it_either(monkeypatch):
    run = Run("specimen")
    monkeypatch.setattr(terminal.shutil, "disk_usage", lambda path: SimpleNamespace(free=4096))
    run.start(0, "rock", [write_log("full", "")])
    run.fail(0)
    expected = "error: results/test: no space left on its disk; make room there and run again"
    assert run.errors[0] == expected


def test_an_error_of_the_study_is_said_without_its_place_in_the_workflow():
    run = Run()
    text = (
        'WorkflowError in file "/home/me/workflow/rules/common.smk", line 55:\n'
        "config/mine.yaml: unknown key 'grane'; did you mean 'grain'?\n"
        '  File "/home/me/workflow/rules/common.smk", line 55, in <module>\n'
    )
    run.tell("error", msg=text, levelname="ERROR")
    run.tell("error", msg="WorkflowError:\nAt least one job did not complete successfully.")
    run.close()
    assert run.lines == []
    assert run.errors == ["error: config/mine.yaml: unknown key 'grane'; did you mean 'grain'?"]


def test_warnings_of_the_data_stand_together_at_the_end_once_each():
    run = Run("specimen", "specimen")
    warning = "warning: " + "suspicious cells of the scans carry most of the load; " * 8
    for number in range(2):
        log = write_log(f"warned_{number}", f"some lines\n{warning}\n    warning:  \n")
        run.make(number, "rock: levelled scan", [log])
    assert run.errors == []
    run.close()
    assert run.lines[-1].startswith("2 jobs done in ")
    assert run.errors[0] == "warnings of the data:"
    assert run.errors[1].startswith("  rock: suspicious cells")
    assert all(len(line) <= terminal.WIDTH for line in run.errors)
    assert "\n".join(run.errors).count("rock:") == 1


def test_more_warnings_than_a_screen_takes_are_left_to_the_page():
    run = Run("specimen")
    text = "".join(f"warning: number {n}\n" for n in range(100))
    run.make(0, log=[write_log("many", text)])
    run.close()
    assert run.errors[-1] == "  and more, which the result page has"
    assert len(run.errors) == terminal.MAX_WARNINGS + 2


_CHANGED = (
    "Params have changed since last execution: Union of exclusive params before and now across "
    "all output: "
)
REASONS = {
    "Missing output files: a.nc, b.nc; Input files updated by another job: c.nc": "not made yet",
    "Input files updated by another job: c.nc": "what it is made of is made again",
    "Updated input files: c.nc": "a file that it is made of is newer",
    f"{_CHANGED}before: '0123456789abcdef' now: 'fedcba9876543210' ": (
        "its code, or a library, changed"
    ),
    f"{_CHANGED}before: {{'window': 20}},'0123456789abcdef' now: {{'window': 30}} ": (
        "settings changed"
    ),
    f"{_CHANGED}before: {{'scans/a.npy': '{'0' * 64}'}} now: {{'scans/a.npy': '{'1' * 64}'}} ": (
        "its scan changed"
    ),
    "something that a later Snakemake says": "something that a later Snakemake says",
}


def test_a_dry_run_is_a_table_of_jobs_with_reasons():
    run = Run(*["contact"] * len(REASONS), dry_run=True)
    for number, reason in enumerate(REASONS):
        keys = {"rule_name": "contact", "rule_msg": f"{number} {LONG}", "log": []}
        run.tell("job_info", jobid=number, reason=reason, **keys)
        run.tell("job_finished", job_id=number)
    run.close()
    assert run.errors == []
    for number, (line, words) in enumerate(zip(run.lines, REASONS.values(), strict=False)):
        assert line.startswith(f"  {number} x")
        assert line.endswith(f"…  {words}")
        assert len(line) <= terminal.WIDTH
    assert run.lines[len(REASONS) :] == [f"{len(REASONS)} jobs would be done; nothing was"]


@pytest.mark.parametrize("dry_run", [False, True])
def test_nothing_to_do_is_said(dry_run):
    run = Run(dry_run=dry_run)
    run.tell(None, msg="Nothing to be done (all requested files are present).")
    run.close()
    assert run.lines == ["nothing to do: everything there is, is up to date"]
    assert run.errors == []


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(0.4, "0 s"), (99, "99 s"), (130, "2 min 10 s"), (700, "11 min"), (11100, "3 h 5 min")],
)
def test_durations_in_words(seconds, words, monkeypatch):
    monkeypatch.setattr(terminal.time, "time", lambda: 1e9 + seconds)
    assert terminal._took(1e9) == words


def test_a_job_that_succeeds_at_the_second_attempt_has_not_failed():
    run = Run("specimen")
    run.start(0)
    run.fail(0)
    run.make(0)
    assert run.handler.failed == {}
    run.close()
    assert run.lines[-2:] == ["[1/1] rock: scan (0 s)", "1 job done in 0 s"]
    assert run.errors[0].startswith("error: ended without an error message")


def test_a_reader_that_ends_early_stops_nothing():
    read, write = os.pipe()
    with os.fdopen(write, "w") as pipe:
        run = Run(*["specimen"] * 3, out=pipe, err=pipe)
        os.close(read)
        for number in range(3):
            run.make(number)
        assert run.handler.done == 3


def test_names_of_others_neither_stop_nor_change_a_terminal():
    run = Run("specimen", out=stream("ascii"))
    run.make(0, "Stein\x1b[2J 岩: scan")
    assert run.lines[-1] == r"[1/1] Stein\x1b[2J \u5ca9: scan (0 s)"


def test_a_warning_before_the_jobs_is_wrapped():
    run = Run()
    run.tell(None, levelname="WARNING", msg="scans: passed over: " + "a b.tmp, " * 40)
    assert run.errors[0].startswith("warning: scans: passed over: ")
    assert max(map(len, run.errors)) <= terminal.WIDTH


def test_files_of_before_that_snakemake_puts_back_are_no_lines_of_a_run():
    run = Run()
    for text in (
        "Restored previous version of atlas.nc (updating job failed).",
        "Cannot restore figures/rock/errors.svg: no backup found.",
        "scans: half a pair",
    ):
        run.tell(None, msg=text, levelname="WARNING")
    assert run.lines == []
    assert run.errors == ["warning: scans: half a pair"]
