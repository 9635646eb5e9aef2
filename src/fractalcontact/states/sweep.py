"""Contact states over offsets, loads and resolutions, the work of one job."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from roughcontact.contact.solve import solve_contact
from roughcontact.contact.state import ContactState
from roughcontact.elastic.halfspace import HalfSpace
from roughcontact.errors import NotConverged

from ..core.datasets import labelled_dataset
from ..core.labels import cf_attrs
from ..core.settings import ContactSettings, Solver
from ..joint.contact_dips import PARTS, STEPS, dips_by_force
from ..joint.joint import prefractal, rigid_dilatancy
from .loading import JointLoading
from .plan import solved_loads
from .settlement import interface_closure, window_settlement
from .state_scalars import aperture, numbers_of
from .states import (
    DIP,
    ERRORS,
    OFFSET_GAP,
    OFFSETS,
    REASONS,
    SCALARS,
    chosen_offset,
    concat_directions,
    forces_of,
    map_fields,
)

#: Factor by which the tolerance is tightened where that of the study leaves too large an error.
TIGHTENING = 10.0
#: Smallest tolerance: nodes that just touch stay ambiguous at any tolerance.
TIGHTEST = 1e-8


def load_steps(
    composite: np.ndarray,
    space: HalfSpace,
    forces: ArrayLike,
    solving: Mapping[str, Any],
    where: str,
) -> Iterator[ContactState]:
    """States under rising forces, each started from the one before.

    Parameters
    ----------
    composite : (ny, nx) ndarray
        h, mm.
    space : HalfSpace
    forces : (n,) array_like
        N, ascending.
    solving : mapping
        Options of :func:`contact.solve.solve_contact`.
    where : str
        Name of the loaded specimen or window, for errors.

    Raises
    ------
    NotConverged
        If a state could not be verified; its note names it.
    """
    state, composite = None, np.ascontiguousarray(composite)  # copied once for all loads
    for force in np.asarray(forces):
        state = _solved(composite, space, force, state, solving, where)
        yield state


def _solved(
    composite: np.ndarray,
    space: HalfSpace,
    force: float,
    start: ContactState | None,
    solving: Mapping[str, Any],
    where: str,
) -> ContactState:
    """State under a force; a failure names the specimen and state."""
    try:
        return solve_contact(composite, space, force=force, start=start, **solving)
    except NotConverged as error:
        error.add_note(f"{where}, F = {force:g} N")
        raise


def map_place(joint: xr.Dataset, settings: ContactSettings, direction: str) -> int:
    """Offset of the contact maps in cells of a direction."""
    offsets = joint["offset"].values
    offset = chosen_offset(settings.map_offset, np.sort(offsets))
    cells = joint["offset_cells"].sel(contact_direction=direction).values
    return cells[offsets == offset][0]


def joint_states(
    specimen: xr.Dataset,
    joint: xr.Dataset,
    directions: Sequence[str],
    offsets: slice,
    settings: ContactSettings,
    resolutions: Sequence[int],
    solver: Solver,
) -> xr.Dataset:
    """Contact states of a joint in some directions, at some of its offsets and resolutions.

    ``offsets`` is a slice. As :func:`contact_states`; ``offset`` is that of the first of the
    directions.
    """
    states = []
    for direction in directions:
        whole = JointLoading.of_joint(specimen, joint, direction, settings, solver)
        map_cells = map_place(joint, settings, direction)
        states.append(
            contact_states(whole.at(whole.cells[offsets]), resolutions, map_cells=map_cells)
        )
    return concat_directions(states)


def contact_states(
    loading: JointLoading[ContactSettings],
    resolutions: Sequence[int],
    *,
    map_cells: int | None = None,
    lightly: bool = False,
) -> xr.Dataset:
    """Contact states at some offsets and resolutions, under the loads that are needed.

    Parameters
    ----------
    loading : JointLoading
        Where the solver states an ``accuracy``, only those states are solved that
        :func:`states.plan.solved_loads` names, else all.
    resolutions : sequence of int
        Multiples k of the scan's spacing.
    map_cells : int, optional
        Offset of the contact maps in cells, from :func:`map_place`.
    lightly : bool
        Without dips, and with the stiffness at the finest resolution alone.

    Returns
    -------
    xr.Dataset
        The scalars of :data:`SCALARS` with :data:`ERRORS` and :data:`REASONS`, and ``solved``, over
        (direction, offset, resolution, load), those of :data:`OFFSETS` over (direction, offset)
        and, for each resolution k, the contact domain ``in_contact_k`` over (direction, offset,
        normal_force, y_k, x_k). NaN, and no contact, where a state was not solved. Where the
        states that are looked at closely are among them, those of
        :data:`states.states.MAP_FIELDS`, over (normal_force, y_k, x_k) or, of the offsets,
        (offset, y_k, x_k).

    Raises
    ------
    NotConverged
        If any state could not be verified; the message names it.
    InputError
        As :func:`states.states.hardness_of`.
    """
    settings, direction, cells = loading.settings, loading.direction, loading.cells
    forces = loading.forces(settings.loads)
    shape = (1, len(cells), len(resolutions), len(forces))
    scalars = {name: np.full(shape, np.nan) for name in SCALARS | ERRORS}
    scalars |= {name: np.full(shape, "", object) for name in REASONS}
    solved = np.zeros(shape, bool)
    dips = np.full((*shape, len(STEPS), PARTS), np.nan, np.float32)
    fields: dict[str, tuple] = {}
    reference = int(np.argmin(np.abs(forces - forces_of([settings.map_load], loading.area)[0])))
    for k, factor in enumerate(resolutions):
        grid = tuple(-(-n // factor) for n in loading.shape)
        space = loading.half_space(grid, factor)
        touching = np.zeros((1, len(cells), len(forces), *grid), bool)
        finest = factor == min(settings.resolutions)
        looked_at, stiff = finest and _in_first_direction(loading), finest or not lightly
        of_offsets = np.full((len(cells), *grid), np.nan, np.float32) if looked_at else None
        for i, n in enumerate(cells):
            pressures, gaps = [], []
            suspicious = prefractal(loading.suspect_nodes(n), factor)
            slopes = [] if lightly else loading.contact_dips(n, factor)
            for j, state in _load_curve(loading, n, factor, space, at_maps=n == map_cells):
                pressures.append(state.pressure.astype(np.float32))
                gaps.append(aperture(state).astype(np.float32))
                if of_offsets is not None and j == reference:
                    of_offsets[i] = gaps[-1]
                solved[0, i, k, j] = True
                for step, of_step in enumerate(slopes):
                    dips[0, i, k, j, step] = dips_by_force(state.pressure, of_step)
                touching[0, i, j] = state.in_contact
                for name, value in numbers_of(state, suspicious, stiff=stiff).items():
                    scalars[name][0, i, k, j] = value
            if looked_at and n == map_cells:
                fields |= map_fields(pressures, gaps, loading.offsets[i], direction, factor)
        if of_offsets is not None:
            words = cf_attrs("mm", "gap g under the reference load")
            fields[OFFSET_GAP] = ("offset", f"y_{factor}", f"x_{factor}"), of_offsets, words
        fields[f"in_contact_{factor}"] = (
            ("direction", "offset", "normal_force", f"y_{factor}", f"x_{factor}"),
            touching,
            cf_attrs("1", f"contact domain at {factor} times the scan's spacing"),
        )
    if loading.slides and not lightly:
        words = cf_attrs("degree", "apparent dip along the sliding, by equal parts of the force")
        dims = ("direction", "offset", "resolution", "normal_force", "dip_step", "force_part")
        fields[DIP] = dims, dips, words
    return _labelled_states(loading, resolutions, scalars | {"solved": solved}).assign(fields)


def _in_first_direction(loading: JointLoading[ContactSettings]) -> bool:
    return loading.direction == loading.settings.contact_directions[0]


def _load_curve(
    loading: JointLoading[ContactSettings],
    cells: int,
    factor: int,
    space: HalfSpace,
    *,
    at_maps: bool,
) -> Iterator[tuple[int, ContactState]]:
    """Places among the loads, and states, that are needed at one offset and resolution."""
    settings, accuracy = loading.settings, loading.solver.accuracy
    forces = loading.forces(settings.loads)
    steps = solved_loads(
        settings,
        forces,
        loading.area,
        first=_in_first_direction(loading),
        at_maps=at_maps,
        factor=factor,
        all_states=accuracy is None,
    )
    composite = prefractal(loading.composite(cells), factor)
    where = (
        f"specimen {loading.specimen.attrs['name']}, direction {loading.direction}, "
        f"offset {cells} cells, resolution {factor}"
    )
    states = load_steps(composite, space, forces[steps], loading.solving, where)
    for step, state in zip(steps, states, strict=True):
        yield step, _exact_enough(state, composite, loading.solving, accuracy, where)


def _labelled_states(
    loading: JointLoading, resolutions: Sequence[int], of_states: Mapping[str, np.ndarray]
) -> xr.Dataset:
    """The dataset of :func:`contact_states` but for its fields."""
    forces = loading.forces(loading.settings.loads)
    opened, spread = rigid_dilatancy(loading.specimen, loading.direction, loading.cells)
    of_offsets = {
        "offset_on_grid": loading.offsets,
        "rigid_opening": opened,
        "composite_spread": spread,
    }
    dims = ("direction", "offset", "resolution", "normal_force")
    of_scalars = SCALARS | ERRORS | REASONS
    table: dict[str, tuple] = {name: (dims, *words) for name, words in of_scalars.items()}
    table["solved"] = (dims, "1", "whether the state was needed, and solved")
    table |= {name: (dims[:2], *words) for name, words in OFFSETS.items()}
    return labelled_dataset(
        table,
        {**of_states, **{name: values[np.newaxis] for name, values in of_offsets.items()}},
        coords={
            "direction": [loading.direction],
            "offset": ("offset", loading.offsets, cf_attrs("mm", "shear offset v")),
            "resolution": (
                "resolution",
                np.array(resolutions),
                cf_attrs("1", "multiple k of the scan's spacing"),
            ),
            "normal_force": ("normal_force", forces, cf_attrs("N", "normal force F")),
        },
        attrs={"boundary": loading.settings.boundary},
    )


def _exact_enough(
    state: ContactState,
    composite: np.ndarray,
    solving: Mapping[str, Any],
    accuracy: Mapping[str, float] | None,
    where: str,
) -> ContactState:
    """The state, solved more tightly until its errors are within the requested accuracy.

    The errors are of the interface closure, which may be a small part of the whole closure, and of
    Delta_sigma, estimated from the ambiguous nodes. A state that starts from itself improves within
    few iterations.
    """
    if accuracy is None:
        return state
    few = accuracy["delta_sigma"] * np.count_nonzero(state.in_contact)
    space, rtol = state.space, solving["rtol"]
    settlement = window_settlement(space, state.force)
    # Flush faces have no interface; their own closure is the scale of the error.
    flush = np.ptp(composite) == 0
    closing = state.closure if flush else abs(interface_closure(state.closure, settlement))
    small = accuracy["closure"] * closing
    while rtol > TIGHTEST and (state.ambiguous > few or state.residual * state.closure > small):
        rtol /= TIGHTENING
        tighter = {**solving, "rtol": rtol}
        state = _solved(composite, space, state.force, state, tighter, where)
    return state
