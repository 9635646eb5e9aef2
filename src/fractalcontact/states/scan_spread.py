"""Scan error of two scanned faces: spread over fair readings of their scans."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from ..core.settings import Load
from .loading import JointLoading
from .subgrid import QUANTITIES, state_quantities
from .sweep import load_steps

#: Heights (reading, face, y, x) of both faces by other readings of the scans, in a specimen.
OTHER_FACES = "other_faces"
#: Their dimension.
READING = "reading"


def other_readings(specimen: xr.Dataset) -> dict[str, xr.Dataset]:
    """The specimen by each other reading of its scans; empty where it has none."""
    if OTHER_FACES not in specimen:
        return {}
    return {
        str(words): specimen.assign(
            {
                face: specimen[face].copy(data=heights.sel(face=face).values)
                for face in ("lower", "upper")
            }
        )
        for words, heights in zip(
            specimen[READING].values, specimen[OTHER_FACES].transpose(READING, ...), strict=True
        )
    }


def reading_values(
    loading: JointLoading, loads: Sequence[Load] | None = None
) -> dict[str, np.ndarray]:
    """Closures, separation, area and stiffness by this reading and each other one.

    Parameters
    ----------
    loading : JointLoading
        Of two scanned faces, at one offset.
    loads : sequence of (float, str), optional
        Those solved; the study's if left out.

    Returns
    -------
    dict of str to (reading, load) ndarray
        By :data:`states.subgrid.QUANTITIES`, this reading first. The separation is that of
        :func:`states.registration_spread.registration_values`. A reading whose faces have a hole
        where the window slides is left out.

    Raises
    ------
    NotConverged
        If a state could not be verified.
    """
    (cells,) = loading.cells
    forces = loading.forces(loading.settings.loads if loads is None else loads)
    space = loading.half_space(loading.shape)
    rows = []
    for words, specimen in {
        "this one": loading.specimen,
        **other_readings(loading.specimen),
    }.items():
        composite = replace(loading, specimen=specimen).composite(int(cells))
        if not np.isfinite(composite).all():
            continue
        where = f"specimen {specimen.attrs['name']}, {words}"
        datum = float(composite.max()), float(composite.mean())
        states = load_steps(composite, space, forces, loading.solving, where)
        found = [state_quantities(state, *datum) for state in states]
        rows.append({name: np.array([one[name] for one in found]) for name in QUANTITIES})
    return {name: np.array([row[name] for row in rows]) for name in QUANTITIES}


def scan_spread(
    loading: JointLoading, loads: Sequence[Load] | None = None
) -> dict[str, np.ndarray] | None:
    """Scan error: largest distance of the other readings from this one.

    Not a half-width of chance: readings are few, and none is more likely than another.

    Parameters
    ----------
    loading, loads
        As for :func:`reading_values`.

    Returns
    -------
    dict of str to (load,) ndarray, or None
        By :data:`states.subgrid.QUANTITIES`, in their units. None without another reading.

    Raises
    ------
    NotConverged
        If a state could not be verified.
    """
    if not other_readings(loading.specimen):
        return None
    values = reading_values(loading, loads)
    if len(values["closure"]) < 2:
        return None
    return {name: np.abs(of[1:] - of[0]).max(axis=0) for name, of in values.items()}
