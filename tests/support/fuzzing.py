"""Spoilt scan files by the thousand: each is read or refused in one sentence, nothing else.

    python tests/support/fuzzing.py --files 5000 --seed 1
    python tests/support/fuzzing.py --seed 1 --only 1234  # one of them again, with its traceback

A file depends on the seed and its number alone. What failed is kept in results/fuzzing.
"""

import argparse
import contextlib
import logging
import os
import re
import resource
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml
from mutations import spoil
from places import ROOT, SCANS
from scan_writers import WRITERS, write
from stated import ARRAY

from fractalcontact.core.errors import InputError
from fractalcontact.scan import confined
from fractalcontact.scan.raw import IncompleteSidecar
from fractalcontact.scan.read import read_scan
from fractalcontact.study.checks import read_sidecar

LONGEST_SECONDS = 10
MAX_MEMORY = 2 * 1024**3
LONGEST_MESSAGE = 1000
LONGEST_DRAFT = 6100  # what the reader cuts it to, and what it puts in place
_LARGEST_SEED = 2_500_000  # bytes of a real file that is worth spoiling a hundred times
_SCHEMA = yaml.safe_load((ROOT / "config/schema/study.schema.yaml").read_text(encoding="utf-8"))
_SIDECAR = (
    b"label: granite, tensile crack\nunit_xy: mm\nunit_z: um\nspacing: [0.1 mm, 0.2]\n"
    b"columns: [x, y, 2]\nmissing: -9999\nwindow: 20 mm\nloads: [10 kN, 25 MPa]\n"
    b"material: {modulus: 20 GPa, poisson: 0.2}\n"
)
_ESRI = b"ncols 15\nnrows 12\nxllcorner 0.0\nyllcorner 0.0\ncellsize 0.5\nNODATA_value -9999\n"
_ESRI_SIDECAR = {
    **ARRAY,
    "delimiter": "blank",
    "decimal": ".",
    "header": 6,
    "unit": "mm",
    "spacing": 0.5,
    "first_row": "top",
    "missing": -9999,
}


@dataclass(frozen=True)
class Seed:
    """A sound file to spoil: its ending, its content, the sidecar that goes with it."""

    ending: str
    content: bytes
    options: dict


@dataclass(frozen=True)
class Verdict:
    """What became of one file; ``fault`` is empty if that is as it should be."""

    ending: str
    was_read: bool
    seconds: float
    peak: int
    fault: str


class _Hangs(BaseException):
    """No error handler of a reader may catch this."""


def make_seeds(folder: Path, real: bool) -> list[Seed]:
    """One small file of every format that can be written, and the real ones that are there."""
    rng = np.random.default_rng(0)
    heights = np.round(rng.uniform(-0.5, 0.5, (12, 15)), 4)
    seeds = [Seed(".yaml", _SIDECAR, {})]
    rows = "\n".join(" ".join(map(str, row)) for row in heights)
    seeds.append(Seed(".asc", _ESRI + rows.encode(), _ESRI_SIDECAR))
    heights[3, 4] = heights[7, 2] = np.nan
    for ending in WRITERS:
        whole = np.nan_to_num(heights) if ending in (".stl", ".obj", ".ply") else heights
        options = write(folder / f"seed{ending}", whole, 0.5, 0.25)
        seeds.append(Seed(ending, (folder / f"seed{ending}").read_bytes(), options))
    for path in sorted(SCANS.glob("instruments/*/*.*")) if real else ():
        if path.stat().st_size <= _LARGEST_SEED and not re.search("LICENSE|README", path.name):
            seeds.append(Seed(path.suffix.lower(), path.read_bytes(), {}))
    return seeds


def spoilt(seeds: list[Seed], seed: int, number: int) -> tuple[Seed, bytes]:
    """File ``number`` of a run: the seeds in turn, each time spoilt differently."""
    rng = np.random.default_rng([seed, number])
    chosen = seeds[number % len(seeds)]
    return chosen, spoil(chosen.content, rng)


def judge(chosen: Seed, content: bytes, folder: Path) -> Verdict:
    """Read one spoilt file and say what is wrong with how that went.

    ``folder`` is empty and the current one, and holds the folder of temporary files.
    """
    path = folder / f"rock{chosen.ending}"
    path.write_bytes(content)
    before = _listing(folder)
    watch = _Watch()
    fault, was_read = "", False
    signal.signal(signal.SIGALRM, _raise_hang)
    signal.alarm(10 * LONGEST_SECONDS)
    try:
        _read(path, chosen)
        was_read = True
    except InputError as error:
        fault = _fault_of_refusal(error, path)
    except _Hangs:
        fault = "".join(traceback.format_exc(limit=-6))
    except Exception as error:
        fault = "".join([*getattr(error, "__notes__", []), traceback.format_exc(limit=-8)])
    finally:
        signal.alarm(0)
    seconds, peak = watch.stop()
    if seconds > LONGEST_SECONDS:
        fault += f"\ntook {seconds:.1f} s"
    if peak > MAX_MEMORY:
        fault += f"\ntook {peak / 1024**3:.1f} GiB"
    if _listing(folder) != before:
        fault += f"\nfiles created or changed: {sorted(set(_listing(folder)) ^ set(before))}"
    path.unlink()
    return Verdict(chosen.ending, was_read, seconds, peak, fault)


def _read(path: Path, chosen: Seed) -> None:
    if chosen.ending == ".yaml":
        read_sidecar(path, _SCHEMA)
    else:
        read_scan(path, chosen.options)


def _fault_of_refusal(error: InputError, path: Path) -> str:
    """The fault of a sentence, and of the draft of a sidecar that may follow it."""
    if not isinstance(error, IncompleteSidecar):
        return _fault_of_message(str(error), path)
    if len(error.draft) > LONGEST_DRAFT:
        return f"a draft of {len(error.draft)} characters: {error.draft}"
    return _fault_of_message(error.message, path)


def _fault_of_message(message: str, path: Path) -> str:
    if path.name not in message:
        return f"the message does not name the file: {message}"
    if len(message) > LONGEST_MESSAGE:
        return f"a message of {len(message)} characters: {message}"
    return ""


def _raise_hang(*_):
    raise _Hangs


def _listing(folder: Path) -> list:
    """Every file below a folder with its size and time."""
    return sorted(
        (str(p), p.stat().st_size, p.stat().st_mtime_ns) for p in folder.rglob("*") if p.is_file()
    )


class _Watch(logging.Handler):
    """Processor time and most memory: of the reader, which logs them, and of this process.

    Time by the clock would measure how busy the machine is.
    """

    def __init__(self):
        super().__init__()
        self.logger = logging.getLogger(confined.__name__)
        self.logger.setLevel(logging.DEBUG)
        self.logger.addHandler(self)
        self.logger.propagate = False
        self.seconds, self.reader_peak = -time.process_time(), 0
        with contextlib.suppress(OSError):  # Linux forgets the peak so far; others grow only
            Path("/proc/self/clear_refs").write_text("5", encoding="utf-8")
        self.own_peak = _own_peak()

    def emit(self, record):
        _, _, peak, seconds = record.args
        self.reader_peak = max(self.reader_peak, peak * (1 if sys.platform == "darwin" else 1024))
        self.seconds += seconds

    def stop(self) -> tuple[float, int]:
        self.logger.removeHandler(self)
        self.logger.propagate = True
        grown = _own_peak() - self.own_peak
        return self.seconds + time.process_time(), max(self.reader_peak, grown)


def _own_peak() -> int:
    """Most memory this process had, in bytes."""
    with contextlib.suppress(FileNotFoundError):
        status = Path("/proc/self/status").read_text(encoding="utf-8")
        return int(re.search(r"VmHWM:\s+(\d+)", status)[1]) * 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


@contextlib.contextmanager
def own_folder():
    """An empty current folder, which holds what libraries write to the temporary one, too."""
    here, temporary = Path.cwd(), tempfile.tempdir
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name).resolve()
        (folder / "temporary").mkdir()
        os.chdir(folder)
        tempfile.tempdir = str(folder / "temporary")
        set_before = os.environ.get("TMPDIR")
        os.environ["TMPDIR"] = tempfile.tempdir
        confined.stop_reader()  # the next one starts with this folder of temporary files
        try:
            yield folder
        finally:
            os.chdir(here)
            tempfile.tempdir = temporary
            confined.stop_reader()
            if set_before is None:
                del os.environ["TMPDIR"]
            else:
                os.environ["TMPDIR"] = set_before


def run(numbers, seed: int, kept: Path | None = None, real: bool = True) -> list[Verdict]:
    """Judge files of these numbers; those that failed go to ``kept``, with the reason."""
    verdicts = []
    with own_folder() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with tempfile.TemporaryDirectory(dir=folder.parent) as seeds_folder:
            seeds = make_seeds(Path(seeds_folder), real)
        for number in numbers:
            chosen, content = spoilt(seeds, seed, number)
            verdict = judge(chosen, content, folder)
            verdicts.append(verdict)
            if verdict.fault and kept is not None:
                kept.mkdir(parents=True, exist_ok=True)
                name = f"{seed}-{number}{chosen.ending}"
                (kept / name).write_bytes(content)
                (kept / f"{name}.fault").write_text(
                    f"{chosen.options}\n{verdict.fault}\n", encoding="utf-8"
                )
    return verdicts


def table(verdicts: list[Verdict]) -> str:
    """Files, read, refused and failed, slowest and largest, by format."""
    by_ending = defaultdict(list)
    for verdict in verdicts:
        by_ending[verdict.ending].append(verdict)
        by_ending["all"].append(verdict)
    lines = [f"{'format':16}{'files':>7}{'read':>7}{'refused':>9}{'failed':>8}{'s':>8}{'MB':>7}"]
    for ending in sorted(by_ending):
        group = by_ending[ending]
        read, failed = sum(v.was_read for v in group), sum(bool(v.fault) for v in group)
        slowest, largest = max(v.seconds for v in group), max(v.peak for v in group)
        lines.append(
            f"{ending:16}{len(group):7}{read:7}{len(group) - read:9}{failed:8}{slowest:8.2f}"
            f"{largest / 1e6:7.0f}"
        )
    return "\n".join(lines)


def judge_from_command_line(description: str, kept: Path, run: Callable, table: Callable) -> None:
    """Judge the files that the command line asks for; exit with their number where some failed.

    Parameters
    ----------
    description : str
    kept : Path
        Folder for the files that failed.
    run : callable
        (numbers, seed, kept) to judgements, each with a ``fault`` and, where known, ``message``.
    table : callable
        Judgements to what is printed of them.
    """
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--files", type=int, default=5000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first file")
    parser.add_argument("--only", type=int, help="number of one file")
    arguments = parser.parse_args()
    numbers = range(arguments.first, arguments.first + arguments.files)
    if arguments.only is not None:
        numbers = [arguments.only]
    start = time.monotonic()
    judged = run(numbers, arguments.seed, kept)
    print(table(judged))
    print(f"{time.monotonic() - start:.0f} s")
    if arguments.only is not None:
        print("\n".join(one.fault or getattr(one, "message", "") for one in judged))
    if faults := sum(bool(one.fault) for one in judged):
        sys.exit(f"{faults} of {len(judged)} files failed; they are kept in {kept}")


if __name__ == "__main__":
    judge_from_command_line(__doc__.splitlines()[0], ROOT / "results" / "fuzzing", run, table)
