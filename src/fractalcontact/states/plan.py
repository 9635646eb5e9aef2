"""States of a study that are solved at the accuracy it requests."""

import numpy as np

from ..core.settings import ContactSettings
from .states import forces_of


def solved_loads(
    settings: ContactSettings,
    forces: np.ndarray,
    area: float,
    *,
    first: bool,
    at_maps: bool,
    factor: int,
    all_states: bool,
) -> np.ndarray:
    """Load steps of a curve that the plan solves: indices (m,) of the forces, N, ascending.

    ``first`` says that the curve is in the first direction whose contact is solved, ``at_maps``
    that it is at the offset of the contact maps, ``factor`` its resolution k; A_0 in mm2.

    Closure curves, their fits and the contact domains over load are shown in the first direction,
    at the finest resolution; how they change with the resolution, at the offset of the maps. In the
    other directions only the dilatancy under its loads is.
    """
    if all_states or (first and (at_maps or factor == min(settings.resolutions))):
        return np.arange(len(forces))
    if factor != min(settings.resolutions):
        return np.arange(0)
    wanted = forces_of(settings.drawn_loads, area)
    return np.flatnonzero(np.isin(forces, wanted))
