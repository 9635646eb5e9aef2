"""A known surface in foreign-looking files: read as its true sidecar says, or refused with a draft.

    python tests/support/dialect_fuzzing.py --files 5000 --seed 1
    python tests/support/dialect_fuzzing.py --seed 1 --only 1234  # one of them again

A file depends on the seed and its number alone. What failed is kept in results/dialects.
"""

import re
import tempfile
import traceback
import warnings
from collections import Counter, defaultdict
from dataclasses import dataclass
from pathlib import Path
from unittest import mock

import dialects_of_contradictions  # noqa: F401  # enter their dialects
import dialects_of_doubt  # noqa: F401
import dialects_of_matrices  # noqa: F401
import dialects_of_meaning  # noqa: F401
import dialects_of_points  # noqa: F401
import numpy as np
import yaml
from dialects import Written, make
from fuzzing import judge_from_command_line
from places import ROOT

from fractalcontact.core.errors import InputError
from fractalcontact.scan import read
from fractalcontact.scan.formats import read_raw
from fractalcontact.scan.raw import IncompleteSidecar

#: Words of a sentence that says what to do.
_ADVICE = re.compile(r"\b(export|write|save|say|remove|mend|set|name)\b|'[a-z_]+: ", re.IGNORECASE)
LONGEST_MESSAGE = 1200


#: A line of one unit, filled with two where the owner knows two.
_UNITS = ("unit_xy", "unit_z")
#: A draft that asks further keys is filled this often.
MAX_DRAFTS = 3


@dataclass(frozen=True)
class Judgement:
    """What became of one file.

    Attributes
    ----------
    written : Written
    outcome : str
        "right", "refused" or "wrong", by its true sidecar.
    message : str
    fault : str
        What must not have happened; "" if all is well.
    drafted : str
        The outcome by its draft, its empty lines filled truly and all others accepted; "" where
        there is none.
    mistaken : tuple of str
        Keys in which the draft differs from the truth, where it was read wrong.
    """

    written: Written
    outcome: str
    message: str
    fault: str
    drafted: str = ""
    mistaken: tuple[str, ...] = ()


def judge(written: Written, folder: Path) -> Judgement:
    """Read one file without a sidecar, with its true one, and as its draft says.

    It is read in this process: what the reader's own process does is `fuzzing`'s matter, and it
    takes ten times as long.
    """
    path = folder / f"rock{written.ending}"
    path.write_bytes(written.content)
    with mock.patch.object(read, "read_confined", read_raw):
        try:
            return _judge(written, path)
        finally:
            path.unlink()


def _judge(written: Written, path: Path) -> Judgement:
    fault, draft = _without_sidecar(written, path)
    outcome, message = _read(path, written, written.sidecar)
    if outcome == "wrong":
        fault = fault or f"read wrong: {message}"
    elif outcome == "refused":
        fault = fault or _fault_of_message(message, path)
        if written.expected == "read":
            fault = fault or f"refused, but its sidecar says all: {message}"
    elif written.expected == "refused":
        outcome, fault = "wrong", fault or "read, but holds no surface or contradicts itself"
    if not draft:
        return Judgement(written, outcome, message, fault)
    drafted = _completed(path, draft, written.sidecar)
    by_draft, _ = _read(path, written, drafted)
    keys = sorted(drafted.keys() | written.sidecar.keys())
    mistaken = tuple(key for key in keys if drafted.get(key) != written.sidecar.get(key))
    return Judgement(written, outcome, message, fault, by_draft, mistaken)


def _completed(path: Path, draft: dict, truth: dict) -> dict:
    """A sidecar as an owner makes it of drafts: empty lines filled truly, the rest accepted."""
    drafted: dict = {}
    for _ in range(MAX_DRAFTS):
        drafted |= {key: value for key, value in draft.items() if value is not None}
        empty = {key for key, value in draft.items() if value is None}
        if "unit" in empty:
            empty |= set(_UNITS)
        drafted |= {key: truth[key] for key in empty if key in truth and key not in drafted}
        try:
            read.read_scan(path, drafted)
        except IncompleteSidecar as error:
            draft = yaml.safe_load(error.draft)
        except InputError:
            break
        else:
            break
    return drafted


def _without_sidecar(written: Written, path: Path) -> tuple[str, dict]:
    """The fault of reading a file alone, and the draft that its refusal prints."""
    try:
        read.read_scan(path)
    except IncompleteSidecar as error:
        return _fault_of_message(error.message, path), yaml.safe_load(error.draft)
    except InputError as error:
        return _fault_of_message(str(error), path), {}
    outcome, message = _read(path, written, {})
    if not written.describes_itself:
        return f"read without a sidecar, {outcome}", {}
    return (f"read wrong without a sidecar: {message}" if outcome == "wrong" else ""), {}


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
                    f"{written.dialect}\n{written.sidecar}\n{judgement.fault}\n",
                    encoding="utf-8",
                )
    return judgements


def table(judgements: list[Judgement]) -> str:
    """By dialect: files, outcomes by the true sidecar and by the completed draft, and faults."""
    groups = defaultdict(list)
    for judgement in judgements:
        groups[judgement.written.dialect].append(judgement)
    groups["all"] = judgements
    outcomes = ("right", "refused", "wrong")
    head = "".join(f"{outcome:>8}" for outcome in outcomes)
    lines = [f"{'dialect':40}{'files':>6} by sidecar:{head} by draft:{head}  faults"]
    for name, group in groups.items():
        true = "".join(f"{sum(j.outcome == o for j in group):8}" for o in outcomes)
        draft = "".join(f"{sum(j.drafted == o for j in group):8}" for o in outcomes)
        faults = sum(bool(j.fault) for j in group)
        keys = Counter(key for j in group if j.drafted == "wrong" for key in j.mistaken)
        why = ", ".join(f"{key} {count}" for key, count in keys.most_common(4))
        lines.append(f"{name:40}{len(group):6}{'':12}{true}{'':10}{draft}{faults:8}  {why}")
    return "\n".join(lines)


if __name__ == "__main__":
    kept = ROOT / "results" / "dialects"
    judge_from_command_line(__doc__.splitlines()[0], kept, run, table)
