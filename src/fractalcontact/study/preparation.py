"""Preparation of a specimen from scan files, for studies and for `check_scans`."""

from collections.abc import Mapping
from pathlib import Path

import xarray as xr

from ..core.settings import SpecimenSettings
from ..registration.registration_scatter import motion_variables, scattered_motions
from ..scan.read import read_faces
from ..surface.specimen import make_specimen
from .configuration import window_arguments


def prepare_specimen(
    lower: Path | str,
    upper: Path | str | None,
    options: Mapping,
    settings: SpecimenSettings,
    name: str,
) -> xr.Dataset:
    """Read the faces of a specimen, level them and place the window.

    Of two registered faces it also holds further motions that are statistically as good.

    Parameters
    ----------
    lower, upper : path-like
        ``upper`` is None if one face was scanned.
    options : mapping
        Scan keys of the sidecar.
    settings : SpecimenSettings
    name : str

    Returns
    -------
    xr.Dataset
        As :func:`surface.specimen.make_specimen` makes it.

    Raises
    ------
    InputError
        If a file cannot be read, or the window finds no place.
    """
    faces = read_faces(lower, upper, options)
    specimen = make_specimen(*faces, name=name, **window_arguments(settings))
    z_l, z_u = faces
    motions = [] if z_u is None else scattered_motions(z_l, z_u)
    return specimen.assign(motion_variables(motions)) if motions else specimen
