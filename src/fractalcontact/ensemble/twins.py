"""Twins of a scan: random surfaces with its measured spectrum, a parametric bootstrap.

What one window shows has the error of a sample of one. Twins are further samples, of a population
that shares with the scan its power spectrum, directional and with its roll-off, the distribution of
its heights, and its mean plane; they are not the scan. The spread of what they show is the
population error of the scan's numbers.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from ..core.errors import InputError
from ..core.mean_plane import without_mean_plane
from ..core.settings import EnsembleSettings
from ..core.window import spacing_of, window_slices
from ..roughness.twin_surface import twin_doubt, twin_surface
from ..states.loading import JointLoading


def twin_loadings(
    loading: JointLoading[EnsembleSettings], seeds: Sequence[int]
) -> Iterator[JointLoading[EnsembleSettings]]:
    """Loadings of the twins of a scan, one a seed.

    ``loading`` is of the scan, at one offset. Of a face with its perfect match: a twin of the face,
    slid as the scan is. Of two scanned faces: a twin of their composite topography at the offset,
    and of a face on a plane, of an aperture map, a twin of it, each of the window alone, against a
    plane. Raises `InputError` if the surface is flat, or a side has fewer than eight nodes.

    The spectrum and the heights are those of the window that is solved. Waves longer than half of
    it are extrapolated. A twin against a plane has the mean plane of the scan; the twin of a face
    that slides on its match is level, as a tilt adds a constant to its composite topography.
    """
    specimen, rough = loading.specimen, _surface(loading)
    slid = _slides(loading)
    plane = 0.0 if slid else rough - without_mean_plane(rough)
    ny, nx = specimen["lower"].shape if slid else rough.shape
    try:
        surface = twin_surface(rough, spacing_of(specimen), (ny, nx))
    except ValueError as error:
        name = specimen.attrs["name"]
        raise InputError(f"specimen {name}, key 'twins': {error}; remove the key") from error
    if not slid:
        settings = replace(loading.settings, contact_directions=["none"], map_offset=None)
        loading = replace(loading, direction="none", cells=np.zeros(1, int), settings=settings)
    for seed in seeds:
        twin = _twin(specimen, plane + surface.drawn(seed), slid=slid)
        twin.attrs["name"] = f"{specimen.attrs['name']}, twin of seed {seed}"
        yield replace(loading, specimen=twin)


def doubt_of_twins(loading: JointLoading[EnsembleSettings]) -> str:
    """Reason why first touch and dilatancy of the twins of a scan mean little, or ""."""
    return twin_doubt(_surface(loading), spacing_of(loading.specimen))


def _slides(loading: JointLoading[EnsembleSettings]) -> bool:
    """True of a face with its perfect match, whose twin slides as it does."""
    return bool(loading.specimen.attrs["opposite"] == "match")


def _surface(loading: JointLoading[EnsembleSettings]) -> np.ndarray:
    """Surface (ny, nx) of the window that the twins are like, mm."""
    if not _slides(loading):
        return loading.composite(int(loading.cells[0]))
    whole = loading.specimen["lower"].values.astype(float)
    return whole[window_slices(loading.specimen)]


def _twin(specimen: xr.Dataset, heights: np.ndarray, *, slid: bool) -> xr.Dataset:
    """Specimen of the heights of a whole face, or of the window against a plane."""
    twin = specimen[["lower"]]
    if not slid:
        rows, columns = window_slices(specimen)
        twin = twin.isel(y=rows, x=columns)
        twin = twin.assign_attrs(opposite="flat", window_y0=0, window_x0=0)
    return twin.assign(lower=twin["lower"].copy(data=heights))
