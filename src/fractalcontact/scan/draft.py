"""Drafts of sidecars from the hints in a file, each line with its source, for the owner to check.

A draft is shown with the relief it would give; no part of the program reads it.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..core.directions import APERTURE
from ..core.labels import listed, printable
from .keys import words_to_fill
from .options import NO_MARK, ScanOptions
from .statements import statements
from .undeclared import find_marks, number, possible_marks

_NUMBER = r"[-+]?(?:\d+(?:[.,]\d+)?|[.,]\d+)(?:[eE][-+]?\d+)?"
#: Words that a sidecar would read as a number, a truth or nothing.
_READ_AS_ANOTHER = re.compile(
    rf"{_NUMBER}|[.\d]+e[-+]?\d+|\.?(?:nan|inf)|null|true|false|yes|no|on|off", re.IGNORECASE
)
#: Pattern of words for an opening between faces, not for a face.
OPENING = re.compile(r"apertures?|(?<![a-z])(gaps?|openings?)(?![a-z])", re.IGNORECASE)
#: Columns in which the comments of a draft begin.
_COMMENT_AT = 26
#: Most numbers named that may mark missing cells.
_MAX_MARKS = 4
#: Keys whose mention alone leaves open what would be taken for granted.
_ASKED = ("heights", "kind", "missing", "first_row", "spacing", "unit", "unit_z")
#: What to write where the file says nothing, by key, in the order of a draft.
_TO_FILL = words_to_fill()


@dataclass(frozen=True)
class Suggestion:
    """Likely value of a key in a file, its place, and the alternatives."""

    value: Any
    source: str
    others: tuple[str, ...] = ()


@dataclass
class Hints:
    """Hints in a file on the keys of its sidecar."""

    keys: dict[str, Suggestion] = field(default_factory=dict)
    #: Open choices of a key, whose line stays empty.
    doubts: dict[str, str] = field(default_factory=dict)
    #: Keys that a draft has a line for though not every such file needs them.
    optional: set[str] = field(default_factory=set)
    #: Lengths that the file states: name, numbers, unit, line.
    lengths: list[tuple[str, list[float], str, str]] = field(default_factory=list)
    #: Some numbers of the file, in which marks of missing cells are looked for.
    heights: np.ndarray | None = None

    def add(self, key: str, value: Any, source: str, others: Sequence[str] = ()) -> None:
        """Suggest a value for a key without one."""
        self.keys.setdefault(key, Suggestion(value, source, tuple(others)))

    def ask(self, key: str, choices: str) -> None:
        """Leave a key open, whatever is suggested for it."""
        said = self.doubts.get(key)
        self.doubts[key] = f"{said}; {choices}" if said else choices

    def ask_openings(self) -> None:
        """Leave the kind open where many numbers are 0 and none is below: openings, or heights."""
        present = () if self.heights is None else self.heights[np.isfinite(self.heights)]
        zeros = int(np.sum(np.equal(present, 0)))
        if zeros > 2 and np.min(present) == 0 and "kind" not in self.keys:
            self.ask("kind", f"{zeros} cells hold 0 and none less, as in a map of apertures")

    def state(self, key: str, value: Any, source: str) -> None:
        """Suggest a value in place of any other, without a doubt."""
        self.forget(key)
        self.add(key, value, source)

    def forget(self, *keys: str) -> None:
        """Take back what was suggested and left open of keys."""
        for key in keys:
            self.keys.pop(key, None)
            self.doubts.pop(key, None)


def image_hints(values: np.ndarray, mark: float | None = None) -> Hints:
    """Hints on a matrix of grey levels; cells equal to a stated ``mark`` count as missing."""
    hints = Hints(heights=values if mark is None else np.where(values == mark, np.nan, values))
    hints.ask("first_row", "a picture begins at the top, an array saved as one may not")
    return hints


def add_words(hints: Hints, lines: Iterable[tuple[str, str]]) -> None:
    """Add what lines state of units, spacing, rows, heights and missing cells; ask the rest.

    A line is the place where it stands ("line 3", "attribute units") and its text.
    """
    stated = statements(lines)
    hints.lengths += stated.lengths
    for key in dict.fromkeys([*stated.values, *stated.mentions]):
        only = stated.only(key)
        # A line on depths or openings, or on a factor, leaves open what another line states.
        is_open = key in stated.mentions and key in ("heights", "unit_z", "kind")
        if only and not is_open:
            hints.add(key, *only)
        elif key in stated.values or key in _ASKED:
            hints.ask(key, f"the file says {stated.quoted(key)}")
    if "unit_z" in stated.mentions:
        hints.ask("unit", f"the file says {stated.quoted('unit_z')}")


def drafted_options(options: ScanOptions, hints: Hints) -> ScanOptions:
    """Options of the sidecar, completed by hints in the file."""
    changes: dict[str, Any] = {}
    for key, suggestion in hints.keys.items():
        is_open = key in hints.doubts or getattr(options, key) is not None
        if key in _TO_FILL and not is_open and suggestion.value is not None:
            value = suggestion.value
            changes[key] = tuple(value) if isinstance(value, list) else value
    if options.unit is not None or ("unit" in changes and "unit_z" not in changes):
        changes.pop("unit_xy", None)
    if options.kind is None and "kind" not in hints.doubts:
        changes.setdefault("kind", "face")
    layout = options.layout or changes.get("layout")
    if layout == "points":
        changes.pop("spacing", None)
        changes.pop("first_row", None)
    if (options.axes or changes.get("axes")) == "both" and options.spacing is None:
        changes.pop("spacing", None)
        changes.pop("first_row", None)
    if {"unit_xy", "unit_z"} <= changes.keys():
        changes.pop("unit", None)
    return options.but(**changes)


def draft_lines(
    options: ScanOptions, hints: Hints, required: set[str], arrays: Sequence[str] = ()
) -> list[str]:
    """Lines of a sidecar: each key, its value, and in a comment the source of the value.

    Keys are those that are required or stated already; ``arrays`` are the names for ``variable``.
    """
    drafted = drafted_options(options, hints)
    lines = []
    for key in _TO_FILL:
        value = getattr(options, key)
        if value is not None:
            lines.append(draft_line(key, value, "as stated"))
            continue
        value = getattr(drafted, key)
        is_known = key.startswith("unit") and value is not None
        if key in required or key in hints.optional or is_known:
            lines += _drafted_line(key, drafted, hints, arrays)
    return lines


def _drafted_line(key: str, drafted: ScanOptions, hints: Hints, arrays: Sequence[str]) -> list[str]:
    """The line of a key that is not stated, and others that might be meant."""
    suggestion, value = hints.keys.get(key), getattr(drafted, key)
    if key == "missing":
        return [draft_line(key, *_missing(hints, drafted.kind))]
    if key == "heights" and value is None and key not in hints.doubts:
        return [draft_line(key, "up", "nothing in the file says that they are depths")]
    if key == "kind" and suggestion is None and value is not None:
        return [draft_line(key, value, "a file of heights")]
    if value is None:
        names = f": {listed(arrays)}" if key == "variable" else ""
        return [draft_line(key, None, f"FILL IN: {_TO_FILL[key]}{names}{_known(key, hints)}")]
    assert suggestion is not None  # it has given the value
    lines = [draft_line(key, value, suggestion.source)]
    return lines + [f"#   {key}: {other}" for other in suggestion.others]


def _known(key: str, hints: Hints) -> str:
    """The choices of an open key, and what the file says of it."""
    said = [hints.doubts[key]] if key in hints.doubts else []
    if key in hints.doubts and key in hints.keys:
        said.append(f"it says {written(hints.keys[key].value)}, {hints.keys[key].source}")
    if key in ("spacing", "first_row") and "axes" in hints.doubts:
        said.append("delete this line if axes is both and its numbers are lengths")
    if key in ("unit_xy", "unit_z") and "unit" in hints.doubts and key not in hints.doubts:
        said.append(hints.doubts["unit"])
    return "".join(f"; {part}" for part in dict.fromkeys(said))


def _missing(hints: Hints, kind: str | None) -> tuple[Any, str]:
    """Marks of missing cells; None, and what may be one, where the file leaves that open."""
    suggestion = hints.keys.get("missing")
    marks = () if suggestion is None else suggestion.value
    marks = list(marks) if isinstance(marks, list | tuple) else [marks]
    said = [] if suggestion is None else [suggestion.source]
    suspects: list[tuple[float, int]] = []
    if hints.heights is not None:
        heights = np.array(hints.heights, dtype=float)
        for mark in marks:
            if isinstance(mark, float):
                heights[np.isclose(heights, mark, rtol=1e-6, atol=0)] = np.nan
        if kind == APERTURE:
            heights[heights == 0] = np.nan
            said.append("zeros of an aperture map are contact")
        for mark in find_marks(heights):
            if mark.outside:
                marks.append(float(mark.value))
                said.append(f"{mark.cells} cells hold {number(mark.value)}")
                heights[np.isclose(heights, mark.value, rtol=1e-6, atol=0)] = np.nan
        suspects = possible_marks(heights)
    if not suspects and "missing" not in hints.doubts:
        value = marks if len(marks) > 1 else marks[0] if marks else NO_MARK
        return value, "; ".join(said) or "no unusual number in the part that was read"
    choices = [f"{cells} cells hold {number(value)}" for value, cells in suspects[:_MAX_MARKS]]
    if any(value == 0 for value, _ in suspects) and kind is None:
        choices.append("zeros of an aperture map are contact")
    doubt = [hints.doubts["missing"]] if "missing" in hints.doubts else []
    return None, f"FILL IN: {_TO_FILL['missing']}; {'; '.join([*choices, *doubt, *said])}"


def draft_line(key: str, value: Any, comment: str = "") -> str:
    """One line of a draft; the user fills in a missing value."""
    comment = comment or f"FILL IN: {_TO_FILL[key]}"
    text = f"{key}: {written(value)}" if value is not None else f"{key}:"
    return f"{text:<{_COMMENT_AT - 1}} # {printable(comment)}"


def written(value: Any) -> str:
    """Value in YAML."""
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(written, value))}]"
    if isinstance(value, float):
        return f"{value:.9g}"
    if isinstance(value, int):
        return str(value)
    text = printable(value)
    if _READ_AS_ANOTHER.fullmatch(text):
        return f'"{text}"'
    return text if re.fullmatch(r"[A-Za-z0-9][\w ./µ-]*", text) and text[-1] != " " else f'"{text}"'
