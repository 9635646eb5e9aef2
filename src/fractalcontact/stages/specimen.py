"""Stages of a specimen before contact: dimension, scan quality, sliding joint."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import xarray as xr

from ..core.datasets import titled
from ..core.settings import SpecimenSettings
from ..core.window import spacing_of
from ..joint.joint import describe_joint
from ..registration.registration_scatter import motion_variables, scattered_motions
from ..roughness.dimension import surface_dimension
from ..roughness.quality import scan_quality
from ..scan.read import read_faces
from ..surface.specimen import make_specimen, window_arguments
from .other_readings import with_other_readings


def stages_of_scan(
    files: Sequence[str],
    options: Mapping,
    settings: SpecimenSettings,
    name: str,
) -> dict[str, xr.Dataset]:
    """Stages of :func:`specimen_stages` from scan files: the lower face, and the upper if scanned.

    ``options`` are the scan keys of the sidecar. Raises InputError as :func:`prepare_specimen`.
    """
    lower, upper = files[0], files[1] if len(files) > 1 else None
    return specimen_stages(prepare_specimen(lower, upper, options, settings, name), settings)


def prepare_specimen(
    lower: Path | str,
    upper: Path | str | None,
    options: Mapping,
    settings: SpecimenSettings,
    name: str,
) -> xr.Dataset:
    """Specimen of :func:`surface.specimen.make_specimen`: faces read and levelled, window placed.

    Of two registered faces it also holds further motions that are statistically as good, and the
    heights by other fair readings of the scans.

    Parameters
    ----------
    lower, upper : path-like
        ``upper`` is None if one face was scanned.
    options : mapping
        Scan keys of the sidecar.
    settings : SpecimenSettings
    name : str

    Raises
    ------
    InputError
        If a file cannot be read, or the window finds no place.
    """
    faces = read_faces(lower, upper, options)
    specimen = make_specimen(*faces, name=name, **window_arguments(settings))
    z_l, z_u = faces
    if z_u is None or upper is None:
        return specimen
    if motions := scattered_motions(z_l, z_u):
        specimen = specimen.assign(motion_variables(motions))
    return with_other_readings(specimen, (z_l, z_u), (lower, upper), options, settings)


@titled(
    specimens="levelled faces, mask, window and where they came from",
    quality="relief, spectra and noise floor of each face, and where its fractal range ends",
    surface_dimension="Delta_g of each face by several estimators",
    joints="offsets and composite topographies",
)
def specimen_stages(specimen: xr.Dataset, settings: SpecimenSettings) -> dict[str, xr.Dataset]:
    """Stages specimens, surface_dimension, quality and joints of one levelled specimen."""
    return {
        "specimens": specimen,
        "joints": describe_joint(specimen, settings),
        "surface_dimension": surface_dimension(
            specimen.lower.values,
            spacing_of(specimen),
            fit_range=settings.surface_range,
            known_dimension=settings.known_dimension,
        ),
        "quality": scan_quality(specimen, settings.resolutions),
    }
