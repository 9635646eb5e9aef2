"""Sub-grids: the same surface on finer grids, and its contact states there."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from roughcontact.contact.state import ContactState
from roughcontact.elastic.halfspace import HalfSpace

from ..core.determined import decided_by_scan
from ..core.limits import RESOLVED_NODES
from ..joint.joint import prefractal
from ..joint.overlap import suspect_load_share
from .loading import JointLoading, Variant
from .settlement import interface_closure, interface_stiffness, window_settlement
from .state_scalars import resolved_slope, state_area
from .sweep import load_steps

#: Quantities of a state with a numerical error: unit, long name. They have the names that the error
#: budget publishes: `closure` and `stiffness` are of the interface alone, those of
#: :data:`states.states.SCALARS` of interface and blocks together.
STATE_QUANTITIES = {
    "closure": ("mm", "closure w_int from first touch"),
    "separation": ("mm", "separation of the mean planes, delta_r - w"),
    "area_corrected": ("mm2", "real contact area, corrected for its edge"),
    "stiffness": ("MPa/mm", "stiffness of the interface d sigma / d w_int"),
}

#: Key of what says whether fits take a state: 1 or 0.
SOUND = "sound"

#: Nodes around which the summit of the spline is looked for, and points per cell there. The spline
#: rises above its nodes by a few tenths of the difference between neighbours, so that a node much
#: lower than the highest ones has no summit beside it that matters.
SUMMIT_NODES, SUMMIT_POINTS = 64, 16


def subgrid(composite: ArrayLike, factor: int) -> np.ndarray:
    """Composite topography on cells ``factor`` times smaller: the cubic spline through its nodes.

    Nodes are centres of cells, so that n cells of s and 2 n cells of s/2 cover the same window, and
    the same nominal area, but have no centre in common; of odd factors each old centre is a new
    one. All are samples of one surface. Within half a cell of the window's edge the spline has no
    nodes beyond: it is continued evenly about the edge, which invents no summit there.
    """
    from scipy import ndimage

    heights = np.asarray(composite, float)
    if factor == 1:
        return heights
    return ndimage.zoom(heights, factor, order=3, mode="reflect", grid_mode=True)


def summit(composite: ArrayLike) -> float:
    """Largest height of the spline of :func:`subgrid`, mm."""
    from scipy import ndimage

    heights = np.asarray(composite, float)
    spline = ndimage.spline_filter(heights, order=3, mode="reflect")
    highest = np.argsort(heights, axis=None)[-SUMMIT_NODES:]
    around = np.linspace(-1, 1, 2 * SUMMIT_POINTS + 1)
    rows, columns = (
        np.clip(place[:, np.newaxis] + around, -0.5, n - 0.5)
        for place, n in zip(np.unravel_index(highest, heights.shape), heights.shape, strict=True)
    )
    points = np.broadcast_arrays(rows[:, :, np.newaxis], columns[:, np.newaxis, :])
    heights_around = ndimage.map_coordinates(
        spline, points, order=3, mode="reflect", prefilter=False
    )
    return float(max(heights_around.max(), heights.max()))


def subgrid_states(
    composite: np.ndarray,
    space: HalfSpace,
    factor: int,
    forces: ArrayLike,
    solving: Mapping[str, Any],
    where: str,
) -> Iterator[tuple[ContactState, float]]:
    """Contact states on cells ``factor`` times smaller, and the largest height on their grid, mm.

    Arguments as for :func:`states.sweep.load_steps`. The closure of a state counts from that
    height.
    """
    heights = subgrid(composite, factor)
    spacing = space.spacing[0] / factor, space.spacing[1] / factor
    kernel, boundary = space.kernel, space.boundary
    finer = HalfSpace(heights.shape, spacing, space.modulus, kernel=kernel, boundary=boundary)
    highest = float(heights.max())
    for state in load_steps(heights, finer, forces, solving, f"{where}, spacing / {factor}"):
        yield state, highest


def composite_quantities(
    loading: JointLoading, variants: Iterable[Variant], forces: np.ndarray, factor: int = 1
) -> dict[str, np.ndarray]:
    """:data:`STATE_QUANTITIES` and :data:`SOUND` (variant, load) of variants of a joint.

    Every ``factor``-th node is taken. The separation is max h - mean h - w: that of the mean planes
    within the window, which needs no highest node of the mated faces. Raises `NotConverged`.
    """
    names, rows = (*STATE_QUANTITIES, SOUND), []
    for variant in variants:
        composite = prefractal(variant.composite, factor)
        suspicious = prefractal(variant.suspicious, factor)
        space = loading.half_space(composite.shape, factor)
        where = f"specimen {loading.specimen.attrs['name']}, {variant.name}"
        states = load_steps(composite, space, forces, loading.solving, where)
        datum = float(composite.max()), float(composite.mean())
        of_loads = [
            state_quantities(state, *datum) | {SOUND: is_sound(state, suspicious)}
            for state in states
        ]
        rows.append([[of_state[name] for name in names] for of_state in of_loads])
    table = np.reshape(rows, (len(rows), len(forces), len(names))).astype(float)
    return dict(zip(names, np.moveaxis(table, -1, 0), strict=True))


def is_sound(state: ContactState, suspicious: np.ndarray) -> bool:
    """True of a state that fits take, as :func:`laws.scan_errors.on_sound_cells` of stored ones."""
    enough = np.count_nonzero(state.in_contact) >= RESOLVED_NODES
    share = suspect_load_share(state.pressure, suspicious)
    return bool(enough and not decided_by_scan(share))


def state_quantities(
    state: ContactState, highest: float, reference: float = 0.0
) -> dict[str, float]:
    """:data:`STATE_QUANTITIES` of a contact state.

    ``highest`` is the largest height of its composite topography, on its own grid, ``reference``
    that at zero offset on the scan's grid, from which dilatancy counts, mm. The separation is
    ``highest - reference - w``. The largest height rises as the grid gets finer, and so does the
    closure counted from it: their difference is the place of the rigid plane and knows nothing of
    the summit. The reference is a length of the joint and stays what it is.
    """
    space = state.space
    area = float(np.prod(np.multiply(space.shape, space.spacing)))
    settlement = float(window_settlement(space, state.force))
    stiffness = resolved_slope(state).value
    compliance = area / stiffness if stiffness else np.inf
    return {
        "closure": float(interface_closure(state.closure, settlement)),
        "separation": highest - reference - state.closure,
        "area_corrected": state_area(state),
        "stiffness": float(interface_stiffness(compliance, settlement / (state.force / area))),
    }
