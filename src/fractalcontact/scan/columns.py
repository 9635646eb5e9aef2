"""Columns, or a profile, of a text table whose first line names each with its unit, ``z [um]``."""

import csv
import math
import re
import unicodedata
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..core.errors import InputError
from ..core.labels import printable
from ..core.units import length_factor, length_unit
from .text_lines import cleaned, open_text

_DELIMITERS = ",;\t"
_WORDS_OF = {",": "comma", ";": "semicolon", "\t": "tab"}
#: Largest difference of the steps of a profile from their mean, as a fraction of it.
_EVEN = 0.01
_SPREADSHEETS = (".xls", ".xlsx", ".ods")
#: Sign that old programs write at the end of a text.
_END_OF_FILE = "\x1a"
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_MONTHS = (
    "jan|feb|fev|fév|mar|mär|mrz|apr|avr|abr|may|mai|mag|jun|juin|giu|jul|juil|lug|aug|aoû|ago|"
    "sep|set|oct|okt|out|ott|nov|dec|dez|déc|dic"
)
#: Days and times as spreadsheets show them: 01. Jan, 3.Mrz, Jan 25, 1/2/2024, 2024-01-02, 12:30.
_DATE = re.compile(
    rf"(?:\d{{1,4}}[-./ ]{{0,2}})?(?:{_MONTHS})[^\W\d]{{0,8}}[-./ ]{{0,2}}\d{{0,4}}"
    r"|\d{1,4}[-./]\d{1,2}[-./]\d{1,4}.{0,16}|\d{1,2}/\d{1,2}|\d{1,2}:\d\d.{0,9}",
    re.IGNORECASE,
)


@dataclass(frozen=True, eq=False)
class Column:
    """Numbers (n,) of a column in the unit that its heading states."""

    values: np.ndarray
    unit: str
    file: Path
    heading: str  # as it stands in the file
    lines: np.ndarray  # (n + 1,) numbers of the lines, that of the heading first

    @property
    def where(self) -> str:
        """Place of the heading, for errors."""
        return self._place(0)

    def at(self, reading: int) -> str:
        """Place of a reading and its number, for errors."""
        return f"{self._place(reading + 1)}: {self.said(reading)}"

    def said(self, reading: int) -> str:
        """Number of a reading with its unit."""
        return f"{self.values[reading] + 0.0:.6g} {self.unit}"  # no -0

    def at_lowest(self) -> str:
        """The lowest number and its line, for errors."""
        lowest = int(np.argmin(self.values))
        return f"{self.said(lowest)} in line {self.line(lowest)}"

    def line(self, reading: int) -> int:
        """Number of the line of a reading."""
        return int(self.lines[reading + 1])

    def _place(self, number: int) -> str:
        return _place_of(self.file, int(self.lines[number]), self.heading)


def read_columns(path: Path | str, wanted: Mapping[str, str]) -> dict[str, Column]:
    """Columns (n,) of a text table, by the names of ``wanted``.

    The table is a line of headings, then numbers, between them a comma, a semicolon or a tab. Where
    it is no comma, numbers may have a decimal comma. ``wanted`` gives the heading with its unit by
    name, ``{"pressure": "sn [MPa]"}``. A heading without brackets stands for ``x [UNIT]`` with any
    unit; that of the file may lack the unit that is stated here. Signs that look alike, as the
    micro sign and the Greek mu, are one.

    Refused are a spreadsheet, a heading or unit that is lacking or there twice, a line with more
    cells than the heading, and a cell that is no finite number.
    """
    path = Path(path)
    if path.suffix.lower() in _SPREADSHEETS:
        raise InputError(f"{path}: a spreadsheet; save the sheet as CSV")
    lines = _lines(path)
    head_line, head = lines[0] if lines else (1, "")
    delimiter, headings, places = _places(path, head_line, head.lstrip("#% "), wanted)
    rows = list(_rows(path, lines[1:], delimiter, headings))
    numbers = np.array([head_line, *(number for number, _ in rows)])
    columns = {}
    for name, (place, unit) in places.items():
        heading = headings[place]
        values = [
            _number(row[place] if place < len(row) else None, delimiter, (path, line, heading))
            for line, row in rows
        ]
        columns[name] = Column(np.array(values, float), unit, path, heading, numbers)
    return columns


def read_profile(path: Path | str) -> tuple[np.ndarray, float]:
    """Heights (n,) of a profile and their spacing, both in mm.

    The file is a text with a first line such as ``x [mm], z [um]``; its x must rise in even steps.
    """
    columns = read_columns(path, {"x": "x", "z": "z"}).values()
    x, z = (column.values * length_factor(column.unit, column.where) for column in columns)
    steps = np.diff(x)
    even = x.size > 1 and steps.min() > 0 and np.ptp(steps) <= 2 * _EVEN * steps.mean()
    if not even:
        raise InputError(
            f"{path}: x does not rise in even steps (within {100 * _EVEN:.0f} %); resample the "
            "profile to even steps and fill its gaps"
        )
    return z, float(steps.mean())


def _lines(path: Path) -> list[tuple[int, str]]:
    """Lines that are not blank, with their numbers."""
    try:
        with open_text(path) as file:
            lines = [(number, line.strip()) for number, line in enumerate(file, 1)]
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read ({error}); expected a text file") from None
    lines = [(number, line) for number, line in lines if line]
    if lines and lines[-1][1].endswith(_END_OF_FILE):
        number, last = lines.pop()
        if last := last.rstrip(_END_OF_FILE).strip():
            lines.append((number, last))
    return lines


def _places(
    path: Path, line: int, head: str, wanted: Mapping[str, str]
) -> tuple[str, list[str], dict[str, tuple[int, str]]]:
    """Delimiter and headings of a table; number and unit of each wanted column."""
    by_count = sorted(_DELIMITERS, key=head.count, reverse=True)
    for delimiter in by_count:
        headings = _cells(path, line, head, delimiter)
        matches = {name: _matches(stated, headings) for name, stated in wanted.items()}
        if all(matches.values()):
            break
    else:
        delimiter = by_count[0]
        example = f"{delimiter} ".join(_with_unit(stated) for stated in wanted.values())
        raise InputError(
            f"{path}: line {line} does not name these columns, it is '{printable(head, 60)}'; "
            f"expected their names and units, such as '{example}', and numbers in every other line"
        )
    for name, places in matches.items():
        if len(places) > 1:
            numbers = " and ".join(str(place + 1) for place, _ in places)
            raise InputError(
                f"{path}: line {line}: columns {numbers} are both '{wanted[name]}'; rename one, or "
                f"state the heading with its unit in 'columns: {{{name}: ...}}'"
            )
    return delimiter, headings, {name: places[0] for name, places in matches.items()}


def _matches(stated: str, headings: list[str]) -> list[tuple[int, str]]:
    """Numbers and units of the columns that a heading names; those in the same case before all."""
    matches = [_same(stated, heading, number) for number, heading in enumerate(headings)]
    exact = [match for match in matches if match]
    return [match for match in exact if _plain(headings[match[0]]) == _plain(stated)] or exact


def _same(stated: str, heading: str, number: int) -> tuple[int, str] | None:
    """Number and unit of a column whose heading is the stated one; either may lack the unit."""
    stated, heading = _plain(stated), _plain(heading)
    (name, unit), (of_file, file_unit) = _name_and_unit(stated), _name_and_unit(heading)
    if unit and heading.lower() == name.lower():
        return number, unit
    if file_unit and of_file.lower() == stated.lower():
        return number, file_unit
    if file_unit and of_file.lower() == name.lower() and _same_unit(unit, file_unit):
        return number, file_unit
    return None


def _name_and_unit(heading: str) -> tuple[str, str]:
    """Name and unit of a heading; the unit stands in its last brackets."""
    start = max(heading.rfind("["), heading.rfind("("))
    unit = heading[start + 1 : -1].strip()
    if start < 0 or not unit or not heading.endswith(("]", ")")):
        return heading, ""
    return heading[:start].rstrip(), unit


def _same_unit(stated: str, of_file: str) -> bool:
    """True if a stated unit is none or that of the file, however a length is written."""
    unit = length_unit(stated)
    return stated in ("", of_file) or (unit is not None and unit == length_unit(of_file))


def _plain(text: str) -> str:
    """Text with one sign for those that look alike, and single blanks."""
    return " ".join(unicodedata.normalize("NFKC", text).split())


def _with_unit(stated: str) -> str:
    """Heading with its unit, or one as an example."""
    unit = "MPa" if "pressure" in stated or "str" in stated else "mm"
    return stated if _name_and_unit(stated)[1] else f"{stated} [{unit}]"


def _rows(
    path: Path, lines: list[tuple[int, str]], delimiter: str, headings: list[str]
) -> Iterator[tuple[int, list[str]]]:
    """Cells of each line; blank ones may follow the last heading."""
    for number, line in lines:
        row = _cells(path, number, cleaned(line, delimiter), delimiter)
        if any(row[len(headings) :]):
            commas = (
                "numbers with decimal commas want semicolons between the columns, in the first "
                "line too"
                if delimiter == ","
                else "give every column a heading"
            )
            raise InputError(
                f"{path}: line {number}: {len(row)} cells below {len(headings)} headings, it is "
                f"'{printable(line, 60)}'; {commas}"
            )
        yield number, row


def _cells(path: Path, number: int, line: str, delimiter: str) -> list[str]:
    try:
        (row,) = csv.reader([line], delimiter=delimiter, skipinitialspace=True)
    except (csv.Error, ValueError) as error:
        raise InputError(
            f"{path}: line {number} cannot be split into cells ({error}); write each row in a line"
        ) from None
    return [cell.strip().strip("\"'") for cell in row]


def _number(cell: str | None, delimiter: str, place: tuple[Path, int, str]) -> float:
    text = cell or ""
    if delimiter != ",":
        text = text.replace(",", ".")
    value = float(text) if _NUMBER.fullmatch(text) else math.nan
    if math.isfinite(value):
        return value
    if not cell:
        missing = "the line ends before this column" if cell is None else "the cell is empty"
        words = f"{missing}; write its number, or remove the line"
    elif _DATE.fullmatch(cell):
        words = (
            f"'{printable(cell, 40)}' is a date, which a spreadsheet makes of a number such as "
            "1.2; format the column as numbers there, write the number again, and save as CSV"
        )
    else:
        comma = "" if delimiter == "," else ", or a decimal comma"
        words = (
            f"'{printable(cell, 40)}' is no finite number; write numbers with a decimal point"
            f"{comma}, and between the columns a {_WORDS_OF[delimiter]} as in the first line"
        )
    raise InputError(f"{_place_of(*place)}: {words}")


def _place_of(path: Path, line: int, heading: str) -> str:
    """File, line and column, for errors."""
    return f"{path}: line {line}, column '{printable(heading, 40)}'"
