"""Branches of the closure curve of a joint whose contacts crush: loading, unloading, reloading."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from roughcontact.contact.path import BRANCHES, LOAD, UNLOAD, BranchState, load_path
from roughcontact.elastic.halfspace import HalfSpace
from roughcontact.errors import NotConverged

from ..core.labels import cf_attrs

#: What each state of a branch has: unit, long name.
OF_BRANCHES = {
    "closure": ("mm", "closure w from first touch before any load"),
    "area": ("mm2", "real contact area A_r"),
    "set_volume": ("mm3", "volume pressed in for good"),
    "yielded_fraction": ("1", "fraction of the window that has carried the hardness"),
    "plastic_load_fraction": ("1", "fraction of the force on nodes at the hardness"),
}
#: What the cycle has: unit, long name.
OF_CYCLE = {
    "residual_closure": ("mm", "closure at which contact is lost after unloading"),
    "dissipated_energy": ("N mm", "energy spent on what is pressed in"),
    "recovered_energy": ("N mm", "elastic energy that unloading gives back"),
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
    rows = [[_numbers(state) for state in branch] for branch in states]
    data = xr.Dataset(
        {
            name: (
                ("branch", "normal_force"),
                [[one[name] for one in row] for row in rows],
                cf_attrs(*attrs),
            )
            for name, attrs in OF_BRANCHES.items()
        },
        coords={
            "branch": list(BRANCHES),
            "normal_force": ("normal_force", up, cf_attrs("N", "normal force F")),
        },
    )
    of_cycle = {
        "residual_closure": empty.closure,
        "dissipated_energy": top.dissipated_energy,
        "recovered_energy": top.elastic_energy,
    }
    for name, attrs in OF_CYCLE.items():
        data[name] = (), of_cycle[name], cf_attrs(*attrs)
    pressed = cf_attrs("mm", "how far each node is pressed in for good")
    data["permanent_set"] = ("y", "x"), top.permanent_set, pressed
    return data


def _numbers(state: BranchState) -> dict[str, float]:
    """The :data:`OF_BRANCHES` of a state."""
    return {
        "closure": state.closure,
        "area": state.contact.area,
        "set_volume": state.set_volume,
        "yielded_fraction": float(state.yielded.mean()),
        "plastic_load_fraction": state.plastic_load_fraction,
    }
