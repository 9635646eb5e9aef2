"""The arrays of HDF5, netCDF-4 and classic netCDF files, looked at before any number is read.

h5py and scipy open them rather than the netCDF library, which hangs over some damaged files.
"""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ..core.errors import InputError
from .raw import refuse_larger
from .tables import choose_array, is_table

MASK = "mask"
_ATTRIBUTES = (
    *("units", "unit", "axis", "standard_name", "positive", "scale_factor", "add_offset"),
    *("_Unsigned", "spacing"),
    *("_FillValue", "missing_value", "valid_min", "valid_max", "valid_range"),
)
#: Mark of netCDF-4 in HDF5 for a dimension without coordinates.
_NO_COORDINATES = b"This is a netCDF dimension but not a netCDF variable"


@dataclass(frozen=True)
class Variable:
    """Array in a file."""

    shape: tuple
    dtype: np.dtype
    dimensions: tuple  # names of the variables of coordinates, one an axis
    attributes: dict  # those that determine the meaning of the numbers
    read: Callable[[], np.ndarray]  # returns the numbers as stored


@contextmanager
def open_variables(path: Path) -> Iterator[dict[str, Variable]]:
    """Open a file and list its variables by name, those in groups as ``group/name``."""
    import h5py

    with (_open_hdf5 if h5py.is_hdf5(path) else _open_classic)(path) as variables:
        yield variables


def choose_variable(variables: dict, wanted: str | None, path: Path) -> str:
    """Name of the wanted or only 2-D numeric variable; a huge one is refused."""
    name = choose_array(table_names(variables), wanted, path)
    refuse_larger(math.prod(variables[name].shape) * 8, path)
    return name


def table_names(variables: dict) -> list[str]:
    """Names of the 2-D numeric variables."""
    return [
        name
        for name, variable in variables.items()
        if is_table(variable.shape, variable.dtype)
        and min(variable.shape) > 1
        and name.rpartition("/")[2] != MASK
    ]


def single_numbers(variables: dict) -> dict[str, float]:
    """Variables that hold one number alone, by name."""
    return {
        name: float(variable.read().ravel()[0])
        for name, variable in variables.items()
        if math.prod(variable.shape) == 1 and variable.dtype.kind in "fiu"
    }


@contextmanager
def _open_classic(path: Path):
    from scipy.io import netcdf_file

    with netcdf_file(path, mmap=False, maskandscale=False) as file:
        yield {
            name: Variable(
                variable.shape,
                variable.data.dtype,
                variable.dimensions,
                _attributes(variable._attributes),
                partial(np.array, variable.data),
            )
            for name, variable in file.variables.items()
        }


@contextmanager
def _open_hdf5(path: Path):
    import h5py

    with h5py.File(path, "r") as file:
        variables: dict[str, Variable] = {}

        def collect(name: str, item: h5py.HLObject) -> None:
            # MATLAB keeps the content of cells and structs under #refs#.
            if not isinstance(item, h5py.Dataset) or not item.shape or name.startswith("#"):
                return
            if not bytes(item.attrs.get("NAME", b"")).startswith(_NO_COORDINATES):
                dimensions = tuple(_dimension(axis) for axis in item.dims)
                read = partial(_read_hdf5, item, path)
                attributes = _attributes(item.attrs)
                variables[name] = Variable(item.shape, item.dtype, dimensions, attributes, read)

        file.visititems(collect)  # links into other files are not followed
        yield variables


def _dimension(axis) -> str:
    return axis[0].name.lstrip("/") if len(axis) else axis.label


def _read_hdf5(dataset, path: Path) -> np.ndarray:
    """The numbers, unless they lie in other files: untrusted input may name any file there."""
    if dataset.external or dataset.is_virtual:
        raise InputError(
            f"{path}: dataset {dataset.name!r} lies in another file; store the numbers in this one"
        )
    if dataset.chunks:  # a chunk is unpacked as a whole
        refuse_larger(math.prod(dataset.chunks) * dataset.dtype.itemsize, path)
    return dataset[()]


def _attributes(stored) -> dict:
    """Known attributes, texts as str."""
    attributes = {name: stored[name] for name in _ATTRIBUTES if name in stored}
    return {name: _plain(value) for name, value in attributes.items()}


def _plain(value: Any) -> Any:
    """Plain value of an attribute: the number of an array of one, text of bytes."""
    if isinstance(value, np.ndarray) and value.size == 1:
        value = value.ravel()[0]
    return value.decode(errors="replace") if isinstance(value, bytes) else value
