"""Readings of a laboratory test in mm and MPa, less the rock between its gauge points."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..core.errors import InputError
from ..core.settings import MeasuredTest
from ..core.units import length_factor, quantity
from ..scan.columns import Column, read_columns
from .curve import MIN_READINGS, Curve, scatter
from .one_way import require_one_way

#: Columns that are lengths. Transmissivities are cubes of lengths, all other columns are pressures.
_LENGTHS = ("displacement", "dilation", "hydraulic_aperture")
#: Columns without values below 0.
_POSITIVE = ("pressure", "shear_strength", "transmissivity", "hydraulic_aperture")
#: Difference, as a fraction of the travel, within which dilation and displacement are one column.
_SAME = 0.05


@dataclass(frozen=True, eq=False)
class TestReadings:
    """Readings of a test; ``note``: what was done to them, ``warning``: what to check, or ""."""

    curve: Curve
    note: str
    warning: str

    @property
    def said(self) -> str:
        """Note and warning in one text."""
        return "; ".join(filter(None, (self.warning, self.note)))


def read_test(test: MeasuredTest) -> TestReadings:
    """Readings of a test over the pressure, MPa, or the shear displacement, mm.

    A hydraulic aperture h is given as the transmissivity h^3/12. The error is that stated, else the
    scatter of the readings; of a transmissivity it is a fraction of each.

    Raises `InputError` if the file cannot be read, a unit is not that of its column, a pressure is
    below 0, the pressure does not go the way of the branch or the displacement that of sliding, the
    joint would open under pressure or close while it slides, or no closure is left beside the rock.
    """
    columns = read_columns(test.file, test.columns)
    (of_x, x), (of_y, y) = (
        (name, _in_program_units(name, column)) for name, column in columns.items()
    )
    for name, column in columns.items():
        if name in _POSITIVE:
            _require_positive(name, column)
    _require_enough(test, of_x, columns[of_x])
    note = require_one_way(test.branch, of_x, columns[of_x]) if test.kind != "strength" else ""
    over_pressure = of_x == "pressure"
    if test.kind == "closure":
        y = y - test.compliance * x
        _require_closing(test, columns[of_y], x, y)
    if of_y == "hydraulic_aperture":
        y = y**3 / 12
    curve = Curve.of(x, y, 0.0, log_x=over_pressure)
    if of_y == "dilation":
        _require_opening(columns[of_y], curve)
    if of_y == "shear_stress":
        _require_resistance(columns[of_y])
    warning = _same_column(test, curve) if of_y == "dilation" else ""
    return TestReadings(_with_error(test, curve), note, warning)


def _with_error(test: MeasuredTest, curve: Curve) -> Curve:
    """The readings with the error that is stated, else with their scatter."""
    places = np.log(curve.x) if curve.log_x else curve.x
    if test.kind == "flow":
        flowing = curve.y > 0
        error = curve.y * scatter(places[flowing], np.log(curve.y[flowing]))
    else:
        error = np.full(curve.y.shape, test.error)
        if np.isnan(test.error):
            error[:] = scatter(places, curve.y)
    return Curve(curve.x, curve.y, error, log_x=curve.log_x)


def _in_program_units(name: str, column: Column) -> np.ndarray:
    values, unit, where = column.values, column.unit, column.where
    if name in _LENGTHS:
        return values * length_factor(unit, where)
    if name == "transmissivity":
        length = unit.removesuffix("³").removesuffix("3").removesuffix("^")
        if length == unit:
            raise InputError(
                f"{where}: {unit!r} is no cube of a length; give T = h^3/12 in mm3 or m3 (of a "
                "hydraulic transmissivity in m2/s: times viscosity over rho g), or the hydraulic "
                "aperture h as 'columns: {hydraulic_aperture: h [um]}'"
            )
        return values * length_factor(length, where) ** 3
    return values * quantity(f"1 {unit}", "pressure", where)


def _require_positive(name: str, column: Column) -> None:
    below = np.flatnonzero(column.values < 0)
    if below.size:
        give = "compression above 0" if name == "pressure" else "it above 0"
        raise InputError(f"{column.at(below[0])} is below 0; give {give}")


def _require_enough(test: MeasuredTest, name: str, column: Column) -> None:
    values = column.values[column.values > 0] if name == "pressure" else column.values
    above = " at a pressure above 0" if name == "pressure" else ""
    if values.size < MIN_READINGS:
        raise InputError(
            f"{test.file}: {values.size} readings{above}, expected {MIN_READINGS} or more"
        )
    if np.ptp(values) == 0:
        raise InputError(
            f"{column.where}: every reading is {values[0]:.6g} {column.unit}; check which column "
            f"is the {name}"
        )


def _require_closing(
    test: MeasuredTest, column: Column, pressure: np.ndarray, closure: np.ndarray
) -> None:
    loaded = pressure > 0
    slope = np.polyfit(np.log(pressure[loaded]), closure[loaded], 1)[0]
    if slope <= 0:
        rock = f" less {1000 * test.compliance:g} um/MPa of rock" if test.compliance else ""
        raise InputError(
            f"{column.where}: the displacement{rock} falls as the pressure rises, so that the "
            "joint would open; check the gauge, and give closing as positive"
        )


def _require_opening(column: Column, curve: Curve) -> None:
    """Refuse a dilation that falls by more than its scatter while the joint slides."""
    fall = -np.polyfit(curve.x, curve.y, 1)[0] * np.ptp(curve.x) if np.ptp(curve.x) else 0.0
    if fall > max(scatter(curve.x, curve.y), 1e-9) and curve.y[-1] < curve.y[0]:
        raise InputError(
            f"{column.where}: the dilation falls while the joint slides, to {column.at_lowest()}; "
            "give opening as positive (a joint that closes as it slides has no dilation to compare)"
        )


def _require_resistance(column: Column) -> None:
    """Refuse shear stresses that are below 0 on the whole; a first few may be."""
    if column.values.mean() < 0:
        raise InputError(
            f"{column.where}: the shear stress is below 0, down to {column.at_lowest()}; give the "
            "stress against sliding as positive"
        )


def _same_column(test: MeasuredTest, curve: Curve) -> str:
    """Warning of a dilation that is the displacement."""
    sliding, opening = curve.x - curve.x[0], curve.y - curve.y[0]
    if np.abs(opening - sliding).max() > _SAME * np.ptp(curve.x):
        return ""
    return (
        f"{Path(test.file).name}: the dilation equals the displacement in every reading, within "
        f"{_SAME:.0%} of the travel; that is 45 degrees over the whole test: check which column is "
        "the dilation"
    )
