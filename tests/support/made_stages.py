"""Stages of a specimen by the functions that the jobs of a study call, without Snakemake."""

import numpy as np
import xarray as xr
from declared import Declared

from fractalcontact.mechanics.sweep import joint_states
from fractalcontact.stages.specimen import specimen_stages
from fractalcontact.stages.states import state_stages
from fractalcontact.stages.strength import strength_stages
from fractalcontact.stages.windows import window_stages
from fractalcontact.study.configuration import window_arguments
from fractalcontact.study.stages import CONTACT, SOLVER_READ, STAGES, read_by, solver_read_by
from fractalcontact.surface.specimen import make_specimen


def scan(heights, spacing):
    """One scanned face, mm."""
    coordinates = [spacing * (np.arange(n) + 0.5) for n in heights.shape]
    attrs = {"spacing_x": spacing, "spacing_y": spacing, "source": "made", "sha256": "0" * 64}
    return xr.DataArray(heights, dims=("y", "x"), coords=coordinates, attrs=attrs)


#: Functions that make the stages after those of the specimen itself, by their first stage.
LATER = {"window_states": window_stages, "closure": state_stages, "windows": strength_stages}


def stages_of(name, faces, settings, solver, later=tuple(LATER)):
    """Stages of a specimen made from its faces, all by default."""
    arguments = window_arguments(read(STAGES["specimens"].function, settings))
    specimen = make_specimen(*faces, name=name, **arguments)
    return stages_of_specimen(specimen, settings, solver, later)


def stages_of_specimen(specimen, settings, solver, later=tuple(LATER)):
    """Stages of a specimen, all by default, as the jobs of a study compute them."""
    known = specimen_stages(specimen, read(STAGES["specimens"].function, settings))
    states = joint_states(
        specimen,
        known["joints"],
        settings["contact_directions"],
        slice(None),
        read(CONTACT, settings),
        settings["resolutions"],
        Declared(solver_read_by(CONTACT, solver)),
    )
    for stage in later:
        before = {need: known[need] for need in STAGES[stage].needs}
        parts = {"parts": [states]} if stage == "closure" else {}
        known |= LATER[stage](**before, **parts, **_given(STAGES[stage].function, settings, solver))
    return known


def read(function, settings):
    """What a rule hands over: the settings that the function declares; others are refused."""
    return Declared(read_by(function, settings))


def _given(function, settings, solver):
    given = {"settings": read(function, settings)}
    if function in SOLVER_READ:
        given["solver"] = Declared(solver_read_by(function, solver))
    return given
