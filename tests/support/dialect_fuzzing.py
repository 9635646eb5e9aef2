"""A known surface in foreign-looking text files: each is read right or refused with advice.

    python tests/support/dialect_fuzzing.py --files 5000 --seed 1
    python tests/support/dialect_fuzzing.py --seed 1 --only 1234  # one of them again

A file depends on the seed and its number alone. What failed is kept in results/dialects.
"""

import re
import tempfile
import traceback
import warnings
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from unittest import mock

import dialects_of_matrices  # noqa: F401  # enter their dialects
import dialects_of_points  # noqa: F401
import numpy as np
from dialects import Written, make
from fuzzing import judge_from_command_line
from places import ROOT

from fractalcontact.core.errors import InputError
from fractalcontact.scan import read
from fractalcontact.scan.formats import read_raw

#: Words of a sentence that says what to do.
_ADVICE = re.compile(r"\b(export|write|save|say|remove|mend|set|name)\b|'[a-z_]+: ", re.IGNORECASE)
LONGEST_MESSAGE = 1000


@dataclass(frozen=True)
class Judgement:
    """What became of one file: ``outcome`` is "right", "refused" or "wrong"; why it is a fault."""

    written: Written
    outcome: str
    message: str
    fault: str


def judge(written: Written, folder: Path) -> Judgement:
    """Read one file with its sidecar, and without, and compare what was read with the truth.

    It is read in this process: what the reader's own process does is `fuzzing`'s matter, and it
    takes ten times as long.
    """
    path = folder / f"rock{written.ending}"
    path.write_bytes(written.content)
    with mock.patch.object(read, "read_confined", read_raw):
        return _judge(written, path)


def _judge(written: Written, path: Path) -> Judgement:
    try:
        fault = _fault_without_sidecar(written, path) if written.sidecar else ""
        outcome, message = _read(path, written, written.sidecar)
    finally:
        path.unlink()
    if outcome == "wrong":
        fault = fault or f"read wrong: {message}"
    elif outcome == "refused":
        fault = fault or _fault_of_message(message, path)
        if written.expected == "read":
            fault = fault or f"refused, but says all: {message}"
    elif written.expected == "refused":
        outcome, fault = "wrong", fault or "read, but holds no surface or contradicts itself"
    return Judgement(written, "wrong" if fault.startswith("read") else outcome, message, fault)


def _fault_without_sidecar(written: Written, path: Path) -> str:
    """Without its sidecar a file is read right or refused; and what it states is not denied."""
    outcome, message = _read(path, written, {})
    if outcome == "wrong" and "missing" in written.sidecar:
        return ""  # a number that nobody has said to mean a missing cell
    if outcome == "wrong" or (outcome == "right" and written.expected == "refused"):
        return f"read wrong without a sidecar: {message}"
    if outcome == "refused":
        if written.states_units and "states no unit" in message:
            return f"it states its units, but: {message}"
        return _fault_of_message(message, path)
    return ""


def _read(path: Path, written: Written, sidecar: dict) -> tuple[str, str]:
    """The outcome, and the refusal or what differs from the truth."""
    try:
        heights = read.read_scan(path, sidecar)
    except InputError as error:
        return "refused", str(error)
    except Exception:
        return "wrong", traceback.format_exc(limit=-4)
    truth = written.surface
    if heights.shape != truth.heights.shape:
        return "wrong", f"{heights.shape} cells in place of {truth.heights.shape}"
    steps = heights.attrs["spacing_x"], heights.attrs["spacing_y"]
    if not np.allclose(steps, (truth.dx, truth.dy), rtol=1e-3, atol=0):
        return "wrong", f"spacing {steps} in place of {truth.dx, truth.dy}"
    if not np.array_equal(np.isnan(heights), np.isnan(truth.heights)):
        return "wrong", "other cells are missing"
    strays = np.nanmax(np.abs(heights.values - truth.heights)) / np.nanstd(truth.heights)
    if not strays < 1e-3:
        return "wrong", f"heights differ by {strays:.3g} of their deviation"
    return "right", ""


def _fault_of_message(message: str, path: Path) -> str:
    if path.name not in message:
        return f"the message does not name the file: {message}"
    if not _ADVICE.search(message):
        return f"the message does not say what to write: {message}"
    if len(message) > LONGEST_MESSAGE:
        return f"a message of {len(message)} characters: {message}"
    return ""


def run(numbers, seed: int, kept: Path | None = None) -> list[Judgement]:
    """Judge files of these numbers; those that failed go to ``kept``, with the reason."""
    judgements = []
    with tempfile.TemporaryDirectory() as name, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for number in numbers:
            judgement = judge(make(seed, number), Path(name))
            judgements.append(judgement)
            if judgement.fault and kept is not None:
                kept.mkdir(parents=True, exist_ok=True)
                written = judgement.written
                stem = f"{seed}-{number}"
                (kept / f"{stem}{written.ending}").write_bytes(written.content)
                (kept / f"{stem}.fault").write_text(
                    f"{written.dialect}\n{written.sidecar}\n{judgement.fault}\n"
                )
    return judgements


def table(judgements: list[Judgement]) -> str:
    """Files, read right, refused, read wrong, and faults of any kind, by dialect."""
    groups = defaultdict(list)
    for judgement in judgements:
        groups[judgement.written.dialect].append(judgement)
    groups["all"] = judgements
    lines = [f"{'dialect':42}{'files':>7}{'right':>7}{'refused':>9}{'wrong':>7}{'faults':>8}"]
    for name, group in groups.items():
        counts = [
            sum(j.outcome == outcome for j in group) for outcome in ("right", "refused", "wrong")
        ]
        faults = sum(bool(j.fault) for j in group)
        lines.append(f"{name:42}{len(group):7}{counts[0]:7}{counts[1]:9}{counts[2]:7}{faults:8}")
    return "\n".join(lines)


if __name__ == "__main__":
    kept = ROOT / "results" / "dialects"
    judge_from_command_line(__doc__.splitlines()[0], kept, run, table)
