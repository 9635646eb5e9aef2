"""Sizes of a table that its header states, compared with what was read."""

import math
import re
from collections.abc import Iterator, Sequence
from itertools import pairwise

from ..core.errors import InputError
from ..core.labels import printable
from ..core.limits import SMALLEST_SIDE
from ..core.units import length_unit
from .options import ScanOptions

#: Longest line, and most lines of a header, that state a pair of sides.
_MAX_LINE, _MAX_LINES = 200, 200
#: Names of the sides of a matrix.
_SIDES = re.compile(
    r"[#%!/\s\"']*(?:(?P<x>nx|ncols|n_cols|columns)|(?P<y>ny|nrows|n_rows|rows))[\s:=,;\t]+"
    r"(?P<n>\d{1,12})[\s\"']*",
    re.IGNORECASE,
)
#: Pattern of a line of whole numbers alone.
_COUNTS = re.compile(r"\s*\d{1,9}(?:[\s,;]+\d{1,9}){0,2}[\s,;]*")
#: Pattern of a whole number that is no part of a decimal, a date or a time.
_WHOLE = re.compile(r"(?<![\w.,/-])(?<!\d:)(\d{1,9})(?![\w.,:/-]*\d)")
_AFTER_NUMBER = re.compile(r"\d\s*([^\W\d_]+)")
_PRODUCT = re.compile(r"(?<![\d.,])(\d{1,9})\s*[x×*]\s*(\d{1,9})(?![\d.,]*\d)")
_UNKNOWN = ": rows may be wrapped, or the file cut off"
_WRAPPED = ", which are as many: rows are wrapped"


def refuse_other_size(
    header: Sequence[str], shape: tuple[int, ...], options: ScanOptions, where: str
) -> None:
    """Refuse a table of another size than its header states: rows wrapped, or a file cut off.

    Three kinds of statement count: a line of up to three whole numbers alone; for a matrix, a line
    of ``nx`` or ``ncols`` with one of ``ny`` or ``nrows``; and for a matrix, two whole numbers in
    one line or in two successive ones (``70 x 60``, ``DIMENSIONS 70 60 1``), if they make as many
    cells with other sides. A file whose sidecar states ``confirmed`` is not refused here.
    """
    if options.confirmed is None and (other := _other_size(header, shape, options)):
        stated, reason = other
        rows, columns = shape
        raise InputError(
            f"{where}: its header states {printable(stated, 60)!r}, but {rows} rows of {columns} "
            f"numbers were read{reason}; export it again, each row in one line, or write "
            f"'confirmed: {{shape: [{rows}, {columns}]}}' into the sidecar if that is right"
        )


def _other_size(
    header: Sequence[str], shape: tuple[int, ...], options: ScanOptions
) -> tuple[str, str] | None:
    """First words of a header that state another size, and the likely reason."""
    sides = {}
    for line in header:
        if match := _SIDES.fullmatch(line):
            sides["x" if match["x"] else "y"] = int(match["n"])
        elif _COUNTS.fullmatch(line) and not _agree(
            list(map(int, re.findall(r"\d+", line))), shape
        ):
            return line.strip(), _UNKNOWN
    if options.layout == "points":
        return None
    rows, columns = shape
    has_coordinates = options.axes in ("both", "column")
    if len(sides) == 2 and (sides["y"], sides["x"]) != (rows, columns - has_coordinates):
        return f"{sides['x']} columns and {sides['y']} rows", _UNKNOWN
    for text, across, along in _stated_pairs(header):
        is_wrapped = across * along == rows * columns and {across, along} != {rows, columns}
        if is_wrapped and min(across, along) >= SMALLEST_SIDE:
            return text.strip(), _WRAPPED
    return None


def _agree(counts: list[int], shape: tuple[int, ...]) -> bool:
    """True if counts are those of rows, columns or points, with or without coordinates."""
    rows, columns = shape
    near = {rows, columns, rows - 1, columns - 1, rows + 1, columns + 1, rows * columns}
    return set(counts) <= near or math.prod(counts) == rows


def _stated_pairs(header: Sequence[str]) -> Iterator[tuple[str, int, int]]:
    """Pairs of whole numbers in a line, or in two lines below each other, with their text."""
    lines = [(line, _counts(line)) for line in header[:_MAX_LINES] if len(line) <= _MAX_LINE]
    for line, counts in lines:
        if len(counts) == 2 or (len(counts) == 3 and counts[2] == 1):
            yield line, counts[0], counts[1]
    for (above, first), (below, second) in pairwise(lines):
        if len(first) == len(second) == 1:
            yield f"{above.strip()}, {below.strip()}", first[0], second[0]


def _counts(line: str) -> list[int]:
    """Whole numbers of a line; none of a line of lengths."""
    if any(length_unit(word) for word in _AFTER_NUMBER.findall(line)):
        return []
    if product := _PRODUCT.search(line):
        return [int(product[1]), int(product[2])]
    return [int(number) for number in _WHOLE.findall(line)]
