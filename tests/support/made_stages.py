"""Stages of a specimen by the functions that the jobs of a study call, without Snakemake."""

import numpy as np
import xarray as xr

from fractalcontact.core.settings import arguments
from fractalcontact.mechanics.sweep import joint_states
from fractalcontact.stages.flow import flow_stages
from fractalcontact.stages.report import report_stages
from fractalcontact.stages.specimen import specimen_stages
from fractalcontact.stages.states import state_stages
from fractalcontact.stages.windows import window_stages
from fractalcontact.study.stages import CONTACT, STAGES, read_by
from fractalcontact.surface.specimen import make_specimen, window_arguments


def scan(heights, spacing):
    """One scanned face, mm."""
    coordinates = [spacing * (np.arange(n) + 0.5) for n in heights.shape]
    attrs = {"spacing_x": spacing, "spacing_y": spacing, "source": "made", "sha256": "0" * 64}
    return xr.DataArray(heights, dims=("y", "x"), coords=coordinates, attrs=attrs)


#: Functions that make the stages after those of the specimen itself, by their first stage.
LATER = {
    "window_states": window_stages,
    "closure": state_stages,
    "flow": flow_stages,
    "windows": report_stages,
}


def stages_of(name, faces, settings, solver, later=tuple(LATER)):
    """Stages of a specimen made from its faces, all by default."""
    specimen = make_specimen(*faces, name=name, **window_arguments(settings))
    return stages_of_specimen(specimen, settings, solver, later)


def stages_of_specimen(specimen, settings, solver, later=tuple(LATER)):
    """Stages of a specimen, all by default, as the jobs of a study compute them."""

    def given(name, function):
        """What a rule hands over: the settings that the function names alone."""
        return arguments(function, read_by(name, settings, solver))

    known = specimen_stages(specimen, **given(STAGES["specimens"].function, specimen_stages))
    states = joint_states(
        specimen,
        known["joints"],
        settings.contact_directions,
        slice(None),
        resolutions=settings.resolutions,
        **given(CONTACT, joint_states),
    )
    for stage in later:
        before = {need: known[need] for need in STAGES[stage].needs}
        parts = {"parts": [states]} if stage in ("closure", "flow") else {}
        function = LATER[stage]
        known |= function(**before, **parts, **given(STAGES[stage].function, function))
    return known
