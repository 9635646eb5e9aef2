"""Stages of a specimen before contact: dimension, scan quality, sliding joint."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import xarray as xr

from ..core.datasets import titled
from ..core.settings import SpecimenSettings
from ..core.window import spacing_of
from ..gridding.faces import grid_pair
from ..joint.joint import describe_joint
from ..registration.registration_scatter import motion_variables, scattered_motions
from ..roughness.dimension import surface_dimension
from ..roughness.quality import scan_quality
from ..scan.other_readings import with_other_readings
from ..scan.read import faces_in_mm, read_faces
from ..surface.specimen import make_specimen, window_arguments


def stages_of_scan(
    files: Sequence[str],
    options: Mapping,
    settings: SpecimenSettings,
    name: str,
) -> dict[str, xr.Dataset]:
    """Stages of :func:`specimen_stages` from scan files: the lower face, and the upper if scanned.

    ``options`` are the scan keys of the sidecar. Raises InputError as :func:`prepare_specimen`.
    """
    return specimen_stages(specimen_of_files(files, options, settings, name), settings)


def specimen_of_files(
    files: Sequence[Path | str], options: Mapping, settings: SpecimenSettings, name: str
) -> xr.Dataset:
    """Specimen of :func:`prepare_specimen` with the heights by other fair readings of two scans.

    ``files`` are that of the lower face, and that of the upper if scanned. Raises InputError.
    """
    if len(files) == 1:
        return prepare_specimen(files[0], None, options, settings, name)
    lower, upper, given = faces_in_mm(files[0], files[1], options)
    faces = grid_pair(lower, upper, given.registration, given.mirror_upper)
    specimen = specimen_of_faces(*faces, settings, name)
    return with_other_readings(specimen, faces, (lower, upper), given, settings)


def prepare_specimen(
    lower: Path | str,
    upper: Path | str | None,
    options: Mapping,
    settings: SpecimenSettings,
    name: str,
) -> xr.Dataset:
    """Specimen of :func:`surface.specimen.make_specimen`: faces read and levelled, window placed.

    Of two registered faces it also holds further motions that are statistically as good.

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
    return specimen_of_faces(*read_faces(lower, upper, options), settings, name)


def specimen_of_faces(
    lower: xr.DataArray, upper: xr.DataArray | None, settings: SpecimenSettings, name: str
) -> xr.Dataset:
    """Specimen of :func:`prepare_specimen` from faces of :func:`scan.read.read_faces`."""
    specimen = make_specimen(lower, upper, name=name, **window_arguments(settings))
    if upper is not None and (motions := scattered_motions(lower, upper)):
        specimen = specimen.assign(motion_variables(motions))
    return specimen


@titled(
    specimens="levelled faces, mask, window and where they came from",
    quality="relief, spectra and noise floor of each face, and where its fractal range ends",
    surface_dimension="Delta_g of the lower face by several estimators",
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
