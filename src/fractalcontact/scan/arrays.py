"""Matrices and point lists saved by numpy. Nothing pickled is ever opened."""

import zipfile
from pathlib import Path

import numpy as np

from ..errors import InputError
from .options import ScanOptions
from .raw import RawScan, table_to_raw

_HEADER_READERS = {
    (1, 0): np.lib.format.read_array_header_1_0,
    (2, 0): np.lib.format.read_array_header_2_0,
}


def read_npy(path: Path, options: ScanOptions) -> RawScan:
    """Read a ``.npy`` file.

    Raises
    ------
    InputError
        If it is damaged, pickled, or no 2-D array of numbers.
    """
    try:
        # Mapped, so that a header promising more than the file holds fails at once.
        values = np.load(path, mmap_mode="r", allow_pickle=False)
    except (ValueError, OSError, EOFError) as error:
        raise InputError(f"{path}: not a readable .npy array ({error})") from error
    if not _is_table(values.shape, values.dtype):
        raise InputError(
            f"{path}: expected a 2-D array of numbers, found {values.dtype} of shape {values.shape}"
        )
    return table_to_raw(_as_float(values), None, options, str(path), reader=_reader())


def read_npz(path: Path, options: ScanOptions) -> RawScan:
    """Read one array of a ``.npz`` file; of the others only the header is looked at.

    Raises
    ------
    InputError
        If it is damaged, or the wanted array is absent, ambiguous or pickled.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            tables = _tables_of(archive)
        variable = _choose(tables, options.variable, path)
        with np.load(path, allow_pickle=False) as archive:
            values = archive[variable]
    except InputError:
        raise
    except (ValueError, OSError, EOFError, zipfile.BadZipFile) as error:
        raise InputError(f"{path}: not a readable .npz archive ({error})") from error
    notes = (f"array {variable!r} of the archive",)
    return table_to_raw(_as_float(values), None, options, str(path), reader=_reader(), notes=notes)


def _tables_of(archive: zipfile.ZipFile) -> list[str]:
    """Name the 2-D numeric arrays of an archive, judged by their headers alone."""
    tables = []
    for member in archive.infolist():
        with archive.open(member) as stream:
            read_header = _HEADER_READERS.get(np.lib.format.read_magic(stream))
            if read_header is None:
                continue
            shape, _, dtype = read_header(stream)
        if _is_table(shape, dtype) and np.prod(shape) * dtype.itemsize <= member.file_size:
            tables.append(member.filename.removesuffix(".npy"))
    return tables


def _choose(tables: list[str], variable: str | None, path: Path) -> str:
    has = f"it has {', '.join(tables) or 'none'}"
    if variable is not None:
        if variable not in tables:
            raise InputError(
                f"{path}: key 'variable' is {variable!r}, no 2-D array of numbers; {has}"
            )
        return variable
    if len(tables) != 1:
        raise InputError(
            f"{path}: which array holds the heights? Name one 2-D array of numbers in the sidecar, "
            f"'variable: NAME'; {has}"
        )
    return tables[0]


def _is_table(shape: tuple, dtype: np.dtype) -> bool:
    return len(shape) == 2 and dtype.kind in "fiu"


def _as_float(values) -> np.ndarray:
    return np.array(values, dtype=np.float64)


def _reader() -> str:
    return f"numpy {np.__version__}"
