"""Hints in the first lines of a text file: named columns, and remarks in other lines."""

import re
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from ..core.units import length_unit
from .draft import Hints, add_words
from .options import DELIMITERS, ScanOptions
from .table_hints import add_axes, add_columns, axis_of, coordinate_columns, height_column
from .text_lines import COMMENT_MARKS, cells_of, cleaned, is_number, open_text, value_of, words_of
from .text_style import add_style

_MAX_LINES = 2_000
_LONGEST_LINE = 200_000
#: Most lines of words in front of the numbers of a table that describes itself.
_MAX_ABOVE = 200
#: Longest line, in characters, that names columns; patterns take the square of them, at worst.
_MAX_HEADING = 2_000
_NAMED = re.compile(r"([xyzXYZ])\s*[\[(]\s*([^\[\]()]+?)\s*[\])]")
_GLUED = re.compile(r"[^\s\[(]+\s*[\[(][^\])]*[\])]")
#: Pattern of numbers whose point may part thousands as well.
_MAYBE_GROUPED = re.compile(r"[-+]?[1-9]\d{0,2}(\.\d{3})+")
#: Pattern of the width or height of a field, as programs write it in a line of its own.
_FIELD = re.compile(r"#?\s*[^:=]+:\s*([-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?)\s*([^\W\d]+)")
_MAX_WORDS = 4
_MAX_WORD = 40


def first_lines(path: Path) -> list[str]:
    """Lines at the beginning of a text file."""
    with open_text(path) as stream:
        lines = list(islice(iter(lambda: stream.readline(_LONGEST_LINE), ""), _MAX_LINES))
    return [line.rstrip("\r\n\x1a") for line in lines]


def named_columns(path: Path) -> tuple[dict[str, Any], dict[str, Any]] | None:
    """Scan keys, and units for `RawScan`, of a table whose columns name x, y, z and units.

    The names stand in the line above the numbers, one for each column: ``x [mm], y [mm], z [um]``.
    No columns of any other text, and none where a comma or point might mean two things.
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
        matches = [_NAMED.fullmatch(words_of(cell).strip("\"'")) for cell in cells]
        axes = [match[1].lower() if match and length_unit(match[2]) else "" for match in matches]
        if sorted(filter(None, axes)) != ["x", "y", "z"]:
            continue
        data = [cells_of(text.rstrip(), delimiter) for text in lines[number:] if text.strip()]
        if any(len(row) - (not row[-1].strip()) > len(cells) for row in data):
            return None
        columns = tuple(axes.index(axis) for axis in "xyz")
        if not _is_plain([row[c].strip() for row in data for c in columns if c < len(row)]):
            return None
        unit_x, unit_y, unit_z = (matches[c][2] for c in columns)  # type: ignore[index]
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
    """Hints in the first lines of a text on its layout, and what they leave open."""
    lines, hints = first_lines(path), Hints()
    start = _table_start(lines)
    above, data = lines[:start], [line for line in lines[start:] if line.strip()]
    header = set(above)
    data = [line for line in data if not line.startswith(COMMENT_MARKS) and line not in header]
    name, decimal, thousands = add_style(hints, data, f"in the numbers of line {start + 1}")
    delimiter = DELIMITERS[name]
    form = ScanOptions(delimiter=name, decimal=decimal, thousands=thousands or None)
    rows = [cells_of(cleaned(line, delimiter).rstrip(" ;,\t"), delimiter) for line in data]
    width = int(np.median([len(row) for row in rows])) if rows else 0
    if above and _is_coordinates(cells_of(above[-1].strip(), delimiter), width, form):
        rows.insert(0, cells_of(above.pop().strip(), delimiter))
        start -= 1
    first = f"line {start + 1} is the first of numbers"
    if _first_numbers(lines) is None:
        first = "no line holds numbers alone: is this a scan?"
    hints.add("header", start, first)
    names = _names(above, delimiter, width)
    table = _numbers(rows, width, form)
    _layout(hints, names, table, start, path)
    _words_in_cells(hints, rows, width, form)
    add_words(hints, [(f"line {n}", line) for n, line in enumerate(above, 1) if line.strip()])
    layout = hints.keys.get("layout")
    if layout and layout.value == "matrix":
        _add_matrix(hints, rows, table, above, len(lines) < _MAX_LINES)
    if table.size:
        hints.heights = _heights_of(hints, table)
    return hints


def _is_coordinates(cells: list[str], width: int, form: ScanOptions) -> bool:
    """True for a row of numbers behind a word in the corner."""
    return (
        len(cells) == width > 4
        and not is_number(cells[0], form)
        and not cells[0].startswith(COMMENT_MARKS)
        and all(is_number(cell, form) for cell in cells[1:])
    )


def _add_matrix(
    hints: Hints, rows: list[list[str]], table: np.ndarray, above: list[str], is_whole: bool
) -> None:
    """Suggest axes of a matrix, and its spacing by the length of its sides."""
    lacks_corner = len(rows[0]) == table.shape[1] - 1
    if lacks_corner:
        hints.ask("axes", "its first row holds a number less than the others, as one of both does")
    else:
        add_axes(hints, table)
    if not is_whole:
        return
    axes = hints.keys["axes"].value if "axes" in hints.keys else "none"
    ny = len(table) - (axes in ("both", "row"))
    nx = table.shape[1] - (axes in ("both", "column") or lacks_corner)
    _add_field(hints, above, (ny, nx))
    _ask_lengths(hints, (ny, nx))


def _heights_of(hints: Hints, table: np.ndarray) -> np.ndarray:
    """Numbers that may be heights."""
    layout = hints.keys["layout"].value if "layout" in hints.keys else ""
    if layout == "points":
        if "columns" in hints.keys and "columns" not in hints.doubts:
            return table[:, hints.keys["columns"].value[2]]
        return table[:, height_column(table)]
    axes = hints.keys["axes"].value if "axes" in hints.keys else "both"
    return table[axes in ("both", "row") :, axes in ("both", "column") :]


def _table_start(lines: list[str]) -> int:
    """First line of the numbers: the first of many in a row of as many cells."""
    widths = [len(re.findall(r"[^\s,;]+", line)) if _first_numbers([line]) == 0 else 0
              for line in lines]  # fmt: skip
    for number, width in enumerate(widths):
        if width and (width > 2 or number + 1 == len(widths) or widths[number + 1] == width):
            return number
    return 0


def _names(above: list[str], delimiter: str, width: int) -> list[str]:
    """Cells of the last line above the numbers, if it has one for each column."""
    if not above:
        return []
    cells = [cell.strip().strip("\"'") for cell in
             cells_of(above[-1].lstrip("#%!/ "), delimiter)]  # fmt: skip
    return cells if len(cells) == width else []


def _layout(hints: Hints, names: list[str], table: np.ndarray, start: int, path: Path) -> None:
    """Points or a matrix, by the names or the number of the columns."""
    width = table.shape[1]
    source = f"{width} numbers in line {start + 1}"
    named = [axis for axis, _ in map(axis_of, names) if axis]
    if width == 2:
        hints.add("kind", "profile", f"{source}, distance and height")
        hints.add("layout", "points", source)
    elif width < 8 or (width < 32 and {"x", "y", "z"} <= set(named)):
        hints.add("layout", "points", f"line {start}" if named else source)
        add_columns(hints, names, table, f"line {start}")
        if path.suffix.lower() == ".xyz" and width == 3 and not names:
            hints.state("columns", [0, 1, 2], "its name ends in .xyz")
    elif coordinate_columns(table):
        hints.ask("layout", f"{source}, of which two hold the places of a grid")
    else:
        hints.add("layout", "matrix", source)
        words = {name.lower() for name in names if re.fullmatch(r"[A-Za-z]{3,}.*[A-Za-z]", name)}
        if len(words) > width / 2:
            hints.ask("kind", f"its columns are called {', '.join(names)[:60]}")


def _words_in_cells(hints: Hints, rows: list[list[str]], width: int, form: ScanOptions) -> None:
    """Words that stand in place of numbers, and empty cells."""
    cells = [cell.strip() for row in rows[1:] if len(row) == width for cell in row]
    cells += [cell.strip() for cell in (rows[0] if rows else [])[1:]]
    words = {cell[:_MAX_WORD] for cell in cells if not is_number(cell, form)}
    if 0 < len(words) <= _MAX_WORDS:
        value = sorted(words) if len(words) > 1 else words.pop()
        hints.add("missing", value, "in place of numbers")


def _numbers(rows: list[list[str]], width: int, form: ScanOptions) -> np.ndarray:
    """The rows of most numbers, NaN where there is none."""
    table = [[value_of(cell, form) for cell in row] for row in rows if len(row) == width]
    return np.array(table, dtype=float).reshape(-1, max(width, 1))


def _add_field(hints: Hints, above: list[str], shape: tuple[int, int]) -> None:
    """Suggest the spacing of a field as Gwyddion states it: channel, width, height, unit.

    The width of a field is that of all cells, and the first row is the top.
    """
    if len(above) != 4 or not all(line.startswith("# ") and ":" in line for line in above):
        return
    across, along = (_FIELD.fullmatch(words_of(line)) for line in above[1:3])
    unit = above[3].rpartition(":")[2].strip()
    if not (across and along and length_unit(across[2]) and length_unit(along[2])):
        return
    if not length_unit(unit) or _FIELD.fullmatch(words_of(above[0])):
        return
    steps = [
        f"{float(match[1].replace(',', '.')) / count:.9g} {match[2]}"
        for match, count in ((across, shape[1]), (along, shape[0]))
    ]
    hints.state("spacing", steps, f"lines 2 and 3, over {shape[1]} and {shape[0]} cells: Gwyddion")
    hints.state("first_row", "top", "as Gwyddion writes it, by its four lines")
    hints.state("unit_z", unit, f'line 4: "{above[3][:40]}"')
    hints.forget("unit", "unit_xy")


def _ask_lengths(hints: Hints, shape: tuple[int, int]) -> None:
    """Name both spacings of a length that is stated: over whole cells, and over intervals."""
    if "spacing" in hints.keys and "spacing" not in hints.doubts:
        return
    said = []
    for number, (name, lengths, unit, source) in enumerate(hints.lengths[:2]):
        sides = [shape[1], shape[0]]
        if len(lengths) == 1:
            axis = re.search(r"[xy]$|^[xy]\b|height|along", name.lower())
            is_y = axis[0] in ("y", "height", "along") if axis else number == 1
            sides = [shape[0]] if is_y else [shape[1]]
        for length, count in zip(lengths, sides, strict=True):
            whole, between = length / count, length / max(1, count - 1)
            said.append(f"{source}: over {count} points {between:.6g} {unit} from the first to the "
                        f"last, {whole:.6g} {unit} if it spans whole cells")  # fmt: skip
    if said:
        hints.ask("spacing", "; ".join(said))
