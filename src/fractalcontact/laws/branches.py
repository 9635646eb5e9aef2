"""Branches of the closure curve of a joint whose contacts crush: loading, unloading, reloading."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from roughcontact.contact.path import BRANCHES, LOAD, BranchState, load_path, loaded_state
from roughcontact.contact.state import ContactState
from roughcontact.elastic.halfspace import HalfSpace
from roughcontact.errors import NotConverged

from ..core.datasets import labelled, labelled_dataset
from ..core.labels import cf_attrs
from ..core.limits import PRESSURE_ROUNDING
from ..core.reported import states_at
from ..joint.joint import prefractal
from ..states.loading import JointLoading
from ..states.settlement import bulk_settlement, interface_closure, interface_stiffness
from .closure import determined_closure, stiffness_reason
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
    composite: np.ndarray, loaded: Sequence[ContactState], solving: Mapping[str, Any], where: str
) -> xr.Dataset:
    """States of loading, of unloading from the largest load to none, and of reloading to it.

    ``loaded`` are the states of the composite topography, mm, under ascending forces above zero,
    which are not solved again; ``solving`` has ``hardness`` and ``rtol`` of
    :func:`roughcontact.load_path`, and ``where`` names what is loaded in errors.
    :data:`OF_BRANCHES` are over ``branch`` and ``normal_force``, N; the unloading branch begins
    with the state that loading ended with. Raises `NotConverged`.

    Below the largest load the contact is elastic on the heights that loading has left: unloading
    and reloading are one curve, solved once, and where nothing has yielded that of loading.
    """
    load = [loaded_state(state) for state in loaded]
    forces, top = np.array([state.force for state in load]), load[-1]
    again, residual = load, 0.0
    if top.yielded.any():
        try:
            *down, empty, full = load_path(
                composite,
                top.contact.space,
                forces=[*forces[-2::-1], 0.0, forces[-1]],
                loaded=top.contact,
                **solving,
            )
        except NotConverged as error:
            error.add_note(f"{where}, unloading from F = {forces[-1]:g} N")
            raise
        again, residual = [*down[::-1], full], empty.closure
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
    return labelled_dataset(_TABLE, values, {"branch": list(BRANCHES), "normal_force": loads})


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
}


def joint_branches(loading: JointLoading, curves: xr.Dataset, mapped: xr.Dataset) -> xr.Dataset:
    """Branches of a joint at the reported offset, over the loads that closure laws are fitted to.

    ``loading`` is at that offset alone, ``curves`` the stage ``closure``, ``mapped`` the fields by
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
    loaded = _solved_states(composite, space, curve, mapped, loading.solving["hardness"])
    where = f"specimen {loading.specimen.attrs['name']}"
    data = branches(composite, loaded, loading.solving, where)
    data["stiffness"] = _with_loading(data, curve["stiffness"].reset_coords(drop=True))
    sides = np.multiply(space.shape, space.spacing)
    settlement = bulk_settlement(forces, space.modulus, *sides)
    pressure = forces / loading.area
    flush = xr.DataArray(bool(np.ptp(composite) == 0))
    bulk_settled = xr.DataArray(settlement, dims="normal_force")
    closure = interface_closure(data["closure"], bulk_settled, flush)
    closure = determined_closure(closure, flush).transpose(*_STATES)
    at_seat = np.isclose(pressure, seating, rtol=PRESSURE_ROUNDING, atol=0)
    seat = closure[0].where(at_seat).sum(min_count=1)
    beyond = pressure >= seating * (1 - PRESSURE_ROUNDING)
    bulk = xr.DataArray(pressure / settlement, dims="normal_force")
    compliance = 1 / (data["stiffness"] / loading.area)
    stiffness = interface_stiffness(compliance, 1 / bulk).where(~flush)
    no_total = curve["interface_stiffness_reason"].reset_coords(drop=True)
    reason = stiffness_reason(stiffness, data["stiffness"], flush, no_total)
    values = {
        "interface_closure": closure.values,
        "seated_closure": (closure - seat).where(xr.DataArray(beyond, dims="normal_force")).values,
        "interface_stiffness": stiffness.values,
        "interface_stiffness_reason": reason.values,
        "reference_stiffness": [at_reference_pressures(pressure, row) for row in stiffness.values],
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


def _solved_states(
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
