"""Branches of the closure curve of a joint whose contacts crush: loading, unloading, reloading."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from roughcontact.contact.path import BRANCHES, LOAD, BranchState, load_path, loaded_state
from roughcontact.contact.solve import solve_contact
from roughcontact.contact.state import ContactState
from roughcontact.elastic.boundaries import MIRRORED, PERIODIC
from roughcontact.elastic.halfspace import HalfSpace
from roughcontact.errors import NotConverged

from ..core.datasets import labelled, labelled_dataset
from ..core.labels import cf_attrs
from ..core.limits import LARGEST_STIFFNESS_ERROR, REFERENCE_PRESSURES
from ..core.reported import states_at
from ..joint.joint import prefractal
from ..states.loading import JointLoading
from ..states.seat import closure_from
from ..states.settlement import interface_closure, interface_stiffness, window_settlement
from .closure import determined_closure, stiffness_reason
from .reference_states import further_pressures, stored_states
from .seated_laws import at_reference_pressures, within_span

_STATES = ("branch", "normal_force")

#: Numbers of each state of a branch: unit, long name.
OF_BRANCHES = {
    "closure": ("mm", "closure w from first touch before any load"),
    "stiffness": ("N/mm", "stiffness dF/dw of an elastic branch; of loading that of the states"),
    "area": ("mm2", "real contact area A_r"),
    "set_volume": ("mm3", "volume pressed in for good"),
    "yielded_fraction": ("1", "fraction of the window that has carried the hardness"),
    "plastic_load_fraction": ("1", "fraction of the force on nodes at the hardness"),
}
#: Numbers of the cycle: unit, long name.
OF_CYCLE = {
    "branch_maximum": ("N", "largest load of the branches, from which they unload"),
    "residual_closure": ("mm", "closure at which contact is lost after unloading"),
    "dissipated_energy": ("N mm", "energy dissipated by the permanent set"),
    "recovered_energy": ("N mm", "elastic energy that unloading gives back"),
}
_TABLE: dict[str, tuple[Any, str, str]] = {
    **{name: (_STATES, *words) for name, words in OF_BRANCHES.items()},
    **{name: ((), *words) for name, words in OF_CYCLE.items()},
    "permanent_set": (("y", "x"), "mm", "how far each node is pressed in for good"),
    "yielded": (("y", "x"), "1", "nodes that have carried the hardness"),
}


def branches(
    composite: np.ndarray,
    loaded: Sequence[ContactState],
    solving: Mapping[str, Any],
    where: str,
    further: Sequence[float] | np.ndarray = (),
) -> xr.Dataset:
    """States of loading, of unloading from the largest load to none, and of reloading to it.

    ``loaded`` are the states of the composite topography, mm, under ascending forces above zero,
    which are not solved again; ``solving`` has ``hardness`` and ``rtol`` of
    :func:`roughcontact.load_path`, and ``where`` names what is loaded in errors.
    :data:`OF_BRANCHES` are over ``branch`` and ``normal_force``, N; the unloading branch begins
    with the state that loading ended with. Raises `NotConverged`.

    Below the largest load the contact is elastic on the heights that loading has left: unloading
    and reloading are one curve, solved once, and where nothing has yielded that of loading. Under
    ``further`` forces, N, below the largest and where nodes have yielded, that curve is solved too:
    its stiffness there is ``further_stiffness`` over ``further_force``.
    """
    load = [loaded_state(state) for state in loaded]
    forces, top = np.array([state.force for state in load]), load[-1]
    again, residual = load, 0.0
    between: dict[float, float] = {}
    if top.yielded.any():
        falling = np.union1d(forces[:-1], further)[::-1]
        try:
            *down, empty, full = load_path(
                composite,
                top.contact.space,
                forces=[*falling, 0.0, forces[-1]],
                loaded=top.contact,
                **solving,
            )
        except NotConverged as error:
            error.add_note(f"{where}, unloading from F = {forces[-1]:g} N")
            raise
        by_force = dict(zip(falling.tolist(), down, strict=True))
        again = [*(by_force[force] for force in forces[:-1].tolist()), full]
        residual = empty.closure
        between = {force: by_force[force].contact.stiffness for force in np.sort(further).tolist()}
    first, second = ([_numbers(state) for state in states] for states in (load, again))
    # Unloading is elastic and begins at the closure where loading ended.
    rows = [first, [*second[:-1], second[-1] | {"closure": top.closure}], second]
    values = {
        **{name: [[state[name] for state in row] for row in rows] for name in OF_BRANCHES},
        "branch_maximum": forces[-1],
        "residual_closure": residual,
        "dissipated_energy": top.dissipated_energy,
        "recovered_energy": top.elastic_energy,
        "permanent_set": top.permanent_set,
        "yielded": top.yielded,
    }
    loads = ("normal_force", forces, cf_attrs("N", "normal force F"))
    data = labelled_dataset(_TABLE, values, {"branch": list(BRANCHES), "normal_force": loads})
    if between:
        words = cf_attrs("N/mm", "stiffness dF/dw on reloading under further forces")
        data["further_stiffness"] = ("further_force", list(between.values()), words)
        data.coords["further_force"] = list(between)
    return data


def _numbers(state: BranchState) -> dict[str, float]:
    """The :data:`OF_BRANCHES` of a state."""
    return {
        "closure": state.closure,
        "stiffness": np.nan if state.branch == LOAD else state.contact.stiffness,
        "area": state.contact.area,
        "set_volume": state.set_volume,
        "yielded_fraction": float(state.yielded.mean()),
        "plastic_load_fraction": state.plastic_load_fraction,
    }


#: Numbers of the interface on each branch: dimensions, unit, long name.
_OF_INTERFACE = {
    "interface_closure": (_STATES, "mm", "interface closure w_int = w - w_b"),
    "seated_closure": (
        _STATES,
        "mm",
        "interface closure since loading passed the seat",
    ),
    "interface_stiffness": (_STATES, "MPa/mm", "tangent stiffness d sigma_0 / d w_int"),
    "interface_stiffness_reason": (_STATES, "1", "why there is no tangent stiffness"),
    "reference_stiffness": (
        ("branch", "reference_pressure"),
        "MPa/mm",
        "tangent stiffness of the interface at a pressure",
    ),
    "reference_stiffness_error": (
        ("branch", "reference_pressure"),
        "MPa/mm",
        "error of it on reloading by what lies beyond the edges of the window, half-width",
    ),
    "reload_reason": (
        (),
        "1",
        "why there is no stiffness on unloading and reloading at the reference pressures",
    ),
}
#: Factor on the largest relative difference of the stiffness on reloading between a mirrored and a
#: periodic window. With it the middle of a window of twice the side lies within the error
#: (docs/verification.md).
EDGE_FACTOR = 2.0
DECIDED_BY_EDGES = "what lies beyond the edges of the window changes it by more than half of itself"
#: Reason why the stiffness on reloading is no result of a free window whose contacts crush.
KEPT_BOWL = (
    "a free window keeps the bowl of its own settlement when it is unloaded, and would reload too "
    "softly: write 'boundary: mirrored'"
)


def joint_branches(loading: JointLoading, curves: xr.Dataset, maps: xr.Dataset) -> xr.Dataset:
    """Branches of a joint at the reported offset, over the loads that closure laws are fitted to.

    ``loading`` is at that offset alone, ``curves`` the stage ``closure``, ``maps`` the fields by
    :func:`states.states.map_states`. Loads end at :data:`core.limits.SEATED_SPAN` times the seating
    pressure: a window that was loaded until all of it crushes tells nothing of a joint in use.
    """
    (cells,), (offset,) = loading.cells, loading.offsets
    factor = int(curves["resolution"].min())
    curve = states_at(curves, direction=loading.direction, offset=offset, resolution=factor)
    seating = float(curve["seating_pressure"])
    light = within_span(curve["nominal_pressure"].values, seating)
    curve = curve.isel(normal_force=light | (light.sum() < 2))
    forces = curve["normal_force"].values
    composite = prefractal(loading.composite(int(cells)), factor)
    space = loading.half_space(composite.shape, factor)
    loaded = stored_states(composite, space, curve, maps, loading.solving["hardness"])
    where = f"specimen {loading.specimen.attrs['name']}"
    pressure = forces / loading.area
    further = np.empty(0) if space.is_free else further_pressures(pressure)
    data = branches(composite, loaded, loading.solving, where, further * loading.area)
    data["stiffness"] = _with_loading(data, curve["stiffness"].reset_coords(drop=True))
    flush = xr.DataArray(bool(np.ptp(composite) == 0))
    settlement = xr.DataArray(window_settlement(space, forces), dims="normal_force")
    closure = interface_closure(data["closure"], settlement, flush)
    closure = determined_closure(closure, flush).transpose(*_STATES)
    compliance = 1 / (data["stiffness"] / loading.area)
    stiffness = interface_stiffness(compliance, settlement / pressure).where(~flush)
    no_total = curve["interface_stiffness_reason"].reset_coords(drop=True)
    reason = stiffness_reason(stiffness, data["stiffness"], flush, no_total)
    keeps_bowl = space.is_free and bool(data["yielded"].any())
    if keeps_bowl:
        on_load = stiffness["branch"] == LOAD
        stiffness, reason = stiffness.where(on_load), reason.where(on_load, KEPT_BOWL)
    at_reference = _at_reference(data, stiffness, curve, loading.area)
    apart = np.nan
    if data["yielded"].any() and not space.is_free:
        at = np.array(REFERENCE_PRESSURES)
        at_each = np.isfinite(at_reference[-1]) & (at < pressure[-1])
        # Without a bowl the stiffness of the interface is that of interface and blocks.
        forces, own = at[at_each] * loading.area, at_reference[-1][at_each] * loading.area
        apart = _edge_error(composite, loaded[-1], forces, own, loading.solving, where)
    why = KEPT_BOWL if keeps_bowl else ""
    if apart > LARGEST_STIFFNESS_ERROR:
        why = DECIDED_BY_EDGES
        at_reference[1:] = np.full_like(at_reference[1:], np.nan)
    data = data.drop_vars(["further_stiffness", "further_force"], errors="ignore")
    values = {
        "interface_closure": closure.values,
        "seated_closure": closure_from(
            closure.values, pressure, seating, on_loading=closure.values[0]
        ),
        "interface_stiffness": stiffness.values,
        "interface_stiffness_reason": reason.values,
        "reference_stiffness": at_reference,
        "reference_stiffness_error": [
            np.full(len(row), np.nan) if branch == LOAD else apart * row
            for branch, row in zip(BRANCHES, at_reference, strict=True)
        ],
        "reload_reason": why,
    }
    data.coords["reference_pressure"] = curve["reference_pressure"]
    return data.assign(labelled(_OF_INTERFACE, values)).assign_coords(
        nominal_pressure=("normal_force", pressure, cf_attrs("MPa", "nominal pressure F / A_0"))
    )


def _with_loading(data: xr.Dataset, loaded: xr.DataArray) -> xr.DataArray:
    """Stiffness of all branches, N/mm, that of loading from the loaded states.

    A joint that has not crushed unloads and reloads along its loading curve. One that has crushed
    is stiffer on these branches: a stiffness that is missing there stays so.
    """
    same = (data["branch"] == LOAD) | ~data["yielded"].astype(bool).any()
    return data["stiffness"].where(~same, loaded).transpose(*_STATES)


def _at_reference(
    data: xr.Dataset, stiffness: xr.DataArray, curve: xr.Dataset, area: float
) -> list[np.ndarray]:
    """Stiffness of each branch at the reference pressures, MPa/mm, as solved there; A_0 in mm2."""
    pressure = data["normal_force"].values / area
    rows = []
    for branch in BRANCHES:
        if branch == LOAD or not data["yielded"].any():
            rows.append(curve["reference_stiffness"].values)
            continue
        at, values = pressure, stiffness.sel(branch=branch).values
        if "further_stiffness" in data:
            at = np.concatenate([at, data["further_force"].values / area])
            values = np.concatenate([values, data["further_stiffness"].values / area])
        order = np.argsort(at)
        rows.append(at_reference_pressures(at[order], values[order]))
    return rows


def _edge_error(
    composite: np.ndarray,
    top: ContactState,
    forces: np.ndarray,
    own: np.ndarray,
    solving: Mapping[str, Any],
    where: str,
) -> float:
    """Relative error of the stiffness on reloading by the edges of a mirrored or periodic window.

    ``top`` is the state under the largest load, ``forces`` are those of the reference pressures, N,
    in ascending order, and ``own`` the stiffness there, N/mm. The joint is loaded and unloaded
    again with the other of both boundaries.
    """
    space = top.space
    if not len(forces):
        return np.nan
    boundary = PERIODIC if space.boundary == MIRRORED else MIRRORED
    other = HalfSpace(space.shape, space.spacing, space.modulus, boundary=boundary)
    falling = forces[::-1].tolist()
    try:
        start = solve_contact(composite, other, force=top.force, start=top, **solving)
        path = load_path(composite, other, forces=falling, loaded=start, **solving)
    except NotConverged as error:
        error.add_note(f"{where}, {boundary} window")
        raise
    stiffness = np.array([state.contact.stiffness for state in path])[::-1]
    return float(EDGE_FACTOR * np.abs(stiffness / own - 1).max())
