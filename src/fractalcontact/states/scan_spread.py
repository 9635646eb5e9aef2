"""Scan error of two scanned faces: spread over fair readings of their scans."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..core.settings import Load
from ..scan.other_readings import other_readings
from .loading import JointLoading
from .subgrid import composite_quantities


def reading_values(
    loading: JointLoading, loads: Sequence[Load] | None = None
) -> dict[str, np.ndarray]:
    """Closures, separation, area and stiffness by this reading and each other one.

    Arrays (reading, load) of :func:`states.subgrid.composite_quantities`, this reading first, under
    the study's loads unless others are given. A reading whose faces have a hole where the window
    slides is left out. Raises `NotConverged`.
    """
    (cells,) = loading.cells
    forces = loading.forces(loading.settings.loads if loads is None else loads)
    readings = {"this one": loading.specimen, **other_readings(loading.specimen)}
    composites = (
        (words, replace(loading, specimen=specimen).composite(int(cells)))
        for words, specimen in readings.items()
    )
    whole = ((words, h) for words, h in composites if np.isfinite(h).all())
    return composite_quantities(loading, whole, forces)


def scan_spread(
    loading: JointLoading, loads: Sequence[Load] | None = None
) -> dict[str, np.ndarray] | None:
    """Scan error: largest distance of the other readings from this one.

    It is no half-width of chance: readings are few, and none is more likely than another.

    Distances (load,) by :data:`states.subgrid.STATE_QUANTITIES`, in their units; None without
    another reading. Raises `NotConverged`.
    """
    if not other_readings(loading.specimen):
        return None
    values = reading_values(loading, loads)
    if len(values["closure"]) < 2:
        return None
    return {name: np.abs(of[1:] - of[0]).max(axis=0) for name, of in values.items()}
