"""The whole chain of a specimen as calls: what the jobs of a study compute, one after the other."""

from declared import Declared

from fractalcontact.figures.draw import draw_figures
from fractalcontact.mechanics.sweep import joint_states
from fractalcontact.stages.atlas import join_stages
from fractalcontact.stages.specimen import specimen_stages
from fractalcontact.stages.states import state_stages
from fractalcontact.stages.strength import strength_stages
from fractalcontact.stages.windows import window_stages
from fractalcontact.study.configuration import resolve_settings, solver_settings
from fractalcontact.study.figure_list import figures_of
from fractalcontact.study.preparation import prepare_specimen
from fractalcontact.study.stages import CONTACT, SOLVER_READ, STAGES, read_by, solver_read_by

SOLVER = solver_settings({}, "tiny")


def stages_of(specimen, settings):
    """All stages of a specimen, as the jobs of a study compute them."""
    known = specimen_stages(specimen, read(STAGES["specimens"].function, settings))
    states = joint_states(
        specimen,
        known["joints"],
        settings["contact_directions"],
        slice(None),
        read(CONTACT, settings),
        settings["resolutions"],
        solver_read(CONTACT),
    )
    for stage, of_stage in (
        ("window_states", window_stages),
        ("closure", state_stages),
        ("windows", strength_stages),
    ):
        before = {need: known[need] for need in STAGES[stage].needs}
        parts = {"parts": [states]} if stage == "closure" else {}
        known |= of_stage(**before, **parts, **given(STAGES[stage].function, settings))
    return known


def read(function, settings):
    """What a rule hands over: the settings that the function declares; others are refused."""
    return Declared(read_by(function, settings))


def solver_read(function):
    return Declared(solver_read_by(function, SOLVER))


def given(function, settings):
    solver = {"solver": solver_read(function)} if function in SOLVER_READ else {}
    return {"settings": read(function, settings), **solver}


#: As small as a study can be that still has every figure.
SMALL_STUDY = {
    "study": "small",
    "materials": {
        "rock": {
            "modulus": "20 GPa",
            "poisson": 0.2,
            "basic_friction_angle": "30 deg",
            "joint_wall_strength": "80 MPa",
        }
    },
    "defaults": {
        "material": "rock",
        "directions": ["E", "W"],
        "contact_directions": ["W"],
        "loads": ["1 MPa", "10 MPa", "100 MPa"],
        "resolutions": [1, 2],
    },
}


def atlas_of_scan(lower, upper, options, folder, settings=(), name="specimen"):
    """Scan files of a specimen through all stages into an atlas.

    Returns
    -------
    path : Path
        The atlas.
    opposite : str
    """
    own = dict(settings)
    resolved = resolve_settings(SMALL_STUDY, name, own, "small", pair=upper is not None)
    specimen = prepare_specimen(
        lower, upper, options, read(STAGES["specimens"].function, resolved), name
    )
    parts = {stage: {name: data} for stage, data in stages_of(specimen, resolved).items()}
    path = folder / "atlas.nc"
    join_stages(parts, path, {"study": SMALL_STUDY, "settings": {name: resolved}})
    return path, resolved["opposite"]


def draw_scan(atlas, opposite, folder, name="specimen"):
    """All figures of a specimen, drawn to a folder; their captions by name."""
    return draw_figures(atlas, name, folder, figures_of(opposite))
