"""Stages of a specimen before contact: dimension, scan quality, sliding joint."""

import json
from collections.abc import Mapping, Sequence

import xarray as xr

from ..core.errors import InputError
from ..core.settings import SpecimenSettings
from ..core.window import spacing_of
from ..mechanics.joint import describe_joint
from ..roughness.dimension import surface_dimension
from ..roughness.quality import scan_quality
from ..study.preparation import prepare_specimen


def stages_of_scan(
    files: Sequence[str],
    options: Mapping,
    settings: SpecimenSettings,
    name: str,
    digests: Mapping[str, str],
) -> dict[str, xr.Dataset]:
    """Stages of one specimen from its scan files.

    Parameters
    ----------
    files : sequence of str
        The lower face, and the upper one where it was scanned.
    options : mapping
        Scan keys of the sidecar.
    settings : SpecimenSettings
    name : str
    digests : mapping of str to str
        SHA-256 of the files when the study was planned; none of a scan that the study makes.

    Returns
    -------
    dict of str to xr.Dataset
        As of :func:`specimen_stages`.

    Raises
    ------
    InputError
        If a file cannot be read or is another one by now, or the window finds no place.
    """
    lower, upper = files[0], files[1] if len(files) > 1 else None
    specimen = prepare_specimen(lower, upper, options, settings, name)
    for face, file, digest in zip(("lower", "upper"), files, digests.values(), strict=False):
        if json.loads(specimen.attrs[f"{face}_scan"])["sha256"] != digest:
            raise InputError(f"{file}: changed while it was read; run the study again")
    return specimen_stages(specimen, settings)


def specimen_stages(specimen: xr.Dataset, settings: SpecimenSettings) -> dict[str, xr.Dataset]:
    """Stages of one levelled specimen, itself among them.

    Parameters
    ----------
    specimen : xr.Dataset
        From :func:`study.preparation.prepare_specimen`.
    settings : SpecimenSettings

    Returns
    -------
    dict of str to xr.Dataset
        By stage: specimens, surface_dimension, quality and joints.
    """
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
