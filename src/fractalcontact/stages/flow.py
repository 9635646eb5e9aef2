"""Flow through a joint: transmissivity over loads, branches and offsets of the reported state."""

from collections.abc import Sequence
from typing import Any

import xarray as xr

from ..core.datasets import Dims, labelled_dataset, titled
from ..core.estimate import rows_of
from ..core.labels import cf_attrs
from ..core.reported import Reported
from ..core.settings import JointSettings, Solver
from ..core.window import nominal_area
from ..flow.aperture import PERMEABILITY, PERMEABILITY_RANGE, QUANTILES
from ..flow.cubic_law import WAYS
from ..flow.joint_flow import SHIFT, flow_axes, joint_flow
from ..laws.scan_errors import on_sound_cells
from ..states.loading import JointLoading
from ..states.states import with_pressure

_LOADS = "normal_force"
_STATES, _QUANTILES = ("branch", _LOADS), ("gap_probability", _LOADS)
_MAP = ("flow_y", "flow_x")

#: Numbers of each way that have an interval, that of the window.
_WITH_INTERVAL = ("transmissivity", "hydraulic_aperture")
#: Numbers of each way by dimension: unit, long name.
_OF_WAY: dict[Dims, dict[str, tuple[str, str]]] = {
    _LOADS: {
        "transmissivity": ("mm3", "transmissivity T = h_h^3/12 per unit viscosity"),
        "hydraulic_aperture": ("mm", "hydraulic aperture h_h"),
        "critical_gap": ("mm", "narrowest gap of the widest passage"),
        "channel_fraction": ("1", "fraction of the window that carries 90 % of the flow"),
        "flow_imbalance": ("1", "bound on the relative error of T by mass balance and closed gaps"),
        "flow_reason": ("1", "why T is zero, missing or not resolved, or what its interval lacks"),
        "flow_resolved": ("1", "false where both face values of T differ by more than 30 %"),
        "hydraulic_ratio": ("1", "hydraulic aperture over the mean gap"),
        "transmissivity_grid_error": (
            "mm3",
            "half the difference of T by both face values, or the change of T where every second "
            "cell is left out if that is larger, no interval",
        ),
        "transmissivity_face_difference": (
            "mm3",
            "T by linear apertures between cells less T by harmonic means",
        ),
        "transmissivity_separation_error": (
            "mm3",
            "change of T with the total error of the separation, no interval",
        ),
        "reynolds_gradient": (
            "MPa/mm",
            "pressure gradient of water at 20 degrees at which the Reynolds number is 1",
        ),
    },
    _STATES: {"branch_transmissivity": ("mm3", "T on loading, unloading and reloading")},
    "offset": {"offset_transmissivity": ("mm3", "T under the reference load")},
    (): {
        "unloaded_transmissivity": ("mm3", "T at first touch, before any load"),
        "last_open_pressure": ("MPa", "largest pressure on loading with a path through the gap"),
        "first_closed_pressure": ("MPa", "smallest pressure on loading without such a path"),
    },
    _MAP: {"flux_map": ("1", "flow per width over its mean, under the reference load")},
}
_TABLE: dict[str, tuple[Dims, str, str]] = {
    **{
        row: (dims, *words)
        for way in WAYS
        for dims, rows in _OF_WAY.items()
        for name, (unit, of) in rows.items()
        for row, words in rows_of(f"{name}_{way}", unit, f"{of}, {way} the sliding").items()
        if row == f"{name}_{way}" or name in _WITH_INTERVAL
    },
    **{
        row: ("branch", *words)
        for name, of_law in PERMEABILITY.items()
        for row, words in rows_of(name, *of_law).items()
    },
    **{name: ((), *words) for name, words in PERMEABILITY_RANGE.items()},
    "branch_reason": ("branch", "1", "why a branch has neither gaps nor flow"),
    "gap_slope": (_LOADS, "1", "rms slope of the open gap"),
    "crushed_fraction": (_LOADS, "1", "volume of crushed rock over that of the gap left"),
    "shifted_ratio": (
        (),
        "1",
        f"T along the sliding of faces {SHIFT:g} mm farther apart over T, under the reference load",
    ),
    "gap_quantile": (_QUANTILES, "mm", "quantile of the gap over the window"),
    "zimmerman_aperture": (_LOADS, "mm", "hydraulic aperture by Zimmerman and Bodvarsson's law"),
    "barton_aperture": (_LOADS, "mm", "hydraulic aperture by Barton's law"),
    "effective_stress_coefficient": (_LOADS, "1", "effective-stress coefficient 1 - A_r/A_0"),
    "branch_mean_gap": (_STATES, "mm", "mean gap on loading, unloading and reloading"),
    "offset_mean_gap": ("offset", "mm", "mean gap under the reference load"),
    "unloaded_mean_gap": ((), "mm", "mean gap at first touch, before any load"),
}


@titled(flow="aperture and transmissivity over loads, branches and offsets")
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
    """Stage of the flow through one specimen; of a surface against a plane, ``along`` is along x.

    ``parts`` are contact states from :func:`states.sweep.joint_states`, the rest stages by name.
    Unloading and reloading are one elastic curve on the heights less the permanent set of the stage
    ``branches``; where nothing yields, all branches are that of loading.

    Raises
    ------
    NotConverged
        If a state of unloading could not be verified.
    """
    reported = Reported.read(closure)
    loading = JointLoading.of_joint(specimens, joints, reported.direction, settings, solver)
    axes = flow_axes(loading)
    may_fit = on_sound_cells(reported.states(closure)).values
    values = joint_flow(loading, closure, branches, error_budget, parts, may_fit)
    probability = cf_attrs("1", "fraction of the window with a smaller gap")
    coords: dict[str, Any] = {
        "normal_force": closure["normal_force"],
        "offset": closure["offset"],
        "branch": branches["branch"].values,
        "gap_probability": ("gap_probability", list(QUANTILES), probability),
    }
    for axis_name in "yx":
        nodes = joints[f"window_{axis_name}"].values[:: reported.resolution]
        coords[f"flow_{axis_name}"] = (
            f"flow_{axis_name}",
            nodes,
            cf_attrs("mm", f"{axis_name} of the node"),
        )
    attrs = {f"flow_axis_{way}": axis for way, axis in axes.items()}
    stage = labelled_dataset(_TABLE, values, coords, attrs)
    return {"flow": with_pressure(stage, nominal_area(specimens))}
