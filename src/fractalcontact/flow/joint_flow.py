"""Flow through a joint: over loads, branches and offsets of the reported state."""

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from ..core.estimate import NO_ESTIMATE, Estimate
from ..core.reported import Reported
from ..joint.joint import prefractal, sliding_axis
from ..joint.jrc import profile_roughness
from ..states.loading import JointLoading
from ..states.state_scalars import aperture
from ..states.states import MAP_GAP, MAP_PRESSURE, OFFSET_GAP
from ..states.sweep import load_steps
from .aperture import (
    PERMEABILITY,
    QUANTILES,
    barton_aperture,
    crushed_reason,
    permeability_law,
    reynolds_gradient,
    rms_slope,
    zimmerman_bodvarsson_aperture,
)
from .cubic_law import WAYS, flow_of, grid_error, window_interval
from .network import hydraulic_aperture

#: Distance by which faces are moved apart to see what their fit changes, mm.
SHIFT = 0.1
#: Largest error of the mean gap over windows, as a fraction of the gap, that counts as known.
_MAX_GAP_ERROR = 1.0
#: Reason of a number without an interval, as the quarters alone would make it far too narrow.
_GAP_UNKNOWN = "no interval, as the mean gap of other windows may differ by more than its value"


def flow_axes(loading: JointLoading) -> dict[str, str]:
    """Axis of the flow each way: along the sliding and across it; x and y where nothing slides."""
    along_y = loading.slides and "yx"[sliding_axis(loading.direction)] == "y"
    return dict(zip(WAYS, "yx" if along_y else "xy", strict=True))


def joint_flow(
    loading: JointLoading,
    closure: xr.Dataset,
    branches: xr.Dataset,
    error_budget: xr.Dataset,
    parts: Sequence[xr.Dataset],
    may_fit: np.ndarray,
) -> dict[str, Any]:
    """Numbers of the stage ``flow`` by name; arrays run over its loads, branches and offsets.

    ``loading`` is at all offsets; ``closure``, ``branches`` and ``error_budget`` are the stages of
    these names and ``parts`` contact states from :func:`states.sweep.joint_states`; ``may_fit``
    (load,) are the loads that the law of permeability takes. Raises `NotConverged` if a
    state of unloading could not be verified.
    """
    reported, axes = Reported.read(closure), flow_axes(loading)
    dy, dx = map(float, loading.spacing)
    spacing = reported.resolution * dy, reported.resolution * dx
    both = partial(_both_ways, axes, spacing)
    states = reported.states(closure)
    composite = loading.composite(int(loading.at_map_offset().cells[0]))
    composite = prefractal(composite, reported.resolution)
    space = loading.half_space(composite.shape, reported.resolution)
    maps = next(part for part in parts if MAP_GAP in part)
    gaps = maps[MAP_GAP].values.astype(float)
    crushed = _crushed_fractions(composite, space, states, maps, loading.solving["hardness"])
    errors = {
        "separation": error_budget["total"].sel(quantity="separation").values,
        "mean_gap": error_budget["mean_gap_total_of_population"].values / states["mean_gap"].values,
    }
    values: dict[str, Any] = {
        "crushed_fraction": crushed,
        "gap_slope": [rms_slope(gap, spacing) for gap in gaps],
        "gap_quantile": np.quantile(gaps, QUANTILES, axis=(1, 2)),
        **_laws(states, loading),
    }
    for way, axis in axes.items():
        values |= _over_loads(way, axis, gaps, spacing, states, errors, crushed, reported)
    reference = gaps[reported.reference]
    values["shifted_ratio"] = (
        np.nan
        if crushed_reason(crushed[reported.reference])
        else shifted_ratio(reference, spacing, axes[WAYS[0]])
    )
    loaded = {"mean_gap": states["mean_gap"].values}
    loaded |= {of: values[of] for of in (f"transmissivity_{way}" for way in WAYS)}
    for prefix, numbers in {
        "branch": _of_branches(composite, space, loading, branches, both, loaded),
        "offset": _over_offsets(parts, closure["offset"].values, both, reported, loaded),
        "unloaded": both(composite.max() - composite),
    }.items():
        values |= {f"{prefix}_{name}": value for name, value in numbers.items()}
    along = values[f"branch_transmissivity_{WAYS[0]}"]
    law = permeability_law(states["nominal_pressure"].values, along, may_fit)
    for name in PERMEABILITY:
        values |= law.pop(name).columns(name)
    values |= law
    return values


def _both_ways(axes, spacing, gap):
    """Mean gap of a gap, and transmissivities that the grid resolves; NaN else."""
    flows = {way: flow_of(gap, spacing, axis) for way, axis in axes.items()}
    return {"mean_gap": float(gap.mean())} | {
        f"transmissivity_{way}": flow.transmissivity if flow.resolved else np.nan
        for way, flow in flows.items()
    }


def _crushed_fractions(composite, space, states, maps, hardness):
    """Volume pressed in for good over that of the gap left, over the loads.

    ``maps`` has the fields of pressure and gap at the offset of the contact maps.
    """
    if not np.isfinite(hardness):
        return np.zeros(states.sizes["normal_force"])
    clearance, fractions = composite.max() - composite, []
    pressures, gaps = maps[MAP_PRESSURE].values, maps[MAP_GAP].values
    for pressure, gap, closure in zip(pressures, gaps, states["closure"].values, strict=True):
        # The stored gap is 0 where a node yields: what is pressed in lies below.
        overlap = closure - clearance - space.displacement(pressure.astype(float))
        pressed = np.maximum(overlap, 0).sum(where=pressure >= np.float32(hardness))
        left = float(gap.sum(dtype=float))
        fractions.append(pressed / left if left else np.inf if pressed else 0.0)
    return np.array(fractions)


def shifted_ratio(gap: np.ndarray, spacing: tuple[float, float], axis: str) -> float:
    """T of faces :data:`SHIFT` farther apart over that of the gap; NaN where no T is stated."""
    flow, shifted = (flow_of(apertures, spacing, axis) for apertures in (gap, gap + SHIFT))
    stated = flow.transmissivity > 0 and flow.resolved
    return shifted.transmissivity / flow.transmissivity if stated else np.nan


def _over_loads(way, axis, gaps, spacing, states, errors, crushed, reported):
    """Numbers of the flow one way on loading, and the flux map under the reference load."""
    # A joint that does not slide has no way across: its second way is solved at quoted loads.
    every = way == WAYS[0] or reported.direction != "none"
    rows = {
        load: flow_numbers(
            gap,
            spacing,
            axis,
            crushed[load],
            errors["mean_gap"][load] if load in reported.quoted else None,
        )
        for load, gap in enumerate(gaps)
        if every or load in reported.quoted
    }
    flux = rows[reported.reference].pop("flux_map").astype(np.float32)
    nothing = dict.fromkeys(rows[reported.reference], np.nan) | {
        "transmissivity": NO_ESTIMATE,
        "flow_reason": "solved under the reported loads alone",
        "flow_resolved": True,
    }
    of_loads = [rows.get(load, nothing) for load in range(len(gaps))]
    values = {name: np.array([one[name] for one in of_loads]) for name in nothing}
    flow = Estimate.stack(values.pop("transmissivity"))
    hydraulic = flow.mapped(hydraulic_aperture)
    mean = states["mean_gap"].where(states["mean_gap"] > 0).values
    opened, closed = path_pressures(
        states["nominal_pressure"].values, flow.value, values["critical_gap"]
    )
    values |= {
        "hydraulic_ratio": hydraulic.value / mean,
        "transmissivity_separation_error": _separation_error(
            mean, flow.value, errors["separation"]
        ),
        "reynolds_gradient": reynolds_gradient(flow.value),
        "flux_map": flux,
        "last_open_pressure": opened,
        "first_closed_pressure": closed,
    }
    return {
        **{f"{name}_{way}": value for name, value in values.items()},
        **flow.columns(f"transmissivity_{way}"),
        **hydraulic.columns(f"hydraulic_aperture_{way}"),
    }


def flow_numbers(
    gap: np.ndarray,
    spacing: tuple[float, float],
    axis: str,
    crushed: float,
    gap_error: float | None,
) -> dict[str, Any]:
    """Numbers of the flow through a gap.

    The errors of T take five more flows, of parts of it; ``gap_error``, of the mean gap over
    windows as a fraction of it, is None where they are not wanted. Where it is not known, or larger
    than the gap, T has no interval: that of the quarters alone would be far too narrow.
    """
    flow = flow_of(gap, spacing, axis)
    whole, reason, off_grid = Estimate(flow.transmissivity), flow.reason, np.nan
    if gap_error is not None:
        if gap_error <= _MAX_GAP_ERROR:
            whole = window_interval(gap, spacing, axis, flow.transmissivity, gap_error)
        else:
            reason = reason or _GAP_UNKNOWN
        off_grid = grid_error(gap, spacing, axis, flow)
    unknown = crushed_reason(crushed) or ("" if flow.resolved else flow.reason)
    if unknown and flow.transmissivity > 0:
        whole, reason, off_grid = NO_ESTIMATE, unknown, np.nan
    return {
        "transmissivity": whole,
        "transmissivity_grid_error": off_grid,
        "transmissivity_face_difference": flow.face_difference,
        "critical_gap": flow.critical_gap,
        "channel_fraction": flow.channel_fraction,
        "flux_map": flow.flux,
        "flow_imbalance": flow.imbalance,
        "flow_reason": reason,
        "flow_resolved": flow.resolved,
    }


def path_pressures(
    pressure: np.ndarray, flows: np.ndarray, critical: np.ndarray
) -> tuple[float, float]:
    """Largest pressure with a path through the gap and smallest without one, MPa; NaN for none.

    A path with a critical gap is open where no T is stated, too.
    """
    opened, closed = pressure[(flows > 0) | (critical > 0)], pressure[flows == 0]
    return np.append(np.nan, opened)[-1], np.append(closed, np.nan)[0]


def _laws(states, loading):
    """Empirical laws and the effective-stress coefficient over loads."""
    names = ("mean_gap", "gap_deviation", "area_share")
    mean, deviation, contact = (states[name].values for name in names)
    jrc = np.nan
    if loading.slides:
        jrc = float(profile_roughness(loading.specimen, loading.direction)["jrc_used"])
    return {
        "zimmerman_aperture": zimmerman_bodvarsson_aperture(mean, deviation, contact),
        "barton_aperture": barton_aperture(mean, jrc),
        "effective_stress_coefficient": 1 - contact,
    }


def _separation_error(gap, flow, total):
    """Change of T over the total error of the separation, mm3, by the slope between loads.

    The mean gap is off by as much as the separation, whatever node touches first.
    """
    is_known = np.isfinite(gap + flow)
    error = np.full(flow.shape, np.nan)
    if is_known.sum() > 1:
        error[is_known] = np.abs(np.gradient(flow[is_known], gap[is_known])) * total[is_known]
    return error


def _of_branches(composite, space, loading, branches, both, loaded):
    """Numbers of all branches: as given on loading; on the others NaN above the largest load.

    A free window that has crushed keeps the bowl of its own settlement when it is unloaded: its
    gaps are those of a loose square, and have no number on unloading and reloading.
    """
    held, top = branches["permanent_set"].values, branches["normal_force"].values[-1]
    forces = loading.forces(loading.settings.loads)
    values = {
        name: np.tile(over_branches, (branches.sizes["branch"], 1))
        for name, over_branches in loaded.items()
    }
    for over_branches in values.values():
        over_branches[1:, forces > top] = np.nan
    values["reason"] = np.full(branches.sizes["branch"], "", object)
    if held.any() and space.is_free:
        values["reason"][1:] = str(branches["reload_reason"].item())
        for name in loaded:
            values[name][1:] = np.nan
    # A joint that has not crushed unloads and reloads along its loading curve.
    elif held.any():
        descending, elastic = np.flatnonzero(forces <= top)[::-1], {"rtol": loading.solver.rtol}
        where = f"specimen {loading.specimen.attrs['name']}, unloading"
        states = load_steps(composite - held, space, forces[descending], elastic, where)
        for load, state in zip(descending, states, strict=True):
            numbers = both(aperture(state))
            if crushed_reason(held.mean() / numbers["mean_gap"]):
                numbers |= {name: np.nan for name in numbers if name != "mean_gap"}
            for name, value in numbers.items():
                values[name][1:, load] = value
    return values


def _over_offsets(parts, offsets, both, reported, loaded):
    """Numbers over the offsets under the reference load; the reported offset takes ``loaded``."""
    is_reported, load = offsets == reported.offset, reported.reference
    values = {
        name: np.where(is_reported, over_loads[load], np.nan) for name, over_loads in loaded.items()
    }
    for part in (part for part in parts if OFFSET_GAP in part):
        for gap, offset in zip(part[OFFSET_GAP].values, part["offset"].values, strict=True):
            number = int(np.argmin(np.abs(offsets - offset)))
            if not is_reported[number]:
                for name, value in both(gap.astype(float)).items():
                    values[name][number] = value
    return values
