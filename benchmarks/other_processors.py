"""Results of a study as other processors would compute them, beside those of this one.

    python benchmarks/other_processors.py config/smoke.yaml [--only oldest ...] [--digits 3]

The study is made once for each profile of tests/support/processors.py, in a working copy under
results/processors. Counted is what a reader would see change: words (verdicts, reasons, captions),
and numbers in their third digit; what is zero but for rounding is left out. Bounds on what an
iteration left are counted apart, as they depend on where it ended. Details are in
results/processors/PROFILE.txt.
"""

import argparse
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
from same import Comparison

ROOT = Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT / "tests/support"))
from processors import PROFILES, environment, this_processor
from projects import copy_project

from fractalcontact.commands.verify import results_of

FOLDER = ROOT / "results/processors"
#: Names and long names of what an iteration leaves when it ends.
BOUND = re.compile(r"error|residual|iterations|imbalance")
#: Fraction of the largest value of a variable, and number, below which one counts as rounded zero.
ZERO_SHARE, ZERO = 1e-6, 1e-12
_NUMBER = re.compile(r"[-+−]?\d+(\.\d+)?(e[-+]?\d+)?")


class Digits(Comparison):
    """Differences that a reader sees: in words, and in the first digits of numbers.

    Attributes
    ----------
    words, numbers, bounds : list of str
        The three kinds of differences; ``differences`` holds what has no counterpart.
    counted : int
        Numbers that were compared.
    largest : float
        Largest relative difference of a number that is no bound.
    """

    def __init__(self, digits):
        super().__init__()
        self.digits = digits
        self.words, self.numbers, self.bounds = [], [], []
        self.counted, self.largest = 0, 0.0

    def values(self, old, new, place, bound=False):
        """Compare two arrays of numbers, or of words."""
        old, new = np.asarray(old), np.asarray(new)
        if old.shape != new.shape:
            self.differ(place, f"shape {old.shape} is now {new.shape}")
        elif old.dtype.kind not in "fiu" or new.dtype.kind not in "fiu":
            wrong = np.argwhere(old != new)
            self._note(self.words, place, old, new, wrong)
        else:
            old, new = old.astype(float), new.astype(float)
            self.counted += old.size
            zero = _is_zero(old) & _is_zero(new)
            off = ~zero & ~same_digits(old, new, self.digits)
            if not bound:
                self.largest = max(self.largest, _largest_relative(old[~zero], new[~zero]))
            self._note(self.bounds if bound else self.numbers, place, old, new, np.argwhere(off))

    @staticmethod
    def _note(kind, place, old, new, wrong):
        kind += [f"{place} {where}: {old[where]!r}, {new[where]!r}" for where in map(tuple, wrong)]

    def variables(self, old, new, place):
        """Compare two variables of an atlas, and their attributes."""
        self.attributes(old.attrs, new.attrs, place)
        told = f"{place.split()[-1]} {old.attrs.get('long_name', '')}"
        self.values(old.values, new.values, place, BOUND.search(told) is not None)

    def attributes(self, old, new, place):
        """Compare two mappings of attributes."""
        for name in set(old) & set(new):
            if isinstance(old[name], str) and isinstance(new[name], str):
                self.texts(old[name], new[name], f"{place} attribute {name}")
            else:
                self.values(old[name], new[name], f"{place} attribute {name}")

    def texts(self, old, new, place):
        """Compare two texts: their words, and the numbers in them."""
        ours, theirs = (_NUMBER.sub("#", text) for text in (old, new))
        if ours != theirs:
            self.words.append(f"{place}: {old!r}, {new!r}")
            return
        found = [[_value(match[0]) for match in _NUMBER.finditer(text)] for text in (old, new)]
        self.values(*found, place, BOUND.search(place) is not None)

    def tables(self, old, new, place):
        """Compare two tables as texts, column by column."""
        self.compared["tables"] += 1
        ours, theirs = (path.read_text(encoding="utf-8").splitlines() for path in (old, new))
        if len(ours) != len(theirs):
            self.differ(place, f"{len(ours)} lines are now {len(theirs)}")
        for line, (one, other) in enumerate(zip(ours, theirs, strict=False), 1):
            self.texts(one, other, f"{place} line {line}")


def same_digits(old, new, digits):
    """Where two arrays agree to half a unit of their last digit, or miss the same values."""
    with np.errstate(divide="ignore", invalid="ignore"):
        power = np.floor(np.log10(np.maximum(np.abs(old), np.abs(new))))
        close = np.abs(old - new) <= 0.5 * 10.0 ** (power - digits + 1)
    return close | (old == new) | (np.isnan(old) & np.isnan(new))


def _is_zero(values):
    """Where values are small beside the largest of them, or at all."""
    sizes = np.abs(values)
    largest = np.max(sizes, initial=0.0, where=np.isfinite(sizes))
    return sizes <= max(ZERO_SHARE * largest, ZERO)


def _largest_relative(old, new):
    known = np.isfinite(old) & np.isfinite(new) & (old != 0)
    return float(np.max(np.abs(new[known] / old[known] - 1), initial=0.0))


def _value(text):
    return float(text.replace("−", "-"))


def make_study(study, profile, processor):
    """The folder of a study's results, made as a processor of this profile would make them."""
    project = FOLDER / profile.name
    shutil.rmtree(project, ignore_errors=True)
    project.mkdir(parents=True)
    copy_project(project)
    shutil.rmtree(project / "scans")
    (project / "scans").symlink_to(ROOT / "scans")
    command = [sys.executable, "workflow/run.py", str(study), "--", "--cores", "2"]
    subprocess.run(command, cwd=project, env=environment(profile, processor), check=True)
    return project / results_of(str(study))


def main():
    """Make the study under each profile, and print what changes between them."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("study", type=Path, help="a study in config/")
    others = [name for name in PROFILES if name != "native"]
    parser.add_argument("--only", action="append", choices=others, help="this profile alone")
    parser.add_argument("--digits", type=int, default=3, help="digits that are to agree")
    options = parser.parse_args()
    processor = this_processor()
    native = make_study(options.study, PROFILES["native"], processor)
    heads = ("numbers", "words", "digits", "bounds", "lost or new", "largest change")
    lines = [f"{'profile':16}" + "".join(f"{head:>15}" for head in heads)]
    for name in options.only or others:
        if why := PROFILES[name].missing(processor):
            lines.append(f"{name:16}  not made: {why}")
            continue
        found = Digits(options.digits)
        found.folders(native, make_study(options.study, PROFILES[name], processor))
        kinds = (found.words, found.numbers, found.bounds, found.differences)
        told = "\n".join(line for kind in kinds for line in kind)
        (FOLDER / f"{name}.txt").write_text(f"{told}\n", encoding="utf-8")
        counts = "".join(f"{len(kind):15}" for kind in kinds)
        lines.append(f"{name:16}{found.counted:15}{counts}{found.largest:15.1e}")
    print("\n" + "\n".join(lines))


if __name__ == "__main__":
    sys.exit(main())
