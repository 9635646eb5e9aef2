"""Contact states: fields kept, loads, and the joining of their parts.

No solver is imported here: most jobs of a study only read states.
"""

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.errors import InputError
from ..core.labels import cf_attrs
from ..core.settings import JointSettings, Load
from ..core.window import nominal_area

#: Scalars kept of every state: name, unit, long name.
SCALARS = {
    "closure": ("mm", "closure w from first touch"),
    "force": ("N", "normal force F"),
    "area": ("mm2", "real contact area A_r"),
    "nodes": ("1", "nodes in contact"),
    "extent": ("1", "fraction of the window within the smallest rectangle around the contact"),
    "perimeter": ("mm", "perimeter of the contact domain's cells inside the window"),
    "area_corrected": ("mm2", "real contact area less what the cells on its edge overstate"),
    "area_sampling": ("1", "relative sampling error of it under its force, half-width at 95 %"),
    "stiffness": ("N/mm", "normal stiffness dF/dw"),
    "stiffness_scatter": ("N/mm", "scatter of the stiffness over the cells that come to yield"),
    "mean_gap": ("mm", "mean gap over the nominal area: the mechanical aperture"),
    "gap_deviation": ("mm", "standard deviation of the gap over the nominal area"),
    "residual": ("1", "largest KKT residual, fraction of the closure"),
    "energy_error": ("1", "Frank-Wolfe bound on the energy above its minimum, fraction of it"),
    "iterations": ("1", "applications of the elastic operator"),
    "suspect_load_share": ("1", "fraction of the force on suspicious cells of the scans"),
}

#: End of the long name of an error bound that the solver's tolerance leaves.
SOLVER_ERROR = "solver error bound"

#: Scalars that the tolerance of the solver leaves uncertain. The force is given.
WITH_SOLVER_ERROR = ("closure", "area", "nodes", "perimeter", "area_corrected", "stiffness")
#: Solver error bounds of these scalars: name, unit, long name.
ERRORS = {
    f"{name}_error": (SCALARS[name][0], f"{SCALARS[name][1]}, {SOLVER_ERROR}")
    for name in WITH_SOLVER_ERROR
}
#: End of the long name of the error of a stiffness; where nodes yield, its scatter is added.
WITH_SCATTER = f"{SOLVER_ERROR} and scatter"
ERRORS["stiffness_error"] = ("N/mm", f"{SCALARS['stiffness'][1]}, {WITH_SCATTER}")

#: Reasons of missing scalars: name, unit, long name.
REASONS = {"stiffness_reason": ("1", "why there is no stiffness dF/dw")}

#: Variables of a state without its contact domain.
STATE_VARIABLES = [*SCALARS, *ERRORS, *REASONS, "solved"]

#: Numbers kept of every offset: name, unit, long name.
OFFSETS = {
    "offset_on_grid": ("mm", "shear offset v, in whole cells of this direction"),
    "rigid_opening": ("mm", "rigid dilatancy delta_r at that offset"),
    "composite_spread": ("mm", "standard deviation of the composite topography"),
}


#: Mean apparent dip of equal parts of the force, of states that slide.
DIP = "apparent_dip"

#: Pressures at the offset of the contact maps, in the first direction and at the finest resolution,
#: under every load. One of the parts that jobs solve holds them.
MAP_PRESSURE = "map_pressure"
#: Gaps of the same states.
MAP_GAP = "map_gap"
#: Gaps of every offset in the first direction and at the finest resolution under the reference
#: load, for the flow through the joint as it slides.
OFFSET_GAP = "offset_gap"
#: Fields that only some parts hold.
MAP_FIELDS = (MAP_PRESSURE, MAP_GAP, OFFSET_GAP)


def error_attrs(attrs: Mapping[str, str], kind: str = SOLVER_ERROR) -> dict[str, str]:
    """Attributes of an error, by default the solver error bound, of a variable with these
    attributes.
    """
    return cf_attrs(attrs["units"], f"{attrs['long_name']}, {kind}")


def forces_of(loads: Sequence[Load], area: float) -> np.ndarray:
    """Loads as forces (n,), N, ascending: pressures, MPa, are nominal, on ``area`` in mm2."""
    return np.unique([value * area if kind == "pressure" else value for value, kind in loads])


def with_pressure(stage: xr.Dataset, area: float) -> xr.Dataset:
    """A stage with the nominal pressure as a second coordinate of its loads; A_0 in mm2.

    A stage over no load is handed back as it is.
    """
    if "normal_force" not in stage.dims:
        return stage
    pressure = stage["normal_force"].values / area
    words = cf_attrs("MPa", "nominal pressure sigma_0 = F/A_0")
    return stage.assign_coords(nominal_pressure=("normal_force", pressure, words))


def force_range(loads: Sequence[Load] | None, specimen: xr.Dataset) -> tuple[float, float] | None:
    """Smallest and largest force, N, of a range of loads; None for all."""
    return None if loads is None else tuple(forces_of(loads, nominal_area(specimen))[[0, -1]])


def chosen_offset(wanted: float | None, offsets: ArrayLike) -> float:
    """Offset of the contact maps, mm: the one nearest to that of the study, else the third."""
    offsets = np.asarray(offsets)
    if wanted is None:
        return float(offsets[min(2, len(offsets) - 1)])
    return float(min(offsets, key=lambda offset: abs(offset - wanted)))


def hardness_of(settings: JointSettings, specimen: xr.Dataset) -> float:
    """Largest pressure of the material, MPa, or infinity.

    Raises
    ------
    InputError
        If a load of the study is more than the whole window carries at that pressure.
    """
    hardness = settings.material.hardness
    area = nominal_area(specimen)
    largest = forces_of(settings.loads, area)[-1]
    if largest >= hardness * area:
        raise InputError(
            f"specimen {specimen.attrs['name']}: load {largest:g} N is more than the window of "
            f"{area:.4g} mm2 carries at a hardness of {hardness:g} MPa (of a scan the joint wall "
            f"strength, unless its material says 'hardness: none'); write loads below "
            f"{hardness * area:.4g} N"
        )
    return hardness


def combine(parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """One dataset from the parts that several jobs solved.

    Parameters
    ----------
    parts : sequence of xr.Dataset
        From :func:`states.sweep.contact_states` or from here; empty ones are passed over.

    Returns
    -------
    xr.Dataset
        Offsets, resolutions and loads ascending, directions in the order of ``parts``. Without
        :data:`MAP_PRESSURE`: see :func:`map_states`.

    Notes
    -----
    The n-th offsets of all directions belong together, but each is a whole number of cells of its
    own direction. Where cells are not square they differ by less than a cell: ``offset`` is that
    of the first direction, as in :func:`joint.joint.describe_joint`, and ``offset_on_grid``
    that of each.

    Raises
    ------
    ValueError
        If the directions do not have the same number of offsets.
    """
    groups: dict[tuple, list[xr.Dataset]] = {}
    for part in parts:
        if part.sizes["offset"]:
            states = part.drop_vars(MAP_FIELDS, errors="ignore")
            for i, direction in enumerate(part["direction"].values):
                key = (direction, tuple(part["resolution"].values))
                groups.setdefault(key, []).append(states.isel(direction=[i]))
    by_direction: dict[str, list[xr.Dataset]] = {}
    for (direction, _), members in groups.items():
        whole = xr.concat(members, "offset", data_vars="minimal").sortby("offset")
        by_direction.setdefault(direction, []).append(whole)
    return concat_directions([_join_resolutions(members) for members in by_direction.values()])


def concat_directions(directions: Sequence[xr.Dataset]) -> xr.Dataset:
    """One dataset of the states of several directions, at the offsets of the first."""
    states = [part.drop_vars(MAP_FIELDS, errors="ignore") for part in directions]
    joined = xr.concat(states, "direction", data_vars="minimal", join="override")
    for part in directions:
        joined = joined.assign({name: part[name] for name in MAP_FIELDS if name in part})
    return joined


def contact_domains(states: xr.Dataset) -> xr.Dataset:
    """The contact domains alone, with which of them were solved, and their error bounds."""
    kept = ("solved", "nodes_error")
    other = [name for name in (*STATE_VARIABLES, *OFFSETS) if name not in kept]
    return states.drop_vars(other).drop_vars(DIP, errors="ignore")


def map_fields(
    pressures: ArrayLike, gaps: ArrayLike, offset: float, direction: str, factor: int
) -> dict[str, tuple]:
    """Variables :data:`MAP_PRESSURE`, MPa, and :data:`MAP_GAP`, mm, with their state in attributes.

    Arrays are (normal_force, ny, nx), the offset is in mm, ``factor`` the resolution k.
    """
    of_place = {"offset": offset, "direction": direction, "resolution": factor}
    dims = ("normal_force", f"y_{factor}", f"x_{factor}")
    labels = {
        MAP_PRESSURE: cf_attrs("MPa", "pressure p at the offset of the contact maps"),
        MAP_GAP: cf_attrs("mm", "gap g at the offset of the contact maps"),
    }
    fields = {MAP_PRESSURE: pressures, MAP_GAP: gaps}
    return {
        name: (dims, np.array(values), labels[name] | of_place) for name, values in fields.items()
    }


def map_states(parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """Pressures of the states that are looked at closely, under every load: ``pressure``, MPa.

    Over (normal_force, y, x), with the scalars ``direction``, ``offset`` and ``resolution``, the
    multiple k of the scan's spacing.
    """
    part = next(part for part in parts if MAP_PRESSURE in part)
    pressure = part[MAP_PRESSURE]
    place = pressure.attrs
    dims = ("normal_force", "y", "x")
    return xr.Dataset(
        {
            "pressure": (dims, pressure.values, cf_attrs("MPa", "pressure p")),
        },
        coords={
            "normal_force": part["normal_force"],
            "direction": place["direction"],
            "offset": ((), place["offset"], cf_attrs("mm", "shear offset v")),
            "resolution": (
                (),
                int(place["resolution"]),
                cf_attrs("1", "multiple k of the scan's spacing"),
            ),
        },
    )


def _join_resolutions(parts: Sequence[xr.Dataset]) -> xr.Dataset:
    """Parts that differ in resolution alone: scalars side by side, fields each their own."""
    kept = [*STATE_VARIABLES, *(DIP for part in parts[:1] if DIP in part)]
    scalars = xr.concat([part[kept] for part in parts], "resolution")
    fields = [part.drop_vars([*kept, "resolution"]) for part in parts]
    return xr.merge([scalars, *fields], compat="identical", join="exact").sortby("resolution")
