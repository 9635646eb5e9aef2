"""Contact states over offsets, loads and resolutions: what one job of a study computes."""

import numpy as np
import xarray as xr

from ..contact.solve import solve_contact
from ..core.errors import NotConverged
from ..core.labels import cf_attrs
from ..elastic.halfspace import HalfSpace
from ..surface.specimen import nominal_area
from .closure import bulk_settlement
from .joint import composite_topography, direction_spacing, prefractal, rigid_dilatancy
from .plan import solved_loads
from .state_scalars import numbers_of
from .states import (
    ERRORS,
    OFFSETS,
    SCALARS,
    chosen_offset,
    forces_of,
    hardness_of,
    map_pressure,
    side_by_side,
)

#: Tolerances are tightened by so much where that of the study leaves too large an error.
TIGHTENING = 10.0
#: But to no less than this: nodes that just touch are undecided at any tolerance.
TIGHTEST = 1e-8


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
        Options of :func:`contact.solve.solve_contact`.
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
        state = _solved(composite, space, force, state, solving, where)
        yield state


def _solved(composite, space, force, start, solving, where):
    """The state of a force; a failure names what is pressed."""
    try:
        return solve_contact(composite, space, force=force, start=start, **solving)
    except NotConverged as error:
        error.add_note(f"{where}, F = {force:g} N")
        raise


def map_place(joint, settings, direction):
    """Offset of the contact maps in cells of a direction.

    Parameters
    ----------
    joint : xr.Dataset
        From :func:`mechanics.joint.describe_joint`.
    settings : dict
        From :func:`study.configuration.resolve_settings`.
    direction : str

    Returns
    -------
    int
    """
    offsets = joint["offset"].values
    offset = chosen_offset(settings["map_offset"], np.sort(offsets))
    cells = joint["offset_cells"].sel(contact_direction=direction).values
    return cells[offsets == offset][0]


def joint_states(specimen, joint, directions, offsets, settings, resolutions, solver):
    """:func:`contact_states` of some directions and offsets of a joint.

    Parameters
    ----------
    specimen, settings, resolutions, solver
        As for :func:`contact_states`.
    joint : xr.Dataset
        From :func:`mechanics.joint.describe_joint`.
    directions : sequence of str
    offsets : slice
        Which of the joint's.

    Returns
    -------
    xr.Dataset
        As of :func:`contact_states`; ``offset`` is that of the first of the directions.

    Raises
    ------
    NotConverged, InputError
        As :func:`contact_states`.
    """
    parts = []
    for direction in directions:
        cells = joint["offset_cells"].sel(contact_direction=direction).values[offsets]
        mapped = map_place(joint, settings, direction)
        found = contact_states(
            specimen, direction, cells, settings, resolutions, solver, mapped=mapped
        )
        parts.append(found)
    return side_by_side(parts)


def contact_states(specimen, direction, cells, settings, resolutions, solver, *, mapped=None):
    """Solve the contact at some offsets and resolutions, under the loads that are needed.

    Parameters
    ----------
    specimen : xr.Dataset
    direction : str
    cells : (n,) int array_like
        Offsets in cells; may be empty.
    settings : dict
        From :func:`study.configuration.resolve_settings`.
    resolutions : sequence of int
        Multiples k of the scan's spacing.
    solver : dict
        From :func:`study.configuration.solver_settings`. With an ``accuracy`` only those states
        are solved that :func:`mechanics.plan.solved_loads` names, else all.
    mapped : int, optional
        Offset of the contact maps in cells, from :func:`map_place`.

    Returns
    -------
    xr.Dataset
        The scalars of :data:`SCALARS` with their :data:`ERRORS`, and ``solved``, over (direction,
        offset, resolution, load), those of :data:`OFFSETS` over (direction, offset) and, for each
        resolution k, the contact domain ``in_contact_k`` over (direction, offset, load, y_k, x_k).
        NaN, and no contact, where a state was not solved. Where the states that are looked at
        closely are among them, :data:`mechanics.states.MAP_PRESSURE` over (load, y_k, x_k).

    Raises
    ------
    NotConverged
        If any state could not be verified; the message names it.
    InputError
        As :func:`hardness_of`.
    """
    area = nominal_area(specimen)
    forces = forces_of(settings["loads"], area)
    solving = {"rtol": solver["rtol"], "hardness": hardness_of(settings, specimen)}
    accuracy = solver.get("accuracy")
    cells = np.asarray(cells, int)
    offsets_made = cells * direction_spacing(specimen, direction)
    shape = (1, len(cells), len(resolutions), len(forces))
    kept = SCALARS | ERRORS
    scalars = {name: np.full(shape, np.nan) for name in kept}
    solved = np.zeros(shape, bool)
    fields = {}
    first = direction == settings["contact_directions"][0]
    for k, factor in enumerate(resolutions):
        space = _space(specimen, factor, settings, solver)
        touching = np.zeros((1, len(cells), len(forces), *space.shape), bool)
        for i, n in enumerate(cells):
            steps = solved_loads(
                settings,
                forces,
                area,
                first=first,
                mapped=n == mapped,
                factor=factor,
                everything=accuracy is None,
            )
            composite = prefractal(composite_topography(specimen, direction, n), factor)
            where = (
                f"specimen {specimen.attrs['name']}, direction {direction}, offset {n} cells, "
                f"resolution {factor}"
            )
            states = load_steps(composite, space, forces[steps], solving, where)
            pressures = []
            for j, state in zip(steps, states, strict=True):
                state = _exact_enough(state, composite, solving, accuracy, where)
                pressures.append(state.pressure.astype(np.float32))
                solved[0, i, k, j] = True
                touching[0, i, j] = state.in_contact
                for name, value in numbers_of(state).items():
                    scalars[name][0, i, k, j] = value
            if first and n == mapped and factor == min(settings["resolutions"]):
                fields |= map_pressure(pressures, offsets_made[i], direction, factor)
        fields[f"in_contact_{factor}"] = (
            ("direction", "offset", "load", f"y_{factor}", f"x_{factor}"),
            touching,
            cf_attrs("1", f"contact domain at {factor} times the scan's spacing"),
        )
    dims = ("direction", "offset", "resolution", "load")
    opened, spread = rigid_dilatancy(specimen, direction, cells)
    of_offsets = {"offset_made": offsets_made, "rigid_opening": opened, "composite_spread": spread}
    return xr.Dataset(
        {
            **{name: (dims, values, cf_attrs(*kept[name])) for name, values in scalars.items()},
            "solved": (dims, solved, cf_attrs("1", "whether the state was needed, and solved")),
            **{
                name: (("direction", "offset"), values[np.newaxis], cf_attrs(*OFFSETS[name]))
                for name, values in of_offsets.items()
            },
            **fields,
        },
        coords={
            "direction": [direction],
            "offset": ("offset", offsets_made, cf_attrs("mm", "shear offset v")),
            "resolution": (
                "resolution",
                np.array(resolutions),
                cf_attrs("1", "multiple k of the scan's spacing"),
            ),
            "load": ("load", forces, cf_attrs("N", "normal force F")),
        },
    )


def _exact_enough(state, composite, solving, accuracy, where):
    """The state, solved more tightly until its errors are within what is asked for.

    They are those of the closure of the interface, which may be a small part of the whole closure,
    and of Delta_sigma, estimated from the nodes that are undecided. Started from itself, a state is
    soon better.
    """
    if accuracy is None:
        return state
    few = accuracy["delta_sigma"] * np.count_nonzero(state.in_contact)
    space, rtol = state.space, solving["rtol"]
    sides = np.multiply(space.shape, space.spacing)
    settlement = bulk_settlement(state.force, space.modulus, *sides)
    # Faces that are flush have no interface to close.
    interface = abs(state.closure - settlement) if np.ptp(composite) > 0 else state.closure
    small = accuracy["closure"] * interface
    while rtol > TIGHTEST and (state.ambiguous > few or state.residual * state.closure > small):
        rtol /= TIGHTENING
        tighter = solving | {"rtol": rtol}
        state = _solved(composite, space, state.force, state, tighter, where)
    return state


def _space(specimen, factor, settings, solver):
    attrs = specimen.attrs
    shape = tuple(-(-attrs[f"window_n{axis}"] // factor) for axis in "yx")
    spacing = tuple(attrs[f"spacing_{axis}"] * factor for axis in "yx")
    return HalfSpace(shape, spacing, settings["material"]["e_star"], kernel=solver["kernel"])
