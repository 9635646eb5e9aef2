"""Matrices and point lists saved by numpy. Nothing pickled is ever opened."""

import contextlib
import math
import zipfile
from functools import partial
from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ..array_hints import require_array
from ..format import Format
from ..options import ScanOptions
from ..raw import RawScan, reading, refuse_larger
from ..tables import choose_array, is_table, table_to_raw

_HEADER_READERS = {
    (1, 0): np.lib.format.read_array_header_1_0,
    (2, 0): np.lib.format.read_array_header_2_0,
}

_SMALL = 1000  # bytes of an array of one number


def read_npy(path: Path, options: ScanOptions) -> RawScan:
    """Array of a ``.npy`` file; a damaged or pickled one is refused."""
    with reading(path, ".npy array"):
        _refuse_pickled(path)
        # Mapped, so that a header promising more than the file holds fails at once.
        values = np.load(path, mmap_mode="r", allow_pickle=False)
    if not is_table(values.shape, values.dtype):
        raise InputError(
            f"{path}: expected a 2-D array of numbers, found {values.dtype} of shape {values.shape}"
        )
    refuse_larger(values.size * 8, path)
    require_array(path, options, {"": values.shape}, lambda name: values)
    return table_to_raw(_as_float(values), options, str(path), reader=_reader("npy"))


def read_npz(path: Path, options: ScanOptions) -> RawScan:
    """One array of a ``.npz`` file and the headers of the others; a pickled one is refused."""
    with reading(path, ".npz archive"):
        with zipfile.ZipFile(path) as archive:
            tables = _tables_of(archive)
        read = partial(_array_of, path)
        require_array(path, options, tables, read, partial(_single_numbers, path))
        variable = choose_array(list(tables), options.variable, path)
        refuse_larger(math.prod(tables[variable]) * 8, path)
        values = read(variable)
    notes = (f"array {variable!r} of the archive",)
    return table_to_raw(_as_float(values), options, str(path), reader=_reader("npz"), notes=notes)


def _array_of(path: Path, name: str) -> np.ndarray:
    with np.load(path, allow_pickle=False) as archive:
        return archive[name]


def _single_numbers(path: Path) -> dict[str, float]:
    """Single numbers of an archive by name: a spacing may be among them."""
    with zipfile.ZipFile(path) as archive:
        small = [m.filename for m in archive.infolist() if m.file_size < _SMALL]
    numbers = {}
    for member in small:
        name = member.removesuffix(".npy")
        with contextlib.suppress(ValueError, KeyError):  # pickled, or no array
            values = _array_of(path, name)
            if values.size == 1 and values.dtype.kind in "fiu":
                numbers[name] = float(values.ravel()[0])
    return numbers


def _refuse_pickled(path: Path) -> None:
    """Refuse pickled objects with a message of our own; numpy's advises an unsafe way."""
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


def _as_float(values) -> np.ndarray:
    return np.array(values, dtype=np.float64)


def _reader(kind: str) -> str:
    return f"numpy {np.__version__} / {kind}"


def _read(path: Path, options: ScanOptions) -> RawScan:
    return (read_npy if path.suffix.lower() == ".npy" else read_npz)(path, options)


FORMAT = Format(_read, endings=(".npy", ".npz"), keys=("layout", "axes", "columns"))
