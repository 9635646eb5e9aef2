"""Drafts of sidecars from the hints in a file, each line with its source, for the owner to check.

Nothing here is ever believed: a draft is shown, with the relief it would give, and read by nobody.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..core.directions import APERTURE
from ..core.labels import listed, printable
from ..core.units import length_unit
from .options import NO_MARK, ScanOptions
from .text_lines import words_of
from .undeclared import find_marks, number

_NUMBER = r"[-+]?(?:\d+(?:[.,]\d+)?|[.,]\d+)(?:[eE][-+]?\d+)?"
_WORD = r"[^\W\d_]+"
_LENGTH = re.compile(rf"(?<!\d)({_NUMBER})(?:\s*[x×*]\s*({_NUMBER}))?\s*[\[(]?({_WORD})\b")
_ALONE = re.compile(rf"(?:\bin\s+|[\[(]\s*|units?\b[\w ]*[\s:=,;]+)({_WORD})", re.IGNORECASE)
_NO_DATA = re.compile(
    rf"(?:no[\s_-]?data|missing|invalid|fill|void|blank)[\w \t]*[\s:=,;\"']+({_NUMBER})\W*$",
    re.IGNORECASE,
)
_SPACING = re.compile(
    r"spacing|step|pitch|pixel|cell ?size|sampling|increment|interval|\bd[xy]\b", re.IGNORECASE
)
#: Words that a sidecar would read as a number, a truth or nothing.
_READ_AS_ANOTHER = re.compile(
    rf"{_NUMBER}|[.\d]+e[-+]?\d+|\.?(?:nan|inf)|null|true|false|yes|no|on|off", re.IGNORECASE
)
_UP = re.compile(r"\b(z|heights?|values?|data|elevations?|depths?|vertical)\b", re.IGNORECASE)
_LATERAL = re.compile(r"\b(x|y|xy|lateral|coordinates?|positions?|width)\b", re.IGNORECASE)
_ROWS = re.compile(r"\b(?:first row|origin)\b.*\b(top|upper|bottom|lower)\b", re.IGNORECASE)
_DOWN = re.compile(r"\bdepths?\b|\bdown(?:wards?)?\b", re.IGNORECASE)
#: Words for an opening and no face.
OPENING = re.compile(r"apertures?|(?<![a-z])(gaps?|openings?)(?![a-z])", re.IGNORECASE)
#: Columns in which the comments of a draft begin.
_COMMENT_AT = 26
_MAX_OTHERS = 3
#: What to write where the file says nothing, by key.
_TO_FILL = {
    "kind": "face, aperture or contact-map",
    "delimiter": "comma, semicolon, tab or blank",
    "decimal": "'.' or ','",
    "header": "lines above the first number",
    "layout": "matrix (rows of heights) or points (x, y, z in columns)",
    "variable": "the array of the heights",
    "columns": "those of x, y and z, counted from 0",
    "axes": "none, both, row or column: where coordinates stand instead of heights",
    "unit": "of x, y and z: m, mm, um, ...; or unit_xy and unit_z",
    "unit_xy": "of x and y: m, mm, um, ...",
    "unit_z": "of the heights: m, mm, um, or of one count, 0.01 um",
    "spacing": "between neighbouring cells, 0.1 mm, or [dx, dy]",
    "first_row": "bottom or top: where the first row lies",
    "heights": "up or down: which way the numbers grow",
    "missing": "the number or word of cells without a height, or none",
}


@dataclass(frozen=True)
class Suggestion:
    """Likely value of a key in a file, its place, and the alternatives."""

    value: Any
    source: str
    others: tuple[str, ...] = ()


@dataclass
class Hints:
    """Hints in a file on the keys of its sidecar.

    Attributes
    ----------
    keys : dict of str to Suggestion
    heights : ndarray or None
        Some of its numbers, in which marks of missing cells are looked for.
    """

    keys: dict[str, Suggestion] = field(default_factory=dict)
    heights: np.ndarray | None = None

    def add(self, key: str, value: Any, source: str, others: Sequence[str] = ()) -> None:
        """Suggest a value for a key without one."""
        self.keys.setdefault(key, Suggestion(value, source, tuple(others)))


def add_words(hints: Hints, lines: Iterable[tuple[str, str]]) -> None:
    """Suggest units, spacing, rows, heights and missing cells from words in the file.

    Parameters
    ----------
    hints : Hints
    lines : iterable of (str, str)
        Where a line stands ("line 3", "attribute units"), and its text.
    """
    found: dict[str, list[tuple[Any, str]]] = {}

    def seen(key: str, value: Any, source: str) -> None:
        found.setdefault(key, []).append((value, source))

    for where, line in lines:
        source, text = f'{where}: "{printable(line.strip(), 50)}"', words_of(line)
        lengths = [match for match in _LENGTH.finditer(text) if length_unit(match[3])]
        for match in lengths:
            steps = [step.replace(",", ".") for step in match.groups()[:2] if step]
            value = [f"{step} {match[3]}" for step in steps]
            key = "spacing" if _SPACING.search(text) else "length"
            seen(key, value if len(value) == 2 else value[0], source)
        if not lengths:
            begin = 0
            for match in _ALONE.finditer(text):
                if length_unit(match[1]):
                    seen(_unit_key(text[begin : match.start(1)]), match[1], source)
                begin = match.end()
        if marked := _NO_DATA.search(text):
            seen("missing", float(marked[1].replace(",", ".")), source)
        if rows := _ROWS.search(text):
            seen("first_row", "top" if rows[1].lower() in ("top", "upper") else "bottom", source)
        if _DOWN.search(text):
            seen("heights", "down", source)
        if OPENING.search(text):
            seen("kind", APERTURE, source)
    for key, values in found.items():
        others = [f"{written(value)} ({source})" for value, source in values[1:]]
        hints.add(key, values[0][0], values[0][1], others[:_MAX_OTHERS])


def _unit_key(before: str) -> str:
    """Quantity of a unit, by the words before it."""
    up, lateral = _UP.search(before), _LATERAL.search(before)
    if bool(up) == bool(lateral):
        return "unit"
    return "unit_z" if up else "unit_xy"


def drafted_options(options: ScanOptions, hints: Hints) -> ScanOptions:
    """Options of the sidecar, completed by hints in the file."""
    changes: dict[str, Any] = {}
    for key, suggestion in hints.keys.items():
        if key in _TO_FILL and getattr(options, key) is None and suggestion.value is not None:
            value = suggestion.value
            changes[key] = tuple(value) if isinstance(value, list) else value
    if options.unit is not None or ("unit" in changes and "unit_z" not in changes):
        changes.pop("unit_xy", None)
    if options.kind is None:
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
    return replace(options, **changes)


def draft_lines(
    options: ScanOptions, hints: Hints, required: set[str], arrays: Sequence[str] = ()
) -> list[str]:
    """Lines of a sidecar: a key, its value, and in a comment where the value comes from.

    Parameters
    ----------
    options : ScanOptions
        What is stated already.
    hints : Hints
    required : set of str
        Keys to write; those that are stated are written too.
    arrays : sequence of str
        Names of which ``variable`` is one.
    """
    drafted = drafted_options(options, hints)
    lines = []
    for key in _TO_FILL:
        value = getattr(options, key)
        if value is not None:
            lines.append(draft_line(key, value, "as stated"))
            continue
        value = getattr(drafted, key)
        if key not in required and (value is None or not key.startswith("unit")):
            continue
        lines += _drafted_line(key, value, hints, arrays)
    return lines


def _drafted_line(key: str, value: Any, hints: Hints, arrays: Sequence[str]) -> list[str]:
    """The line of a key that is not stated, and others that might be meant."""
    suggestion = hints.keys.get(key)
    if key == "missing" and suggestion is None:
        value, source = _marks(hints.heights)
        return [draft_line(key, value, source)]
    if key == "heights" and suggestion is None:
        return [draft_line(key, "up", "nothing in the file says that they are depths")]
    if key == "kind" and suggestion is None:
        return [draft_line(key, "face", "a file of heights")]
    if value is None:
        names = f": {listed(arrays)}" if key == "variable" else ""
        lengths = hints.keys.get("length")
        other = lengths and key in ("unit", "unit_xy", "spacing")
        said = f"; it says {written(lengths.value)}, {lengths.source}" if lengths and other else ""
        return [draft_line(key, None, f"FILL IN: {_TO_FILL[key]}{names}{said}")]
    assert suggestion is not None  # it has given the value
    lines = [draft_line(key, value, suggestion.source)]
    return lines + [f"#   {key}: {other}" for other in suggestion.others]


def _marks(heights: np.ndarray | None) -> tuple[Any, str]:
    """Numbers that are likely to mark missing cells."""
    if heights is None:
        return NO_MARK, "every number is a height"
    marks = find_marks(heights)
    if not marks:
        return NO_MARK, "no unusual number in the part that was read"
    values = [float(mark.value) for mark in marks]
    where = "; ".join(f"{mark.cells} cells hold {number(mark.value)}" for mark in marks)
    return values if len(values) > 1 else values[0], where


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
