"""Which array of a file holds the heights, and whether a table is a matrix or a list of points."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..core.errors import InputError
from ..core.labels import listed
from ..core.units import length_factor
from .column_names import has_record_names, named_axes, numbers_columns, parse_name
from .options import ScanOptions
from .raw import SMALLEST_SIDE, RawScan, foreign_units, stated_unit
from .table_axes import stacked, without_axes

_WHOLE = (
    "x and y are whole numbers from 0 or 1 on, taken in the file's unit; if they count cells, "
    "write 'spacing: 0.1 mm'"
)
#: Numbered columns and rows may leave at most this many empty cells for each cell that they fill.
MOST_EMPTY = 20
#: Points on a grid fill at least one node in this many.
FULL = 5
#: Larger tables are not searched for the columns that lie on a grid: it sorts them all.
MOST_ORDERED = 1_000_000
#: A narrow table may be a list of points with colours and normals.
FEW_COLUMNS = 32
#: Columns of heights scatter alike; others differ by more than this factor.
UNLIKE = 20
#: Times the median step between rows that a line between two matrices must part.
PARTED = 3
#: Two matrices follow each other without a line between them where a step between rows is this
#: many times the largest other one.
TORN = 8


def choose_array(names: list[str], wanted: str | None, path: Path) -> str:
    """Choose the array of heights: the one the sidecar's ``variable`` names, or the only one.

    Parameters
    ----------
    names : list of str
        The arrays that could be heights.
    wanted : str or None
    path : Path

    Raises
    ------
    InputError
        If the wanted one is absent, or none is named where there are several or none at all.
    """
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
    """Tell a 2-D array of real numbers from everything else."""
    return len(shape) == 2 and dtype.kind in "fiu"


def refuse_unknown_channel(names: list[str], wanted: str | None, path: Path) -> None:
    """Refuse a ``variable`` of the sidecar that is none of the channels."""
    if wanted is not None and wanted not in names:
        raise InputError(f"{path}: no channel {wanted!r} (key 'variable'); it has {listed(names)}")


@dataclass(frozen=True)
class TextLayout:
    """What stands around the numbers of a text file.

    Attributes
    ----------
    names_are_sure : bool
        Whether the line taken for names of columns can be nothing else.
    above : ndarray or None
        Numbers of a header line, one for each column.
    breaks : sequence of int
        Rows before which an empty line, a comment or a header stands.
    """

    names_are_sure: bool = True
    above: np.ndarray | None = None
    breaks: Sequence[int] = ()


def table_to_raw(
    table: np.ndarray,
    names: list[str] | None,
    options: ScanOptions,
    where: str,
    layout: TextLayout = TextLayout(),
    **stated: Any,
) -> RawScan:
    """Decide whether a table of numbers is a matrix of heights or a list of points.

    The sidecar decides first, then the names of the columns, then their number.

    Parameters
    ----------
    table : ndarray, shape (rows, columns)
    names : list of str or None
        Column names, where the file has them.
    options : ScanOptions
    where : str
        The file, for errors.
    layout : TextLayout
    **stated
        Further fields of `RawScan`.

    Raises
    ------
    InputError
        If neither its width nor its column names decide, they show that it is no surface, a wanted
        column is absent, or several tables stand under one another.
    """
    n_columns = table.shape[1]
    named = None if options.columns or options.layout == "matrix" else named_axes(names)
    if options.columns and options.layout != "matrix":
        chosen = [_column_index(c, names, n_columns, where) for c in options.columns]
        units = [parse_name(names[c]).unit if names else None for c in chosen]
        return _points(_selected(table, chosen), units, layout, options, where, stated)
    if named is not None:
        columns = _selected(table, named.columns)
        if named.counted:
            return _counted(columns, named.units[2], where, stated)
        return _points(columns, named.units, layout, options, where, stated)
    if options.layout == "points" or (options.layout is None and n_columns == 3):
        if options.layout is None:
            _refuse_other_names(names, layout, where)
        _column_index(2, names, n_columns, where)
        if options.layout is None:
            _refuse_other_order(table, where)
        return _points(table[:, :3], (None,) * 3, layout, options, where, stated)
    if options.layout is None:
        _refuse_no_matrix(table, names, layout, where)
        _refuse_unlike_columns(table, options.missing or stated.get("missing"), where)
    if options.axes == "none":
        return RawScan(table, "matrix", **stated)
    _refuse_stacked(table, layout.breaks, where)
    heights, found = without_axes(table, where, layout.above)
    _refuse_two_spacings(stated, found, options, where)
    notes = (*stated.pop("notes", ()), *found.pop("notes", ()))
    return RawScan(heights, "matrix", notes=notes, **{**stated, **found})


def _selected(table: np.ndarray, columns: Sequence[int]) -> np.ndarray:
    """Columns of a table; itself where they are all of it, as a copy would be in vain."""
    if list(columns) == list(range(table.shape[1])):
        return table
    return table[:, list(columns)]


def _refuse_two_spacings(stated: dict, found: dict, options: ScanOptions, where: str) -> None:
    """Refuse a header and coordinates that say different spacings: their units may differ."""
    said, seen = stated.get("spacing"), found.get("spacing")
    if not (said and seen) or options.spacing is not None:
        return
    if not np.allclose(said, seen, rtol=1e-3, atol=0):
        raise InputError(
            f"{where}: its coordinates go in steps of {seen[0]:.6g} and {seen[1]:.6g}, its header "
            f"says {said[0]:.6g} and {said[1]:.6g} {stated.get('unit_xy', '')}; write which is "
            "right into the sidecar, 'spacing: [0.1 mm, 0.2 mm]'"
        )


def _points(
    columns: np.ndarray,
    units: Sequence,
    layout: TextLayout,
    options: ScanOptions,
    where: str,
    stated: dict,
) -> RawScan:
    """Points in the units of their columns, y in that of x."""
    _refuse_repeated(columns, layout.breaks, where)
    stated = dict(stated)
    spacing, first_row = stated.pop("spacing", None), stated.pop("first_row", None)
    counted = _counts_cells(columns)
    if counted and (spacing is not None or options.spacing is not None):
        more = {"spacing": spacing} | ({"first_row": first_row} if first_row else {})
        return _counted(columns, units[2], where, stated | more)
    if counted:
        stated["notes"] = (*stated.get("notes", ()), _WHOLE)
    points = np.ascontiguousarray(columns)
    unit_x, unit_y, unit_z = units
    unread = (*stated.pop("unread", ()), *foreign_units(x=unit_x, y=unit_y, z=unit_z))
    lateral = [unit for unit in (unit_x, unit_y) if stated_unit(unit)]
    if lateral:
        stated["unit_xy"] = lateral[0]
    if len(lateral) == 2:
        points[:, 1] *= length_factor(unit_y, where) / length_factor(unit_x, where)
    if stated_unit(unit_z):
        stated["unit_z"] = unit_z
    return RawScan(points, "points", unread=unread, **stated)


def _counts_cells(columns: np.ndarray) -> bool:
    """Whether x and y are whole numbers from 0 or 1 on."""
    lateral = columns[:1000, :2]
    if not np.all(lateral == np.round(lateral)):
        return False
    lateral = columns[:, :2]
    return bool(
        np.isfinite(lateral).all()
        and np.isin(lateral.min(axis=0), (0, 1)).all()
        and np.all(lateral == np.round(lateral))
    )


def _counted(columns: np.ndarray, unit_z: str | None, where: str, stated: dict) -> RawScan:
    """Heights by number of column and row, as a matrix: how far cells lie apart is not said."""
    lateral = columns[:, :2]
    low, high = lateral.min(axis=0), lateral.max(axis=0)
    if not (np.isfinite(lateral).all() and np.all(lateral == np.round(lateral))):
        raise InputError(
            f"{where}: its columns and rows are no whole numbers; write which columns are x, y and "
            "z in the sidecar, for example 'columns: [0, 1, 2]'"
        )
    nx, ny = (int(count) for count in high - low + 1)
    if nx * ny > MOST_EMPTY * len(columns):
        raise InputError(
            f"{where}: {len(columns)} heights for {nx} columns and {ny} rows; remove what is no "
            "height, or export x, y, z"
        )
    heights = np.full((ny, nx), np.nan)
    x, y = (lateral - low).astype(np.intp).T
    heights[y, x] = columns[:, 2]
    notes = (*stated.pop("notes", ()), "x and y count cells: columns and rows of a matrix")
    stated = {"spacing": None, **stated, "notes": notes}
    if stated_unit(unit_z):
        stated["unit_z"] = unit_z
    unread = (*stated.pop("unread", ()), *foreign_units(z=unit_z))
    return RawScan(heights, "matrix", unread=unread, **stated)


def _refuse_other_names(names: list[str] | None, layout: TextLayout, where: str) -> None:
    """Refuse three columns whose names say that they are not x, y and z."""
    if names and (layout.names_are_sure or has_record_names(names)):
        raise InputError(
            f"{where}: its columns are called {', '.join(names)}, which are no x, y and z; if it "
            "is a surface, say in the sidecar which are, for example 'columns: [0, 1, 2]'"
        )


def _refuse_other_order(table: np.ndarray, where: str) -> None:
    """Refuse three columns of which another pair than the first two lies on a grid."""
    if not SMALLEST_SIDE**2 <= len(table) <= MOST_ORDERED:
        return
    levels = [len(np.unique(column)) for column in table.T]
    if levels[0] * levels[1] <= FULL * len(table):
        return
    for x, y, z in ((1, 2, 0), (0, 2, 1)):
        if (
            levels[x] * levels[y] <= FULL * len(table)
            and min(levels[x], levels[y]) >= SMALLEST_SIDE
        ):
            raise InputError(
                f"{where}: its columns {x} and {y}, counted from 0, lie on a grid, the first two "
                f"do not; say in the sidecar which are x, y and z: 'columns: [{x}, {y}, {z}]', or "
                "'columns: [0, 1, 2]' if they stand in this order"
            )


def _refuse_no_matrix(
    table: np.ndarray, names: list[str] | None, layout: TextLayout, where: str
) -> None:
    """Refuse a profile, and a table of different quantities, where a matrix is needed."""
    n_rows, n_columns = table.shape
    if 1 in table.shape:
        line = "row" if n_rows == 1 else "column"
        raise InputError(
            f"{where}: one {line} of {table.size} numbers, a profile or a matrix without its "
            "lines; a surface is needed: export the whole matrix, each row in a line of its own"
        )
    if n_columns == 2 or (n_rows == 2 and n_columns > SMALLEST_SIDE):
        raise InputError(
            f"{where}: {n_rows} rows of {n_columns} numbers are a profile, distance and height; a "
            "surface is needed: export x, y and z, or a matrix of heights"
        )
    if n_columns < SMALLEST_SIDE and n_rows > n_columns:
        called = (
            f"called {', '.join(names)}" if names and layout.names_are_sure else "without names"
        )
        raise InputError(
            f"{where}: {n_columns} columns {called} are neither x, y, z nor a matrix; say "
            "which columns are x, y and z in the sidecar, for example 'columns: [0, 1, 2]'"
        )
    if n_columns < SMALLEST_SIDE:
        return
    is_named = layout.names_are_sure and layout.above is None
    if names and is_named and not numbers_columns(names):
        called = ", ".join(names[:6]) + ", ..." * (n_columns > 6)
        raise InputError(
            f"{where}: its columns are called {called}, different quantities and no matrix of "
            "heights; say in the sidecar which are x, y and z, 'columns: [0, 1, 2]', or 'layout: "
            "matrix'"
        )


def _refuse_unlike_columns(table: np.ndarray, missing: Any, where: str) -> None:
    """Refuse a list of points with colours or normals where a matrix is needed."""
    n_rows, n_columns = table.shape
    if n_columns > FEW_COLUMNS or n_rows <= n_columns:
        return
    marks = missing if isinstance(missing, tuple) else (missing,)
    is_mark = np.isin(table, [mark for mark in marks if isinstance(mark, float | int)])
    present = np.where(is_mark, np.nan, table)[1:, 1:]  # without coordinates beside it
    with np.errstate(invalid="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of columns without any number
        spread = np.ptp(np.nanpercentile(present, [25, 75], axis=0), axis=0)
    spread = spread[spread > 0]
    if spread.size and spread.max() > UNLIKE * spread.min():
        raise InputError(
            f"{where}: its {n_columns} columns scatter by {spread.min():.3g} to "
            f"{spread.max():.3g}, different quantities rather than a matrix of heights; say in "
            "the sidecar which are x, y and z, 'columns: [0, 1, 2]', or 'layout: matrix'"
        )


def _refuse_stacked(table: np.ndarray, breaks: Sequence[int], where: str) -> None:
    """Refuse matrices under one another, parted by a line, or by a step that no row else makes."""
    bounds = [0, *breaks, len(table)]
    sizes = np.diff(bounds)
    with np.errstate(invalid="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of rows without any number
        jumps = np.sqrt(np.nanmean(np.diff(table, axis=0) ** 2, axis=1))
    jumps = np.nan_to_num(jumps)
    if breaks and sizes.min() >= SMALLEST_SIDE:
        steps = jumps[np.array(breaks) - 1]
        if np.ptp(sizes) == 0 or steps.max() > PARTED * np.median(jumps):
            raise stacked(where, len(sizes), int(sizes[0]))
    half = len(table) // 2
    if len(table) == 2 * half and half >= SMALLEST_SIDE:
        others = np.delete(jumps, half - 1)
        if jumps[half - 1] > TORN * others.max():
            raise stacked(where, 2, half)


def _refuse_repeated(points: np.ndarray, breaks: Sequence[int], where: str) -> None:
    """Refuse clouds under one another: parted by a line, at the same places, of other heights."""
    bounds = np.array([0, *breaks, len(points)])
    sizes = np.diff(bounds)
    if not breaks or np.ptp(sizes) or sizes[0] < SMALLEST_SIDE**2:
        return
    blocks = points.reshape(len(sizes), sizes[0], 3)
    corners = np.concatenate([blocks[:, :, :2].min(axis=1), blocks[:, :, :2].max(axis=1)], axis=1)
    if not (corners == corners[0]).all():
        return
    ordered = [block[np.lexsort(block.T[:2])] for block in blocks]
    if all(np.array_equal(block[:, :2], ordered[0][:, :2]) for block in ordered):
        raise stacked(where, *blocks.shape[:2])


def _column_index(column, names, n_columns: int, where: str) -> int:
    if isinstance(column, str):
        if column not in (names or ()):
            has = f"its columns are {listed(names)}" if names else "it names no columns"
            raise InputError(f"{where}: no column {column!r} (key 'columns'); {has}")
        return names.index(column)
    if column >= n_columns:
        raise InputError(
            f"{where}: no column {column} (columns are counted from 0; it has {n_columns}); set "
            "key 'columns' to three that exist"
        )
    return column
