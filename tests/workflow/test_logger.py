"""What a run says: lines of jobs, errors, warnings, told by Snakemake's events alone."""

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


def text_of(stream):
    stream.flush()
    return stream.buffer.getvalue().decode(stream.encoding)


def begun(out, err, *, dry_run=False):
    one = terminal.LogHandler(SimpleNamespace(dryrun=dry_run), None)
    for stream in (out, err):
        stream.reconfigure(errors=one.out.errors)
    one.out, one.err = out, err
    return one


@pytest.fixture
def said(tmp_path, monkeypatch):
    """A function that begins a run, and one that gives what was said on both streams."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv(terminal.RESULTS, "results/test")
    out, err = stream(), stream()

    def start(dry_run=False):
        return begun(out, err, dry_run=dry_run)

    return start, lambda: (text_of(out).splitlines(), text_of(err).splitlines())


def event(kind, **keys):
    return SimpleNamespace(**({"event": kind, "levelname": "INFO", "msg": "None"} | keys))


def begin(one, rules):
    """Jobs of these rules, numbered from 0; each is announced when it begins."""
    counts = {rule: rules.count(rule) for rule in rules}
    one.emit(event("run_info", stats=counts | {"total": len(rules)}))


def start_job(one, number, rule, title=None, log=()):
    one.emit(event("job_started", jobs=[number]))
    keys = {"rule_name": rule, "rule_msg": title, "reason": "Forced execution", "log": list(log)}
    one.emit(event("job_info", jobid=number, **keys))


def write_log(name, text, age=0):
    path = f"results/test/logs/{name}.log"
    os.makedirs("results/test/logs", exist_ok=True)
    with open(path, "w") as file:
        file.write(text)
    os.utime(path, (time.time() - age, time.time() - age))
    return path


def test_a_job_is_one_line_that_fits_whatever_its_specimen_is_called(said):
    start, both = said
    one = start()
    begin(one, ["specimen"] * 12)
    for number, title in enumerate(["rock: levelled scan", f"{LONG}: levelled scan"]):
        start_job(one, number, "specimen", title)
        one.emit(event("job_finished", job_id=number))
    lines, errors = both()
    assert lines[0] == "12 jobs; what is made goes to results/test"
    assert lines[1] == "[ 1/12] rock: levelled scan (0 s)"
    assert lines[2].startswith("[ 2/12] xxx")
    assert len(lines[2]) == terminal.WIDTH
    assert errors == []


def test_what_only_asks_for_others_is_no_job(said):
    start, both = said
    one = start()
    begin(one, ["specimen", "all"])
    for number, rule in enumerate(("specimen", "all")):
        start_job(one, number, rule)
        one.emit(event("job_finished", job_id=number))
    one.close()
    lines = [
        "1 job; what is made goes to results/test",
        "[1/1] specimen (0 s)",
        "1 job done in 0 s",
    ]
    assert both() == (lines, [])


def test_a_failed_job_says_its_own_sentence_and_where_its_log_is(said):
    start, both = said
    one = start()
    begin(one, ["specimen", "specimen", "contact", "contact"])
    sentence = "scans/rock.npy: a constant surface"
    cases = {
        0: ("said", f"levelled\nerror: {sentence}\n", f"error: {sentence}"),
        1: (
            "fault",
            "error in the program\nTraceback ...\nKeyError: 'x'\n",
            "error: a fault of the program, not of the input: KeyError: 'x'",
        ),
        2: ("killed", "", "error: ended without an error message: killed, or out of memory"),
    }
    for number, (name, text, expected) in cases.items():
        log = write_log(name, text)
        start_job(one, number, "specimen", f"rock {number}", [log])
        told = event("job_error", jobid=number, rule_name="specimen", rule_msg=None, log=[log])
        one.emit(told)
        one.emit(told)  # Snakemake reports one twice where it gives up
        errors = both()[1]
        assert errors[-3].startswith(expected)
        assert errors[-2:] == [f"  job: rock {number}", f"  log: {log}"]
    one.close()
    assert both()[1][9:] == ["0 of 4 jobs done, 3 failed; 1 more were not begun"]


def test_the_log_of_an_earlier_run_explains_nothing(said):
    start, both = said
    one = start()
    begin(one, ["specimen"])
    log = write_log("old", "error: scans/rock.npy: what was wrong yesterday\n", age=3600)
    start_job(one, 0, "specimen", "rock", [log])
    one.emit(event("job_error", jobid=0, rule_name="specimen", rule_msg=None, log=[log]))
    assert "yesterday" not in "\n".join(both()[1])


def test_a_full_disk_is_one_sentence_where_the_log_found_no_place_on_it_either(said, monkeypatch):
    start, both = said
    one = start()
    begin(one, ["specimen"])
    monkeypatch.setattr(terminal.shutil, "disk_usage", lambda path: SimpleNamespace(free=4096))
    start_job(one, 0, "specimen", "rock", [write_log("full", "")])
    told = event("job_error", jobid=0, rule_name="specimen", rule_msg=None, log=[])
    one.emit(told)
    expected = "error: results/test: no space left on its disk; make room there and run again"
    assert both()[1][0] == expected


def test_an_error_of_the_study_is_said_without_its_place_in_the_workflow(said):
    start, both = said
    one = start()
    text = (
        'WorkflowError in file "/home/me/workflow/rules/common.smk", line 55:\n'
        "config/mine.yaml: unknown key 'grane'; did you mean 'grain'?\n"
        '  File "/home/me/workflow/rules/common.smk", line 55, in <module>\n'
    )
    one.emit(event("error", msg=text, levelname="ERROR"))
    one.emit(event("error", msg="WorkflowError:\nAt least one job did not complete successfully."))
    one.close()
    expected = "error: config/mine.yaml: unknown key 'grane'; did you mean 'grain'?"
    assert both() == ([], [expected])


def test_warnings_of_the_data_stand_together_at_the_end_once_each(said):
    start, both = said
    one = start()
    begin(one, ["specimen"] * 2)
    warning = "warning: " + "suspicious cells of the scans carry most of the load; " * 8
    for number in range(2):
        log = write_log(f"warned_{number}", f"some lines\n{warning}\n    warning:  \n")
        start_job(one, number, "specimen", "rock: levelled scan", [log])
        one.emit(event("job_finished", job_id=number))
    assert both()[1] == []
    one.close()
    lines, errors = both()
    assert lines[-1].startswith("2 jobs done in ")
    assert errors[0] == "warnings of the data:"
    assert errors[1].startswith("  rock: suspicious cells")
    assert all(len(line) <= terminal.WIDTH for line in errors)
    assert "\n".join(errors).count("rock:") == 1


def test_more_warnings_than_a_screen_takes_are_left_to_the_page(said):
    start, both = said
    one = start()
    begin(one, ["specimen"])
    text = "".join(f"warning: number {n}\n" for n in range(100))
    start_job(one, 0, "specimen", "rock: scan", [write_log("many", text)])
    one.emit(event("job_finished", job_id=0))
    one.close()
    assert both()[1][-1] == "  and more, which the result page has"
    assert len(both()[1]) == terminal.MAX_WARNINGS + 2


REASONS = {
    "Missing output files: a.nc, b.nc; Input files updated by another job: c.nc": "not made yet",
    "Input files updated by another job: c.nc": "what it is made of is made again",
    "Updated input files: c.nc": "a file that it is made of is newer",
    "Params have changed since last execution: Union of exclusive params before and now across "
    "all output: before: '0123456789abcdef' now: 'fedcba9876543210' ": (
        "its code, or a library, changed"
    ),
    "Params have changed since last execution: Union of exclusive params before and now across "
    "all output: before: {'window': 20},'0123456789abcdef' now: {'window': 30} ": (
        "settings changed"
    ),
    "Params have changed since last execution: Union of exclusive params before and now across "
    f"all output: before: {{'scans/a.npy': '{'0' * 64}'}} now: {{'scans/a.npy': '{'1' * 64}'}} ": (
        "its scan changed"
    ),
    "something that a later Snakemake says": "something that a later Snakemake says",
}


def test_a_dry_run_is_a_table_of_jobs_with_reasons(said):
    start, both = said
    one = start(dry_run=True)
    begin(one, ["contact"] * len(REASONS))
    for number, reason in enumerate(REASONS):
        keys = {"rule_name": "contact", "rule_msg": f"{number} {LONG}", "log": []}
        one.emit(event("job_info", jobid=number, reason=reason, **keys))
        one.emit(event("job_finished", job_id=number))
    one.close()
    lines, errors = both()
    assert errors == []
    for number, (line, words) in enumerate(zip(lines, REASONS.values(), strict=False)):
        assert line.startswith(f"  {number} x")
        assert line.endswith(f"…  {words}")
        assert len(line) <= terminal.WIDTH
    assert lines[len(REASONS) :] == [f"{len(REASONS)} jobs would be done; nothing was"]


def test_nothing_to_do_is_said(said):
    start, both = said
    for dry_run in (False, True):
        one = start(dry_run=dry_run)
        one.emit(event(None, msg="Nothing to be done (all requested files are present)."))
        one.close()
    assert both() == (["nothing to do: everything there is, is up to date"] * 2, [])


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(0.4, "0 s"), (99, "99 s"), (130, "2 min 10 s"), (700, "11 min"), (11100, "3 h 5 min")],
)
def test_durations_in_words(seconds, words, monkeypatch):
    monkeypatch.setattr(terminal.time, "time", lambda: 1e9 + seconds)
    assert terminal._took(1e9) == words


def test_a_job_that_succeeds_at_the_second_attempt_has_not_failed(said):
    start, both = said
    one = start()
    begin(one, ["specimen"])
    told = event("job_error", jobid=0, rule_name="specimen", rule_msg=None, log=[])
    for attempt in range(2):
        start_job(one, 0, "specimen", "rock: scan")
        one.emit(told if attempt == 0 else event("job_finished", job_id=0))
    assert one.failed == {}
    one.close()
    lines, errors = both()
    assert lines[-2:] == ["[1/1] rock: scan (0 s)", "1 job done in 0 s"]
    assert errors[0].startswith("error: ended without an error message")


def test_a_reader_that_ends_early_stops_nothing():
    read, write = os.pipe()
    with os.fdopen(write, "w") as stream:
        one = begun(stream, stream)
        begin(one, ["specimen"])
        os.close(read)
        for attempt in range(3):
            start_job(one, attempt, "specimen", "rock: scan")
            one.emit(event("job_finished", job_id=attempt))
        assert one.done == 3


def test_names_of_others_neither_stop_nor_change_a_terminal():
    narrow = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    one = begun(narrow, narrow)
    begin(one, ["specimen"])
    start_job(one, 0, "specimen", "Stein\x1b[2J 岩: scan")
    one.emit(event("job_finished", job_id=0))
    said = narrow.buffer.getvalue().decode("ascii").splitlines()
    assert said[-1] == r"[1/1] Stein\x1b[2J \u5ca9: scan (0 s)"


def test_a_warning_before_the_jobs_is_wrapped(said):
    start, both = said
    start().emit(event(None, levelname="WARNING", msg="scans: passed over: " + "a b.tmp, " * 40))
    assert both()[1][0].startswith("warning: scans: passed over: ")
    assert max(map(len, both()[1])) <= terminal.WIDTH


def test_files_of_before_that_snakemake_puts_back_are_no_lines_of_a_run(said):
    start, lines = said
    one = start()
    for text in (
        "Restored previous version of atlas.nc (updating job failed).",
        "Cannot restore figures/rock/errors.svg: no backup found.",
        "scans: half a pair",
    ):
        one.emit(event(None, msg=text, levelname="WARNING"))
    assert lines() == ([], ["warning: scans: half a pair"])
