"""Readings of a laboratory test in mm and MPa, less the rock between its gauge points."""

import numpy as np

from ..core.errors import InputError
from ..core.settings import MeasuredTest
from ..core.units import length_factor, quantity
from ..scan.columns import Column, read_columns
from .curve import MIN_READINGS, Curve, scatter

#: Columns that are lengths; transmissivities are cubes of one, all others are pressures.
_LENGTHS = ("displacement", "dilation", "hydraulic_aperture")
#: Fraction of the steps of the pressure that go the way of the branch.
_STEPS = 0.75


def read_test(test: MeasuredTest) -> Curve:
    """Readings of a test.

    Returns
    -------
    Curve
        Over the pressure, MPa, or the shear displacement, mm. A hydraulic aperture h is given as
        the transmissivity h^3/12. The error is that stated, else the scatter of the readings; of a
        transmissivity it is a fraction of each.

    Raises
    ------
    InputError
        If the file cannot be read, a unit is not that of its column, the pressure does not go the
        way of the branch, or no closure is left beside the rock.
    """
    columns = read_columns(test.file, test.columns)
    (of_x, x), (of_y, y) = ((name, _in_program_units(name, one)) for name, one in columns.items())
    if x.size < MIN_READINGS:
        raise InputError(f"{test.file}: {x.size} readings, expected {MIN_READINGS} or more")
    over_pressure = of_x == "pressure"
    if over_pressure and x.min() < 0:
        raise InputError(f"{test.file}: pressure: some are below 0; give compression above 0")
    if test.branch:
        _require_branch(test, x)
    if test.kind == "closure":
        y = y - test.compliance * x
        _require_closing(test, x, y)
    if of_y == "hydraulic_aperture":
        y = y**3 / 12
    curve = Curve.of(x, y, 0.0, log_x=over_pressure)
    places = np.log(curve.x) if over_pressure else curve.x
    if test.kind == "flow":
        flowing = curve.y > 0
        error = curve.y * scatter(places[flowing], np.log(curve.y[flowing]))
    else:
        error = np.full(curve.y.shape, test.error)
        if np.isnan(test.error):
            error[:] = scatter(places, curve.y)
    return Curve(curve.x, curve.y, error, log_x=over_pressure)


def _in_program_units(name: str, column: Column) -> np.ndarray:
    values, unit, where = column
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


def _require_branch(test: MeasuredTest, pressure: np.ndarray) -> None:
    steps = np.diff(pressure)
    moved = steps[steps != 0]
    rising = float(np.mean(moved > 0)) if moved.size else 0.0
    falls = test.branch == "unload"
    went = 1 - rising if falls else rising
    if went < _STEPS:
        way = "falls" if falls else "rises"
        raise InputError(
            f"{test.file}: 'branch: {test.branch}', but the pressure {way} in only "
            f"{went:.0%} of its steps; keep the readings in their order, write each branch into a "
            "file of its own, and state its 'branch': load, unload or reload"
        )


def _require_closing(test: MeasuredTest, pressure: np.ndarray, closure: np.ndarray) -> None:
    slope = np.polyfit(np.log(pressure[pressure > 0]), closure[pressure > 0], 1)[0]
    if slope <= 0:
        rock = f" less {1000 * test.compliance:g} um/MPa of rock" if test.compliance else ""
        raise InputError(
            f"{test.file}: the displacement{rock} falls as the pressure rises, so that the joint "
            "would open; check the gauge, and give closing as positive"
        )
