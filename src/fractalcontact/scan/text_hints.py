"""Hints in the first lines of a text file: named columns, and remarks in other lines."""

import re
from itertools import islice, pairwise
from pathlib import Path
from typing import Any

import numpy as np

from ..core.units import length_unit
from .draft import Hints, add_words
from .options import DELIMITERS, ScanOptions
from .text_lines import COMMENT_MARKS, cells_of, cleaned, is_number, open_text, words_of

_MAX_LINES = 2_000
_LONGEST_LINE = 200_000
#: Lines of words in front of the numbers that a table which describes itself may have.
_MAX_ABOVE = 200
#: Characters of a line that names columns; patterns take the square of them, at worst.
_MAX_HEADING = 2_000
_NAMED = re.compile(r"([xyzXYZ])\s*[\[(]\s*([^\[\]()]+?)\s*[\])]")
_GLUED = re.compile(r"[^\s\[(]+\s*[\[(][^\])]*[\])]")
#: Numbers whose point may part thousands as well.
_MAYBE_GROUPED = re.compile(r"[-+]?[1-9]\d{0,2}(\.\d{3})+")
_WORDS_OF = {
    "x": ("x", "east"),
    "y": ("y", "north"),
    "z": ("z", "height", "elev", "topo", "h", "aperture", "gap", "opening"),
}
#: The width or height of a field, as programs write it in a line of its own.
_FIELD = re.compile(r"#?\s*[^:=]+:\s*([-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?)\s*([^\W\d]+)")
_NO_NUMBER = re.compile(r"[A-Za-z#*?-][\w#/.*? -]*")


def first_lines(path: Path) -> list[str]:
    """Lines at the beginning of a text file."""
    with open_text(path) as stream:
        lines = list(islice(iter(lambda: stream.readline(_LONGEST_LINE), ""), _MAX_LINES))
    return [line.rstrip("\r\n\x1a") for line in lines]


def named_columns(path: Path) -> tuple[dict[str, Any], dict[str, Any]] | None:
    """Keys of a table whose columns are named x, y and z, each with a unit of length.

    The names stand in the line above the numbers, one for each column: ``x [mm], y [mm], z [um]``.

    Returns
    -------
    (dict, dict) or None
        Scan keys, and units for `RawScan`; None for any other text, and where a comma or point
        might mean two things.
    """
    lines = first_lines(path)
    number = _first_numbers(lines[: _MAX_ABOVE + 1])
    if not number:
        return None
    line = lines[number - 1].lstrip("#%!/ ").rstrip()
    if len(line) > _MAX_HEADING:
        return None
    for name, delimiter in DELIMITERS.items():
        cells = _GLUED.findall(line) if delimiter == " " else line.split(delimiter)
        if delimiter == " " and "".join(cells).replace(" ", "") != line.replace(" ", ""):
            continue
        found = [_NAMED.fullmatch(words_of(cell).strip("\"'")) for cell in cells]
        axes = [match[1].lower() if match and length_unit(match[2]) else "" for match in found]
        if sorted(filter(None, axes)) != ["x", "y", "z"]:
            continue
        data = [cells_of(text.rstrip(), delimiter) for text in lines[number:] if text.strip()]
        if any(len(row) - (not row[-1].strip()) > len(cells) for row in data):
            return None
        columns = tuple(axes.index(axis) for axis in "xyz")
        if not _is_plain([row[c].strip() for row in data for c in columns if c < len(row)]):
            return None
        unit_x, unit_y, unit_z = (found[c][2] for c in columns)  # type: ignore[index]
        if unit_x != unit_y:
            return None
        keys = {"delimiter": name, "decimal": ".", "header": number, "layout": "points"}
        return keys | {"columns": columns}, {"unit_xy": unit_x, "unit_z": unit_z}
    return None


def _is_plain(cells: list[str]) -> bool:
    """True if no comma is in a number, and its points can be nothing but decimal points."""
    pointed = [cell for cell in cells if "." in cell]
    grouped = bool(pointed) and all(_MAYBE_GROUPED.fullmatch(cell) for cell in pointed)
    return not grouped and not any("," in cell for cell in cells)


def _first_numbers(lines: list[str]) -> int | None:
    """Index of the first line with only numbers and delimiters."""
    for number, line in enumerate(lines):
        words = re.sub(r"(?i)\bnan\b|(?<=\d)[ed](?=[-+]?\d)", "", line)
        if re.search(r"\d", line) and not re.search(r"[^\W\d_]|[#%!:=]", words):
            return number
    return None


def text_hints(path: Path) -> Hints:
    """Hints in the first lines of a text on its layout."""
    lines, hints = first_lines(path), Hints()
    start = _table_start(lines)
    above, data = lines[:start], [line for line in lines[start:] if line.strip()]
    known = set(above)
    data = [line for line in data if not line.startswith(COMMENT_MARKS) and line not in known]
    name, decimal = _style(data)
    delimiter = DELIMITERS[name]
    hints.add("delimiter", name, f"between the numbers of line {start + 1}")
    hints.add("decimal", decimal, f"in the numbers of line {start + 1}")
    first = f"line {start + 1} is the first of numbers"
    if _first_numbers(lines) is None:
        first = "no line holds numbers alone: is this a scan?"
    hints.add("header", start, first)
    form = ScanOptions(delimiter=name, decimal=decimal)
    rows = [cells_of(cleaned(line, delimiter).rstrip(" ;,\t"), delimiter) for line in data]
    width = int(np.median([len(row) for row in rows])) if rows else 0
    names = _names(above, delimiter, width)
    _layout(hints, names, rows, width, start)
    _words_in_cells(hints, rows, form)
    add_words(hints, [(f"line {n}", line) for n, line in enumerate(above, 1) if line.strip()])
    table = _numbers(rows, width, form)
    if hints.keys["layout"].value == "matrix":
        add_axes(hints, table)
        if len(lines) < _MAX_LINES:
            _add_field(hints, above, table.shape)
    if table.size:
        columns = hints.keys["columns"].value if "columns" in hints.keys else None
        z = columns[2] if columns else table.shape[1]
        hints.heights = table[:, z] if z < table.shape[1] else table
    return hints


def _table_start(lines: list[str]) -> int:
    """First line of the numbers: the first of many in a row of as many cells."""
    widths = [len(re.findall(r"[^\s,;]+", line)) if _first_numbers([line]) == 0 else 0
              for line in lines]  # fmt: skip
    for number, width in enumerate(widths):
        if width and (width > 2 or number + 1 == len(widths) or widths[number + 1] == width):
            return number
    return 0


def _style(data: list[str]) -> tuple[str, str]:
    """Delimiter and decimal mark of most lines."""
    sample = data[:200]
    for name in ("tab", "semicolon"):
        if 2 * sum(DELIMITERS[name] in line.strip() for line in sample) > len(sample):
            return name, "," if any("," in line for line in sample) else "."
    if 2 * sum("," in line for line in sample) <= len(sample):
        return "blank", "."
    text = "\n".join(sample)
    has_blanks = re.search(r"\d[ \t]+[-+]?\d", text) and not re.search(r",\s|\.\d", text)
    return ("blank", ",") if has_blanks else ("comma", ".")


def _names(above: list[str], delimiter: str, width: int) -> list[str]:
    """Cells of the last line above the numbers, if it has one for each column."""
    if not above:
        return []
    cells = [cell.strip().strip("\"'") for cell in
             cells_of(above[-1].lstrip("#%!/ "), delimiter)]  # fmt: skip
    return cells if len(cells) == width else []


def _layout(hints: Hints, names: list[str], rows: list[list[str]], width: int, start: int) -> None:
    """Points or a matrix, by the names or the number of the columns."""
    found = {
        axis: [n for n, name in enumerate(names) if name.lower().startswith(words)]
        for axis, words in _WORDS_OF.items()
    }
    source = f"{width} numbers in line {start + 1}"
    if all(found.values()) and width < 32:
        columns = [found[axis][0] for axis in "xyz"]
        hints.add("layout", "points", f'line {start}: "{", ".join(names)[:40]}"')
        hints.add("columns", columns, f"its columns {', '.join(names[c] for c in columns)[:40]}")
    elif width == 2:
        hints.add("kind", "profile", f"{source}, distance and height")
        hints.add("layout", "points", source)
    elif width < 8:
        hints.add("layout", "points", source)
        hints.add("columns", [0, 1, 2], "in the order of the file; check the order")
    else:
        hints.add("layout", "matrix", source)


def _words_in_cells(hints: Hints, rows: list[list[str]], form: ScanOptions) -> None:
    """Words that stand in place of numbers."""
    words = {cell.strip() for row in rows for cell in row}
    words = {w for w in words if _NO_NUMBER.fullmatch(w) and not is_number(w, form)}
    if 0 < len(words) <= 4:
        value = sorted(words) if len(words) > 1 else words.pop()
        hints.add("missing", value, "in place of numbers")


def _numbers(rows: list[list[str]], width: int, form: ScanOptions) -> np.ndarray:
    """The rows of most numbers, NaN where there is none."""
    mark = form.decimal or "."
    table = [[float(cell.replace(mark, ".")) if is_number(cell, form) else np.nan for cell in row]
             for row in rows if len(row) == width]  # fmt: skip
    return np.array(table, dtype=float).reshape(-1, max(width, 1))


def add_axes(hints: Hints, table: np.ndarray) -> None:
    """Suggest whether the first row and column run evenly, as coordinates and counts do."""
    row = _is_even(table[0, 1:]) if table.size else False
    column = _is_even(table[1:, 0]) if table.size else False
    name = {(True, True): "both", (True, False): "row", (False, True): "column"}.get((row, column))
    if name is None:
        hints.add("axes", "none", "its first row and column do not run in equal steps")
    else:
        hints.add("axes", name, "equal steps, as of coordinates or counts", ["none"])


def _add_field(hints: Hints, above: list[str], shape: tuple[int, ...]) -> None:
    """Suggest the spacing of a field whose width and height two lines state, as Gwyddion does."""
    lengths = [_FIELD.fullmatch(words_of(line)) for line in above]
    for n, (across, along) in enumerate(pairwise(lengths), 1):
        if across and along and length_unit(across[2]) and length_unit(along[2]):
            steps = [
                f"{float(match[1].replace(',', '.')) / count:.9g} {match[2]}"
                for match, count in ((across, shape[1]), (along, shape[0]))
            ]
            source = f"lines {n} and {n + 1}, divided by {shape[1]} and {shape[0]} cells"
            hints.add("spacing", steps, source)
            hints.add("first_row", "top", "as programs that state width and height write it")


def _is_even(numbers: np.ndarray) -> bool:
    steps = np.diff(numbers)
    return bool(len(steps) > 3 and steps[0] != 0 and np.allclose(steps, steps[0], rtol=0.2))
