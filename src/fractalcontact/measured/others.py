"""Computed flow, dilatancy and strength under the conditions of a test."""

import numpy as np
import xarray as xr

from ..core.reported import Reported
from ..core.settings import MeasuredTest
from .beforehand import NEAR, require_direction, require_pressure
from .curve import Curve

#: Reason why a kind of test has no computed value to compare with.
WHY_NONE = {
    "closure": "",
    "flow": "no computed state has a path through the gap on this branch",
    "dilatancy": "no dilatancy was computed",
    "shear": "the study states no basic friction angle, or every angle was truncated",
    "strength": "the study states no basic friction angle, or every angle was truncated",
}
NOTHING = Curve.of([], [], [])


def computed_curve(
    test: MeasuredTest,
    flow: xr.Dataset,
    dilatancy: xr.Dataset,
    strength: xr.Dataset | None,
    reported: Reported,
) -> Curve:
    """Computed curve of a test that is not of closure; without points where there is none.

    Stages ``flow``, ``dilatancy`` and ``strength``, which is None of what does not slide. Raises
    `InputError` if the direction or the pressure was not computed.
    """
    if test.kind == "flow":
        return _flow(test, flow, reported)
    directions = (
        []
        if strength is None
        else [str(direction) for direction in strength["contact_direction"].values]
    )
    require_direction(test, directions)
    assert strength is not None  # otherwise no direction is known
    if test.kind == "dilatancy":
        along = dilatancy.sel(contact_direction=test.direction)
        curve = _under(test, along, "elastic_dilatancy", "offset_on_grid")
        # A test counts its dilation from the start of sliding, when the load already acts.
        return curve.since(0.0) if curve.x.size and curve.x[0] == 0 else curve
    along = strength.sel(contact_direction=test.direction)
    if test.kind == "shear":
        valid = along["shear_strength_valid"].astype(bool)
        below = along.assign(shear_strength=along["shear_strength"].where(valid))
        if not valid.any():
            return NOTHING
        return _under(test, below, "shear_strength", "midpoint")
    valid = along["peak_strength_valid"].astype(bool)
    peaks = along["peak_strength"].where(valid)
    pressure = along["nominal_pressure"].values
    return Curve.of(pressure, peaks.values, along["peak_strength_error"].values)


def _flow(test: MeasuredTest, flow: xr.Dataset, reported: Reported) -> Curve:
    states = reported.states(flow)
    on_branch = states.sel(branch=test.branch)
    name = f"transmissivity_{test.way}"
    error = np.hypot(
        *(
            np.nan_to_num(states[f"transmissivity_{source}_error_{test.way}"].values)
            for source in ("grid", "separation")
        )
    )
    values = on_branch[f"branch_{name}"].where(on_branch[f"branch_{name}"] > 0).values
    return Curve.of(states["nominal_pressure"].values, values, error)


def _under(test: MeasuredTest, along: xr.Dataset, name: str, x: str) -> Curve:
    """A curve over the offsets, straight over the logarithm of the pressure between loads."""
    values = along[name].transpose(..., "normal_force")
    # Loads that are solved at the reported offset alone are left out.
    offsets = np.isfinite(values.values).sum(axis=0)
    solved = (offsets > 0) & (2 * offsets > offsets.max())
    pressure = along["nominal_pressure"].values[solved]
    require_pressure(test, pressure)
    curves = along[[name, f"{name}_error"]].isel(normal_force=solved)
    place = float(np.interp(np.log(test.pressure), np.log(pressure), range(pressure.size)))
    low, part = int(np.floor(place)), place % 1
    high = min(low + 1, pressure.size - 1)

    def between(curve: xr.DataArray) -> np.ndarray:
        first, second = (curve.isel(normal_force=load).values for load in (low, high))
        return first if part < NEAR else (1 - part) * first + part * second

    return Curve.of(
        along[x].values, between(curves[name]), between(curves[f"{name}_error"]), log_x=False
    )
