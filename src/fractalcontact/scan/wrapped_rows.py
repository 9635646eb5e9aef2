"""Sizes that a header states in other words than ``nx`` and ``ny``, compared with what was read."""

import re
from collections.abc import Sequence
from itertools import pairwise

from ..core.errors import InputError
from ..core.labels import printable
from ..core.limits import SMALLEST_SIDE
from ..core.units import length_unit
from .options import ScanOptions

#: Longer lines and headers state no size.
_MAX_LINE, _MAX_LINES = 200, 200
#: A whole number that is no part of a decimal, a date or a time.
_WHOLE = re.compile(r"(?<![\w.,/-])(?<!\d:)(\d{1,9})(?![\w.,:/-]*\d)")
_AFTER_NUMBER = re.compile(r"\d\s*([^\W\d_]+)")
_PRODUCT = re.compile(r"(?<![\d.,])(\d{1,9})\s*[x×*]\s*(\d{1,9})(?![\d.,]*\d)")


def refuse_wrapped(
    header: Sequence[str], shape: tuple[int, ...], options: ScanOptions, where: str
) -> None:
    """Refuse rows that are wrapped: the header states other sides that hold as many numbers.

    Two whole numbers of one line, or of two lines that follow each other, count if their product is
    the count of all numbers that were read: ``DIMENSIONS 70 60 1``, ``70 x 60``, ``width=70
    height=60``. A size that the sidecar confirms rules.

    Parameters
    ----------
    header : sequence of str
    shape : (int, int)
        Rows and columns that were read.
    options : ScanOptions
    where : str
        The file, for errors.

    Raises
    ------
    InputError
        With both sizes.
    """
    if options.confirmed is not None or options.layout == "points":
        return
    rows, columns = shape
    for text, across, along in _stated_sizes(header):
        is_wrapped = across * along == rows * columns and {across, along} != {rows, columns}
        if is_wrapped and min(across, along) >= SMALLEST_SIDE:
            raise InputError(
                f"{where}: its header states {printable(text.strip(), 60)!r}, but {rows} rows of "
                f"{columns} numbers were read, which are as many: rows are wrapped; export it "
                f"again, each row in one line, or write 'confirmed: {{shape: [{rows}, {columns}]}}'"
                " into the sidecar if that is right"
            )


def _stated_sizes(header: Sequence[str]) -> list[tuple[str, int, int]]:
    """Pairs of whole numbers in a line, or in two lines below each other, with their text."""
    lines = [line for line in header[:_MAX_LINES] if len(line) <= _MAX_LINE]
    found = []
    counts = [_counts(line) for line in lines]
    for line, numbers in zip(lines, counts, strict=True):
        if len(numbers) == 2 or (len(numbers) == 3 and numbers[2] == 1):
            found.append((line, numbers[0], numbers[1]))
    for (above, first), (below, second) in pairwise(zip(lines, counts, strict=True)):
        if len(first) == len(second) == 1:
            found.append((f"{above.strip()}, {below.strip()}", first[0], second[0]))
    return found


def _counts(line: str) -> list[int]:
    """Whole numbers of a line; none of a line of lengths."""
    if any(length_unit(word) for word in _AFTER_NUMBER.findall(line)):
        return []
    if product := _PRODUCT.search(line):
        return [int(product[1]), int(product[2])]
    return [int(number) for number in _WHOLE.findall(line)]
