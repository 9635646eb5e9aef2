"""Stiffness of the reported joint at the reference pressures, solved there and not interpolated.

Between neighbouring loads an interpolated stiffness was off by up to 3.6 %, outside its interval.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from roughcontact.contact.solve import solve_contact
from roughcontact.contact.state import ContactState
from roughcontact.elastic.halfspace import HalfSpace
from roughcontact.errors import NotConverged

from ..core.datasets import labelled
from ..core.labels import cf_attrs
from ..core.limits import PRESSURE_ROUNDING, REFERENCE_PRESSURES, RESOLVED_NODES
from ..core.reported import states_at
from ..joint.joint import prefractal
from ..states.loading import JointLoading
from ..states.settlement import interface_closure, interface_stiffness, window_settlement
from ..states.state_scalars import resolved_slope
from .scan_errors import on_sound_cells
from .seated_laws import ON_SUSPECTS, at_reference_pressures, curve_stiffness

#: Reason why there is no stiffness at a pressure.
NO_LOAD = "no load below or above this pressure has a known stiffness"

_AT = ("reference_pressure",)
_TABLE = {
    "reference_stiffness": (_AT, "MPa/mm", "tangent stiffness of the interface at a pressure"),
    "reference_stiffness_reason": (_AT, "1", "why there is none"),
}


def further_pressures(pressure: np.ndarray) -> np.ndarray:
    """Reference pressures between the smallest and the largest of some, MPa, that equal none."""
    inside = [
        wanted
        for wanted in REFERENCE_PRESSURES
        if pressure.min() < wanted < pressure.max()
        and not np.isclose(pressure, wanted, rtol=PRESSURE_ROUNDING, atol=0).any()
    ]
    return np.array(inside)


def reference_stiffness(
    loading: JointLoading, curves: xr.Dataset, mapped: xr.Dataset
) -> xr.Dataset:
    """Stiffness of the reported curve at the reference pressures, of states solved there.

    Where such a state has no stiffness of its own, that of the closure curve through it and the
    loads around stands in its place. ``loading`` is at the reported offset alone, ``curves`` the
    stage ``closure``, ``mapped`` the fields by :func:`states.states.map_states`. The variables of
    :data:`_TABLE`. Raises `NotConverged`.
    """
    (cells,), (offset,) = loading.cells, loading.offsets
    factor = int(curves["resolution"].min())
    curve = states_at(curves, direction=loading.direction, offset=offset, resolution=factor)
    composite = prefractal(loading.composite(int(cells)), factor)
    sound, resolved = on_sound_cells(curve).values, curve["resolved"].values.astype(bool)
    pressure, stiffness = (
        curve[name].values for name in ("nominal_pressure", "interface_stiffness")
    )
    interpolated, of_resolved = (
        at_reference_pressures(pressure, np.where(of, stiffness, np.nan))
        for of in (sound, resolved)
    )
    at_reference = np.full(len(REFERENCE_PRESSURES), np.nan)
    if sound.sum() > 1 and np.ptp(composite) > 0:
        of_sound = curve.isel(normal_force=sound)
        at_reference = _solved_there(loading, composite, factor, of_sound, mapped)
    by_scan = np.isnan(interpolated) & np.isfinite(of_resolved)
    reason = np.where(by_scan, ON_SUSPECTS, NO_LOAD)
    values = {
        "reference_stiffness": at_reference,
        "reference_stiffness_reason": np.where(np.isfinite(at_reference), "", reason),
    }
    words = cf_attrs("MPa", "nominal pressure at which the stiffness is stated")
    pressures = {"reference_pressure": (_AT[0], np.array(REFERENCE_PRESSURES), words)}
    return xr.Dataset(labelled(_TABLE, values), pressures)


def _solved_there(
    loading: JointLoading,
    composite: np.ndarray,
    factor: int,
    curve: xr.Dataset,
    mapped: xr.Dataset,
) -> np.ndarray:
    """Stiffness (k,) at the reference pressures, MPa/mm, from a curve of sound states."""
    pressure, stiffness, closure = (
        curve[name].values
        for name in ("nominal_pressure", "interface_stiffness", "interface_closure")
    )
    wanted = further_pressures(pressure)
    if wanted.size:
        space = loading.half_space(composite.shape, factor)
        solving = loading.solving
        loaded = stored_states(composite, space, curve, mapped, solving["hardness"])
        where = f"specimen {loading.specimen.attrs['name']}, reference pressures"
        solved = _solved(composite, loaded, wanted * loading.area, solving, where)
        found = [_of_interface(state, loading.area) for state in solved]
        pressure = np.concatenate([pressure, wanted])
        order = np.argsort(pressure)
        pressure = pressure[order]
        stiffness = np.concatenate([stiffness, [k for k, _ in found]])[order]
        closure = np.concatenate([closure, [w for _, w in found]])[order]
    return at_reference_pressures(pressure, with_curve_stiffness(pressure, stiffness, closure))


def with_curve_stiffness(
    pressure: np.ndarray, stiffness: np.ndarray, closure: np.ndarray
) -> np.ndarray:
    """Stiffnesses (n,), MPa/mm, at the reference pressures that of the curve where they lack one.

    Other pressures keep theirs: between states without a stiffness nothing is interpolated.
    """
    at_reference = np.isclose(
        pressure[:, np.newaxis], REFERENCE_PRESSURES, rtol=PRESSURE_ROUNDING, atol=0
    )
    of_curve = curve_stiffness(pressure, closure)
    return np.where(np.isnan(stiffness) & at_reference.any(axis=1), of_curve, stiffness)


def stored_states(
    composite: np.ndarray,
    space: HalfSpace,
    curve: xr.Dataset,
    mapped: xr.Dataset,
    hardness: float,
) -> list[ContactState]:
    """States of a closure curve, from their pressures, which are stored in single precision.

    The stored gap is 0 in contact; that of a node that yields lies below, by what is pressed in.
    """
    clearance = composite.max() - composite
    states = []
    for force, closure, residual in zip(
        curve["normal_force"].values, curve["closure"].values, curve["residual"].values, strict=True
    ):
        stored = mapped["pressure"].sel(normal_force=force).values
        pressure = np.where(stored >= np.float32(hardness), hardness, stored.astype(float))
        displacement = space.displacement(pressure)
        gap = clearance - closure + displacement
        numbers = float(closure), float(force), float(residual), 0, space, hardness
        states.append(ContactState(pressure, displacement, gap, *numbers))
    return states


def _solved(
    composite: np.ndarray,
    loaded: list[ContactState],
    forces: np.ndarray,
    solving: Mapping[str, Any],
    where: str,
) -> list[ContactState]:
    """States under some forces, N, each started from the stored one below."""
    states = []
    for force in forces.tolist():
        start = max((one for one in loaded if one.force < force), key=lambda one: one.force)
        try:
            states.append(
                solve_contact(composite, start.space, force=force, start=start, **solving)
            )
        except NotConverged as error:
            error.add_note(f"{where}, F = {force:g} N")
            raise
    return states


def _of_interface(state: ContactState, area: float) -> tuple[float, float]:
    """Stiffness, MPa/mm, and closure, mm, of the interface in a state; A_0 in mm2."""
    settlement = float(window_settlement(state.space, state.force))
    closure = float(interface_closure(state.closure, settlement))
    if np.count_nonzero(state.in_contact) < RESOLVED_NODES:
        return np.nan, closure
    compliance = area / resolved_slope(state).value
    return float(interface_stiffness(compliance, settlement / (state.force / area))), closure
