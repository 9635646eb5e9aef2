"""Which array of a file holds the heights, and whether a table is a matrix or a list of points."""

from pathlib import Path
from typing import Any

import numpy as np

from ..core.errors import InputError
from .options import ScanOptions
from .raw import SMALLEST_SIDE, RawScan


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
    has = f"it has {', '.join(names)}"
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
        raise InputError(
            f"{path}: no channel {wanted!r} (key 'variable'); it has {', '.join(names)}"
        )


def table_to_raw(
    table: np.ndarray, names: list[str] | None, options: ScanOptions, where: str, **stated: Any
) -> RawScan:
    """Decide whether a table of numbers is a matrix of heights or a list of points.

    Parameters
    ----------
    table : ndarray, shape (rows, columns)
    names : list of str or None
        Column names, where the file has them.
    options : ScanOptions
    where : str
        The file, for errors.
    **stated
        Further fields of `RawScan`.

    Raises
    ------
    InputError
        If neither its width nor its column names tell, or a wanted column is absent.
    """
    columns = options.columns or _named_xyz(names)
    n_columns = table.shape[1]
    layout = options.layout or ("points" if columns or n_columns == 3 else "matrix")
    if layout == "matrix":
        if options.layout is None and n_columns < SMALLEST_SIDE and len(table) > n_columns:
            raise InputError(
                f"{where}: {n_columns} columns without names are neither x, y, z nor a matrix; say "
                "which columns are x, y and z in the sidecar, for example 'columns: [0, 1, 2]'"
            )
        return RawScan(table, "matrix", **stated)
    chosen = [_column_index(c, names, n_columns, where) for c in columns or (0, 1, 2)]
    if chosen != list(range(n_columns)):  # else a copy of all would be in vain
        table = table[:, chosen]
    return RawScan(np.ascontiguousarray(table), "points", **stated)


def _named_xyz(names) -> list[int] | None:
    """Find columns called x, y and z, whatever their case or unit in brackets."""
    plain = [name.split("(")[0].split("[")[0].strip().lower() for name in names or ()]
    return [plain.index(axis) for axis in "xyz"] if {"x", "y", "z"} <= set(plain) else None


def _column_index(column, names, n_columns: int, where: str) -> int:
    if isinstance(column, str):
        if column not in (names or ()):
            has = f"its columns are {', '.join(names)}" if names else "it names no columns"
            raise InputError(f"{where}: no column {column!r} (key 'columns'); {has}")
        return names.index(column)
    if column >= n_columns:
        raise InputError(
            f"{where}: no column {column} (columns are counted from 0; it has {n_columns}); set "
            "key 'columns' to three that exist"
        )
    return column
