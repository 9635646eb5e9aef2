"""Results of a study compared, bit for bit, with those kept before a change.

    python benchmarks/same.py keep STUDY ...
    python benchmarks/same.py compare STUDY ... [--against RESULTS] [--renamed NAMES.yaml]

`make keep` and `make same` make the studies first. Compared are all variables and attributes of the
atlas, all tables and captions. Of pictures those that changed are listed, to be looked at.
NAMES.yaml has a line `old: new` for each stage, variable, dimension, attribute, column or figure
that was renamed.
"""

import argparse
import csv
import difflib
import json
import re
import shutil
import sys
from collections import Counter
from pathlib import Path

import numpy as np
import yaml

from fractalcontact.commands.verify import results_of
from fractalcontact.core.errors import InputError
from fractalcontact.study.atlas import read_atlas

KEPT = Path("results/same")
#: Files that are compared; texts are captions, and reasons why a figure was not drawn.
COMPARED = ("atlas.nc", "**/*.csv", "**/*.txt")
PICTURES = ("**/*.png",)
#: Attributes that differ between two commits of equal numbers, and why.
MAY_DIFFER = {
    "versions": "libraries that were installed, and the release of this package",
    "versions_differ": "the same, of parts made with other ones",
}
#: Words shown to either side of a difference between two texts.
CONTEXT = 8


class Comparison:
    """Differences between the results in two folders, a line each.

    Attributes
    ----------
    differences : list of str
    renamed : set of str
    pictures : list of str
        Those whose files differ.
    compared : Counter
        Number of groups, variables, tables and texts.
    """

    def __init__(self, new_names=None):
        self.new_names = new_names or {}
        self.differences, self.renamed, self.pictures = [], set(), []
        self.compared = Counter(groups=0, variables=0, tables=0, texts=0)

    def differ(self, place, words):
        """Note a difference."""
        self.differences.append(f"{place}: {words}")

    def pairs(self, old, new, place, kind):
        """Old and new name of what both have; what only one has is a difference."""
        left = list(new)
        for name in old:
            parts = re.sub(r"[^/.]+", lambda part: self.new_names.get(part[0], part[0]), name)
            wanted = (self.new_names.get(name), parts, name)
            now = next((candidate for candidate in wanted if candidate in left), None)
            if now is None:
                self.differ(place, f"{kind} {name} is lost")
                continue
            left.remove(now)
            if now != name:
                self.renamed.add(f"{kind} {name} is now {now}")
            yield name, now
        for name in left:
            self.differ(place, f"{kind} {name} is new")

    def folders(self, old, new):
        """Compare the results in two folders."""
        for name, now in self.pairs(_files(old), _files(new), new.name, "file"):
            if name.endswith(".nc"):
                self.atlases(_tree(old / name), _tree(new / now), now)
            elif name.endswith(".csv"):
                self.tables(old / name, new / now, now)
            else:
                self.compared["texts"] += 1
                self.texts(
                    (old / name).read_text(encoding="utf-8"),
                    (new / now).read_text(encoding="utf-8"),
                    now,
                )
        for name in _files(new, PICTURES):
            if (old / name).is_file() and (old / name).read_bytes() != (new / name).read_bytes():
                self.pictures.append(name)

    def atlases(self, old, new, place):
        """Compare two atlases, {path of group: dataset}."""
        for path, now in self.pairs(old, new, place, "group"):
            self.compared["groups"] += 1
            ours, theirs, here = old[path], new[now], f"{place} {now}"
            self.attributes(ours.attrs, theirs.attrs, here)
            for name, other in self.pairs(ours.variables, theirs.variables, here, "variable"):
                self.compared["variables"] += 1
                self.variables(ours.variables[name], theirs.variables[other], f"{here} {other}")

    def variables(self, old, new, place):
        """Compare attributes, dimensions, types and values of two variables."""
        self.attributes(old.attrs, new.attrs, place)
        dims = tuple(self.new_names.get(dim, dim) for dim in old.dims)
        if new.dims not in (dims, old.dims) or old.shape != new.shape:
            self.differ(place, f"{dict(old.sizes)} is now {dict(new.sizes)}")
        elif old.dtype != new.dtype and not {old.dtype.kind, new.dtype.kind} <= set("UO"):
            self.differ(place, f"type {old.dtype} is now {new.dtype}")
        elif not (same := _same_bits(old.values, new.values)).all():
            first = tuple(int(i) for i in np.argwhere(~same)[0])
            where = ", ".join(f"{dim} {i}" for dim, i in zip(new.dims, first, strict=True))
            count = f"{np.count_nonzero(~same)} of {same.size} values differ, first at [{where}]"
            self.differ(place, f"{count}: {old.values[first]!r} is now {new.values[first]!r}")

    def attributes(self, old, new, place):
        """Compare two mappings of attributes, but for those that may differ."""
        ours, theirs = ([name for name in of if name not in MAY_DIFFER] for of in (old, new))
        for name, now in self.pairs(ours, theirs, place, "attribute"):
            a, b = old[name], new[now]
            if isinstance(a, str) and isinstance(b, str):
                self.texts(a, b, f"{place} attribute {now}")
            elif type(a) is not type(b) or np.shape(a) != np.shape(b) or not _same_bits(a, b).all():
                self.differ(place, f"attribute {now}: {a!r} is now {b!r}")

    def texts(self, old, new, place):
        """Compare two texts word by word."""
        if old == new:
            return
        a, b = (re.findall(r"\s+|[\w.]+|.", text) for text in (old, new))
        for kind, i, j, k, m in difflib.SequenceMatcher(None, a, b, autojunk=False).get_opcodes():
            if kind != "equal":
                before, after = a[max(i - CONTEXT, 0) : i], a[j : j + CONTEXT]
                words = (*before, "[", *a[i:j], "] is now [", *b[k:m], "]", *after)
                self.differ(place, "".join(words).replace("\n", "\\n"))

    def tables(self, old, new, place):
        """Compare two tables, cell by cell where their bytes differ."""
        self.compared["tables"] += 1
        if old.read_bytes() == new.read_bytes():
            return
        already = len(self.differences)
        (heads, *rows), (new_heads, *new_rows) = (
            list(csv.reader(path.read_text(encoding="utf-8").splitlines())) for path in (old, new)
        )
        if len(rows) != len(new_rows):
            self.differ(place, f"{len(rows)} rows are now {len(new_rows)}")
        columns = list(self.pairs(heads, new_heads, place, "column"))
        for name, now in columns:
            i, j = heads.index(name), new_heads.index(now)
            cells = [(a[i], b[j]) for a, b in zip(rows, new_rows, strict=False)]
            wrong = [row for row, (a, b) in enumerate(cells) if a != b]
            if wrong:
                a, b = cells[wrong[0]]
                count = f"{len(wrong)} of {len(cells)} cells differ, first in row {wrong[0] + 1}"
                self.differ(place, f"column {now}: {count}: {a!r} is now {b!r}")
        if len(self.differences) == already and all(name == now for name, now in columns):
            self.differ(place, "equal cells in another order of columns, or written otherwise")


def _same_bits(a, b):
    """Where two arrays have the same bits; every NaN is the same."""
    a, b = np.asarray(a), np.asarray(b)
    if a.dtype.kind != "f" or b.dtype.kind != "f":
        return np.asarray(a == b)
    return (a == b) & (np.signbit(a) == np.signbit(b)) | np.isnan(a) & np.isnan(b)


def _tree(path):
    """Datasets of an atlas by the paths of their groups, those in its parts too."""
    parts = json.loads(read_atlas(path).attrs.get("parts", "{}")).values()
    files = (*(path.parent / part for part in parts), path)
    return {group.path: group.to_dataset() for file in files for group in read_atlas(file).subtree}


def _files(results, patterns=COMPARED):
    found = {path for pattern in patterns for path in results.glob(pattern)}
    return sorted(path.relative_to(results).as_posix() for path in found)


def keep(results, folder):
    """Keep what is compared of some results, in the place of what was kept before."""
    shutil.rmtree(folder, ignore_errors=True)
    for name in _files(results, (*COMPARED, "atlas/*.nc", *PICTURES)):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(results / name, folder / name)
    print(f"{results}: kept in {folder}")


def compare(old, new, new_names=None):
    """Print what differs between the results in two folders; whether nothing does."""
    for folder, advice in ((old, "run 'make keep' before the change"), (new, "run 'make' first")):
        if not (folder / "atlas.nc").is_file():
            raise InputError(f"{folder}: no atlas.nc in this folder; {advice}")
    found = Comparison(new_names)
    found.folders(old, new)
    for word, lines in (
        ("renamed", sorted(found.renamed)),
        ("another picture, look at it", found.pictures),
        ("DIFFERS", found.differences),
    ):
        for line in lines:
            print(f"{word}: {line}")
    counts = ", ".join(f"{n} {kind}" for kind, n in found.compared.items())
    end = f"{len(found.differences)} differences" if found.differences else "all the same"
    print(f"{new} against {old}: {counts}: {end}")
    return not found.differences


def main(arguments=None):
    """Keep or compare the results of the studies on the command line."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("action", choices=["keep", "compare"])
    parser.add_argument("studies", nargs="+", help="files of studies, or folders of results")
    parser.add_argument("--against", type=Path, default=KEPT, help="results of another checkout")
    parser.add_argument("--renamed", type=Path, help="YAML file, a line 'old: new' for each name")
    options = parser.parse_args(arguments)
    try:
        results = [results_of(study) for study in options.studies]
        if options.action == "keep":
            for folder in results:
                keep(folder, KEPT / folder.name)
            return 0
        new_names = (
            yaml.safe_load(options.renamed.read_text(encoding="utf-8")) if options.renamed else {}
        )
        same = [compare(options.against / folder.name, folder, new_names) for folder in results]
    except (InputError, OSError) as error:
        sys.exit(f"error: {error}")
    return int(not all(same))


if __name__ == "__main__":
    sys.exit(main())
