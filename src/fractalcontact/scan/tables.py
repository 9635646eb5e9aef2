"""Tables of numbers as heights or points, by the layout and axes of the sidecar."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..core.errors import InputError
from ..core.labels import listed
from ..core.limits import SMALLEST_SIDE
from .options import ScanOptions
from .raw import RawScan

#: Most empty cells that numbered columns and rows may leave for each cell that they fill.
MAX_EMPTY_PER_POINT = 20
#: Most blocks of points that are clouds; more blocks are scan lines.
_MAX_CLOUDS = 4
#: Largest distance of coordinates from equal steps, as a fraction of a step: rounding in the
#: export.
EVEN = 0.1


def choose_array(names: list[str], wanted: str | None, path: Path) -> str:
    """Name of the array of heights: the one the sidecar's ``variable`` names, or the only one."""
    if not names:
        raise InputError(
            f"{path}: holds no 2-D array of real numbers, so no heights; export it again"
        )
    has = f"it has {listed(names)}"
    if wanted is not None:
        if wanted not in names:
            raise InputError(
                f"{path}: key 'variable' is {wanted!r}, no 2-D array of numbers; {has}"
            )
        return wanted
    if len(names) != 1:
        raise InputError(
            f"{path}: which array holds the heights? Name one 2-D array of numbers in the sidecar, "
            f"'variable: NAME'; {has}"
        )
    return names[0]


def is_table(shape: tuple, dtype: np.dtype) -> bool:
    """True for a 2-D array of real numbers."""
    return len(shape) == 2 and dtype.kind in "fiu"


def refuse_unknown_channel(names: list[str], wanted: str | None, path: Path) -> None:
    """Refuse a ``variable`` of the sidecar that is none of the channels."""
    if wanted is not None and wanted not in names:
        raise InputError(f"{path}: no channel {wanted!r} (key 'variable'); it has {listed(names)}")


@dataclass(frozen=True)
class TextParts:
    """Parts of a text file beside the table of its numbers."""

    names: list[str] | None = None  # cells of the last header line
    #: Row of coordinates in front of the table, where the sidecar states one.
    above: np.ndarray | None = None
    #: Row before which a line without numbers stands, and the number of that line.
    breaks: Mapping[int, int] = field(default_factory=dict)


def table_to_raw(
    table: np.ndarray,
    options: ScanOptions,
    where: str,
    parts: TextParts = TextParts(),
    **stated: Any,
) -> RawScan:
    """Heights or points of a table (rows, columns), as ``layout``, ``columns`` and ``axes`` state.

    ``stated`` are further fields of `RawScan`. An absent column, uneven coordinates beside a matrix
    and several tables under one another are refused.
    """
    if options.layout != "points":
        return _matrix(table, options, where, parts, stated)
    chosen = options.columns or (0, 1, 2)
    columns = [column_index(c, parts.names, table.shape[1], where) for c in chosen]
    points = table if columns == list(range(table.shape[1])) else table[:, columns]
    _refuse_repeated(points, parts.breaks, where)
    _refuse_overlapping(points, parts.breaks, options, where)
    if options.spacing is not None:
        return RawScan(_by_cell(points, where), "matrix", **stated)
    return RawScan(np.ascontiguousarray(points), "points", **stated)


def _matrix(
    table: np.ndarray, options: ScanOptions, where: str, parts: TextParts, stated: dict
) -> RawScan:
    """Heights without the coordinates, or counts, in the first row and column of a matrix."""
    axes, above, left = options.axes, parts.above, None
    _refuse_stacked(len(table), parts.breaks, options, where)
    if axes in ("both", "row") and above is None:
        above, table = table[0], table[1:]
    if axes in ("both", "column"):
        left, table = table[:, 0], table[:, 1:]
    if above is not None:
        above = above[-table.shape[1] :] if table.shape[1] else above
        if len(above) != table.shape[1]:
            raise InputError(
                f"{where}: its first row holds {len(above)} numbers, the others {table.shape[1]} "
                "heights; write 'axes: none' or 'axes: column' if it holds no coordinates"
            )
    for name, numbers in (("row", above), ("column", left)):
        if numbers is not None and len(np.unique(numbers)) < len(numbers):
            raise InputError(
                f"{where}: its first {name} repeats a number, so that it has neither counts nor "
                "coordinates; write another 'axes' into the sidecar. If the file has several "
                "tables, put each into its own file"
            )
        if numbers is not None:
            _step(numbers, name, where)
    if axes == "both" and options.spacing is None:
        assert above is not None  # it was taken off
        assert left is not None
        dx, dy = _step(above, "row", where), _step(left, "column", where)
        table = table[:, ::-1] if dx < 0 else table
        stated |= {"spacing": (abs(dx), abs(dy)), "first_row": "top" if dy < 0 else "bottom"}
    return RawScan(table, "matrix", **stated)


def _step(numbers: np.ndarray, name: str, where: str) -> float:
    """Signed step of coordinates in equal steps."""
    step = (numbers[-1] - numbers[0]) / max(1, len(numbers) - 1)
    even = np.linspace(numbers[0], numbers[-1], len(numbers))
    if len(numbers) < 2 or not np.abs(numbers - even).max() <= EVEN * abs(step):
        raise InputError(
            f"{where}: the coordinates or counts in its first {name} are not in equal steps; "
            "export x, y and z as three columns, or write another 'axes' if they are heights"
        )
    return float(f"{step:.10g}")


def _by_cell(points: np.ndarray, where: str) -> np.ndarray:
    """Heights by number of column and row, which a stated spacing makes of x and y."""
    lateral = points[:, :2]
    low, high = lateral.min(axis=0), lateral.max(axis=0)
    if not (np.isfinite(lateral).all() and np.all(lateral == np.round(lateral))):
        raise InputError(
            f"{where}: with 'spacing' its x and y are numbers of cells, but they are no whole "
            "numbers; remove 'spacing' if they are lengths"
        )
    nx, ny = (int(count) for count in high - low + 1)
    if nx * ny > MAX_EMPTY_PER_POINT * len(points):
        raise InputError(
            f"{where}: {len(points)} heights for {nx} columns and {ny} rows; remove the other "
            "numbers, or export x, y, z"
        )
    x, y = (lateral - low).astype(np.intp).T
    if len(np.unique(y * nx + x)) < len(points):
        raise InputError(f"{where}: two heights for one cell; write each table into its own file")
    heights = np.full((ny, nx), np.nan)
    heights[y, x] = points[:, 2]
    return heights


def _refuse_stacked(rows: int, breaks: Mapping[int, int], options: ScanOptions, where: str) -> None:
    """Refuse tables under one another, parted by lines without numbers.

    Lines between rows in even steps separate no tables. Other lines are accepted if the sidecar
    confirms the size of the whole.
    """
    sizes = np.diff([0, *breaks, rows])
    if len(sizes) < 2 or options.confirmed is not None:
        return
    if np.ptp(sizes) == 0 and sizes[0] >= SMALLEST_SIDE:
        raise _stacked(where, len(sizes), int(sizes[0]))
    step = int(sizes[1])
    is_even = len(sizes) > 3 and np.ptp(sizes[1:-1]) == 0 and step < SMALLEST_SIDE
    if not (is_even and max(sizes[0], sizes[-1]) <= step):
        raise _below(where, breaks, rows, f"confirmed: {{shape: [{rows}, NUMBER OF COLUMNS]}}")


def _below(where: str, breaks: Mapping[int, int], rows: int, key: str) -> InputError:
    row, line = list(breaks.items())[-1]
    return InputError(
        f"{where}: line {line} holds no numbers, and {rows - row} more rows follow it, as a row of "
        "means or a second table does; remove them, or that line if they belong to the same "
        f"surface, or write '{key}' into the sidecar"
    )


def _refuse_overlapping(
    points: np.ndarray, breaks: Mapping[int, int], options: ScanOptions, where: str
) -> None:
    """Refuse a cloud below a line that lies where the points above that line lie."""
    sizes = np.diff([0, *breaks, len(points)])
    if not 1 < len(sizes) <= _MAX_CLOUDS or options.confirmed is not None:
        return
    key = f"confirmed: {{points: {len(points)}}}"
    if sizes[-1] <= 2 < min(sizes[:-1]):
        raise _below(where, breaks, len(points), key)
    if min(sizes) < SMALLEST_SIDE**2 or not np.isfinite(points[:, :2]).all():
        return
    blocks = [block[:, :2] for block in np.split(points, list(breaks))]
    low, high = blocks[-1].min(axis=0), blocks[-1].max(axis=0)
    inside = [((block >= low) & (block <= high)).all(axis=1).sum() for block in blocks[:-1]]
    if max(inside) > sizes[-1] / 2:
        raise _below(where, breaks, len(points), key)


def _refuse_repeated(points: np.ndarray, breaks: Mapping[int, int], where: str) -> None:
    """Refuse clouds under one another: parted by a line, at the same places."""
    sizes = np.diff([0, *breaks, len(points)])
    if len(sizes) < 2 or np.ptp(sizes) or sizes[0] < SMALLEST_SIDE**2:
        return
    blocks = points.reshape(len(sizes), sizes[0], 3)[:, :, :2]
    ordered = [block[np.lexsort(block.T)] for block in blocks]
    if all(np.array_equal(block, ordered[0]) for block in ordered):
        raise _stacked(where, len(sizes), int(sizes[0]))


def _stacked(where: str, count: int, rows: int) -> InputError:
    return InputError(
        f"{where}: {count} tables of {rows} rows stand one under the other; write each into a file "
        "of its own, two faces as NAME.lower and NAME.upper"
    )


def column_index(column: int | str, names: list[str] | None, n_columns: int, where: str) -> int:
    """Number of a column, by its number or its name in the last header line."""
    if isinstance(column, str):
        if names is None or names.count(column) != 1:
            has = f"it has {listed(names)}" if names else "there is no header line"
            raise InputError(
                f"{where}: no single column {column!r} (key 'columns') in the last header line "
                f"(key 'header'); {has}; columns can be counted too, from 0"
            )
        return names.index(column)
    if column >= n_columns:
        raise InputError(
            f"{where}: no column {column} (columns are counted from 0; it has {n_columns}); set "
            "key 'columns' to three that exist"
        )
    return column
