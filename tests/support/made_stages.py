"""Stages of a specimen by the functions that the jobs of a study call, without Snakemake."""

from dataclasses import asdict, is_dataclass
from typing import get_type_hints

import numpy as np
import xarray as xr

from fractalcontact.core import settings as sections
from fractalcontact.stages.closure_and_box_counts import state_stages
from fractalcontact.stages.flow import flow_stages
from fractalcontact.stages.specimen import specimen_stages
from fractalcontact.stages.strength import strength_stages
from fractalcontact.stages.windows import window_stages
from fractalcontact.states.sweep import joint_states
from fractalcontact.surface.specimen import make_specimen, window_arguments


def scan(heights, spacing):
    """One scanned face, mm."""
    coordinates = [spacing * (np.arange(n) + 0.5) for n in heights.shape]
    attrs = {"spacing_x": spacing, "spacing_y": spacing, "source": "made", "sha256": "0" * 64}
    return xr.DataArray(heights, dims=("y", "x"), coords=coordinates, attrs=attrs)


_OF_JOINT = ("specimens", "surface_dimension", "joints")
#: Functions that make the stages after those of the specimen itself, by their first stage, and the
#: stages that each takes, as the rules of the workflow have them.
LATER = {
    "window_states": (window_stages, ("specimens", "joints")),
    "closure": (state_stages, _OF_JOINT),
    "flow": (flow_stages, ("specimens", "joints", "closure", "branches", "error_budget")),
    "windows": (
        strength_stages,
        (
            *(*_OF_JOINT, "window_states", "size_test", "closure", "dilatancy", "area", "domains"),
            *("scaling", "domain_measures", "error_budget"),
        ),
    ),
}


def stages_of(name, faces, settings, solver, later=tuple(LATER)):
    """Stages of a specimen made from its faces, all by default."""
    specimen = make_specimen(*faces, name=name, **window_arguments(settings))
    return stages_of_specimen(specimen, settings, solver, later)


def stages_of_specimen(specimen, settings, solver, later=tuple(LATER)):
    """Stages of a specimen, all by default, as the jobs of a study compute them."""
    known = specimen_stages(specimen, **given(specimen_stages, settings, solver))
    states = joint_states(
        specimen,
        known["joints"],
        settings.contact_directions,
        slice(None),
        resolutions=settings.resolutions,
        **given(joint_states, settings, solver),
    )
    for stage in later:
        function, needs = LATER[stage]
        before = {need: known[need] for need in needs}
        parts = {"parts": [states]} if stage in ("closure", "flow") else {}
        known |= function(**before, **parts, **given(function, settings, solver))
    return known


def given(function, settings, solver):
    """What a rule hands over to a function: the settings that its annotations name alone."""
    stated = asdict(settings) | asdict(solver)
    named = get_type_hints(function)
    return {key: sections.read(of, stated) for key, of in named.items() if is_section(of)}


def is_section(of):
    """True for a class of `core.settings`."""
    return is_dataclass(of) and of.__module__ == sections.__name__
