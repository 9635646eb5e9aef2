"""Branches of the closure curve of a joint whose contacts crush: loading, unloading, reloading."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from roughcontact.contact.path import BRANCHES, LOAD, RELOAD, UNLOAD, BranchState, load_path
from roughcontact.elastic.halfspace import HalfSpace
from roughcontact.errors import NotConverged

from ..core.datasets import labelled, labelled_dataset
from ..core.labels import cf_attrs
from .closure import bulk_settlement, interface_stiffness
from .loading import JointLoading
from .seated_laws import reference_stiffness, within_span
from .separation import ROUNDING

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
    "residual_closure": ("mm", "closure at which contact is lost after unloading"),
    "dissipated_energy": ("N mm", "energy spent on what is pressed in"),
    "recovered_energy": ("N mm", "elastic energy that unloading gives back"),
}
_TABLE: dict[str, tuple[Any, str, str]] = {
    **{name: (_STATES, *words) for name, words in OF_BRANCHES.items()},
    **{name: ((), *words) for name, words in OF_CYCLE.items()},
    "permanent_set": (("y", "x"), "mm", "how far each node is pressed in for good"),
}


def branches(
    composite: np.ndarray,
    space: HalfSpace,
    forces: ArrayLike,
    solving: Mapping[str, Any],
    where: str,
) -> xr.Dataset:
    """States of loading, of unloading from the largest load to none, and of reloading to it.

    Parameters
    ----------
    composite : (ny, nx) ndarray
        h, mm.
    space : HalfSpace
    forces : (n,) array_like
        N, above zero, ascending.
    solving : mapping
        ``hardness`` and ``rtol`` of :func:`roughcontact.load_path`.
    where : str
        What is loaded, for errors.

    Returns
    -------
    xr.Dataset
        :data:`OF_BRANCHES` over ``branch`` and ``normal_force`` (N), of which the unloading branch
        begins with the state that loading ended with; :data:`OF_CYCLE`; the map ``permanent_set``
        (mm), of the cycle.

    Raises
    ------
    NotConverged
        If a state could not be verified; its note names it.
    """
    up = np.asarray(forces, float)
    down, n = up[-2::-1], up.size
    try:
        path = load_path(composite, space, forces=[*up, *down, 0.0, *up], **solving)
    except NotConverged as error:
        error.add_note(f"{where}, loading, unloading and reloading up to F = {up[-1]:g} N")
        raise
    top, empty = path[n - 1], path[2 * n - 1]
    of = {LOAD: path[:n], UNLOAD: [*path[2 * n - 2 : n - 1 : -1], top]}
    states = [of.get(branch, path[2 * n :]) for branch in BRANCHES]
    rows = {
        branch: [_numbers(state, branch) for state in of_branch]
        for branch, of_branch in zip(BRANCHES, states, strict=True)
    }
    # Unloading begins elastically at the closure where loading ended, as reloading ends.
    begun = {name: rows[RELOAD][-1][name] for name in ("stiffness", "plastic_load_fraction")}
    rows[UNLOAD][-1] |= begun
    values = {
        **{name: [[one[name] for one in row] for row in rows.values()] for name in OF_BRANCHES},
        "residual_closure": empty.closure,
        "dissipated_energy": top.dissipated_energy,
        "recovered_energy": top.elastic_energy,
        "permanent_set": top.permanent_set,
    }
    loads = ("normal_force", up, cf_attrs("N", "normal force F"))
    return labelled_dataset(_TABLE, values, {"branch": list(BRANCHES), "normal_force": loads})


def _numbers(state: BranchState, branch: str) -> dict[str, float]:
    """The :data:`OF_BRANCHES` of a state."""
    return {
        "closure": state.closure,
        "stiffness": np.nan if branch == LOAD else state.contact.stiffness,
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
    "reference_stiffness": (
        ("branch", "reference_pressure"),
        "MPa/mm",
        "tangent stiffness of the interface at a pressure",
    ),
}


def joint_branches(loading: JointLoading, curves: xr.Dataset) -> xr.Dataset:
    """Branches of a joint at the reported offset, over the loads that closure laws are fitted to.

    Parameters
    ----------
    loading : JointLoading
        At that offset alone.
    curves : xr.Dataset
        The stage ``closure``.

    Returns
    -------
    xr.Dataset
        That of :func:`branches` and closures and stiffness of the interface, up to
        :data:`core.limits.SEATED_SPAN` times the seating pressure: what was loaded until the whole
        window crushes tells nothing of a joint in use. Where nothing yields all branches are that
        of loading, which is not solved again.
    """
    (cells,), (offset,) = loading.cells, loading.offsets
    curve = curves.sel(direction=loading.direction, resolution=curves["resolution"].min())
    curve = curve.sel(offset=offset, method="nearest")
    seating = float(curve["seating_pressure"])
    light = within_span(curve["nominal_pressure"].values, seating)
    curve = curve.isel(normal_force=light | (light.sum() < 2))
    forces = curve["normal_force"].values
    composite = loading.composite(int(cells))
    space = loading.half_space(composite.shape)
    if np.isfinite(loading.solving["hardness"]):
        where = f"specimen {loading.specimen.attrs['name']}"
        data = branches(composite, space, forces, loading.solving, where)
        data["stiffness"].values[0] = curve["stiffness"].values
    else:
        data = _elastic(curve, composite.shape)
    sides = np.multiply(space.shape, space.spacing)
    settlement = bulk_settlement(forces, space.modulus, *sides)
    pressure = forces / loading.area
    closure = data["closure"] - xr.DataArray(settlement, dims="normal_force")
    seat = closure[0].where(np.isclose(pressure, seating, rtol=ROUNDING, atol=0)).sum(min_count=1)
    beyond = pressure >= seating * (1 - ROUNDING)
    bulk = xr.DataArray(pressure / settlement, dims="normal_force")
    stiffness = interface_stiffness(data["stiffness"] / loading.area, bulk)
    values = {
        "interface_closure": closure.values,
        "seated_closure": (closure - seat).where(xr.DataArray(beyond, dims="normal_force")).values,
        "interface_stiffness": stiffness.values,
        "reference_stiffness": [reference_stiffness(pressure, row) for row in stiffness.values],
    }
    data.coords["reference_pressure"] = curve["reference_pressure"]
    return data.assign(labelled(_OF_INTERFACE, values)).assign_coords(
        nominal_pressure=("normal_force", pressure, cf_attrs("MPa", "nominal pressure F / A_0"))
    )


def _elastic(curve: xr.Dataset, shape: tuple[int, ...]) -> xr.Dataset:
    """Branches where nothing yields: the curve of loading three times, and nothing pressed in."""
    n = curve.sizes["normal_force"]
    of = {"closure": curve["closure"].values, "stiffness": curve["stiffness"].values}
    of["area"] = curve["area"].values
    values = {
        **{name: [of.get(name, np.zeros(n))] * len(BRANCHES) for name in OF_BRANCHES},
        **{"residual_closure": 0.0, "dissipated_energy": 0.0, "recovered_energy": np.nan},
        "permanent_set": np.zeros(shape),
    }
    coords = {"branch": list(BRANCHES), "normal_force": curve["normal_force"]}
    return labelled_dataset(_TABLE, values, coords)
