"""Stages of a specimen before contact: dimension, scan quality, sliding joint."""

import xarray as xr

from ..core.settings import SpecimenSettings
from ..core.window import spacing_of
from ..mechanics.joint import describe_joint
from ..roughness.dimension import surface_dimension
from ..roughness.quality import scan_quality


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
