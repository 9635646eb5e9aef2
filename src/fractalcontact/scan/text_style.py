"""How the lines of a text file are written: numbers or words, delimiter, decimal mark, names."""

import math
import re
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..core.errors import InputError
from ..core.units import length_unit
from .column_names import parse_name
from .raw import SMALLEST_SIDE

COMMENT_MARKS = ("#", "%", "//", "!")
_WORD = re.compile(r"[A-Za-z_]+")
_NUMBER_WORDS = {"e", "d", "nan", "inf", "infinity", "na", "n", "a", "null", "none", "bad"}
_DECIMAL_COMMA = re.compile(r"^[-+]?\d+,\d+([eE][-+]?\d+)?$")
#: Cells without a number, as programs write them.
_MISSING_MARKS = re.compile(
    r"\bno[ -]?data\b|#N/?A(?: N/A)?|#(?:NUM|DIV/0|VALUE|REF|NULL)!?|[-+]?\b1\.#[A-Z]+\d*"
    r"|\b(?:missing|invalid|void|masked)\b|<NA>",
    re.IGNORECASE,
)
_TYPOGRAPHY = str.maketrans("\u2212\u2012\u2013\u00a0\u2009\u202f", "---   ")
_FORTRAN_EXPONENT = re.compile(r"(?<=[\d.])[dD](?=[-+]?\d)")
_QUOTED = re.compile(r'"[^"]*"')
_ORDINARY = re.compile(r"[-+0-9.,;eE \t]*")
#: A coordinate in a header line, with its unit.
_ABOVE = re.compile(r"(?:[xX]\s*=\s*)?([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*([^\W\d_]*)")
_SAMPLE = 200  # lines that decide about delimiter and decimal mark


@dataclass(frozen=True)
class Style:
    """How the lines of numbers are written."""

    delimiter: str  # " " is white space of any length
    decimal: str
    width: int  # numbers in a line
    trailing: bool  # lines end with a delimiter that parts nothing


def find_style(lines: list[str], path: Path) -> Style:
    """Find delimiter, decimal mark and width from the first lines of numbers."""
    delimiter, decimal = _sniff(lines[:_SAMPLE])
    if delimiter == "," and _halves_of_numbers(lines[:_SAMPLE]):
        raise InputError(
            f"{path}: commas both inside and between its numbers; export it with decimal points, "
            "or with semicolons between the numbers"
        )
    ending = sum(line.endswith(delimiter) for line in lines)
    trailing = delimiter != " " and ending >= max(1, len(lines) - 1)
    if trailing:
        lines = [line.removesuffix(delimiter) for line in lines]
    widths = Counter(len(split_cells(line, delimiter)) for line in lines)
    return Style(delimiter, decimal, widths.most_common(1)[0][0], trailing)


def has_words(line: str) -> bool:
    """Whether a line holds letters that belong to no number and mark no missing cell."""
    return any(word.lower() not in _NUMBER_WORDS for word in _WORD.findall(line))


def numbers_of(line: str, in_front: bool) -> str | None:
    """A line of numbers as the parser takes it; None if it is a comment or has words.

    Parameters
    ----------
    line : str
    in_front : bool
        Whether no numbers have come yet: "NODATA -9999" is a header there.
    """
    if _ORDINARY.fullmatch(line):
        return line
    text = _MISSING_MARKS.sub("nan", line).translate(_TYPOGRAPHY)
    if text.startswith(COMMENT_MARKS) or has_words(text):
        return None
    if in_front and text != line and len(re.findall(r"[^\s,;]+", text)) < 3:
        return None
    text = _FORTRAN_EXPONENT.sub("e", text)
    quoted = "".join(_QUOTED.findall(text))
    if quoted and not any(mark in quoted and mark in _QUOTED.sub("", text) for mark in ",;\t"):
        text = text.replace('"', "")
    return text


def _sniff(sample: list[str]) -> tuple[str, str]:
    """Find delimiter and decimal mark; white space of any length is the delimiter ``" "``.

    A mark that stands in a few lines alone parts nothing.
    """
    text = "\n".join(sample)
    cells = [cell.strip() for line in sample for cell in line.strip().split("\t")]
    apart = sum(bool(re.search(r"[\d.] +[-+]?[\d.]", cell)) for cell in cells)
    if _in_most("\t", sample) and 2 * apart <= len(cells):
        delimiter = "\t"
    elif _in_most(";", sample):
        delimiter = ";"
    elif not _in_most(",", sample):
        delimiter = " "
    else:
        # "1,5 2,5" is blanks and decimal commas; "1, 2" and "1.5,2.5" are commas.
        decimal_commas = re.search(r"\d[ \t]+[-+]?\d", text) and not re.search(r",\s|\.\d", text)
        delimiter = " " if decimal_commas else ","
    if delimiter == ",":
        return delimiter, "."
    cells = [cell.strip() for line in sample for cell in split_cells(line, delimiter)]
    return delimiter, "," if any(_DECIMAL_COMMA.match(cell) for cell in cells) else "."


def _in_most(mark: str, lines: list[str]) -> bool:
    return 2 * sum(mark in line.strip() for line in lines) > len(lines)


def _halves_of_numbers(lines: list[str]) -> bool:
    """Whether cells between commas are whole parts and decimals in turn: 0,05, 1,25.

    No program writes a whole number with a zero in front, but every tenth decimal has one.
    """
    cells = [cell.strip() for line in lines for cell in line.rstrip(", ").split(",")]
    if any(not re.fullmatch(r"[-+]?\d*", cell) for cell in cells):
        return False
    return any(re.fullmatch(r"[-+]?0\d+", cell) for cell in cells)


def counts_agree(counts: list[int], shape: tuple[int, ...]) -> bool:
    """Whether the numbers in front are those of rows, columns or points."""
    rows, columns = shape
    known = {rows, columns, rows - 1, columns - 1, rows * columns}
    of_points = columns < SMALLEST_SIDE and math.prod(counts) == rows
    return set(counts) <= known or of_points


def split_cells(line: str, delimiter: str) -> list[str]:
    """Cells of a line; the delimiter ``" "`` is white space of any length."""
    return line.split() if delimiter == " " else line.split(delimiter)


def column_names(header: list[str], style: Style) -> tuple[list[str] | None, bool, int | None]:
    """Take the last header line with one word a column as the columns' names.

    Returns
    -------
    names : list of str or None
    sure : bool
        Whether the line can be nothing else: a comment of three words may stand before three
        columns.
    number : int or None
        Of the line in the header.
    """
    delimiter, width = style.delimiter, style.width
    for number in range(len(header) - 1, -1, -1):
        text = header[number].lstrip("#%!/ ").removesuffix(delimiter)
        others = [] if re.search(r"[:=]|\d,\d", text) else [",", ";", "\t", " "]
        for separator in (delimiter, *others):
            names = [name.strip().strip("\"'") for name in split_cells(text, separator)]
            if len(names) == width and any(map(has_words, names)):
                if number and (named := _with_units(header[number - 1], names, separator)):
                    return named, True, number - 1
                units = any(parse_name(name).unit for name in names)
                # No title has as many words as a matrix has columns.
                is_line = width >= SMALLEST_SIDE and not header[number].startswith(COMMENT_MARKS)
                return names, separator != " " or units or is_line, number
            glued = re.findall(r"[^\s\[(]+(?:\s*[\[(][^\])]*[\])])?", text)
            if separator == " " and len(glued) == width and re.search(r"[\[(]", text):
                return glued, True, number
    return None, False, None


def _with_units(line: str, units: list[str], separator: str) -> list[str] | None:
    """Names of a line above one that holds nothing but their units: "X [mm]"."""
    plain = [unit.strip("[]() ") for unit in units]
    text = line.lstrip("#%!/ ").removesuffix(separator)
    names = [name.strip().strip("\"'") for name in split_cells(text, separator)]
    if len(names) != len(units) or not all(length_unit(unit) for unit in plain if unit):
        return None
    return [f"{name} [{unit}]" if unit else name for name, unit in zip(names, plain, strict=True)]


def numbers_above(
    header: list[str], style: Style, where: str
) -> tuple[np.ndarray | None, list[str]]:
    """Numbers that a header line holds, one for each column: coordinates; and the other lines.

    A word may stand in the corner, "y/x [mm]", and a unit with each number.

    Raises
    ------
    InputError
        If that word says that x may run down the side.
    """
    for number in range(len(header) - 1, -1, -1):
        text = header[number].lstrip("#%!/ ").removesuffix(style.delimiter)
        cells = [cell.strip().strip("\"'") for cell in split_cells(text, style.delimiter)]
        found = [_ABOVE.fullmatch(cell.replace(",", ".")) for cell in cells]
        first = 0 if found and found[0] else 1
        if all(found[first:]) and style.width - 1 <= len(found) - first <= style.width:
            of_y = first and len(found) > style.width and cells[0].lower().startswith("y")
            if style.width < SMALLEST_SIDE or of_y:
                continue
            if len(found) == style.width and parse_name(cells[0]).word.startswith("x"):
                raise InputError(
                    f"{where}: {cells[0]!r} stands in the corner between its coordinates, so that "
                    "x may run down its side; write 'y' there if x runs along its rows, else "
                    "export it transposed, or x, y, z as columns"
                )
            values = [float(match[1]) for match in found[first:] if match]
            units = {match[2] for match in found[first:] if match}
            rest = header[:number] + header[number + 1 :]
            unit = units.pop() if len(units) == 1 else None
            corner = parse_name(cells[0]).unit if first else None
            if unit or corner:
                rest = [*rest, f"x, y [{unit or corner}]"]
            return np.array(values), rest
    return None, header
