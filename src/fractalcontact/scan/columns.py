"""Columns, or a profile, of a text table whose first line names each with its unit, ``z [um]``."""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..core.errors import InputError
from ..core.labels import printable
from ..core.units import length_factor
from .text_lines import open_text

_NAMED = re.compile(r"(?P<name>[^\[(]*?)\s*[\[(]\s*(?P<unit>[^\])]+?)\s*[\])]")
_DELIMITERS = ",;\t"
#: Characters of the line of headings, and of a heading; patterns take the cube of one, at worst.
_MAX_HEADING, _MAX_CELL = 10_000, 100
#: Steps of a profile may differ from their mean by this part of it.
_EVEN = 0.01
_SPREADSHEETS = (".xls", ".xlsx", ".ods")


class Column(NamedTuple):
    """Numbers of a column in the unit that its heading states; ``where`` is for errors."""

    values: np.ndarray
    unit: str
    where: str


def read_columns(path: Path | str, wanted: Mapping[str, str]) -> dict[str, Column]:
    """Columns of a text table.

    Parameters
    ----------
    path : path-like
        Text: a line of headings, then numbers, between them a comma, a semicolon or a tab. Where it
        is no comma, numbers may have a decimal comma.
    wanted : mapping of str to str
        Heading with its unit by name, ``{"pressure": "sn [MPa]"}``. A heading without brackets
        stands for ``x [UNIT]`` with any unit; the file's may lack the unit that is stated here.

    Returns
    -------
    dict of str to Column
        Each (n,), of the names of ``wanted``.

    Raises
    ------
    InputError
        If the file is a spreadsheet, cannot be read, lacks a heading or its unit, or a line holds
        something else than finite numbers.
    """
    path = Path(path)
    if path.suffix.lower() in _SPREADSHEETS:
        raise InputError(f"{path}: a spreadsheet; save the sheet as CSV")
    try:
        with open_text(path) as file:
            lines = [line.strip() for line in file if line.strip()]
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read ({error}); expected a text file") from None
    head = lines[0][:_MAX_HEADING].lstrip("#% ") if lines else ""
    delimiter = max(_DELIMITERS, key=head.count)
    headings = [cell.strip().strip("\"'")[:_MAX_CELL] for cell in head.split(delimiter)]
    places = {name: _place(stated, headings) for name, stated in wanted.items()}
    if None in places.values():
        example = f"{delimiter} ".join(_with_unit(stated) for stated in wanted.values())
        raise InputError(
            f"{path}: the first line does not name these columns, it is '{printable(head, 60)}'; "
            f"expected their names and units, such as '{example}', and numbers in every other line"
        )
    found = {}
    for name, place in places.items():
        number, unit = place  # type: ignore[misc]
        cells = (line.split(delimiter) for line in lines[1:])
        found[name] = Column(_numbers(cells, number, delimiter, path), unit, f"{path}: {name}")
    return found


def read_profile(path: Path | str) -> tuple[np.ndarray, float]:
    """Heights of a profile in even steps.

    Parameters
    ----------
    path : path-like
        Text: a line such as ``x [mm], z [um]``, then numbers, x ascending in even steps.

    Returns
    -------
    heights : (n,) ndarray
        mm.
    spacing : float
        mm.

    Raises
    ------
    InputError
        As :func:`read_columns`, or if its x do not rise in even steps.
    """
    columns = read_columns(path, {"x": "x", "z": "z"}).values()
    x, z = (one.values * length_factor(one.unit, one.where) for one in columns)
    steps = np.diff(x)
    even = x.size > 1 and steps.min() > 0 and np.ptp(steps) <= 2 * _EVEN * steps.mean()
    if not even:
        raise InputError(
            f"{path}: x does not rise in even steps (within {100 * _EVEN:.0f} %); resample the "
            "profile to even steps and fill its gaps"
        )
    return z, float(steps.mean())


def _place(stated: str, headings: list[str]) -> tuple[int, str] | None:
    """Number and unit of the column that a heading names; None without."""
    parts = _NAMED.fullmatch(stated.strip())
    name, unit = (parts["name"], parts["unit"]) if parts else (stated.strip(), "")
    for number, heading in enumerate(headings):
        of_file = _NAMED.fullmatch(heading)
        if heading.lower() == name.lower() and unit:
            return number, unit
        if of_file and of_file["name"].lower() == name.lower():
            if unit and of_file["unit"] != unit:
                continue
            return number, of_file["unit"]
    return None


def _with_unit(stated: str) -> str:
    """Heading with its unit, or one as an example."""
    unit = "MPa" if "pressure" in stated or "str" in stated else "mm"
    return stated if _NAMED.fullmatch(stated) else f"{stated} [{unit}]"


def _numbers(cells, number: int, delimiter: str, path: Path) -> np.ndarray:
    try:
        column = [row[number] for row in cells]
        if delimiter != ",":
            column = [cell.replace(",", ".") for cell in column]
        values = np.array([float(cell) for cell in column])
    except (ValueError, IndexError):
        values = np.array([np.nan])
    if not np.isfinite(values).all():
        raise InputError(
            f"{path}: a line does not hold numbers for these columns, or one is not finite; write "
            "numbers with a decimal point and the same delimiter as in the first line"
        )
    return values
