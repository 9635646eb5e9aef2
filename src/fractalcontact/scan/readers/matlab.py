"""Matrices in MATLAB files of version 4, 5 and 7 (scipy) and 7.3 (HDF5)."""

import math
from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ..format import Format
from ..options import ScanOptions
from ..raw import RawScan, reading, refuse_larger
from ..tables import choose_array, table_to_raw
from ..variables import choose_variable, open_variables

#: MATLAB's classes that are plain numbers; cells, structs, objects and functions are never opened.
_NUMERIC = {"double", "single", *(f"{u}int{bits}" for u in ("", "u") for bits in (8, 16, 32, 64))}
_HDF5_HEADER = b"MATLAB 7.3 MAT-file"


def read_mat(path: Path, options: ScanOptions) -> RawScan:
    """Read one matrix of a ``.mat`` file; of the others only the header is looked at.

    Raises
    ------
    InputError
        If the file is damaged, or the wanted matrix is absent, ambiguous, complex or no numbers.
    """
    with open(path, "rb") as stream:
        is_hdf5 = stream.read(len(_HDF5_HEADER)) == _HDF5_HEADER
    with reading(path, ".mat file"):
        name, values, reader = (_read_7_3 if is_hdf5 else _read_old)(path, options.variable)
    notes = (f"matrix {name!r}",)
    return table_to_raw(values, None, options, str(path), reader=reader, notes=notes)


def _read_7_3(path: Path, wanted: str | None):
    import h5py

    with open_variables(path) as variables:
        name = choose_variable(variables, wanted, path)
        values = variables[name].read().astype(np.float64)
    # HDF5 counts rows first, MATLAB columns.
    return name, np.ascontiguousarray(values.T), f"h5py {h5py.__version__} / mat 7.3"


def _read_old(path: Path, wanted: str | None):
    import scipy
    from scipy.io import loadmat

    tables = _tables(path)
    name = choose_array(list(tables), wanted, path)
    refuse_larger(math.prod(tables[name]) * 8, path)
    values = loadmat(path, appendmat=False, variable_names=[name])[name]
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
        if kind in _NUMERIC and len(shape) == 2 and min(shape) > 1
    }


FORMAT = Format(read_mat, endings=(".mat",), libraries=("scipy.io", "h5py"))
