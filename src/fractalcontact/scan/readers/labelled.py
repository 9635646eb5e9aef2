"""Height maps in netCDF and HDF5 files, with units and coordinates as is usual there."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ...core.units import length_factor
from ..format import Format
from ..options import ScanOptions
from ..raw import RawScan, foreign_units, reading, stated_unit
from ..tables import table_to_raw
from ..variables import MASK, Variable, choose_variable, open_variables

#: Coordinates may stray this fraction of a cell from equal steps: float32 leaves as much.
REGULAR = 0.01
#: What netCDF leaves in cells that nobody wrote.
_UNWRITTEN = {
    "f4": 9.969209968386869e36,
    "f8": 9.969209968386869e36,
    "i2": -32767,
    "i4": -(2**31) + 1,
}


@dataclass(frozen=True)
class Axis:
    """One axis of a matrix: "x", "y" or "", signed step and unit of its coordinates, if any."""

    letter: str
    step: float | None = None
    unit: str | None = None


def read_labelled(path: Path, options: ScanOptions) -> RawScan:
    """Read one 2-D variable of a netCDF or HDF5 file.

    Fill values, ``scale_factor`` and ``add_offset`` are applied (CF conventions); where a variable
    ``mask`` is not zero, cells are missing (SurfaceTopography's convention). Dimensions called x
    and y, or with the attribute ``axis``, distinguish the axes; else rows are y. Coordinates give
    spacing and direction, attributes ``units`` (or ``unit``) the units.

    Raises
    ------
    InputError
        If the file is damaged, the wanted variable absent or ambiguous, a coordinate irregular, or
        the data lie in another file.
    """
    with reading(path, "netCDF or HDF5 file"), open_variables(path) as variables:
        name = choose_variable(variables, options.variable, path)
        values = _values(name, variables)
        axes = [_axis(dimension, variables, path) for dimension in variables[name].dimensions]
        unit = _unit(variables[name])
    if axes[0].letter == "x" or axes[1].letter == "y":
        values, axes = values.T, axes[::-1]
    for number, axis in enumerate(axes):
        if axis.step is not None and axis.step < 0:
            values = np.flip(values, number)
    rows, columns = axes
    stated = {
        "reader": _reader(path),
        "unit_z": stated_unit(unit),
        "unread": foreign_units(z=unit, x=columns.unit, y=rows.unit),
        "notes": (f"variable {name!r}",),
        # The coordinates say where the rows lie, and they ascend by now.
        "first_row": None if rows.step is None else "bottom",
        **_spacing(columns, rows),
    }
    values = np.ascontiguousarray(values)
    if "spacing" in stated:
        return RawScan(values, "matrix", **stated)
    return table_to_raw(values, None, options, str(path), **stated)


def _values(name: str, variables: dict) -> np.ndarray:
    """Numbers in the file's unit, NaN where missing."""
    variable = variables[name]
    stored = variable.read()
    values = stored.astype(np.float64)
    absent = ~_is_valid(stored, variable.attributes)
    group, slash, _ = name.rpartition("/")
    mask = variables.get(group + slash + MASK)
    if mask is not None and mask.shape == values.shape:
        absent |= mask.read() != 0
    values = values * _number(variable, "scale_factor", 1) + _number(variable, "add_offset", 0)
    values[absent] = np.nan
    return values


def _is_valid(stored: np.ndarray, attributes: dict) -> np.ndarray:
    """Neither a fill value nor outside the valid range; all three count before scaling (CF 2.5)."""
    valid = np.ones(stored.shape, dtype=bool)
    fills = [attributes.get("_FillValue", _UNWRITTEN.get(stored.dtype.str[1:]))]
    for fill in (*fills, attributes.get("missing_value")):
        if fill is not None:
            valid &= ~np.isin(stored, np.asarray(fill, dtype=stored.dtype))
    low, high = attributes.get("valid_range", (None, None))
    if (low := attributes.get("valid_min", low)) is not None:
        valid &= stored >= low
    if (high := attributes.get("valid_max", high)) is not None:
        valid &= stored <= high
    return valid


def _number(variable: Variable, attribute: str, default: float) -> float:
    return np.asarray(variable.attributes.get(attribute, default), dtype=np.float64).item()


def _unit(variable: Variable):
    return variable.attributes.get("units", variable.attributes.get("unit"))


def _axis(dimension: str, variables: dict, path: Path) -> Axis:
    """Which axis a dimension is, and the step and unit of its coordinates."""
    name = dimension.rpartition("/")[2]
    coordinate = variables.get(dimension)
    if coordinate is None or len(coordinate.shape) != 1 or coordinate.dtype.kind not in "fiu":
        return Axis(_letter(name))
    letter = _letter(str(coordinate.attributes.get("axis") or name))
    places = coordinate.read().astype(np.float64)
    step = (places[-1] - places[0]) / (len(places) - 1)
    strays = np.abs(np.diff(places) - step).max()
    if not strays <= REGULAR * abs(step):  # also where one is NaN
        raise InputError(
            f"{path}: coordinate {name!r} is not equidistant; resample the heights on a regular "
            "grid, or export x, y, z as text"
        )
    return Axis(letter, float(step), _unit(coordinate))


def _letter(name: str) -> str:
    first = name[:1].lower()
    return first if first in ("x", "y") else ""


def _spacing(columns: Axis, rows: Axis) -> dict:
    """Spacing and its unit, where both axes have coordinates in one kind of unit."""
    if columns.step is None or rows.step is None:
        return {}
    dx, dy = abs(columns.step), abs(rows.step)
    unit_x, unit_y = stated_unit(columns.unit), stated_unit(rows.unit)
    if unit_x and unit_y:
        dy *= length_factor(unit_y, "y") / length_factor(unit_x, "x")
        return {"spacing": (dx, dy), "unit_xy": unit_x}
    if columns.unit or rows.unit:  # degrees, pixels: no length, so no spacing
        return {}
    return {"spacing": (dx, dy)}


def _reader(path: Path) -> str:
    import h5py
    import scipy

    if h5py.is_hdf5(path):
        return f"h5py {h5py.__version__} / {path.suffix.lstrip('.').lower()}"
    return f"scipy {scipy.__version__} / netCDF classic"


FORMAT = Format(read_labelled, endings=(".h5", ".hdf5", ".nc"), libraries=("h5py", "scipy.io"))
