"""Contact states over offsets, loads and resolutions: what one job of a study computes."""

import numpy as np
import xarray as xr

from .area import contact_perimeter, corrected_area
from .contact import NotConverged, solve_contact
from .errors import InputError
from .halfspace import HalfSpace
from .joint import composite_topography, direction_spacing, prefractal, rigid_dilatancy
from .labels import about
from .specimen import nominal_area

#: Scalars kept of every state: name, unit, long name.
SCALARS = {
    "closure": ("mm", "closure w from first touch"),
    "force": ("N", "normal force F"),
    "area": ("mm2", "real contact area A_r"),
    "nodes": ("1", "nodes in contact"),
    "perimeter": ("mm", "perimeter of the contact domain's cells inside the window"),
    "area_corrected": ("mm2", "real contact area less what the cells on its edge overstate"),
    "stiffness": ("N/mm", "normal stiffness dF/dw"),
    "residual": ("1", "largest violation of the contact conditions, share of the closure"),
    "iterations": ("1", "applications of the elastic operator"),
}

#: Numbers kept of every offset: name, unit, long name.
OFFSETS = {
    "offset_made": ("mm", "shear offset v, in whole cells of this direction"),
    "rigid_opening": ("mm", "rigid dilatancy delta_r at the offset made"),
    "composite_spread": ("mm", "standard deviation of the composite topography"),
}


def forces_of(loads, area):
    """Loads as forces, N, ascending: pressures are nominal, on ``area`` in mm2.

    Parameters
    ----------
    loads : sequence of (float, str)
        Value and kind, "force" (N) or "pressure" (MPa).
    area : float

    Returns
    -------
    (n,) ndarray
    """
    return np.unique([value * area if kind == "pressure" else value for value, kind in loads])


def force_range(loads, specimen):
    """Smallest and largest force, N, of a range of loads; None for all."""
    return None if loads is None else tuple(forces_of(loads, nominal_area(specimen))[[0, -1]])


def chosen_offset(wanted, offsets):
    """The offset whose contact domains are looked at: the study's, else the third; mm.

    Parameters
    ----------
    wanted : float or None
        ``map_offset`` of the settings.
    offsets : (n,) array_like
        Those solved.
    """
    if wanted is None:
        return float(offsets[min(2, len(offsets) - 1)])
    return float(min(offsets, key=lambda offset: abs(offset - wanted)))


def hardness_of(settings, specimen):
    """Largest pressure of the material, MPa, or infinity.

    Raises
    ------
    InputError
        If a load of the study is more than the whole window carries at that pressure.
    """
    hardness = settings["material"].get("hardness", np.inf)
    area = nominal_area(specimen)
    largest = forces_of(settings["loads"], area)[-1]
    if largest >= hardness * area:
        raise InputError(
            f"specimen {specimen.attrs['name']}: load {largest:g} N is more than the window of "
            f"{area:.4g} mm2 carries at a hardness of {hardness:g} MPa; write loads below "
            f"{hardness * area:.4g} N"
        )
    return hardness


def load_steps(composite, space, forces, solving, where):
    """States under rising forces, each started from the one before.

    Parameters
    ----------
    composite : (ny, nx) ndarray
        h, mm.
    space : HalfSpace
    forces : (n,) array_like
        N, ascending.
    solving : dict
        Options of :func:`fractalcontact.contact.solve_contact`.
    where : str
        What is pressed, for errors.

    Yields
    ------
    ContactState

    Raises
    ------
    NotConverged
        If a state could not be verified; its note names it.
    """
    state = None
    for force in forces:
        try:
            state = solve_contact(composite, space, force=force, start=state, **solving)
        except NotConverged as error:
            error.add_note(f"{where}, F = {force:g} N")
            raise
        yield state


def contact_states(specimen, direction, cells, settings, resolutions, solver):
    """Solve the contact at some offsets and resolutions, under every load of the study.

    Parameters
    ----------
    specimen : xr.Dataset
    direction : str
    cells : (n,) int array_like
        Offsets in cells; may be empty.
    settings : dict
        From :func:`fractalcontact.study.resolve_settings`.
    resolutions : sequence of int
        Multiples k of the scan's spacing.
    solver : dict
        ``rtol`` and ``kernel``.

    Returns
    -------
    xr.Dataset
        The scalars of :data:`SCALARS` over (direction, offset, resolution, load), those of
        :data:`OFFSETS` over (direction, offset) and, for each resolution k, the contact domain
        ``in_contact_k`` over (direction, offset, load, y_k, x_k).

    Raises
    ------
    NotConverged
        If any state could not be verified; the message names it.
    InputError
        As :func:`hardness_of`.
    """
    forces = forces_of(settings["loads"], nominal_area(specimen))
    solving = {"rtol": solver["rtol"], "hardness": hardness_of(settings, specimen)}
    cells = np.asarray(cells, int)
    shape = (1, len(cells), len(resolutions), len(forces))
    scalars = {name: np.full(shape, np.nan) for name in SCALARS}
    fields = {}
    for k, factor in enumerate(resolutions):
        space = _space(specimen, factor, settings, solver)
        touching = np.zeros((1, len(cells), len(forces), *space.shape), bool)
        for i, n in enumerate(cells):
            composite = prefractal(composite_topography(specimen, direction, n), factor)
            where = (
                f"specimen {specimen.attrs['name']}, direction {direction}, offset {n} cells, "
                f"resolution {factor}"
            )
            for j, state in enumerate(load_steps(composite, space, forces, solving, where)):
                touching[0, i, j] = state.in_contact
                of_domain = {
                    "nodes": np.count_nonzero(state.in_contact),
                    "perimeter": contact_perimeter(state.in_contact, space.spacing),
                    "area_corrected": corrected_area(state.in_contact, space.spacing),
                }
                for name, values in scalars.items():
                    known = of_domain[name] if name in of_domain else getattr(state, name)
                    values[0, i, k, j] = known
        fields[f"in_contact_{factor}"] = (
            ("direction", "offset", "load", f"y_{factor}", f"x_{factor}"),
            touching,
            about("1", f"contact domain at {factor} times the scan's spacing"),
        )
    dims = ("direction", "offset", "resolution", "load")
    made = cells * direction_spacing(specimen, direction)
    opened, spread = rigid_dilatancy(specimen, direction, cells)
    of_offsets = {"offset_made": made, "rigid_opening": opened, "composite_spread": spread}
    return xr.Dataset(
        {
            **{name: (dims, values, about(*SCALARS[name])) for name, values in scalars.items()},
            **{
                name: (("direction", "offset"), values[np.newaxis], about(*OFFSETS[name]))
                for name, values in of_offsets.items()
            },
            **fields,
        },
        coords={
            "direction": [direction],
            "offset": ("offset", made, about("mm", "shear offset v")),
            "resolution": (
                "resolution",
                np.array(resolutions),
                about("1", "multiple k of the scan's spacing"),
            ),
            "load": ("load", forces, about("N", "normal force F")),
        },
    )


def map_states(specimen, joint, settings, solver):
    """Contact domains and pressures of the states that are looked at closely, under every load.

    Parameters
    ----------
    specimen : xr.Dataset
    joint : xr.Dataset
        From :func:`fractalcontact.joint.describe_joint`.
    settings : dict
        From :func:`fractalcontact.study.resolve_settings`.
    solver : dict
        ``rtol`` and ``kernel``.

    Returns
    -------
    xr.Dataset
        ``in_contact`` and ``pressure`` (load, y, x) at the scan's spacing, with the scalars
        ``direction``, the first whose contact is solved, and ``offset``, that of the maps.

    Raises
    ------
    NotConverged, InputError
        As :func:`contact_states`.
    """
    direction = settings["contact_directions"][0]
    offsets = joint["offset"].values
    offset = chosen_offset(settings["map_offset"], np.sort(offsets))
    cells = joint["offset_cells"].sel(contact_direction=direction).values[offsets == offset][0]
    composite = composite_topography(specimen, direction, cells)
    space = _space(specimen, 1, settings, solver)
    forces = forces_of(settings["loads"], nominal_area(specimen))
    solving = {"rtol": solver["rtol"], "hardness": hardness_of(settings, specimen)}
    where = f"specimen {specimen.attrs['name']}, direction {direction}, offset {cells} cells"
    states = list(load_steps(composite, space, forces, solving, where))
    dims = ("load", "y", "x")
    return xr.Dataset(
        {
            "in_contact": (dims, [s.in_contact for s in states], about("1", "contact domain")),
            "pressure": (dims, [s.pressure for s in states], about("MPa", "pressure p")),
        },
        coords={
            "load": ("load", forces, about("N", "normal force F")),
            "direction": direction,
            "offset": ((), offset, about("mm", "shear offset v")),
        },
    )


def combine(parts):
    """One dataset from the parts that several jobs solved.

    Parameters
    ----------
    parts : sequence of xr.Dataset
        From :func:`contact_states`; empty ones are passed over.

    Returns
    -------
    xr.Dataset
        Offsets, resolutions and loads ascending, directions in the order of ``parts``.

    Notes
    -----
    The n-th offsets of all directions belong together, but each is a whole number of cells of its
    own direction. Where cells are not square they differ by less than a cell: ``offset`` is that
    of the first direction, as in :func:`fractalcontact.joint.describe_joint`, and ``offset_made``
    that of each.

    Raises
    ------
    ValueError
        If the directions do not have the same number of offsets.
    """
    groups = {}
    for part in parts:
        if part.sizes["offset"]:
            key = (part.direction.item(), tuple(part.resolution.values))
            groups.setdefault(key, []).append(part)
    by_direction = {}
    for (direction, _), members in groups.items():
        whole = xr.concat(members, "offset", data_vars="minimal").sortby("offset")
        by_direction.setdefault(direction, []).append(whole)
    return xr.concat(
        [_join_resolutions(members) for members in by_direction.values()],
        "direction",
        data_vars="minimal",
        join="override",
    )


def domains_of(states):
    """The contact domains alone, without the scalars."""
    return states.drop_vars([*SCALARS, *OFFSETS, "resolution"])


def _join_resolutions(parts):
    """Parts that differ in resolution alone: scalars side by side, fields each their own."""
    scalars = xr.concat([part[list(SCALARS)] for part in parts], "resolution")
    fields = [part.drop_vars([*SCALARS, "resolution"]) for part in parts]
    return xr.merge([scalars, *fields], compat="identical", join="exact").sortby("resolution")


def _space(specimen, factor, settings, solver):
    attrs = specimen.attrs
    shape = tuple(-(-attrs[f"window_n{axis}"] // factor) for axis in "yx")
    spacing = tuple(attrs[f"spacing_{axis}"] * factor for axis in "yx")
    return HalfSpace(shape, spacing, settings["material"]["e_star"], kernel=solver["kernel"])
