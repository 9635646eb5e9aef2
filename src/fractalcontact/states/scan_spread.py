"""Scan error of two scanned faces: spread over fair readings of their scans."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ..scan.other_readings import other_readings
from .loading import JointLoading
from .seat import closure_from
from .subgrid import STATE_QUANTITIES, composite_quantities


def reading_values(loading: JointLoading, factor: int = 1) -> dict[str, np.ndarray]:
    """Closures, separation, area and stiffness by this reading and each other one.

    Arrays (reading, load) of :func:`states.subgrid.composite_quantities` at ``factor`` times the
    scan's spacing, this reading first, under the study's loads. A reading
    whose faces have a hole where the window slides is left out. Raises `NotConverged`.
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
        Distances by :data:`states.subgrid.STATE_QUANTITIES`, and of the closure from the seat, in
        their units; None without another reading.
    """
    if len(values["closure"]) < 2:
        return None
    compared = {name: values[name] for name in STATE_QUANTITIES}
    compared["seated_closure"] = closure_from(values["closure"], forces, seat)
    return {name: np.abs(of[1:] - of[0]).max(axis=0) for name, of in compared.items()}


def wider_spread(
    readings: Mapping[str, np.ndarray] | None, motions: Mapping[str, np.ndarray] | None
) -> dict[str, np.ndarray] | None:
    """Errors of two scans (load,) by quantity: the larger of two; None without either.

    ``readings`` are from :func:`scan_spread`, ``motions`` from
    :func:`states.registration_spread.registration_spread`.
    """
    if readings is None or motions is None:
        only = motions if readings is None else readings
        return None if only is None else dict(only)
    return {name: np.fmax(of, motions[name]) for name, of in readings.items()}
