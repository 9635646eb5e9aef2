"""Other fair readings of two scanned faces: outliers treated otherwise, faces not registered.

A pair of scans is read in one way of several that are as fair. The others are kept with the
specimen, on its own grid, so that their contact can be solved beside its own.
"""

import json
from collections.abc import Iterator
from contextlib import suppress

import numpy as np
import xarray as xr

from ..core.errors import InputError
from ..core.labels import cf_attrs
from ..core.settings import SpecimenSettings
from ..gridding.faces import grid_pair
from ..gridding.ungridded import UngriddedScan
from ..surface.specimen import make_specimen, window_arguments
from .options import ScanOptions

#: Heights (reading, face, y, x) of both faces by other readings of the scans, in a specimen.
OTHER_FACES = "other_faces"
#: Dimension of the readings.
READING = "reading"
#: Registrations that are compared, the one of a sidecar and none, and treatments of outliers.
_UNREGISTERED, _REGISTERED = "none", "rigid"
_TREATED = {"keep": "fill", "mask": "fill", "fill": "keep"}
#: Smallest correlation of the levelled faces as given, for faces in one frame: below it the files
#: have frames of their own, and not to register them is no fair reading.
MIN_CORRELATION = 0.9


def with_other_readings(
    specimen: xr.Dataset,
    faces: tuple[xr.DataArray, xr.DataArray],
    scans: tuple[UngriddedScan, UngriddedScan],
    options: ScanOptions,
    settings: SpecimenSettings,
) -> xr.Dataset:
    """Specimen of two faces with :data:`OTHER_FACES`, where there are others.

    Parameters
    ----------
    specimen : xr.Dataset
        From :func:`surface.specimen.make_specimen`.
    faces : tuple of DataArray (y, x)
        Both faces that the specimen was made from.
    scans : tuple of UngriddedScan
        Numbers of both files, from :func:`scan.read.faces_in_mm`.
    options : ScanOptions
        Scan keys of the pair.
    settings : SpecimenSettings
    """
    on_grid: dict[str, np.ndarray] = {}
    # One at a time: of large scans each takes much memory.
    for words, other in _readings(faces, scans, options, settings):
        heights = _on_grid(specimen, other)
        if heights is not None:
            on_grid[words] = heights
    if not on_grid:
        return specimen
    attrs = cf_attrs("mm", "heights of both faces by another fair reading of the scans")
    dims = (READING, "face", "y", "x")
    every = np.stack(list(on_grid.values()))
    coords = {READING: list(on_grid), "face": ["lower", "upper"]}
    return specimen.assign_coords(coords).assign({OTHER_FACES: (dims, every, attrs)})


def _readings(faces, scans, options, settings) -> Iterator[tuple[str, xr.Dataset]]:
    """Other readings by name, each as a specimen."""
    stated = options.registration or _REGISTERED
    otherwise = _REGISTERED if stated == _UNREGISTERED else _UNREGISTERED
    pairs = {stated: faces}
    if stated == _UNREGISTERED or _in_one_frame(faces):
        lower, upper = scans
        # As they were given, faces may share no area, or lie in the wrong order.
        with suppress(InputError):
            pairs[otherwise] = grid_pair(lower, upper, otherwise, options.mirror_upper)
    for registration, pair in pairs.items():
        for outliers in (settings.outliers, _TREATED[settings.outliers]):
            if (registration, outliers) == (stated, settings.outliers):
                continue
            arguments = window_arguments(settings) | {"outliers": outliers}
            try:
                other = make_specimen(*pair, name="another reading", **arguments)
            except InputError:  # its window finds no place
                continue
            yield f"registration {registration}, outliers {outliers}", other


def _in_one_frame(faces) -> bool:
    """True of faces that registration moved, and that lay well on each other before."""
    record = json.loads(faces[1].attrs["registration"])
    if not record["applied"] or record["gap_mean_before_mm"] is None:
        return False
    return (record["correlation_before"] or 0.0) >= MIN_CORRELATION


def _on_grid(specimen, other) -> np.ndarray | None:
    """Heights (face, y, x) on the grid of a specimen; None where its window has a hole."""
    places = {
        axis: other.indexes[axis].get_indexer(
            specimen[axis], method="nearest", tolerance=0.25 * specimen.attrs[f"spacing_{axis}"]
        )
        for axis in "yx"
    }
    heights = np.full((2, specimen.sizes["y"], specimen.sizes["x"]), np.nan)
    rows, columns = (np.flatnonzero(places[axis] >= 0) for axis in "yx")
    for face, name in zip(heights, ("lower", "upper"), strict=True):
        there = np.ix_(places["y"][rows], places["x"][columns])
        face[np.ix_(rows, columns)] = other[name].values[there]
    y, x, ny, nx = (specimen.attrs[f"window_{of}"] for of in ("y0", "x0", "ny", "nx"))
    return heights if np.isfinite(heights[:, y : y + ny, x : x + nx]).all() else None


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
