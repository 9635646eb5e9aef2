"""Stages of a study, each described once: its title, inputs and grain, and the function behind it.

The rules of the workflow, the atlas and the tests read this table. It names functions by strings,
so that reading it imports none of them: on a cluster every job reads the workflow.

To add a stage: an entry here; its function, which takes its settings and, by their names, the
datasets of the stages it needs; a row of ``STAGE_JOBS`` in workflow/rules/contact.smk; a test. Its
dataset then stands in the atlas. In a module of its own in `stages` it makes no other stage out of
date. It gets the settings that the class in its signature names, and no others: a change of one
that it does not read makes nothing of it again.
"""

import ast
import functools
from collections.abc import Collection
from dataclasses import asdict, is_dataclass
from importlib import import_module
from typing import Any

from ..core import settings
from ..core.packages import CHAIN, SOURCES, installed
from ..core.stage import ENSEMBLE, GRAINS, JOINT, MAP, SPECIMEN, STUDY, TESTED, Stage

_SPECIMEN_STAGES = "fractalcontact.stages.specimen:stages_of_scan"
_STATE_STAGES = "fractalcontact.stages.states:state_stages"
_WINDOW_STAGES = "fractalcontact.stages.windows:window_stages"
#: Solves the contact of a specimen, the costly part: several jobs, and no stage of its own.
CONTACT = "fractalcontact.mechanics.sweep:joint_states"
_REPORT_STAGES = "fractalcontact.stages.report:report_stages"
#: What is known of a joint before contact is solved.
_OF_JOINT = ("specimens", "surface_dimension", "joints")
#: And what is reported of it: nothing is solved for a friction angle, a rule or a label.
_OF_REPORT = (
    *_OF_JOINT,
    *("window_states", "size_test", "closure", "dilatancy", "area", "domains", "scaling"),
    *("domain_measures", "error_budget"),
)


def _of_states(name, title):
    return Stage(name, title, SPECIMEN, _STATE_STAGES, _OF_JOINT)


def _of_report(name, title, grain=SPECIMEN):
    return Stage(name, title, grain, _REPORT_STAGES, _OF_REPORT)


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
    Stage(
        "ensemble",
        "realisations of an embedded specimen or twins of a scan, their mean and spread",
        ENSEMBLE,
        "fractalcontact.ensemble.realisations:ensemble",
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
    _of_states("branches", "closure of loading, unloading and reloading, at the reported offset"),
    _of_states("choices", "solve plan: states solved, accuracy, reasons, and resulting errors"),
    _of_states("error_budget", "error of the published quantities, split by source"),
    Stage(
        "flow",
        "aperture and transmissivity over loads, branches and offsets",
        SPECIMEN,
        "fractalcontact.stages.flow:flow_stages",
        ("specimens", "joints", "closure", "branches", "error_budget"),
    ),
    _of_report("windows", "closure, roughness and strength of sub-windows against their size"),
    _of_report("strength", "dilatancy and friction angles, shear strength", JOINT),
    Stage(
        "measured",
        "laboratory tests beside computed closure, flow, dilatancy and strength",
        TESTED,
        "fractalcontact.measured.stage:measured_stage",
        ("specimens", "joints", "closure", "dilatancy", "error_budget", "flow"),
    ),
    Stage(
        "contact_maps",
        "measured contact maps, one group per map",
        MAP,
        "fractalcontact.domain.measured_map:read_contact_map",
    ),
    _of_report(
        "elastic_model",
        "verdict on the elastic model: real mean pressure against strength, slope of the faces",
    ),
    _of_report("statements", "the paper's statements, and their verdicts"),
    Stage(
        "study_statements",
        "the paper's statements on several joints together, and their verdicts",
        STUDY,
        "fractalcontact.statements.study:judge_study",
        member="study",
    ),
    _of_report(
        "comparison", "quantities of a specimen for comparison with others, with their errors"
    ),
    Stage(
        "study_comparison",
        "specimens side by side, and how groups of them spread",
        STUDY,
        "fractalcontact.statements.comparison:compare_specimens",
        member="study",
    ),
)
#: Every stage by name, in the order of the atlas: those of the chain, then those of the laboratory.
STAGES = {
    stage.name: stage
    for table in (
        _TABLE,
        *(import_module(f"{name}.stages").STAGES for name in installed() if name != CHAIN),
    )
    for stage in table
}


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
    path = SOURCES / f"{module.replace('.', '/')}.py"
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
    return {name: stage.path for name, stage in STAGES.items() if stage.grain in grains}


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
