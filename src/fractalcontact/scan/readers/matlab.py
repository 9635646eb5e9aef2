"""Matrices in MATLAB files of version 4, 5 and 7 (scipy) and 7.3 (HDF5)."""

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ..array_hints import array_hints
from ..format import Format
from ..options import ScanOptions
from ..raw import RawScan, reading, refuse_larger
from ..stated import Needs, require_stated
from ..tables import choose_array, table_to_raw
from ..variables import choose_variable, open_variables, table_names

#: MATLAB's classes that are plain numbers; cells, structs, objects and functions are never opened.
_NUMERIC = {"double", "single", *(f"{u}int{bits}" for u in ("", "u") for bits in (8, 16, 32, 64))}
_HDF5_HEADER = b"MATLAB 7.3 MAT-file"


def read_mat(path: Path, options: ScanOptions) -> RawScan:
    """One matrix of a ``.mat`` file and the headers of the others; a complex one is refused."""
    with open(path, "rb") as stream:
        is_hdf5 = stream.read(len(_HDF5_HEADER)) == _HDF5_HEADER
    with reading(path, ".mat file"):
        name, values, reader = (_read_7_3 if is_hdf5 else _read_old)(path, options)
    notes = (f"matrix {name!r}",)
    return table_to_raw(values, options, str(path), reader=reader, notes=notes)


def _read_7_3(path: Path, options: ScanOptions):
    import h5py

    with open_variables(path) as variables:
        names = table_names(variables)
        # HDF5 counts rows first, MATLAB columns; its single numbers are 1 x 1.
        tables = {name: variables[name].shape[::-1] for name in names}
        small = {
            name: float(variable.read().ravel()[0])
            for name, variable in variables.items()
            if variable.shape == (1, 1) and variable.dtype.kind in "fiu"
        }
        _require(path, options, tables, small, lambda name: variables[name].read().T)
        name = choose_variable(variables, options.variable, path)
        values = variables[name].read().astype(np.float64)
    return name, np.ascontiguousarray(values.T), f"h5py {h5py.__version__} / mat 7.3"


def _read_old(path: Path, options: ScanOptions):
    import scipy
    from scipy.io import loadmat

    every = _tables(path)
    tables = {name: shape for name, shape in every.items() if min(shape) > 1}

    def read(name: str) -> np.ndarray:
        return loadmat(path, appendmat=False, variable_names=[name])[name]

    single = [name for name, shape in every.items() if shape == (1, 1)]
    small = {name: float(read(name).real.item()) for name in single}
    _require(path, options, tables, small, read)
    name = choose_array(list(tables), options.variable, path)
    refuse_larger(math.prod(tables[name]) * 8, path)
    values = read(name)
    if values.dtype.kind not in "fiu":
        raise InputError(f"{path}: matrix {name!r} is {values.dtype}; heights are real numbers")
    return name, values.astype(np.float64), f"scipy {scipy.__version__} / mat"


def _tables(path: Path) -> dict[str, tuple]:
    """Shapes of the 2-D matrices of numbers, by name."""
    from scipy.io import loadmat, whosmat

    try:
        headers = whosmat(path, appendmat=False)
    except TypeError:
        # It fails over objects, such as MATLAB's strings, which have no shape (scipy 1.17);
        # loadmat passes them over. They are never opened.
        loaded = loadmat(path, appendmat=False)
        headers = [
            (name, values.shape, "double")
            for name, values in loaded.items()
            if isinstance(values, np.ndarray) and values.dtype.kind in "fiu"
        ]
    return {
        name: shape
        for name, shape, kind in headers
        if kind in _NUMERIC and len(shape) == 2 and 0 not in shape
    }


def _require(
    path: Path,
    options: ScanOptions,
    tables: dict[str, tuple],
    small: dict[str, float],
    read: Callable[[str], np.ndarray],
) -> None:
    """Refuse matrices of which the sidecar does not say all."""
    needs = Needs(table=True, arrays=list(tables))
    require_stated(path, options, needs, lambda: array_hints(tables, options.variable, small, read))


FORMAT = Format(
    read_mat, endings=(".mat",), keys=("layout", "axes", "columns"), libraries=("scipy.io", "h5py")
)
