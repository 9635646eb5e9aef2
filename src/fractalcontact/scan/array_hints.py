"""Hints from the arrays of a file without units: likely heights, and remarks in other arrays."""

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np

from .draft import Hints, add_words
from .options import ScanOptions
from .stated import Needs, require_stated
from .table_hints import add_axes, add_columns, height_column
from .text_lines import words_of

_HEIGHTS = re.compile(r"(?:^|[^a-z])(?:z|heights?|topo\w*|elev\w*|surf\w*|data)(?:[^a-z]|$)")
#: Most cells of an array that is searched for hints.
_MAX_CELLS = 20_000_000
_STEP = re.compile(r"(?:d|delta_?|pixel_?|step_?)([xy])?|spacing|pitch|resolution")


def require_array(
    path: Path,
    options: ScanOptions,
    tables: Mapping[str, tuple],
    read: Callable[[str], np.ndarray],
    single: Callable[[], Mapping[str, float]] = dict,
    words: Sequence[tuple[str, str]] = (),
) -> None:
    """Refuse a file of arrays whose sidecar does not state all, with a draft from its contents.

    ``tables`` are shapes of the 2-D arrays by name, and ``read`` gives one of them. ``single``
    gives single numbers by name, of which one may be a spacing. ``words`` are attributes, each
    with the place where it stands.
    """
    needs = Needs(table=True, arrays=list(tables))
    wanted = options.variable
    require_stated(path, options, needs, lambda: _hints(tables, wanted, single(), read, words))


def _hints(
    tables: Mapping[str, tuple],
    wanted: str | None,
    single: Mapping[str, float],
    read: Callable[[str], np.ndarray],
    words: Sequence[tuple[str, str]],
) -> Hints:
    """Hints on the array of heights, from names, shapes, single numbers and attributes."""
    hints = Hints()
    names = sorted(tables, key=lambda name: (not _HEIGHTS.search(words_of(name.lower())), name))
    name = wanted if wanted in tables else names[0] if names else None
    if name is None:
        return hints
    others = [
        f"{other} of {tables[other][0]} x {tables[other][1]}" for other in names if other != name
    ]
    hints.add("variable", name, f"an array of {tables[name][0]} x {tables[name][1]}", others)
    named = [other for other in names if _HEIGHTS.search(other.lower())]
    if wanted not in tables and len(names) > 1 and len(named) != 1:
        hints.ask("variable", "which of them holds the heights?")
    add_words(hints, [(f"the name of {name!r}", name.replace("_", " "))])
    _add_spacing(hints, single)
    add_words(hints, words)
    if np.prod(tables[name]) > _MAX_CELLS:
        return hints
    values = np.asarray(read(name), dtype=float)
    if values.shape[1] < 8:
        hints.add("layout", "points", f"{values.shape[1]} columns")
        add_columns(hints, [], values, "")
        hints.heights = values[:, height_column(values)]
    else:
        hints.add("layout", "matrix", f"{values.shape[1]} columns")
        add_axes(hints, values)
        hints.heights = values
    return hints


def _add_spacing(hints: Hints, single: Mapping[str, float]) -> None:
    """Name single numbers that are called as a spacing is; their unit is nowhere said."""
    steps = {name: value for name, value in single.items() if _STEP.fullmatch(name.lower())}
    if steps:
        numbers = ", ".join(f"{name} = {value:g}" for name, value in steps.items())
        hints.ask("spacing", f"the file holds {numbers}, without a unit")
