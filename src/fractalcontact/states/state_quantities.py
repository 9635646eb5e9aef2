"""Quantities of a contact state whose errors are published, and of variants of a joint."""

from collections.abc import Iterable

import numpy as np

from roughcontact.contact.state import ContactState

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
