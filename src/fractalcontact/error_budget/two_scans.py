"""Errors of two scanned faces: the spread over fair readings of their files, and registrations."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from ..core.intervals import t_quantile
from ..core.settings import Load
from ..registration.registration_scatter import stored_motions
from ..registration.surface_motion import Motion, Surface, grid_nodes
from ..scan.other_readings import other_readings
from ..states.loading import JointLoading
from ..states.seat import closure_from
from ..states.state_quantities import STATE_QUANTITIES, composite_quantities


def reading_values(loading: JointLoading, factor: int = 1) -> dict[str, np.ndarray]:
    """Closures, separation, area and stiffness by this reading and each other one.

    Arrays (reading, load) of :func:`states.state_quantities.composite_quantities` at ``factor``
    times the scan's spacing, this reading first, under the study's loads. A reading whose faces
    have a hole where the window slides is left out. Raises `NotConverged`.
    """
    (cells,) = loading.cells
    forces = loading.forces(loading.settings.loads)
    readings = {"this one": loading.specimen, **other_readings(loading.specimen)}
    variants = (
        replace(loading, specimen=specimen).variant(name, int(cells))
        for name, specimen in readings.items()
    )
    whole = (variant for variant in variants if np.isfinite(variant.composite).all())
    return composite_quantities(loading, whole, forces, factor)


def scan_spread(
    values: Mapping[str, np.ndarray], forces: np.ndarray, seat: float
) -> dict[str, np.ndarray] | None:
    """Scan error: largest distance of the other readings from this one.

    It is no half-width of chance: readings are few, and none is more likely than another.

    Parameters
    ----------
    values
        From :func:`reading_values`, under these ``forces`` (load,), N.
    seat : float
        Force from which the closure is seated, N; NaN for none.

    Returns
    -------
    dict of str to (load,) ndarray, or None
        Distances by :data:`states.state_quantities.STATE_QUANTITIES`, and that of the
        ``seated_closure``, from the seat, in their units; None without another reading.
    """
    if len(values["closure"]) < 2:
        return None
    return {
        name: np.abs(of_readings[1:] - of_readings[0]).max(axis=0)
        for name, of_readings in _compared(values, forces, seat).items()
    }


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

    Arrays (motion, load) of :func:`states.state_quantities.composite_quantities` at ``factor``
    times the scan's spacing, under the study's loads unless others are given; empty along the
    motions where the specimen holds none. Raises `NotConverged`.
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
        By the quantities of :func:`scan_spread`, in their units. None of a specimen that holds no
        further motions: one face, faces given in one frame, or faces that do not match.

    Notes
    -----
    All registrations are interpolated alike, so their spread does not hold what that smooths away.
    """
    count = len(values["closure"])
    if count < 2:
        return None
    return {
        name: t_quantile(count - 1) * of_motions.std(axis=0, ddof=1)
        for name, of_motions in _compared(values, forces, seat).items()
    }


def wider_spread(
    readings: Mapping[str, np.ndarray] | None, motions: Mapping[str, np.ndarray] | None
) -> dict[str, np.ndarray] | None:
    """Errors of two scans (load,) by quantity: the larger of two; None without either.

    ``readings`` are from :func:`scan_spread`, ``motions`` from
    :func:`registration_spread`.
    """
    if readings is None or motions is None:
        only = motions if readings is None else readings
        return None if only is None else dict(only)
    return {name: np.fmax(of, motions[name]) for name, of in readings.items()}


def _compared(
    values: Mapping[str, np.ndarray], forces: np.ndarray, seat: float
) -> dict[str, np.ndarray]:
    """Quantities of variants whose spread is stated: of states, and the closure from the seat."""
    of_states = {name: values[name] for name in STATE_QUANTITIES}
    return of_states | {"seated_closure": closure_from(values["closure"], forces, seat)}
