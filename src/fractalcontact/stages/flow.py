"""Flow through a joint: transmissivity over loads, branches and offsets of the reported state."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from roughcontact.contact.solve import solve_contact

from ..core.datasets import Dims, labelled_dataset
from ..core.estimate import names_of, rows_of
from ..core.labels import cf_attrs
from ..core.reported import Reported
from ..core.settings import JointSettings, Solver
from ..core.window import nominal_area
from ..flow.aperture import (
    QUANTILES,
    barton_aperture,
    reynolds_gradient,
    zimmerman_bodvarsson_aperture,
)
from ..flow.cubic_law import hydraulic_aperture
from ..flow.curves import (
    OF_APERTURE,
    OF_WAY,
    WAYS,
    axes_of,
    coarse_transmissivity,
    numbers_of_aperture,
    numbers_of_flow,
    percolation_pressures,
    transmissivity_of,
    window_interval,
)
from ..mechanics.joint import prefractal, sliding_axis
from ..mechanics.jrc import profile_roughness
from ..mechanics.loading import JointLoading
from ..mechanics.state_scalars import aperture
from ..mechanics.states import MAP_GAP, OFFSET_GAP, with_pressure

_LOADS: Dims = "normal_force"
_STATES: Dims = ("branch", "normal_force")
_LOAD, _UNLOAD = 0, 1
#: Numbers of a gap that branches and offsets have.
NAMES = ("mean_gap", *(f"transmissivity_{way}" for way in WAYS))

#: Why a load has no transmissivity.
NOT_QUOTED = "solved under the reported loads alone"

#: Numbers of each way with an interval, that of the window.
_WITH_INTERVAL = ("transmissivity", "hydraulic_aperture")
#: Numbers of each way of the flow beside those of :data:`flow.curves.OF_WAY`.
_MORE_OF_WAY: dict[str, tuple[Dims, str, str]] = {
    "hydraulic_ratio": (_LOADS, "1", "hydraulic aperture over the mean gap"),
    "transmissivity_grid_error": (
        _LOADS,
        "mm3",
        "change of T where every second cell is left out, no interval",
    ),
    "transmissivity_separation_error": (
        _LOADS,
        "mm3",
        "change of T with the total error of the separation, no interval",
    ),
    "reynolds_gradient": (
        _LOADS,
        "MPa/mm",
        "pressure gradient of water at 20 degrees at which the Reynolds number is 1",
    ),
    "branch_transmissivity": (_STATES, "mm3", "T on loading, unloading and reloading"),
    "offset_transmissivity": ("offset", "mm3", "T under the reference load"),
    "unloaded_transmissivity": ((), "mm3", "T at first touch, before any load"),
    "last_open_pressure": ((), "MPa", "largest pressure on loading with a path through the gap"),
    "first_closed_pressure": ((), "MPa", "smallest pressure on loading without such a path"),
    "flux_map": (
        ("flow_y", "flow_x"),
        "1",
        "flow per width over its mean, under the reference load",
    ),
}
_TABLE: dict[str, tuple[Dims, str, str]] = {
    **{
        f"{name}_{way}": (dims, unit, f"{words}, {way} the sliding")
        for way in WAYS
        for name, (dims, unit, words) in (
            {name: (_LOADS, *of) for name, of in OF_WAY.items()} | _MORE_OF_WAY
        ).items()
    },
    **{
        row: (_LOADS, *words)
        for way in WAYS
        for name in _WITH_INTERVAL
        for row, words in rows_of(
            f"{name}_{way}", OF_WAY[name][0], f"{OF_WAY[name][1]}, {way} the sliding"
        ).items()
    },
    **{name: (_LOADS, *words) for name, words in OF_APERTURE.items()},
    "gap_quantile": (
        ("gap_probability", "normal_force"),
        "mm",
        "quantile of the gap over the window",
    ),
    "zimmerman_aperture": (_LOADS, "mm", "hydraulic aperture by Zimmerman and Bodvarsson's law"),
    "barton_aperture": (_LOADS, "mm", "hydraulic aperture by Barton's law"),
    "effective_stress_coefficient": (_LOADS, "1", "effective-stress coefficient 1 - A_r/A_0"),
    "branch_mean_gap": (_STATES, "mm", "mean gap on loading, unloading and reloading"),
    "offset_mean_gap": ("offset", "mm", "mean gap under the reference load"),
    "unloaded_mean_gap": ((), "mm", "mean gap at first touch, before any load"),
}


def flow_stages(
    specimens: xr.Dataset,
    joints: xr.Dataset,
    closure: xr.Dataset,
    branches: xr.Dataset,
    error_budget: xr.Dataset,
    parts: Sequence[xr.Dataset],
    settings: JointSettings,
    solver: Solver,
) -> dict[str, xr.Dataset]:
    """Stage of the flow through one specimen.

    Parameters
    ----------
    specimens, joints : xr.Dataset
        Of the stages of these names, from :func:`stages.specimen.specimen_stages`.
    closure, branches, error_budget : xr.Dataset
        Likewise, from :func:`stages.states.state_stages`.
    parts : sequence of xr.Dataset
        Contact states, from :func:`mechanics.sweep.joint_states`.
    settings : JointSettings
    solver : Solver

    Returns
    -------
    dict of str to xr.Dataset
        The stage flow. Of a surface against a plane, which does not slide, ``along`` is along x.

    Raises
    ------
    NotConverged
        If a state of unloading could not be verified.

    Notes
    -----
    What a cycle has pressed in stays: unloading and reloading are elastic on the heights less the
    permanent set of the stage ``branches``, and one curve. Where nothing yields, all branches are
    that of loading.
    """
    reported = Reported.read(closure)
    loading = JointLoading.of_joint(specimens, joints, reported.direction, settings, solver)
    axis = "yx"[sliding_axis(reported.direction)] if loading.slides else "x"
    whole = _Place(loading.spacing, axes_of(axis))
    place = _Place(loading.spacing * reported.resolution, whole.axes)
    states = reported.states(closure)
    mapped = next(part for part in parts if MAP_GAP in part)[MAP_GAP]
    values: dict[str, Any] = _over_loads(mapped.values.astype(float), place, reported)
    values |= _laws(states, specimens, reported.direction, loading.slides)
    gap = states["mean_gap"].where(states["mean_gap"] > 0).values
    total = error_budget["total"].sel(quantity="separation").values
    for way in WAYS:
        flow = values[f"transmissivity_{way}"]
        values |= {
            f"hydraulic_ratio_{way}": values[f"hydraulic_aperture_{way}"] / gap,
            f"transmissivity_separation_error_{way}": _separation_error(gap, flow, total),
            f"reynolds_gradient_{way}": reynolds_gradient(flow),
        }
        values[f"last_open_pressure_{way}"], values[f"first_closed_pressure_{way}"] = (
            percolation_pressures(states["nominal_pressure"].values, flow)
        )
    (cells,) = loading.at_map_offset().cells
    composite = loading.composite(int(cells))
    values |= _of_branches(composite, loading, branches, states, whole, values)
    kept = prefractal(composite, reported.resolution)
    values |= place.both("unloaded", kept.max() - kept)
    values |= _over_offsets(parts, closure, place, reported, values)
    probability = cf_attrs("1", "fraction of the window with a smaller gap")
    coords: dict[str, Any] = {
        "normal_force": closure["normal_force"],
        "offset": closure["offset"],
        "branch": branches["branch"].values,
        "gap_probability": ("gap_probability", list(QUANTILES), probability),
    }
    for one in "yx":
        nodes = joints[f"window_{one}"].values[:: reported.resolution]
        coords[f"flow_{one}"] = (f"flow_{one}", nodes, cf_attrs("mm", f"{one} of the node"))
    attrs = {"flow_axis_along": place.axes["along"], "flow_axis_across": place.axes["across"]}
    stage = labelled_dataset(_TABLE, values, coords, attrs)
    return {"flow": with_pressure(stage, nominal_area(specimens))}


class _Place:
    """Spacing of the cells and the axes of both ways of the flow."""

    def __init__(self, spacing: np.ndarray, axes: Mapping[str, str]):
        self.spacing, self.axes = (float(spacing[0]), float(spacing[1])), axes

    def both(self, prefix: str, gap: np.ndarray) -> dict[str, float]:
        """Mean gap and transmissivities of a gap, their names after a prefix."""
        flows = {
            f"{prefix}_transmissivity_{way}": transmissivity_of(gap, self.spacing, axis)
            for way, axis in self.axes.items()
        }
        return {f"{prefix}_mean_gap": float(gap.mean()), **flows}


def _over_loads(gaps: np.ndarray, place: _Place, reported: Reported) -> dict[str, Any]:
    """Numbers of the states on loading, and the flux maps under the reference load."""
    of_gaps = [numbers_of_aperture(gap, place.spacing) for gap in gaps]
    values: dict[str, Any] = {name: [one[name] for one in of_gaps] for name in OF_APERTURE}
    values["gap_quantile"] = np.transpose([one["quantiles"] for one in of_gaps])
    for way, axis in place.axes.items():
        # What does not slide has no across: a second direction, at the loads that are quoted.
        every = way == WAYS[0] or reported.direction != "none"
        rows = {
            load: numbers_of_flow(gaps[load], place.spacing, axis)
            for load in (range(len(gaps)) if every else reported.quoted)
        }
        for name in OF_WAY:
            missing = NOT_QUOTED if name == "flow_reason" else np.nan
            values[f"{name}_{way}"] = np.array(
                [rows.get(load, {}).get(name, missing) for load in range(len(gaps))]
            )
        of_flow, of_aperture = (names_of(f"{name}_{way}")[1:] for name in _WITH_INTERVAL)
        grid_error = f"transmissivity_grid_error_{way}"
        values |= {
            name: np.full(len(gaps), np.nan) for name in (*of_flow, *of_aperture, grid_error)
        }
        for load in reported.quoted:
            whole = rows[load]["transmissivity"]
            coarse = coarse_transmissivity(gaps[load], place.spacing, axis)
            values[grid_error][load] = abs(coarse - whole)
            ends = window_interval(gaps[load], place.spacing, axis, whole)
            for name, other, end in zip(of_flow, of_aperture, ends, strict=True):
                values[name][load], values[other][load] = end, hydraulic_aperture(end)
        values[f"flux_map_{way}"] = rows[reported.reference]["flux"].astype(np.float32)
    return values


def _laws(states, specimens, direction, slides):
    """Empirical laws and the effective-stress coefficient over loads."""
    mean, contact = states["mean_gap"].values, states["area_share"].values
    jrc = float(profile_roughness(specimens, direction)["jrc_used"]) if slides else np.nan
    return {
        "zimmerman_aperture": zimmerman_bodvarsson_aperture(
            mean, states["gap_deviation"].values, contact
        ),
        "barton_aperture": barton_aperture(mean, jrc),
        "effective_stress_coefficient": 1 - contact,
    }


def _separation_error(gap, flow, total):
    """Change of T over the total error of the separation, mm3, by the slope between loads.

    The mean gap is off by as much as the separation, whatever node touches first.
    """
    known = np.isfinite(gap + flow)
    error = np.full(flow.shape, np.nan)
    if known.sum() > 1:
        error[known] = np.abs(np.gradient(flow[known], gap[known])) * total[known]
    return error


def _of_branches(composite, loading, branches, states, place, on_loading):
    """Mean gaps and transmissivities of all branches; NaN above their largest load."""
    forces = states["normal_force"].values
    loaded = {f"branch_{name}": on_loading[name] for name in NAMES[1:]}
    loaded["branch_mean_gap"] = states["mean_gap"].values
    # All branches on loading's values; what has crushed gets its own below.
    values = {name: np.tile(one, (branches.sizes["branch"], 1)) for name, one in loaded.items()}
    held, top = branches["permanent_set"].values, branches["normal_force"].values[-1]
    for one in values.values():
        one[_UNLOAD:, forces > top] = np.nan
    if held.any():
        pressed, space, state = composite - held, loading.half_space(composite.shape), None
        for load in np.flatnonzero(forces <= top)[::-1]:
            state = solve_contact(
                pressed, space, force=float(forces[load]), start=state, rtol=loading.solver.rtol
            )
            for name, value in place.both("branch", aperture(state)).items():
                values[name][_UNLOAD:, load] = value
    return values


def _over_offsets(parts, closure, place, reported, of_branches):
    """Mean gaps and transmissivities over the offsets, under the reference load.

    That of the reported offset is the state of its ``of_branches``.
    """
    values = {f"offset_{name}": np.full(closure.sizes["offset"], np.nan) for name in NAMES}
    offsets = closure["offset"].values
    for part in (part for part in parts if OFFSET_GAP in part):
        for gap, offset in zip(part[OFFSET_GAP].values, part["offset"].values, strict=True):
            number = int(np.argmin(np.abs(offsets - offset)))
            if offsets[number] == reported.offset:
                at = _LOAD, reported.reference
                found = {f"offset_{name}": of_branches[f"branch_{name}"][at] for name in NAMES}
            else:
                found = place.both("offset", gap.astype(float))
            for name, value in found.items():
                values[name][number] = value
    return values
