"""Settings that each function of the workflow declares to read: enough, and none too many."""

import numpy as np
import pytest
import xarray as xr
from declared import Declared
from materials import ROCK

from fractalcontact.mechanics.sweep import joint_states
from fractalcontact.stages.specimen import specimen_stages
from fractalcontact.stages.states import state_stages
from fractalcontact.stages.strength import strength_stages
from fractalcontact.stages.windows import window_stages
from fractalcontact.study.configuration import resolve_settings, solver_settings, window_arguments
from fractalcontact.study.stages import (
    CONTACT,
    SETTINGS_READ,
    SOLVER_READ,
    STAGES,
    read_by,
    solver_read_by,
)
from fractalcontact.surface.specimen import make_specimen
from fractalcontact.surface.synthesis import self_affine

SOLVER = solver_settings({}, "study")
STUDY = {
    "materials": {"rock": ROCK},
    "defaults": {
        "material": "rock",
        "directions": ["E", "W"],
        "offsets": ["0.1 mm", "0.4 mm"],
        "loads": ["1 MPa", "5 MPa", "25 MPa"],
        "resolutions": [1, 2],
        "window": "3.2 mm",
    },
}
SPECIMEN, STATES, WINDOWS, STRENGTH = (
    STAGES[name].function for name in ("joints", "closure", "size_test", "strength")
)


def settings_of(function):
    return Declared(read_by(function, resolve_settings(STUDY, "rock", {}, "study")))


def solver_of(function):
    return Declared(solver_read_by(function, SOLVER))


@pytest.fixture(scope="module")
def ran():
    """Settings and solver's settings by function, after each ran with what it declares alone."""
    settings = {function: settings_of(function) for function in SETTINGS_READ}
    solvers = {function: solver_of(function) for function in SOLVER_READ}
    heights = self_affine((48, 48), 0.1, 0.8, rms=0.1, seed=3)
    coordinates = [0.1 * (np.arange(48) + 0.5)] * 2
    attrs = {"spacing_x": 0.1, "spacing_y": 0.1, "source": "made", "sha256": "0" * 64}
    scan = xr.DataArray(heights, dims=("y", "x"), coords=coordinates, attrs=attrs)
    specimen = make_specimen(scan, name="rock", **window_arguments(settings[SPECIMEN]))
    known = specimen_stages(specimen, settings[SPECIMEN])
    states = joint_states(
        specimen,
        known["joints"],
        settings[CONTACT]["contact_directions"],
        slice(None),
        settings[CONTACT],
        [1, 2],
        solvers[CONTACT],
    )
    known |= window_stages(
        specimen, known["joints"], settings=settings[WINDOWS], solver=solvers[WINDOWS]
    )
    before = {stage: known[stage] for stage in STAGES["closure"].needs}
    known |= state_stages(
        **before, parts=[states], settings=settings[STATES], solver=solvers[STATES]
    )
    before = {stage: known[stage] for stage in STAGES["strength"].needs}
    strength_stages(**before, settings=settings[STRENGTH])
    return settings, solvers


@pytest.mark.parametrize("function", SETTINGS_READ)
def test_a_function_reads_the_settings_it_declares_and_no_others(ran, function):
    settings, solvers = ran
    assert settings[function].seen - {"material"} == set(SETTINGS_READ[function])
    if function in solvers:
        assert solvers[function].seen == set(SOLVER_READ[function])


def test_a_key_that_is_not_declared_cannot_be_read():
    settings = settings_of(CONTACT)
    for read in (
        lambda: settings["label"],
        lambda: settings.get("box_range"),
        lambda: "window" in settings,
        lambda: settings["material"].get("basic_friction_angle"),
    ):
        with pytest.raises(AssertionError, match="not declared"):
            read()


@pytest.mark.parametrize(
    ("change", "again"),
    [
        ({"label": "another"}, ()),
        ({"basic_friction_angle": "35 deg"}, (STRENGTH,)),
        ({"joint_wall_strength": "60 MPa"}, (STRENGTH,)),
        ({"box_range": ["0.2 mm", "1 mm"]}, (STATES, WINDOWS)),
    ],
    ids=str,
)
def test_what_changes_no_state_solves_no_joint_again(change, again):
    study = {**STUDY, "defaults": dict(STUDY["defaults"])}
    if change.keys() <= STUDY["materials"]["rock"].keys():
        study["materials"] = {"rock": STUDY["materials"]["rock"] | change}
    else:
        study["defaults"] |= change
    before, after = (resolve_settings(of, "rock", {}, "study") for of in (STUDY, study))
    assert before != after
    for function in SETTINGS_READ:
        same = repr(read_by(function, before)) == repr(read_by(function, after))
        assert same == (function not in again), function
