"""Lines of a run in the terminal: one a job, and errors with their logs. A logger plugin.

Snakemake finds it by the name of its package on the path that workflow/run.py gives it. Snakemake's
own log in .snakemake/log keeps everything.
"""

import os
import re
import shutil
import sys
import textwrap
import time
from pathlib import Path

from snakemake_interface_logger_plugins.base import LogHandlerBase

from engine.cluster import ended_by_cluster
from engine.ending import TOLD

#: Columns of the terminal, and most lines of warnings at the end; the result page has all of them.
WIDTH, MAX_WARNINGS = 120, 24
#: Free bytes below which a disk counts as full.
MIN_FREE_BYTES = 2**20
#: Environment variable with the folder of the study's results.
RESULTS = "FRACTALCONTACT_RESULTS"
#: Rules without work of their own, which only ask for files.
_TARGETS = ("all", "pages")
_FULL = ("No space left on device", "Disk quota exceeded", "no space left on its disk")
#: Digests of code among the parameters that Snakemake names, of both runs or of one.
_DIGESTS = "(?:'?[0-9a-f]{16}'?,?|<nothing exclusive>)+"
#: Patterns in Snakemake's reasons and their words here; the first match counts.
_REASONS = {
    "Missing output files": "not made yet",
    "Forced execution": "left incomplete, or asked for",
    "Set of input files": "is made of other files than before",
    "Updated input files": "a file that it is made of is newer",
    "Input files updated by another job": "what it is made of is made again",
    r"Params have changed.*\b[0-9a-f]{64}\b": "its scan changed",
    f"Params have changed.* before: {_DIGESTS} +now: {_DIGESTS} *(;|$)": (
        "its code, or a library, changed"
    ),
    "Params have changed": "settings changed",
}
#: Place in the workflow where an error was noticed, in front of its message.
_PLACE = re.compile(r"\w+(?: in (?:rule .*|file \".*\", line \d+))?:")
#: Messages on the files of a failed job that were restored, or never existed; they are left out.
_UNSAID = re.compile("Restored previous version of |Cannot restore .*: no backup found")
#: Control characters, which act on a terminal.
_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]")


class LogHandler(LogHandlerBase):
    """Handler that prints lines in place of Snakemake's."""

    writes_to_stream = has_filter = has_formatter = True
    writes_to_file = needs_rulegraph = False

    def __post_init__(self):
        """Start with empty tables of jobs."""
        self.results = os.environ.get(RESULTS, "results")
        self.dry_run, self.begin = self.common_settings.dryrun, time.time()
        #: Jobs by number: title, logs and reason; start of running jobs; titles of failed ones.
        self.jobs, self.running, self.failed = {}, {}, {}
        self.total, self.done, self.errors, self.warnings = 0, 0, [], {}
        self.nothing = self.stopped = self.closed = False
        self.out, self.err = sys.stdout, sys.stderr
        for stream in (self.out, self.err):
            stream.reconfigure(
                errors="backslashreplace"
            )  # names of specimens may be in any alphabet

    def emit(self, record):
        """Take in one event of Snakemake."""
        kind = getattr(record, "event", None)
        if kind is not None:
            getattr(self, f"_{kind}", lambda record: None)(record)
        elif str(record.msg).startswith("Nothing to be done"):
            self.nothing = True
        elif record.levelname == "WARNING" and not _UNSAID.match(str(record.msg)):
            for line in _wrapped(f"warning: {record.msg}"):
                self._say(line, self.err)

    def _run_info(self, record):
        if not self.total:  # a dry run counts twice
            counts = dict(record.stats)
            self.total = counts.pop("total") - sum(counts.get(rule, 0) for rule in _TARGETS)
            if not self.dry_run:
                self._say(f"{_counted(self.total)}; what is made goes to {self.results}")

    def _job_info(self, record):
        if record.rule_name not in _TARGETS:
            title = " ".join((record.rule_msg or record.rule_name).split())
            self.jobs[record.jobid] = title, list(record.log or ()), record.reason or ""

    def _job_started(self, record):
        for number in record.jobs:
            self.running[number] = time.time()
            self.failed.pop(number, None)  # a cluster starts the job again with more memory

    def _job_finished(self, record):
        if self.dry_run or record.job_id not in self.jobs:
            return
        title, logs, _ = self.jobs[record.job_id]
        self.done += 1
        for line in self._lines_of(logs):
            if line.startswith("warning: "):
                self.warnings.setdefault(line[len("warning: ") :], title.partition(": ")[0])
        took = f" ({_took(self.running.pop(record.job_id))})"
        count = f"[{self.done:>{len(str(self.total))}}/{self.total}] "
        self._say(count + _cut(title, WIDTH - len(count) - len(took)) + took)

    def _job_error(self, record):
        if record.jobid in self.failed:  # Snakemake says it twice where it gives up
            return
        title, logs = self.jobs.get(record.jobid, (record.rule_name,))[0], list(record.log or ())
        self.failed[record.jobid] = title
        if said := self._error_of(logs):
            lines = [f"error: {said}", f"  job: {_cut(title, WIDTH - 7)}"]
            for line in [*lines, *(f"  log: {path}" for path in logs)]:
                self._say(line, self.err)

    def _error(self, record):
        lines = str(record.msg).splitlines() or [""]
        if len(lines) > 1 and _PLACE.fullmatch(lines[0]):
            del lines[0]
        self.errors.append("\n".join(s for s in lines if not s.startswith('  File "')).strip())

    def _lines_of(self, logs):
        """Lines that a job wrote into its logs in this run."""
        for path in map(Path, logs):
            try:
                if path.stat().st_mtime >= self.begin - 2:
                    yield from path.read_text(encoding="utf-8", errors="replace").splitlines()
            except OSError:
                continue

    def _error_of(self, logs):
        """Reason why a job failed, in its own words; empty for a job that was told to stop."""
        lines = [line for line in self._lines_of(logs) if line.strip()]
        said = [line[len("error: ") :] for line in lines if line.startswith("error: ")]
        if said:
            return said[-1]
        if TOLD.is_set() or "stopped before it was done" in lines[-1:]:
            self.stopped = True
            return ""
        # A log on a full disk may be empty.
        place = self.results if os.path.isdir(self.results) else "."
        if _is_full(lines) or shutil.disk_usage(place).free < MIN_FREE_BYTES:
            return f"{self.results}: no space left on its disk; make room there and run again"
        if "error in the program" in lines:
            return f"a fault of the program, not of the input: {lines[-1]}"
        return ended_by_cluster(lines) or "ended without an error message: killed, or out of memory"

    def close(self):
        """Print how the run ended, with the warnings of the data or the reason of its failure."""
        super().close()
        if self.closed:
            return
        self.closed = True
        if self.failed:
            left = self.total - self.done - len(self.failed)
            done = f"{self.done} of {_counted(self.total)} done, {len(self.failed)} failed"
            self._say(done + (f"; {left} more were not begun" if left > 0 else ""), self.err)
        elif _is_full(self.errors):
            self._say("error: .snakemake: no space left on its disk; make room there", self.err)
        elif self.errors:
            self._say(f"error: {self.errors[0]}", self.err)  # later ones repeat that it failed
        elif self.nothing or (self.dry_run and not self.jobs):
            self._say("nothing to do: everything there is, is up to date")
        elif self.dry_run:
            self._list_jobs()
        elif self.total:  # not where something else was asked for, such as a report
            self._say(f"{_counted(self.done)} done in {_took(self.begin)}")
        self._say_warnings()

    def _list_jobs(self):
        """Print a table of the jobs that would run, with reasons."""
        rows = sorted(
            (title, next((why for key, why in _REASONS.items() if re.search(key, reason)), reason))
            for title, _, reason in self.jobs.values()
        )
        room = WIDTH - 4 - max(len(why) for _, why in rows)
        width = min(room, max(len(title) for title, _ in rows))
        for title, why in rows:
            self._say(f"  {_cut(title, width):<{width}}  {why}")
        self._say(f"{_counted(len(rows))} would be done; nothing was")

    def _say_warnings(self):
        said = [f"{name}: {text}" for text, name in self.warnings.items()]
        lines = [line for text in said for line in _wrapped(text, "  ")]
        more = ["  and more, which the result page has"] if len(lines) > MAX_WARNINGS else []
        for line in ["warnings of the data:", *lines[:MAX_WARNINGS], *more] if lines else []:
            self._say(line, self.err)

    def _say(self, line, stream=None):
        if self.stopped:
            return
        stream = stream or self.out
        try:
            said = _CONTROL.sub(lambda found: f"\\x{ord(found[0]):02x}", line)
            print(said, file=stream, flush=True)
        except BrokenPipeError:  # nobody reads any more; what is left would be an error at the end
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _is_full(lines):
    return any(words in line for line in lines for words in _FULL)


def _counted(n):
    return f"{n} job" if n == 1 else f"{n} jobs"


def _wrapped(text, indent=""):
    return textwrap.wrap(
        text, WIDTH, initial_indent=indent, subsequent_indent=f"{indent}  ", break_on_hyphens=False
    )


def _cut(text, width):
    return text if len(text) <= width else text[: max(width - 1, 0)] + "…"


def _took(begin):
    """Time since a start in words: 8 s, 2 min 10 s, 3 h 5 min."""
    seconds = round(time.time() - begin)
    minutes, hours = seconds // 60, seconds // 3600
    if seconds < 100:
        return f"{seconds} s"
    if minutes < 10:
        return f"{minutes} min {seconds % 60} s"
    return f"{hours} h {minutes % 60} min" if hours else f"{minutes} min"
