"""Stages of a study, each described once: its title, inputs and grain, and the function behind it.

The rules of the workflow, the atlas and the tests read this table. It names functions by strings,
so that reading it imports none of them: on a cluster every job reads the workflow.

To add a stage: an entry here; its function, which takes its settings and, by their names, the
datasets of the stages it needs; a rule; a test. Its dataset then stands in the atlas. In a module
of its own in `stages` it makes no other stage out of date. It gets the settings that the class in
its signature names, and no others: a change of one that it does not read makes nothing of it again.
"""

import ast
import functools
from collections.abc import Collection
from dataclasses import asdict, dataclass, is_dataclass
from pathlib import Path
from typing import Any

from ..core import settings

#: How often a stage is made: for every specimen, for those that slide, for every measured contact
#: map; once, of all specimens together; once, on synthetic surfaces, where the study has the
#: stage's key; and of studies of accuracy for every test problem, or once.
SPECIMEN, JOINT, MAP, STUDY = "specimen", "joint", "map", "study"
EXPERIMENT, PROBLEM, ACCURACY = "experiment", "problem", "accuracy"
GRAINS = (SPECIMEN, JOINT, MAP, STUDY, EXPERIMENT, PROBLEM, ACCURACY)


@dataclass(frozen=True)
class Stage:
    """One stage of a study: a group of the atlas, and a folder of the results.

    Attributes
    ----------
    name : str
        Of the group, the folder and, for an experiment, the key of the configuration.
    title : str
        What it holds: the description of its group.
    grain : str
        One of :data:`GRAINS`.
    function : str
        "room.module:function" that makes it. Stages of one function are made by one job.
    needs : tuple of str
        Stages whose datasets the function takes, as arguments of their names.
    member : str
        Wildcard or name that its files have, and its groups within the stage's.
    filed : bool
        Whether it has files; if not, it is made while the atlas is put together.
    """

    name: str
    title: str
    grain: str
    function: str
    needs: tuple[str, ...] = ()
    member: str = "{specimen}"
    filed: bool = True

    @property
    def path(self) -> str:
        """Its file, or the pattern of its files, below the folder of the results."""
        return f"{self.name}/{self.member}.nc"

    @property
    def module(self) -> str:
        """Path of the function's module within the package, without ending."""
        return self.function.partition(":")[0].replace(".", "/")


_SPECIMEN_STAGES = "stages.specimen:specimen_stages"
_STATE_STAGES = "stages.states:state_stages"
_WINDOW_STAGES = "stages.windows:window_stages"
#: Solves the contact of a specimen, the costly part: several jobs, and no stage of its own.
CONTACT = "mechanics.sweep:joint_states"
_STRENGTH_STAGES = "stages.strength:strength_stages"
#: What is known of a joint before contact is solved.
_OF_JOINT = ("specimens", "surface_dimension", "joints")
#: And those of its sub-windows: nothing is solved for a friction angle.
_OF_STRENGTH = (*_OF_JOINT, "window_states", "size_test", "dilatancy")


def _of_states(name, title):
    return Stage(name, title, SPECIMEN, _STATE_STAGES, _OF_JOINT)


def _experiment(name, title, function):
    return Stage(name, title, EXPERIMENT, function, member="surfaces")


_TABLE = (
    Stage(
        "specimens",
        "levelled faces, mask, window and where they came from",
        SPECIMEN,
        _SPECIMEN_STAGES,
    ),
    Stage(
        "quality",
        "relief, spectra and noise floor of each face, and where its fractal range ends",
        SPECIMEN,
        _SPECIMEN_STAGES,
    ),
    Stage(
        "surface_dimension",
        "Delta_g of each face by several estimators",
        SPECIMEN,
        _SPECIMEN_STAGES,
    ),
    Stage("joints", "offsets and composite topographies", SPECIMEN, _SPECIMEN_STAGES),
    Stage(
        "window_states",
        "contact states of sub-windows, one by one",
        SPECIMEN,
        _WINDOW_STAGES,
        ("specimens", "joints"),
    ),
    Stage(
        "size_test",
        "contact against size at equal nominal pressure, eq. 6's own form, and the whole predicted",
        SPECIMEN,
        _WINDOW_STAGES,
        ("specimens", "joints"),
    ),
    _of_states("closure", "closure curves, stiffness, real contact area"),
    _of_states("dilatancy", "rigid and elastic dilatancy"),
    _of_states("area", "laws of the real contact area, and the classical theories beside it"),
    _of_states("domains", "box counts, Delta_sigma and clusters of the contact domains"),
    _of_states("contact", "contact domains"),
    _of_states("scaling", "renormalisation over resolutions"),
    _of_states(
        "domain_measures",
        "lacunarity and generalised dimensions of the contact at the map offset",
    ),
    _of_states("choices", "what was solved and how exactly, why, and the errors that makes"),
    _of_states("error_budget", "error of the published quantities, split by source"),
    Stage(
        "windows",
        "closure, roughness and strength of sub-windows against their size",
        SPECIMEN,
        _STRENGTH_STAGES,
        _OF_STRENGTH,
    ),
    Stage(
        "strength",
        "dilatancy and friction angles, shear strength",
        JOINT,
        _STRENGTH_STAGES,
        _OF_STRENGTH,
    ),
    Stage(
        "contact_maps",
        "measured contact maps, one group per map",
        MAP,
        "domain.measured_map:read_contact_map",
        member="{map}",
    ),
    _experiment(
        "roll_off",
        "rigid dilatancy of synthetic joints with and without a roll-off",
        "experiments.roll_off:roll_off_effect",
    ),
    _experiment(
        "area_slope",
        "real contact area at light load, on surfaces with and without a roll-off",
        "experiments.area_slope:area_slope",
    ),
    _experiment(
        "dimension_test",
        "both estimates of Delta_sigma on synthetic surfaces",
        "experiments.delta_sigma:dimension_test",
    ),
    _experiment(
        "estimator_bias",
        "estimators of Delta_g on surfaces of known dimension",
        "experiments.delta_g:estimator_bias",
    ),
    _experiment(
        "size_effect",
        "which exponent carries the size effect: resolution, size and geometry one by one",
        "experiments.size_effect_test:size_effect_test",
    ),
    _experiment(
        "size_strength",
        "strength of sliding mated joints over their side, at equal v and at equal v/b",
        "experiments.size_strength:size_strength",
    ),
    Stage(
        "elastic_model",
        "verdict on the elastic model: real mean pressure against strength, slope of the faces",
        SPECIMEN,
        "mechanics.model_validity:model_validity",
        ("area", "scaling"),
        filed=False,
    ),
    Stage(
        "statements",
        "what the paper says, and whether it holds here",
        SPECIMEN,
        "statements.judge:judge",
        filed=False,
    ),
    Stage(
        "study_statements",
        "what the paper says of several joints together, and whether it holds here",
        STUDY,
        "statements.study:judge_study",
        member="study",
        filed=False,
    ),
    Stage(
        "comparison",
        "what of a specimen is compared with others, with its errors",
        SPECIMEN,
        "statements.comparison:specimen_row",
        filed=False,
    ),
    Stage(
        "study_comparison",
        "specimens side by side, and how groups of them spread",
        STUDY,
        "statements.comparison:compare_specimens",
        member="study",
        filed=False,
    ),
    Stage(
        "speed",
        "error against time of solvers and cheaper models, one group per test problem",
        PROBLEM,
        "accuracy.speed:error_against_time",
        member="{scene}",
    ),
    Stage(
        "speed_growth",
        "time and memory of the solvers over sizes",
        ACCURACY,
        "accuracy.growth:growth",
        ("speed",),
        member="surfaces",
    ),
    Stage(
        "convergence",
        "error against spacing where the solution is known, and Richardson's extrapolation",
        PROBLEM,
        "stages.accuracy:convergence",
        member="{problem}",
    ),
    Stage(
        "stability",
        "verdicts on the solvers by kind of test problem",
        ACCURACY,
        "accuracy.stability:join",
        member="scenes",
    ),
    Stage(
        "elimination",
        "whether dropping points alone reaches the right contact set",
        ACCURACY,
        "accuracy.elimination:elimination",
        member="scenes",
    ),
)
#: Every stage by name, in the order of the atlas.
STAGES = {stage.name: stage for stage in _TABLE}


@functools.cache
def sections_of(function: str) -> dict[str, type]:
    """Settings that a function reads: classes of :mod:`core.settings` by its parameter.

    Read from its text: whoever plans jobs imports nothing of what they compute with.

    Parameters
    ----------
    function : str
        Of a stage, or :data:`CONTACT`.
    """
    module, _, name = function.partition(":")
    path = Path(settings.__file__).parents[1] / f"{module.replace('.', '/')}.py"
    body = ast.parse(path.read_text(encoding="utf-8")).body
    (made,) = (node for node in body if isinstance(node, ast.FunctionDef) and node.name == name)
    named = {one.arg: ast.unparse(one.annotation) for one in made.args.args if one.annotation}
    known: dict[str, Any] = {n: of for n, of in vars(settings).items() if is_dataclass(of)}
    return {parameter: known[of] for parameter, of in named.items() if of in known}


def read_by(function: str, stated: settings.Settings, solver: settings.Solver) -> dict[str, dict]:
    """Settings of a specimen that a function reads, by parameter, as plain data.

    Parameters
    ----------
    function : str
        As of :func:`sections_of`.
    stated, solver
        From :mod:`study.configuration`.
    """
    everything = asdict(stated) | asdict(solver)
    sections = sections_of(function).items()
    return {key: asdict(settings.read(section, everything)) for key, section in sections}


def paths_of(*grains: str) -> dict[str, str]:
    """Files of the stages of some grains.

    Parameters
    ----------
    *grains : str
        Of :data:`GRAINS`.

    Returns
    -------
    dict of str to str
        By stage, below the folder of the results; wildcards stand in braces.
    """
    return {
        name: stage.path for name, stage in STAGES.items() if stage.grain in grains and stage.filed
    }


def made_together(name: str, grains: Collection[str] = GRAINS) -> dict[str, str]:
    """Files that the job of one stage makes: of all stages that share its function.

    Parameters
    ----------
    name : str
        Any stage of the job.
    grains : collection of str, optional
        Those of its stages that are made.

    Returns
    -------
    dict of str to str
        As :func:`paths_of`.
    """
    function = STAGES[name].function
    shared = {name for name, stage in STAGES.items() if stage.function == function}
    return {name: path for name, path in paths_of(*grains).items() if name in shared}


def needed_by(name: str) -> dict[str, str]:
    """Files of the stages that one stage needs, as :func:`paths_of` gives them."""
    return {need: STAGES[need].path for need in STAGES[name].needs}
