"""Matrices in HDF5 files, and in MATLAB's 7.3, which are HDF5."""

import math
from pathlib import Path

from ..errors import InputError
from .arrays import choose_array, is_table
from .options import ScanOptions
from .raw import RawScan, reading, refuse_larger, stated_unit, table_to_raw


def read_hdf5(path: Path, options: ScanOptions) -> RawScan:
    """Read one 2-D dataset; its attribute ``units`` gives the unit of the heights, if any.

    Raises
    ------
    InputError
        If the file is damaged, the wanted dataset is absent or ambiguous, or lies in another file.
    """
    with reading(path, "HDF5 file"):
        name, values, unit = read_dataset(path, options.variable)
    import h5py

    return table_to_raw(
        values,
        None,
        options,
        str(path),
        reader=f"h5py {h5py.__version__} / hdf5",
        unit_z=stated_unit(unit),
        notes=(f"dataset {name!r}",),
    )


def read_dataset(path: Path, wanted: str | None):
    """Read the wanted, or the only, 2-D numeric dataset.

    Returns
    -------
    name : str
    values : ndarray
        float64, as stored.
    unit : str
        Its attribute ``units`` or ``unit``, "" if it has none.
    """
    import h5py

    with h5py.File(path, "r") as file:
        tables = _tables_of(file)
        name = choose_array(list(tables), wanted, path)
        dataset = tables[name]
        refuse_elsewhere(dataset, path)
        refuse_larger(math.prod(dataset.shape) * 8, path)
        if dataset.chunks:
            refuse_larger(math.prod(dataset.chunks) * dataset.dtype.itemsize, path)
        unit = dataset.attrs.get("units", dataset.attrs.get("unit", ""))
        unit = unit.decode(errors="replace") if isinstance(unit, bytes) else unit
        return name, dataset.astype("f8")[()], unit


def _tables_of(file) -> dict:
    """The 2-D numeric datasets by name. Links into other files are not followed."""
    import h5py

    tables = {}

    def collect(name, item):
        is_data = isinstance(item, h5py.Dataset) and item.shape and min(item.shape) > 1
        # MATLAB keeps the content of cells and structs under #refs#.
        if is_data and is_table(item.shape, item.dtype) and not name.startswith("#"):
            tables[name] = item

    file.visititems(collect)
    return tables


def refuse_elsewhere(dataset, path: Path) -> None:
    """Refuse a dataset whose numbers lie in other files: a stranger may name any file there."""
    if dataset.external or dataset.is_virtual:
        raise InputError(
            f"{path}: dataset {dataset.name!r} lies in another file; store the numbers in this one"
        )
