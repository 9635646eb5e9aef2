"""Hints from the arrays of a file without units: likely heights, and remarks in other arrays."""

import re
from collections.abc import Callable, Mapping

import numpy as np

from .draft import Hints, add_words
from .table_hints import add_axes, add_columns, coordinate_columns
from .text_lines import words_of

_HEIGHTS = re.compile(r"(?:^|[^a-z])(?:z|heights?|topo\w*|elev\w*|surf\w*|data)(?:[^a-z]|$)")
#: A larger array is not looked into.
_MAX_CELLS = 20_000_000
_STEP = re.compile(r"(?:d|delta_?|pixel_?|step_?)([xy])?|spacing|pitch|resolution")


def array_hints(
    tables: Mapping[str, tuple],
    wanted: str | None,
    small: Mapping[str, float],
    read: Callable[[str], np.ndarray],
    words: list[tuple[str, str]] | None = None,
) -> Hints:
    """Hints on the array of heights, from the shapes of all 2-D arrays and other contents.

    ``small`` holds single numbers by name, one of which may be a spacing; ``words`` attributes,
    each with the place where it stands.
    """
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
    _add_spacing(hints, small)
    add_words(hints, words or [])
    if np.prod(tables[name]) > _MAX_CELLS:
        return hints
    values = np.asarray(read(name), dtype=float)
    if values.shape[1] < 8:
        hints.add("layout", "points", f"{values.shape[1]} columns")
        add_columns(hints, [], values, "")
        lateral = coordinate_columns(values)
        rest = [n for n in range(values.shape[1]) if n not in lateral]
        hints.heights = values[:, rest[0] if len(rest) == 1 else min(2, values.shape[1] - 1)]
    else:
        hints.add("layout", "matrix", f"{values.shape[1]} columns")
        add_axes(hints, values)
        hints.heights = values
    return hints


def _add_spacing(hints: Hints, small: Mapping[str, float]) -> None:
    """Name single numbers that are called as a spacing is; their unit is nowhere said."""
    steps = {name: value for name, value in small.items() if _STEP.fullmatch(name.lower())}
    if steps:
        numbers = ", ".join(f"{name} = {value:g}" for name, value in steps.items())
        hints.ask("spacing", f"the file holds {numbers}, without a unit")
