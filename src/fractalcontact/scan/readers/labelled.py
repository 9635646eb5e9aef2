"""Height maps in netCDF and HDF5 files: by the CF conventions, or as their sidecar says."""

import re
import warnings
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ...core.labels import printable
from ...core.text import percent
from ...core.units import length_factor
from ...gridding.ungridded import NOTE
from ..array_hints import require_array
from ..format import Format
from ..options import ScanOptions
from ..raw import RawScan, reading, stated_unit
from ..tables import table_to_raw
from ..variables import (
    MASK,
    Variable,
    choose_variable,
    open_variables,
    single_numbers,
    table_names,
)

#: Largest distance of coordinates from equal steps, as a fraction of a cell: float32 leaves as
#: much.
REGULAR = 0.01
#: Numbers that netCDF leaves in cells that were not written.
_UNWRITTEN = {
    "f4": 9.969209968386869e36,
    "f8": 9.969209968386869e36,
    "i2": -32767,
    "i4": -(2**31) + 1,
}
_LETTERS = {"projection_x_coordinate": "x", "projection_y_coordinate": "y"}


@dataclass(frozen=True)
class Axis:
    """Axis of a matrix: "x" or "y", signed step and unit of its coordinates."""

    letter: str
    step: float
    unit: str


def read_labelled(path: Path, options: ScanOptions) -> RawScan:
    """2-D variable of a netCDF or HDF5 file.

    A variable describes itself if its attribute ``units`` and those of its coordinates x and y are
    units of length; its ``positive: down`` is then honoured. Any other is read as its sidecar
    states, and so is one whose sidecar states ``layout``, ``axes`` or ``columns``. Packing, fill
    values and valid ranges are decoded (CF conventions); where a variable ``mask`` is not zero,
    cells are missing (SurfaceTopography's convention).
    """
    with reading(path, "netCDF or HDF5 file"), open_variables(path) as variables:
        names = table_names(variables)
        wanted = options.variable or (names[0] if len(names) == 1 else None)
        laid_out = options.layout or options.axes or options.columns
        axes = None if laid_out else _coordinates(variables.get(wanted or ""), variables, path)
        if axes is None and not (len(names) > 1 and wanted is None and _any_conforms(variables)):
            tables = {name: variables[name].shape for name in names}
            single, words = partial(single_numbers, variables), _words(variables, names)
            require_array(
                path, options, tables, lambda name: decoded(variables[name])[0], single, words
            )
        name = choose_variable(variables, options.variable, path)
        values, notes = _values(name, variables)
    notes = (f"variable {name!r}", *notes)
    if axes is None:
        return table_to_raw(values, options, str(path), reader=_reader(path), notes=notes)
    attributes = variables[name].attributes
    if axes[0].letter == "x":
        values, axes = values.T, axes[::-1]
    for number, axis in enumerate(axes):
        if axis.step < 0:
            values = np.flip(values, number)
    rows, columns = axes
    dy = abs(rows.step) * length_factor(rows.unit, "y") / length_factor(columns.unit, "x")
    return RawScan(
        np.ascontiguousarray(values),
        "matrix",
        reader=_reader(path),
        unit_xy=columns.unit,
        unit_z=_unit(variables[name]),
        spacing=(abs(columns.step), dy),
        # Rows ascend in y by now, as their coordinates state.
        first_row="bottom",
        heights=_direction(attributes, options, f"{path}: variable {name!r}"),
        notes=notes,
    )


def _direction(attributes: dict, options: ScanOptions, where: str) -> str:
    """Direction in which heights grow, by the attribute ``positive``; up without it."""
    said = str(attributes.get("positive", "up")).strip("\0 ").lower()
    for direction in ("up", "down"):
        if re.fullmatch(rf"{direction}(wards?)?", said):
            return direction
    if options.heights is not None:
        return options.heights
    raise InputError(
        f"{where} is positive {printable(said, 40)!r}, which is neither up nor down; write "
        "'heights: up' or 'heights: down' into the sidecar"
    )


def _any_conforms(variables: dict) -> bool:
    """True if the unit of a variable says that the file is labelled: only its choice is open."""
    return any(_unit(v) for v in variables.values() if len(v.shape) == 2)


def _values(name: str, variables: dict) -> tuple[np.ndarray, tuple[str, ...]]:
    """Numbers in the file's unit, NaN where missing, and notes."""
    variable = variables[name]
    values, outside = decoded(variable)
    group, slash, _ = name.rpartition("/")
    mask = variables.get(group + slash + MASK)
    if mask is not None and mask.shape == values.shape:
        values[mask.read() != 0] = np.nan
    if not outside:
        return values, ()
    share = percent(outside / values.size)
    note = f"{NOTE}{share} of the cells lie outside the valid range that the file states: missing"
    return values, (note,)


def decoded(variable: Variable) -> tuple[np.ndarray, int]:
    """Numbers of a variable by the CF conventions, and how many lie outside its valid range.

    The range counts before unpacking, but for one of floating point beside packed integers.
    """
    import xarray as xr

    stored, attributes = variable.read(), dict(variable.attributes)
    fill = _UNWRITTEN.get(stored.dtype.str[1:])
    if fill is not None and "_FillValue" not in attributes and "missing_value" not in attributes:
        attributes["_FillValue"] = stored.dtype.type(fill)
    limits = _limits(attributes)
    for key in ("scale_factor", "add_offset"):
        if key in attributes:
            attributes[key] = np.float64(np.asarray(attributes[key]).item())
    dims = [f"axis_{n}" for n in range(stored.ndim)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", xr.SerializationWarning)  # of two marks in a file
        coded = xr.Variable(dims, stored, attributes)
        values = xr.conventions.decode_cf_variable("z", coded, decode_times=False).values
    values = np.array(values, dtype=np.float64)
    is_packed = "scale_factor" in attributes or "add_offset" in attributes
    unsigned = str(attributes.get("_Unsigned", "")).lower() == "true" and stored.dtype.kind == "i"
    outside = np.zeros(values.shape, dtype=bool)
    for limit, beyond in zip(limits, (np.less, np.greater), strict=True):
        if limit is None:
            continue
        compared = values if is_packed and limit.dtype.kind == "f" else stored
        if unsigned and compared is stored:
            wide = f"u{stored.dtype.itemsize}"
            compared, limit = stored.view(wide), limit.astype(stored.dtype).view(wide)
        outside |= beyond(compared, limit) & np.isfinite(values)
    values[outside] = np.nan
    return values, int(outside.sum())


def _limits(attributes: dict) -> tuple[np.ndarray | None, np.ndarray | None]:
    """The least and the largest valid number, each None where not stated."""
    both = np.ravel(attributes.pop("valid_range", ()))
    low = attributes.pop("valid_min", both[0] if both.size == 2 else None)
    high = attributes.pop("valid_max", both[1] if both.size == 2 else None)
    return tuple(None if limit is None else np.asarray(limit) for limit in (low, high))  # type: ignore[return-value]


def _unit(variable: Variable) -> str | None:
    """Unit of length of a variable; SurfaceTopography calls the attribute ``unit``."""
    return stated_unit(variable.attributes.get("units", variable.attributes.get("unit")))


def _coordinates(variable: Variable | None, variables: dict, path: Path) -> list[Axis] | None:
    """Axes of a variable of lengths with coordinates in units of length; None if incomplete."""
    if variable is None or _unit(variable) is None:
        return None
    axes = [_axis(dimension, variables, path) for dimension in variable.dimensions]
    complete = [axis for axis in axes if axis is not None]
    return complete if sorted(axis.letter for axis in complete) == ["x", "y"] else None


def _axis(dimension: str, variables: dict, path: Path) -> Axis | None:
    """Axis of a dimension, step and unit of its coordinates; None if not stated."""
    name = dimension.rpartition("/")[2]
    coordinate = variables.get(dimension)
    if coordinate is None or len(coordinate.shape) != 1 or coordinate.dtype.kind not in "fiu":
        return None
    attributes, unit = coordinate.attributes, _unit(coordinate)
    axis = str(attributes.get("axis", "")).strip().lower()[:1]
    standard = str(attributes.get("standard_name", "")).strip().lower()
    by_standard = _LETTERS.get(standard, "")
    letter = by_standard or axis or name[:1].lower()
    if axis and by_standard and axis != by_standard:
        raise InputError(
            f"{path}: coordinate {name!r} is of axis {axis.upper()!r} and of standard name "
            f"{standard!r}, which contradict each other; correct one of the two attributes, or "
            "export x, y, z as text"
        )
    if unit is None or letter not in ("x", "y") or coordinate.shape[0] < 2:
        return None
    places, _ = decoded(coordinate)
    step = (places[-1] - places[0]) / (len(places) - 1)
    strays = np.abs(np.diff(places) - step).max()
    if not strays <= REGULAR * abs(step):  # also where one is NaN
        raise InputError(
            f"{path}: coordinate {name!r} is not equidistant; resample the heights on a regular "
            "grid, or export x, y, z as text"
        )
    return Axis(letter, float(step), unit)


def _words(variables: dict, names: list[str]) -> list[tuple[str, str]]:
    """Attributes of the variables, each with its place."""
    words = []
    for name, variable in variables.items():
        # Units of coordinates are those of x and y, whatever the array of heights is called.
        axis = name.rpartition("/")[2].lower()
        quantity = "z" if name in names else axis if axis in ("x", "y") else name
        for key in ("units", "unit", "positive", "spacing"):
            if key in variable.attributes:
                text = f"{quantity} {key}: {variable.attributes[key]}"
                words.append((f"attribute {key} of {name}", text))
    return words


def _reader(path: Path) -> str:
    import h5py
    import scipy

    if h5py.is_hdf5(path):
        return f"h5py {h5py.__version__} / {path.suffix.lstrip('.').lower()}"
    return f"scipy {scipy.__version__} / netCDF classic"


FORMAT = Format(
    read_labelled,
    endings=(".h5", ".hdf5", ".nc"),
    keys=("layout", "axes", "columns"),
    libraries=("h5py", "scipy.io", "xarray"),
)
