"""Registration error of two scanned faces: spread over registrations that are as good."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from ..core.intervals import t_quantile
from ..core.limits import PRESSURE_ROUNDING
from ..core.settings import Load
from ..registration.registration_scatter import stored_motions
from ..registration.surface_motion import Motion, Surface, grid_nodes
from .loading import JointLoading
from .subgrid import STATE_QUANTITIES, composite_quantities

#: Quantities whose spread is computed: those of :mod:`states.subgrid`, and the closure from the
#: first load at the seat or beyond, mm.
SPREAD_QUANTITIES = (*STATE_QUANTITIES, "seated_closure")


def moved_specimen(specimen: xr.Dataset, motion: Motion) -> xr.Dataset:
    """A specimen of two faces with its upper face moved once more, by a small motion.

    Heights are interpolated by a cubic spline; where a cell around is missing the height stays, but
    for the tilt.
    """
    upper = specimen["upper"].assign_attrs(
        spacing_x=specimen.attrs["spacing_x"], spacing_y=specimen.attrs["spacing_y"]
    )
    x, y = grid_nodes(upper)
    moved = Surface(upper)(*motion.back(x, y))
    moved = np.where(np.isfinite(moved), moved, upper.values) + motion.rise(x, y)
    return specimen.assign(upper=upper.copy(data=moved))


def registration_values(
    loading: JointLoading, loads: Sequence[Load] | None = None
) -> dict[str, np.ndarray]:
    """Closures, separation, area and stiffness of each registration that is as good.

    Arrays (motion, load) by :data:`SPREAD_QUANTITIES`, under the study's loads unless others are
    given; empty along the motions where the specimen holds none. The first four are those of
    :func:`states.subgrid.composite_quantities`. Raises `NotConverged`.
    """
    (cells,) = loading.cells
    forces = loading.forces(loading.settings.loads if loads is None else loads)
    motions = stored_motions(loading.specimen)
    moved = (moved_specimen(loading.specimen, motion) for motion in motions)
    composites = (
        ("another registration", replace(loading, specimen=specimen).composite(int(cells)))
        for specimen in moved
    )
    values = composite_quantities(loading, composites, forces)
    seating = loading.settings.seating_pressure * loading.area * (1 - PRESSURE_ROUNDING)
    seat = min(int(np.searchsorted(forces, seating)), len(forces) - 1)
    closure = values["closure"]
    return values | {"seated_closure": closure - closure[:, [seat]]}


def registration_spread(
    loading: JointLoading, loads: Sequence[Load] | None = None
) -> dict[str, np.ndarray] | None:
    """Registration error: half-widths of the 95 % spread over registrations that are as good.

    Parameters
    ----------
    loading, loads
        As for :func:`registration_values`.

    Returns
    -------
    dict of str to (load,) ndarray, or None
        By :data:`SPREAD_QUANTITIES`, in their units. None of a specimen that holds no further
        motions: one face, faces given in one frame, or faces that do not match.

    Raises
    ------
    NotConverged
        If a state could not be verified.

    Notes
    -----
    All registrations are interpolated alike, so their spread does not hold what that smooths away.
    """
    values = registration_values(loading, loads)
    count = len(values["closure"])
    if count < 2:
        return None
    return {
        name: t_quantile(count - 1) * of_motions.std(axis=0, ddof=1)
        for name, of_motions in values.items()
    }
