"""Registration error of two scanned faces: spread over registrations that are as good."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from ..core.intervals import t_quantile
from ..core.settings import Load
from ..registration.registration_scatter import stored_motions
from ..registration.surface_motion import Motion, Surface, grid_nodes
from .loading import JointLoading
from .seat import closure_from
from .subgrid import STATE_QUANTITIES, composite_quantities

#: Quantities whose spread is computed: those of :mod:`states.subgrid`, and the closure from the
#: seat, mm.
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
    loading: JointLoading, loads: Sequence[Load] | None = None, factor: int = 1
) -> dict[str, np.ndarray]:
    """Closures, separation, area and stiffness of each registration that is as good.

    Arrays (motion, load) of :func:`states.subgrid.composite_quantities` at ``factor`` times the
    scan's spacing, under the study's loads unless others are given; empty along the motions where
    the specimen holds none. Raises `NotConverged`.
    """
    (cells,) = loading.cells
    forces = loading.forces(loading.settings.loads if loads is None else loads)
    motions = stored_motions(loading.specimen)
    moved = (moved_specimen(loading.specimen, motion) for motion in motions)
    variants = (
        replace(loading, specimen=specimen).variant("another registration", int(cells))
        for specimen in moved
    )
    return composite_quantities(loading, variants, forces, factor)


def registration_spread(
    values: Mapping[str, np.ndarray], forces: np.ndarray, seat: float
) -> dict[str, np.ndarray] | None:
    """Registration error: half-widths of the 95 % spread over registrations that are as good.

    Parameters
    ----------
    values
        From :func:`registration_values`, under these ``forces`` (load,), N.
    seat : float
        Force from which the closure is seated, N; NaN for none.

    Returns
    -------
    dict of str to (load,) ndarray, or None
        By :data:`SPREAD_QUANTITIES`, in their units. None of a specimen that holds no further
        motions: one face, faces given in one frame, or faces that do not match.

    Notes
    -----
    All registrations are interpolated alike, so their spread does not hold what that smooths away.
    """
    count = len(values["closure"])
    if count < 2:
        return None
    compared = {name: values[name] for name in STATE_QUANTITIES}
    compared["seated_closure"] = closure_from(values["closure"], forces, seat)
    return {
        name: t_quantile(count - 1) * of_motions.std(axis=0, ddof=1)
        for name, of_motions in compared.items()
    }
