"""What every reader of a file format hands over, in the file's own units."""

import re
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from ..core.errors import InputError
from ..core.units import length_factor

LARGEST_FILE = 4 * 1024**3  # bytes, also for what an archive inflates to or a header promises
#: A matrix or grid needs at least this many cells along each side to hold any roughness.
SMALLEST_SIDE = 8
_UNIT = re.compile(r"[^\W\d_]{1,20}")


@dataclass(frozen=True)
class RawScan:
    """The numbers of one file, before units.

    Attributes
    ----------
    values : ndarray
        A matrix (rows, columns) of heights, or points (n, 3).
    layout : {"matrix", "points", "mesh"}
    reader : str
        Software or method that read the file.
    unit_xy, unit_z : str or None
        Units the file states.
    spacing : (float, float) or None
        dx, dy the file states, in ``unit_xy``.
    first_row : {"bottom", "top"} or None
        Where the first row of a matrix lies; None where the file does not say.
    missing : float or None
        Number the file states for a missing cell.
    notes : tuple of str
        What a user should know about the reading.
    triangles : (m, 3) int ndarray or None
        Of a mesh: rows of ``values``; None for a cloud.
    """

    values: np.ndarray
    layout: str
    reader: str
    unit_xy: str | None = None
    unit_z: str | None = None
    spacing: tuple[float, float] | None = None
    first_row: str | None = None
    missing: float | None = None
    notes: tuple[str, ...] = ()
    triangles: np.ndarray | None = None


def refuse_larger(n_bytes: int, path) -> None:
    """Refuse what would need more than `LARGEST_FILE`, before anything is allocated."""
    if n_bytes > LARGEST_FILE:
        raise InputError(
            f"{path}: {n_bytes / 1024**3:.1f} GiB to read, more than the "
            f"{LARGEST_FILE / 1024**3:g} GiB allowed; export a part of it or a coarser grid"
        )


@contextmanager
def reading(path, kind: str):
    """Turn whatever a library raises over a damaged file into one clean `InputError`.

    Parameters
    ----------
    path : Path
    kind : str
        What the file should be, for the message.
    """
    try:
        yield
    except InputError:
        raise
    except Exception as error:  # libraries raise anything over a file that was made to break them
        reason = f"{type(error).__name__}: {error}".splitlines()[0][:200]
        raise InputError(f"{path}: not a readable {kind} ({reason}); export it again") from error


def stated_unit(text) -> str | None:
    """Take the unit of length a file states; None if it states none, or of something else."""
    text = str(text or "").strip()
    if not _UNIT.fullmatch(text):  # nothing else is handed to the parser of units
        return None
    try:
        length_factor(text, "")
    except InputError:
        return None
    return text


def table_to_raw(table, names, options, where, **stated) -> RawScan:
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
    return RawScan(np.ascontiguousarray(table[:, chosen]), "points", **stated)


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
