"""What the lines in front of the numbers of a text file say: units, spacing, factor, missing."""

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from ..core.units import length_factor, length_unit

COMMENT_MARKS = "#%!/; "
_UNIT = (
    r"(?:(?:[pnuµ\u03bcmcdk]?m|MM|UM|NM|CM|[Å\u212b]|[Aa]ngstr[oö]ms?|[Mm]icrons?"
    r"|(?:[Nn]ano|[Mm]icro|[Mm]illi|[Cc]enti|)(?:[Mm]et(?:re|er)s?)|[Ii]nch(?:es)?|[Ff]oot|[Ff]eet)"
    r"(?![\w]))"
)
_PER_CELL = r"(?:\s*(?:/|per)\s*(?:px|pixels?|pt|points?|samples?|steps?|cells?)\b)?"
#: Right behind its number, or as a field of its own at the end of the line.
_LENGTH_AFTER = re.compile(rf"(?:\s*|[\s,;]+(?=\S*\s*$))({_UNIT}){_PER_CELL}")
_IN_BRACKETS = re.compile(rf"[\[(]\s*({_UNIT}){_PER_CELL}\s*[\])]")
_POINT_NUMBER = r"(?<![\w.,])[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?(?![\d,]*\d)"
_COMMA_NUMBER = r"(?<![\w.,])[-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?(?![\d.,]*\d)"
_SOMETHING_LONG = re.compile(rf"\d\s*{_UNIT}|[\[(]\s*{_UNIT}\s*[\])]|\bin\s+{_UNIT}")

_SPACING = re.compile(
    r"\b(spacing|pixel (size|width|height|pitch)|pitch|step( size| width)?|cell ?size"
    r"|sampling( (interval|distance|step|length))?|(xy |lateral |[xy] )(calibration|scale)"
    r"|grid (size|step|interval|spacing)|increment|interval|d[xy]|delta [xy])\b"
)
#: What may count cells as well: a spacing only with its unit.
_OR_COUNT = re.compile(r"\b(size|sampling|scale)\b")
#: Of lines of the scan, of the instrument's optics: not how far apart the cells are.
_OTHER_STEPS = re.compile(r"\b(lines?|profiles?|tracks?|layers?|optical|resolution)\b")
_FACTOR = re.compile(
    r"((z|heights?|data|values?|vertical) )?(factor|scale|scaling|multiplier|scale factor|lsb"
    r"|calibration)"
)
_MISSING = re.compile(
    r"(z )?(no ?data|missing|invalid|fill|bad|void|blank|null)( (data|value|number|marker?|code))?"
    r"|fillvalue|missingvalue|nodatavalue"
)
_AXES = {
    "x": re.compile(r"\b(x|dx|columns?|horizontal|pixel width)\b"),
    "y": re.compile(r"\b(y|dy|rows?|pixel height)\b"),
    "z": re.compile(r"\b(z|dz|(?<!pixel )heights?|values?|data|elevations?|vertical|depth)\b"),
}
_LATERAL = re.compile(r"\b(xy|x|y|lateral|coordinates?|positions?|spacing|horizontal)\b")
_EVERY = re.compile(r"\b(all|lengths?|dimensions?|everything|units?|xyz)\b")
_UNIT_LINE = re.compile(
    r"units?\b(?:(?:\s+[\w ,]+?)?\s*[:=]\s*|[\s,;]+)([^\s,;:=]+)", re.IGNORECASE
)
_IN_UNIT = re.compile(rf"\bin\s+({_UNIT})|[\[(]\s*({_UNIT})\s*[\])]")
_ORIGIN = re.compile(r"\b(first row|origin)\b.*?\b(top|upper|bottom|lower)\b", re.IGNORECASE)


@dataclass(frozen=True)
class Statement:
    """One thing that a line says: of ``what`` ("dx", "unit_z", ...), its value, and the line."""

    what: str
    value: Any
    line: str


def read_statements(lines: Iterable[str], decimal: str = ".") -> dict[str, Any]:
    """What header lines state, as fields of `scan.raw.RawScan`.

    Parameters
    ----------
    lines : iterable of str
        Those in front of the numbers, with their comment marks, but for the names of columns.
    decimal : {".", ","}
        Decimal mark of the numbers in the file.

    Returns
    -------
    dict
        ``unit_xy``, ``unit_z``, ``spacing``, ``factor``, ``missing`` and ``first_row`` where stated
        once and clearly; ``unread``: the lines that speak of lengths and could not be used.
    """
    claims: dict[str, list[Statement]] = defaultdict(list)
    unread = []
    for line in lines:
        text = line.lstrip(COMMENT_MARKS).replace('"', " ").strip()
        found = list(_statements(text, decimal))
        for statement in found:
            claims[statement.what].append(statement)
        if not found and _SOMETHING_LONG.search(text):
            unread.append(text)
    unread += [statement.line for statement in claims.pop("unread", [])]
    said: dict[str, Any] = {}
    for what, statements in claims.items():
        values = {statement.value for statement in statements}
        if len(values) == 1:
            said[what] = values.pop()
        else:
            unread += [statement.line for statement in statements]
    return _as_fields(said, unread)


def _as_fields(said: dict[str, Any], unread: list[str]) -> dict[str, Any]:
    """Fields of `RawScan`: the steps in one unit, a factor with its unit as a unit of counts."""
    fields: dict[str, Any] = {
        k: said[k] for k in ("unit_xy", "unit_z", "missing", "first_row") if k in said
    }
    steps = [said[key] for key in ("dx", "dy") if key in said]
    if len(steps) == 2:
        units = {unit for _, unit in steps}
        if None not in units:
            (dx, unit), (dy, unit_y) = steps
            fields["unit_xy"] = unit
            fields["spacing"] = (
                dx,
                dy * (length_factor(unit_y, "header") / length_factor(unit, "header")),
            )
        elif units == {None}:
            fields["spacing"] = tuple(step[0] for step in steps)
        else:
            unread.append("a spacing with a unit along one axis alone")
    elif steps:
        unread.append(f"a spacing along {'x' if 'dx' in said else 'y'} alone")
    if "factor" in said:
        number, unit = said["factor"]
        fields["factor"] = number
        if unit is not None:
            fields["unit_z"] = unit
    if unread:
        fields["unread"] = tuple(dict.fromkeys(line[:80] for line in unread))[:5]
    return fields


def _statements(text: str, decimal: str) -> Iterator[Statement]:
    """What one line says, numbers with their keys first, then units alone."""
    if match := _ORIGIN.search(text):
        yield Statement(
            "first_row", "top" if match[2].lower() in ("top", "upper") else "bottom", text
        )
    numbered = [
        statement
        for key, numbers, unit in _items(text, decimal)
        for statement in _of_number(key, numbers, unit, text)
    ]
    yield from numbered or _of_units(text)


def _items(text: str, decimal: str) -> Iterator[tuple[str, list[float], str | None]]:
    """Keys with their numbers and unit: "dx = 0.1 mm", "pixel size (um): 0.5 x 0.5"."""
    pattern = re.compile(_COMMA_NUMBER if decimal == "," else _POINT_NUMBER)
    numbers: list[float] = []
    key, unit, end = "", None, 0
    for match in pattern.finditer(text):
        between = text[end : match.start()].strip(" :=,;\t")
        if between.lower() in ("", "x", "×", "*", "by", "and") and numbers:
            numbers.append(float(match[0].replace(",", ".")))
        else:
            if numbers:
                yield key, numbers, unit
            key, numbers, unit = between, [float(match[0].replace(",", "."))], None
            if bracket := _IN_BRACKETS.search(key):
                unit = bracket[1]
        end = match.end()
        if after := _LENGTH_AFTER.match(text, end):
            unit, end = after[1], after.end()
    if numbers:
        yield key, numbers, unit


def _plain(key: str) -> str:
    """A key in lower case, its words apart: "PixelSizeX [um]" as "pixel size x"."""
    key = re.sub(r"[\[(].*?[\])]", " ", key)
    key = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", key)
    return " ".join(re.sub(r"[_\-./|:=,;]", " ", key).lower().split())


def _of_number(key: str, numbers: list[float], unit: str | None, line: str) -> Iterator[Statement]:
    plain = _plain(key).replace("pixelsize", "pixel size")
    axes = {axis for axis, words in _AXES.items() if words.search(plain)}
    if _MISSING.fullmatch(plain) and len(numbers) == 1:
        if not re.search(r"\d\s*(?:$|[,;\t)\]])", line):
            return  # how many are missing: "invalid 3 of 400 cells"
        yield Statement("missing", numbers[0], line)
    elif _OTHER_STEPS.search(plain):
        if unit is not None:
            yield Statement("unread", None, line)
    elif _SPACING.search(plain) and "z" not in axes and len(numbers) <= 2:
        if unit is None and _OR_COUNT.search(plain) and all(n == round(n) for n in numbers):
            return  # how many cells, as likely as how large
        along = sorted(axes) if len(axes) == 1 and len(numbers) == 1 else ["x", "y"]
        both = numbers * 2 if len(numbers) == 1 else numbers
        for axis in along:
            yield Statement(f"d{axis}", (both["xy".index(axis)], unit), line)
    elif _FACTOR.fullmatch(plain) and len(numbers) == 1:
        yield Statement("factor", (numbers[0], unit), line)
    elif unit is not None:
        yield Statement("unread", None, line)


def _of_units(text: str) -> Iterator[Statement]:
    """Units alone: "unit: mm", "z unit = um", "x, y in mm, heights in um", "Height [um]"."""
    if match := _UNIT_LINE.search(text.replace("_", " ")):
        word = match[1].strip("[]()\"'.")
        if not length_unit(word):
            yield Statement("unread", None, text)
            return
        yield from _claims(_plain(text[: match.start(1)]), word, text)
        return
    start = 0
    for match in _IN_UNIT.finditer(text):
        yield from _claims(_plain(text[start : match.start()]), match[1] or match[2], text)
        start = match.end()


def _claims(about: str, unit: str, line: str) -> Iterator[Statement]:
    """Which of x, y and z a unit is said of."""
    lateral, upward = bool(_LATERAL.search(about)), bool(_AXES["z"].search(about))
    if not (lateral or upward):
        if not _EVERY.search(about):
            yield Statement("unread", None, line)
            return
        lateral = upward = True
    if lateral:
        yield Statement("unit_xy", unit, line)
    if upward:
        yield Statement("unit_z", unit, line)
