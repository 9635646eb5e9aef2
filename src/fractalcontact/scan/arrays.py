"""Matrices and point lists saved by numpy. Nothing pickled is ever opened."""

import math
import zipfile
from pathlib import Path

import numpy as np

from ..core.errors import InputError
from .options import ScanOptions
from .raw import RawScan, reading, refuse_larger, table_to_raw

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
    with reading(path, ".npy array"):
        _refuse_pickled(path)
        # Mapped, so that a header promising more than the file holds fails at once.
        values = np.load(path, mmap_mode="r", allow_pickle=False)
    if not is_table(values.shape, values.dtype):
        raise InputError(
            f"{path}: expected a 2-D array of numbers, found {values.dtype} of shape {values.shape}"
        )
    refuse_larger(values.size * 8, path)
    return table_to_raw(_as_float(values), None, options, str(path), reader=_reader("npy"))


def read_npz(path: Path, options: ScanOptions) -> RawScan:
    """Read one array of a ``.npz`` file; of the others only the header is looked at.

    Raises
    ------
    InputError
        If it is damaged, or the wanted array is absent, ambiguous or pickled.
    """
    with reading(path, ".npz archive"):
        with zipfile.ZipFile(path) as archive:
            tables = _tables_of(archive)
        variable = choose_array(list(tables), options.variable, path)
        refuse_larger(math.prod(tables[variable]) * 8, path)
        with np.load(path, allow_pickle=False) as archive:
            values = archive[variable]
    notes = (f"array {variable!r} of the archive",)
    return table_to_raw(
        _as_float(values), None, options, str(path), reader=_reader("npz"), notes=notes
    )


def _refuse_pickled(path: Path) -> None:
    """Say in our own words what numpy would advise to open unsafely."""
    with open(path, "rb") as stream:
        read_header = _HEADER_READERS.get(np.lib.format.read_magic(stream))
        if read_header and read_header(stream)[2].hasobject:
            raise InputError(
                f"{path}: it holds pickled Python objects, which are never opened; save the "
                "heights as an array of numbers"
            )


def _tables_of(archive: zipfile.ZipFile) -> dict[str, tuple]:
    """Shapes of the 2-D numeric arrays of an archive by name, judged by their headers alone."""
    tables = {}
    for member in archive.infolist():
        with archive.open(member) as stream:
            read_header = _HEADER_READERS.get(np.lib.format.read_magic(stream))
            if read_header is None:
                continue
            shape, _, dtype = read_header(stream)
        if is_table(shape, dtype) and math.prod(shape) * dtype.itemsize <= member.file_size:
            tables[member.filename.removesuffix(".npy")] = shape
    return tables


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


def _as_float(values) -> np.ndarray:
    return np.array(values, dtype=np.float64)


def _reader(kind: str) -> str:
    return f"numpy {np.__version__} / {kind}"
