"""Matrices in MATLAB files of version 4, 5 and 7 (scipy) and 7.3 (HDF5)."""

import math
from functools import partial
from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ..array_hints import require_array
from ..format import Format
from ..options import ScanOptions
from ..raw import RawScan, reading, refuse_larger
from ..tables import choose_array, table_to_raw
from ..variables import choose_variable, open_variables, single_numbers, table_names

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
        # HDF5 counts rows first, MATLAB columns.
        tables = {name: variables[name].shape[::-1] for name in names}
        single = partial(single_numbers, variables)
        require_array(path, options, tables, lambda name: variables[name].read().T, single)
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

    def single() -> dict[str, float]:
        names = (name for name, shape in every.items() if shape == (1, 1))
        return {name: float(read(name).real.item()) for name in names}

    require_array(path, options, tables, read, single)
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
        # whosmat of scipy 1.17 fails over objects without a shape, such as MATLAB's strings.
        # loadmat skips them and never opens them.
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


FORMAT = Format(
    read_mat, endings=(".mat",), keys=("layout", "axes", "columns"), libraries=("scipy.io", "h5py")
)
