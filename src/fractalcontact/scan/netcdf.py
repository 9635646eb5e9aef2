"""Height maps in netCDF files, classic or 4, with units and coordinates as usual there."""

import math
from pathlib import Path

import numpy as np

from ..errors import InputError
from ..units import length_factor
from .arrays import choose_array, is_table
from .options import ScanOptions
from .raw import RawScan, reading, refuse_larger, stated_unit

#: Coordinates may stray this fraction of a cell from equal steps: float32 leaves as much.
REGULAR = 0.01
_MASK = "mask"


def read_netcdf(path: Path, options: ScanOptions) -> RawScan:
    """Read one 2-D variable.

    Fill values, ``scale_factor`` and ``add_offset`` are applied; where a variable ``mask`` is not
    zero, cells are missing (SurfaceTopography writes its holes so). Dimensions called x and y, or
    with the attribute ``axis``, tell the axes apart; else rows are y. Coordinate variables give
    spacing and direction, the attribute ``units`` (or ``unit``) the units.

    Raises
    ------
    InputError
        If the file is damaged, the wanted variable absent or ambiguous, or a coordinate irregular.
    """
    import netCDF4

    with reading(path, "netCDF file"):
        _refuse_data_elsewhere(path)
        with netCDF4.Dataset(path.resolve()) as file:
            tables = _tables_of(file)
            name = choose_array(list(tables), options.variable, path)
            variable = tables[name]
            refuse_larger(math.prod(variable.shape) * 8, path)
            values = _values(variable)
            axes = [_axis(variable, number, path) for number in (0, 1)]
            unit_z = stated_unit(_attribute(variable, "units", "unit"))
    if axes[0]["letter"] == "x" or axes[1]["letter"] == "y":
        values, axes = values.T, axes[::-1]
    rows, columns = axes
    for number, axis in enumerate(axes):
        if axis["step"] is not None and axis["step"] < 0:
            values = np.flip(values, number)
    return RawScan(
        np.ascontiguousarray(values),
        "matrix",
        reader=f"netCDF4 {netCDF4.__version__} / netcdf",
        unit_z=unit_z,
        notes=(f"variable {name!r}",),
        # The coordinates say where the rows lie, and they are ascending by now.
        first_row=None if rows["step"] is None else "bottom",
        **_spacing(columns, rows),
    )


def _refuse_data_elsewhere(path: Path) -> None:
    """A netCDF-4 file is HDF5, which can point to data in other files."""
    import h5py

    from .hdf5 import refuse_elsewhere

    if not h5py.is_hdf5(path):
        return

    def check(_, item):
        if isinstance(item, h5py.Dataset):
            refuse_elsewhere(item, path)

    with h5py.File(path, "r") as file:
        file.visititems(check)


def _tables_of(group, prefix: str = "") -> dict:
    """The 2-D numeric variables by name, those of sub-groups as ``group/name``."""
    tables = {
        prefix + name: variable
        for name, variable in group.variables.items()
        if name != _MASK
        and isinstance(variable.dtype, np.dtype)  # else a text
        and is_table(variable.shape, variable.dtype)
        and min(variable.shape) > 1
    }
    for name, inner in group.groups.items():
        tables |= _tables_of(inner, f"{prefix}{name}/")
    return tables


def _values(variable) -> np.ndarray:
    values = np.ma.filled(variable[:].astype(np.float64), np.nan)
    mask = variable.group().variables.get(_MASK)
    if mask is not None and mask.dimensions == variable.dimensions:
        mask.set_auto_maskandscale(False)
        values[mask[:] != 0] = np.nan
    return values


def _axis(variable, number: int, path: Path) -> dict:
    """Which axis a dimension is, and the step and unit of its coordinate variable."""
    name = variable.dimensions[number]
    coordinate = _coordinate(variable.group(), name)
    letter = str(_attribute(coordinate, "axis") or name[:1]).lower()
    axis = {"letter": letter if letter in ("x", "y") else None, "step": None, "unit": None}
    if coordinate is None:
        return axis
    places = np.ma.filled(coordinate[:].astype(np.float64), np.nan)
    step = (places[-1] - places[0]) / (len(places) - 1)  # NaN if an end is missing
    strays = np.abs(np.diff(places) - step).max()
    if not strays <= REGULAR * abs(step):
        raise InputError(
            f"{path}: coordinate {name!r} is not equidistant; resample the heights on a regular "
            "grid, or export x, y, z as text"
        )
    return axis | {"step": float(step), "unit": _attribute(coordinate, "units", "unit")}


def _coordinate(group, name: str):
    """The 1-D variable of a dimension, in its group or one above."""
    while group is not None:
        found = group.variables.get(name)
        if found is not None and found.ndim == 1 and found.dtype.kind in "fiu":
            return found
        group = group.parent
    return None


def _attribute(variable, *names):
    """The first of these attributes that the variable has."""
    return next((getattr(variable, n) for n in names if hasattr(variable, n)), None)


def _spacing(columns: dict, rows: dict) -> dict:
    """Spacing and its unit, where both axes have coordinates in one kind of unit."""
    if columns["step"] is None or rows["step"] is None:
        return {}
    dx, dy = abs(columns["step"]), abs(rows["step"])
    units = [stated_unit(axis["unit"]) for axis in (columns, rows)]
    if None not in units:
        dy *= length_factor(units[1], "y") / length_factor(units[0], "x")
        return {"spacing": (dx, dy), "unit_xy": units[0]}
    if columns["unit"] or rows["unit"]:  # degrees, pixels: no length, so no spacing
        return {}
    return {"spacing": (dx, dy)}
