"""Other fair readings of two scanned faces: outliers treated otherwise, faces not registered.

A pair of scans is read in one way of several that are as fair. The others are kept with the
specimen, on its own grid, so that their contact can be solved beside its own.
"""

import json
from collections.abc import Iterator, Sequence
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
#: Suspicious cells (reading, mark, y, x) of those heights, by these variables of a specimen.
OTHER_MARKS = "other_marks"
MARKS = ("suspect_lower", "suspect_upper", "overlap")
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
    on_grid: dict[str, tuple[np.ndarray, np.ndarray]] = {}
    # One at a time: of large scans each takes much memory.
    for words, other in _readings(faces, scans, options, settings):
        heights, marks = _on_grid(specimen, other, ("lower", "upper"), MARKS)
        if _is_whole(specimen, heights):
            on_grid[words] = heights, np.nan_to_num(marks, nan=1.0).astype(np.int8)
    if not on_grid:
        return specimen
    heights, marks = (np.stack(of) for of in zip(*on_grid.values(), strict=True))
    of_heights = cf_attrs("mm", "heights of both faces by another fair reading of the scans")
    of_marks = cf_attrs("1", "suspicious cells of those heights")
    coords = {READING: list(on_grid), "face": ["lower", "upper"], "mark": list(MARKS)}
    return specimen.assign_coords(coords).assign(
        {
            OTHER_FACES: ((READING, "face", "y", "x"), heights, of_heights),
            OTHER_MARKS: ((READING, "mark", "y", "x"), marks, of_marks),
        }
    )


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


def _on_grid(specimen, other, *of: Sequence[str]) -> list[np.ndarray]:
    """Variables of another reading on the grid of a specimen, (variable, y, x) by group of names.

    NaN where the other reading has no cell.
    """
    places = {
        axis: other.indexes[axis].get_indexer(
            specimen[axis], method="nearest", tolerance=0.25 * specimen.attrs[f"spacing_{axis}"]
        )
        for axis in "yx"
    }
    rows, columns = (np.flatnonzero(places[axis] >= 0) for axis in "yx")
    there = np.ix_(places["y"][rows], places["x"][columns])
    groups = []
    for names in of:
        values = np.full((len(names), specimen.sizes["y"], specimen.sizes["x"]), np.nan)
        for one, name in zip(values, names, strict=True):
            one[np.ix_(rows, columns)] = other[name].values[there]
        groups.append(values)
    return groups


def _is_whole(specimen, heights) -> bool:
    """True of heights (face, y, x) without a hole in the window."""
    y, x, ny, nx = (specimen.attrs[f"window_{of}"] for of in ("y0", "x0", "ny", "nx"))
    return bool(np.isfinite(heights[:, y : y + ny, x : x + nx]).all())


def other_readings(specimen: xr.Dataset) -> dict[str, xr.Dataset]:
    """The specimen by each other reading of its scans; empty where it has none."""
    if OTHER_FACES not in specimen:
        return {}
    names = [str(name) for name in specimen[READING].values]
    parts = {face: specimen[OTHER_FACES].sel(face=face) for face in ("lower", "upper")}
    if OTHER_MARKS in specimen:
        parts |= {mark: specimen[OTHER_MARKS].sel(mark=mark) for mark in MARKS}
    return {
        name: specimen.assign(
            {
                of: specimen[of].copy(data=part.sel({READING: name}).values)
                for of, part in parts.items()
            }
        )
        for name in names
    }
