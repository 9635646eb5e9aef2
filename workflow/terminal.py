"""What a user reads while a study is made: one line a job, how far it is, what is wrong and where.

It is told the events of workflow/logger, and reads the logs of jobs for their own words: the error
of one that failed, and warnings of the data, which stand together at the end.
"""

import csv
import io
import os
import re
import sys
import textwrap
import threading
import time
from collections import deque
from pathlib import Path

from cluster import ended_by_cluster

#: Columns of the terminal.
WIDTH = 120
#: Lines of warnings at the end; the result page has all.
MOST_WARNINGS = 24
#: Lines kept of what jobs and Snakemake write past their logs.
_KEPT = 200
#: Rules that make nothing themselves: what they ask for is made when they come.
_TARGETS = ("all", "pages", "accuracy")
#: A time left is said from this many seconds on.
_WORTH_SAYING = 5
_FULL = ("No space left on device", "Disk quota exceeded", "no space left on its disk")
#: What Snakemake's reasons begin with, and what is said of them; the first that fits.
_REASONS = {
    "Missing output files": "not made yet",
    "Forced execution": "left incomplete, or asked for",
    "Params have changed": "settings changed",
    "Code has changed": "its code changed",
    "Software environment": "its environment changed",
    "Set of input files": "is made of other files than before",
    "Updated input files": "a file that it is made of is newer",
    "Input files updated by another job": "what it is made of is made again",
    "Rules with": "is always done",
}
#: What would do things to a terminal; some of what is said comes from files of others.
_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]")
#: To the beginning of the line, which is emptied.
_BACK = "\r\x1b[K"
#: In a parameter, the checksum of a scan.
_CHECKSUM = re.compile(r"\b[0-9a-f]{64}\b")
#: A parameter that is the digest of code, as `core.sources.digest` writes it.
_DIGEST = re.compile(r"'?[0-9a-f]{16}'?")


class Terminal:
    """The lines of one run.

    Parameters
    ----------
    results : Path
        Folder of the study.
    dry_run : bool
        Whether jobs are only listed.
    out, err : text files
    """

    def __init__(self, results, *, dry_run=False, out=None, err=None):
        self.results, self.dry_run = Path(results), dry_run
        self.out, self.err = out or sys.stdout, err or sys.stderr
        for stream in (self.out, self.err):
            if isinstance(stream, io.TextIOWrapper):  # names of specimens are in any script
                stream.reconfigure(errors="backslashreplace")
        self.lock = threading.Lock()
        self.begin, self.began_at = time.monotonic(), time.time()
        #: Jobs by number: rule, title, log, reason; when those at work began; those that failed.
        self.jobs, self.running, self.failed = {}, {}, {}
        self.waiting, self.total, self.done, self.widest = {}, 0, 0, 1
        self.times = _Times(self.results / "benchmarks")
        self.past = deque(maxlen=_KEPT)
        self.errors, self.warnings, self.nothing, self.muted = [], {}, False, False
        #: Whether a line that names the jobs at work can stand last, and be taken back.
        self.live = self.out.isatty() and not dry_run

    # -- what it is told ---------------------------------------------------------------------------

    def hear(self, event):
        """Take in one event of Snakemake; its keys are those of workflow/logger."""
        with self.lock:
            kind = event["event"]
            if kind is None:
                self._remark(event)
            else:
                getattr(self, f"_{kind}", lambda event: None)(event)
            self._show_at_work()

    def overhear(self, line):
        """Keep a line that a job or Snakemake wrote past its log."""
        with self.lock:
            self.past.append(line.rstrip("\n"))

    def mute(self):
        """Say nothing from now on: what jobs say that are told to end is of no use."""
        with self.lock:
            self.muted = True
            if self.live:
                put(_BACK, self.out)

    def _remark(self, event):
        if event["text"].startswith("Nothing to be done"):
            self.nothing = True
        elif event["level"] == "WARNING":
            for line in _wrapped(f"warning: {event['text']}", WIDTH):
                self._say(line, self.err)

    def _run_info(self, event):
        counts = dict(event["stats"])
        if self.total:  # a dry run counts twice
            return
        self.total = counts.pop("total") - sum(counts.pop(rule, 0) for rule in _TARGETS)
        self.waiting = counts
        if not self.dry_run:
            self._say(f"{_counted(self.total, 'job')}; what is made goes to {self.results}")

    def _job_info(self, event):
        if event["rule_name"] in _TARGETS:
            return
        title = " ".join((event["rule_msg"] or event["rule_name"]).split())
        keys = ("rule_name", "reason", "log")
        self.jobs[event["jobid"]] = {"title": title} | {key: event[key] for key in keys}

    def _job_started(self, event):
        for number in event["jobs"]:
            self.running[number] = time.monotonic()
            if again := self.failed.pop(number, None):  # on a cluster, with more memory
                self.waiting[again["rule_name"]] += 1
        self.widest = max(self.widest, len(self.running))

    def _job_finished(self, event):
        job = self.jobs.get(event["job_id"])
        if self.dry_run or job is None:
            return
        self.done += 1
        seconds = self._ended(event["job_id"], job)
        self.times.add(job["rule_name"], seconds)
        self._gather_warnings(job)
        took = f" ({_duration(seconds)}{self._left()})"
        count = f"[{self.done:>{len(str(self.total))}}/{self.total}] "
        self._say(count + _cut(job["title"], WIDTH - len(count) - len(took)) + took)

    def _job_error(self, event):
        number = event["jobid"]
        job = self.jobs.get(number, {"title": event["rule_name"], "rule_name": event["rule_name"]})
        job["log"] = event["log"]
        if number in self.failed:
            return
        self._ended(number, job)
        said = self._error_of(job)
        self.failed[number] = job
        if said is not None:
            self._say(f"error: {said}", self.err)
            self._say(f"  job: {_cut(job['title'], WIDTH - 7)}", self.err)
            for path in job["log"]:
                self._say(f"  log: {path}", self.err)

    def _error(self, event):
        self.errors.append(_without_places(event["text"]))

    # -- what it works out -------------------------------------------------------------------------

    def _ended(self, number, job):
        """Take a job from those at work; the seconds that it took."""
        rule = job["rule_name"]
        self.waiting[rule] = max(self.waiting.get(rule, 0) - 1, 0)
        return time.monotonic() - self.running.pop(number, time.monotonic())

    def _left(self):
        """About how long the rest will take, in words; none before it can be known."""
        if self.done == self.total or (self.done < 3 and not self.times.known):
            return ""
        now = time.monotonic()
        rest = [
            max(self.times.expected(self.jobs[number]["rule_name"]) - (now - began), 0)
            for number, began in self.running.items()
            if number in self.jobs
        ]
        work = sum(self.times.expected(rule) * count for rule, count in self.waiting.items())
        begun = sum(
            self.times.expected(self.jobs[number]["rule_name"])
            for number in self.running
            if number in self.jobs
        )
        seconds = max([(work - begun + sum(rest)) / self.widest, *rest])
        return f"; about {_duration(seconds)} left" if seconds >= _WORTH_SAYING else ""

    def _lines_of(self, job):
        """What a job wrote into its log in this run."""
        for path in map(Path, job.get("log") or ()):
            try:
                if path.stat().st_mtime >= self.began_at - 2:
                    yield from path.read_text(encoding="utf-8", errors="replace").splitlines()
            except OSError:
                continue

    def _gather_warnings(self, job):
        for line in self._lines_of(job):
            if line.startswith("warning: "):
                name = job["title"].partition(": ")[0]
                self.warnings.setdefault(line.removeprefix("warning: "), name)

    def _error_of(self, job):
        """Why a job failed, in its own words; None of one that was told to stop."""
        lines = list(self._lines_of(job))
        said = [line.removeprefix("error: ") for line in lines if line.startswith("error: ")]
        if said:
            return said[-1]
        if "stopped before it was done" in lines[-1:]:
            return None
        if _is_full([*lines, *self.past]):
            return f"{self.results}: no space left on its disk; make room there and run again"
        if why := ended_by_cluster(lines):
            return why
        said = [line for line in self.past if line.startswith("error: ")]
        if said and not lines:  # it could not write into its log
            return said[-1].removeprefix("error: ")
        last = next((line for line in reversed(lines) if line.strip()), "")
        if "error in the program" in lines:
            return f"a fault of the program, not of the input: {last}"
        return "ended without a word; it was killed, or the memory did not suffice"

    # -- what it says ------------------------------------------------------------------------------

    def finish(self, status):
        """Say how the run ended: what there is to know of the data, or why it did not finish."""
        with self.lock:
            if self.dry_run and not status:
                self._list_jobs()
            elif status:
                self._explain()
            elif self.nothing:
                self._say("nothing to do: everything there is, is up to date")
            elif self.total:  # not where something else was asked for, such as a report
                took = _duration(time.monotonic() - self.begin)
                self._say(f"{_counted(self.done, 'job')} done in {took}")
            if not self.dry_run:
                self._say_warnings()

    def _list_jobs(self):
        """A table of what would be done, and why."""
        if not self.jobs:
            self._say("nothing to do: everything there is, is up to date")
            return
        rows = sorted((job["title"], _reason(job["reason"])) for job in self.jobs.values())
        longest = max(len(why) for _, why in rows)
        width = min(max(len(title) for title, _ in rows), WIDTH - longest - 4)
        for title, why in rows:
            self._say(f"  {_cut(title, width):<{width}}  {why}")
        self._say(f"{_counted(len(rows), 'job')} would be done; nothing was")

    def _explain(self):
        """Why nothing was done, or not all."""
        if self.failed:
            left = self.total - self.done - len(self.failed)
            waiting = f"; {left} more were not begun" if left > 0 else ""
            self._say(
                f"{self.done} of {_counted(self.total, 'job')} done, {len(self.failed)} "
                f"failed{waiting}",
                self.err,
            )
        elif _is_full([*self.errors, *self.past]):
            self._say("error: .snakemake: no space left on its disk; make room there", self.err)
        elif self.errors:
            self._say(f"error: {self.errors[-1]}", self.err)
        else:
            for line in list(self.past)[-10:]:
                self._say(line, self.err)

    def _say_warnings(self):
        lines = []
        for text, name in self.warnings.items():
            lines += [f"  {line}" for line in _wrapped(f"{name}: {text}", WIDTH - 2)]
        if lines:
            self._say("warnings of the data:", self.err)
        for line in lines[:MOST_WARNINGS]:
            self._say(line, self.err)
        if len(lines) > MOST_WARNINGS:
            self._say("  and more, which the result page has", self.err)

    def _show_at_work(self):
        """Name the jobs at work in the last line, which the next one takes the place of."""
        if self.live and not self.muted:
            titles = [self.jobs[number]["title"] for number in self.running if number in self.jobs]
            line = _printable(_cut(f"at work: {'; '.join(titles)}", WIDTH - 1) if titles else "")
            put(f"{_BACK}{line}", self.out)

    def _say(self, line, file=None):
        if self.muted:
            return
        if self.live:
            put(_BACK, self.out)
        put(f"{_printable(line)}\n", file or self.out)


class _Times:
    """Seconds that jobs took, by rule: in this run, else in earlier ones."""

    def __init__(self, benchmarks):
        self.before, self.now = {}, {}
        for path in sorted(Path(benchmarks).rglob("*.tsv")):
            rule = path.relative_to(benchmarks).parts[0].removesuffix(".tsv")
            try:
                with open(path, encoding="utf-8", newline="") as file:
                    found = [float(row["s"]) for row in csv.DictReader(file, delimiter="\t")]
            except (OSError, ValueError, KeyError, TypeError):  # only for an estimate
                continue
            self.before.setdefault(rule, []).extend(found)

    @property
    def known(self):
        """Whether there were earlier runs."""
        return bool(self.before)

    def add(self, rule, seconds):
        self.now.setdefault(rule, []).append(seconds)

    def expected(self, rule):
        """Seconds of one more job of a rule: the mean of its others, else that of all jobs."""
        known = self.now.get(rule) or self.before.get(rule)
        known = known or [seconds for jobs in self.now.values() for seconds in jobs]
        known = known or [seconds for jobs in self.before.values() for seconds in jobs]
        return sum(known) / len(known) if known else 0


def _reason(text):
    """Why a job is done, from the reasons that Snakemake gives."""
    why = next((words for key, words in _REASONS.items() if key in text), text)
    if why == _REASONS["Params have changed"]:
        if _CHECKSUM.search(text):
            return "its scan changed"
        values = re.findall(r"(?:before|now): (.*?)(?= now: |;|$)", text)
        kinds = [value.split(",") for value in values if "<nothing exclusive>" not in value]
        if kinds and all(_DIGEST.fullmatch(one.strip()) for kind in kinds for one in kind):
            return "its code, or a library, changed"
    return why


def _without_places(text):
    """What an error of the workflow says, without where in it that was noticed."""
    lines = text.splitlines()
    head = (
        re.fullmatch(r"\w+(?: in (?:rule .*|file \".*\", line \d+))?:", lines[0]) if lines else None
    )
    lines = lines[1:] if head and len(lines) > 1 else lines
    return "\n".join(line for line in lines if not line.startswith('  File "')).strip()


def _is_full(lines):
    return any(words in line for line in lines for words in _FULL)


def _counted(n, noun):
    return f"{n} {noun}" if n == 1 else f"{n} {noun}s"


def _wrapped(text, width):
    return textwrap.wrap(text, width, subsequent_indent="  ", break_on_hyphens=False)


def put(text, stream):
    """Write to a terminal or a pipe; where nobody reads any more, the study goes on."""
    try:
        print(text, end="", file=stream, flush=True)
    except BrokenPipeError:
        # What is still in the stream would be an error at the end.
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def _printable(text):
    return _CONTROL.sub(lambda found: f"\\x{ord(found[0]):02x}", text)


def _cut(text, width):
    return text if len(text) <= width else text[: max(width - 1, 0)] + "…"


def _duration(seconds):
    """Seconds in words: 8 s, 2 min 10 s, 3 h 5 min."""
    seconds = round(seconds)
    if seconds < 100:
        return f"{seconds} s"
    minutes, rest = divmod(seconds, 60)
    if minutes < 10:
        return f"{minutes} min {rest} s"
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if hours else f"{minutes} min"
