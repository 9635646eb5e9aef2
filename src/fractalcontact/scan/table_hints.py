"""Hints of the numbers of a table on its columns and axes, and what these leave open."""

import re
from collections.abc import Sequence

import numpy as np

from ..core.labels import listed
from .draft import Hints

#: Names of x, y and z without signs and units; `_CELLS` are names of counted cells.
_AXES = {
    "x": re.compile(r"(pos(ition)?)?x|x(pos(ition)?|coord(inate)?s?|value)?|easting|east"),
    "y": re.compile(r"(pos(ition)?)?y|y(pos(ition)?|coord(inate)?s?|value)?|northing|north"),
    "z": re.compile(
        r"(pos(ition)?)?z|z(pos(ition)?|coord(inate)?s?|value)?|heights?|h|elev(ation)?|depth"
        r"|topo(graphy)?|aperture|gap|opening"
    ),
}
_CELLS = {"x": re.compile(r"col(umn)?s?|i"), "y": re.compile(r"rows?|j")}
_UNIT = re.compile(r"\s*[\[(/_].*$")
#: Largest difference of the steps of coordinates written with few digits, as a fraction of a step.
_EVEN = 0.02
_MIN_RUN = 5
#: Fewest rows that show coordinates in columns.
_MIN_POINTS = 48


def axis_of(name: str) -> tuple[str, bool]:
    """Axis that the name of a column says, and whether it counts cells; "" for none."""
    short = name.strip("\"' ").lower()
    counts = "px" in short or "pixel" in short
    for text in (short, _UNIT.sub("", short)):
        plain = re.sub(r"[\W_]+", "", text)
        for axis, pattern in _AXES.items():
            if pattern.fullmatch(plain):
                return axis, counts
        for axis, pattern in _CELLS.items():
            if pattern.fullmatch(plain):
                return axis, True
    return "", False


def add_columns(hints: Hints, names: Sequence[str], table: np.ndarray, source: str) -> None:
    """Suggest the columns of x, y and z that names state, else ask for them."""
    said = [axis_of(name) for name in names]
    axes = [axis for axis, _ in said]
    lateral = coordinate_columns(table)
    if all(axes.count(axis) == 1 for axis in "xyz"):
        columns = [axes.index(axis) for axis in "xyz"]
        hints.add("columns", columns, f"{source}, its columns {listed(names)[:40]}")
        lateral = columns[:2]
        counts = said[columns[0]][1] and said[columns[1]][1]
    else:
        counts = False
        hints.ask("columns", _columns_in_doubt(names, axes, lateral, table.shape[1]))
        if names and not any(axes):
            hints.ask("kind", f"its columns are called {listed(names)[:60]}")
    if len(lateral) == 2 and (counts or all(_counts_cells(table[:, c]) for c in lateral)):
        what = "count cells" if counts else "are whole numbers: if they count cells"
        end = "" if counts else "; delete this line if they are lengths"
        hints.ask("spacing", f"x and y {what}{end}")
        hints.ask("first_row", "bottom: cells are counted from the smallest y" + end)
        hints.optional |= {"spacing", "first_row"}


def _columns_in_doubt(
    names: Sequence[str], axes: Sequence[str], lateral: Sequence[int], width: int
) -> str:
    if names:
        return f"its columns are called {listed(names)[:80]}"
    if len(lateral) == 2 and width == 3:
        a, b = lateral
        (z,) = {0, 1, 2} - {a, b}
        return f"[{a}, {b}, {z}] if x comes before y, [{b}, {a}, {z}] if y comes first"
    if len(lateral) == 2:
        return f"columns {lateral[0]} and {lateral[1]} hold the places of a grid, without names"
    return f"{width} columns without names: [0, 1, 2] if they are x, y and z in this order"


def coordinate_columns(table: np.ndarray) -> list[int]:
    """Columns of the coordinates x and y: the only two whose numbers are places of a grid, each
    repeated; [] if none or several.
    """
    if len(table) < _MIN_POINTS:
        return []
    counts = [len(np.unique(column[np.isfinite(column)])) for column in table.T]
    gridlike = [n for n, count in enumerate(counts) if 3 < count <= len(table) / 3]
    pairs = [(a, b) for a in gridlike for b in gridlike if a < b
             and 0.7 * len(table) <= counts[a] * counts[b] <= 2 * len(table)]  # fmt: skip
    return list(pairs[0]) if len(pairs) == 1 else []


def height_column(table: np.ndarray) -> int:
    """Column that is likely to hold heights: the only one that holds no places of a grid."""
    lateral = coordinate_columns(table)
    others = [n for n in range(table.shape[1]) if n not in lateral]
    return others[0] if len(others) == 1 else min(2, table.shape[1] - 1)


def _counts_cells(numbers: np.ndarray) -> bool:
    """True for whole numbers in steps of 1."""
    levels = np.unique(numbers[np.isfinite(numbers)])
    return bool(
        len(levels) > 1 and np.all(levels == np.round(levels)) and np.diff(levels).min() == 1
    )


def add_axes(hints: Hints, table: np.ndarray) -> None:
    """Suggest which of the first row and column hold coordinates; ask where heights may run so."""
    if min(table.shape, default=0) < 3:
        hints.add("axes", "none", "its first row and column do not run in equal steps")
        return
    inside = table[1:, 1:]
    row, column = table[0, 1:], table[1:, 0]
    is_row, is_column = _stands_out(row, inside), _stands_out(column, inside.T)
    whole = np.all(inside[np.isfinite(inside)] == np.round(inside[np.isfinite(inside)]))
    in_counts = [
        _counts_up(numbers) and not whole and not _runs(neighbours)
        for numbers, neighbours in ((row, inside[0]), (column, inside[:, 0]))
    ]
    if is_row and is_column and _is_even(row) and _is_even(column):
        hints.add("axes", "both", "both run in equal steps, as coordinates or counts do")
        if _counts_up(row) and _counts_up(column):
            end = "if they count rows and columns; delete this line if they are lengths"
            hints.ask("spacing", f"its first row and column are whole numbers in steps of 1: {end}")
            hints.ask("first_row", end)
            hints.optional |= {"spacing", "first_row"}
    elif in_counts[1] and not _runs(row):
        hints.add("axes", "column", "it counts the rows")
    elif in_counts[0] and not _runs(column) and _counts_up(table[0]):
        hints.add("axes", "row", "it counts the columns")
    elif doubt := _axes_in_doubt(table, row, column):
        hints.ask("axes", doubt)
    else:
        hints.add("axes", "none", "its first row and column do not run in one direction")


def _axes_in_doubt(table: np.ndarray, row: np.ndarray, column: np.ndarray) -> str:
    """Readings of the first or last row and column other than heights."""
    running = {
        "row": ("first row", row), "column": ("first column", column),
        "": ("last column", table[1:, -1]), " ": ("last row", table[-1, 1:]),
    }  # fmt: skip
    others = {"row": table[1], "column": table[:, 1], "": table[:, -2], " ": table[-2]}
    parts = [
        f"its {name} runs from {numbers[0]:g} to {numbers[-1]:g}"
        + ("" if axes.strip() else ", which no value of axes says: if it is no height, export anew")
        for axes, (name, numbers) in running.items()
        if _runs(numbers) and (_is_even(numbers) or not _runs(others[axes][1:]))
    ]
    return "; ".join(parts)


def _stands_out(numbers: np.ndarray, inside: np.ndarray) -> bool:
    """True if numbers run in one direction and those beside them do not."""
    return _runs(numbers) and not _runs(inside[0])


def _runs(numbers: np.ndarray) -> bool:
    """True if numbers rise, or fall, from each to the next."""
    steps = np.diff(numbers)
    return bool(len(steps) >= _MIN_RUN and (np.all(steps > 0) or np.all(steps < 0)))


def _is_even(numbers: np.ndarray) -> bool:
    steps = np.diff(numbers)
    return bool(np.ptp(steps) <= 2 * _EVEN * abs(steps.mean()))


def _counts_up(numbers: np.ndarray) -> bool:
    """True for 0, 1, 2, ... and 1, 2, 3, ..."""
    start = numbers[0] if len(numbers) else np.nan
    return start in (0, 1) and bool(np.array_equal(numbers, start + np.arange(len(numbers))))
