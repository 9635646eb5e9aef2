"""Jobs of the laboratory that a study asks for by its keys: what each calls, and what it takes.

Light, because the workflow reads it: what needs the solver is imported where a study has the key.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from fractalcontact.core.settings import Solver
from fractalcontact.study.configuration import resolve_roll_off
from fractalcontact.study.resources import memory

from .experiments.size_tasks import size_jobs
from .stages import STAGES

#: Experiments that are one job each: minutes that they ask for (what needs more gets twice as many
#: at the second attempt), and their priority.
EXPERIMENTS = {
    "roll_off": (30, 1),
    "size_strength": (120, 1),
    "area_slope": (60, -1),
    "estimator_bias": (60, -1),
}
#: Kinds of hard problem that one job judges.
KINDS_A_JOB = 14
_FUNCTIONS = {stage.name: stage.function for stage in STAGES}


@dataclass(frozen=True)
class Job:
    """Call of a function, which makes one file.

    Attributes
    ----------
    function : str
        "package.room.module:function".
    arguments : mapping
    parts : mapping of str to list of str
        Files of other jobs that it takes, by argument, as :func:`jobs_of` names them.
    megabytes, minutes : int
        That it asks for.
    priority : int
        1 of the longest: begun last they would keep one core busy and the others idle. -1 of short
        ones, which fill the core that has nothing else to do at the end.
    alone : bool
        Whether it measures time: it then takes all cores, so that nothing runs beside it.
    peers : tuple of str
        Other codes that it measures: one that is installed later makes it run again.
    """

    function: str
    arguments: Mapping[str, Any]
    parts: Mapping[str, list[str]] = field(default_factory=dict)
    megabytes: int = 4000
    minutes: int = 60
    priority: int = 0
    alone: bool = False
    peers: tuple[str, ...] = ()


def jobs_of(study: Mapping[str, Any], solver: Solver, source: str) -> dict[str, Job]:
    """Jobs by the names of their files, "FOLDER/MEMBER"; the folder of a stage has its name.

    Parameters
    ----------
    study : mapping
        A study that passed the schema.
    solver : Solver
    source : str
        The file the study came from, for errors.

    Raises
    ------
    InputError
        If a recipe contradicts itself.
    """
    jobs = {}
    # In the order of the table: the groups of the atlas have that of the jobs, to the byte.
    for name in (one for one in EXPERIMENTS if one in study):
        minutes, priority = EXPERIMENTS[name]
        arguments = {"recipe": study[name]}
        if name == "roll_off":
            arguments = resolve_roll_off(study, source)
        elif name != "estimator_bias":
            arguments["rtol"] = solver.rtol
        jobs[f"{name}/surfaces"] = Job(
            _FUNCTIONS[name], arguments, minutes=minutes, priority=priority
        )
    if "size_effect" in study:
        jobs |= _size_effect(study["size_effect"], solver)
    if "speed" in study:
        jobs |= _speed(study["speed"])
    if "convergence" in study:
        jobs |= _convergence(study["convergence"])
    if "stability" in study:
        jobs |= _stability(study["stability"])
    return jobs


def _size_effect(recipe, solver):
    """Surfaces of one class a job, minutes each, in any order; small classes share a job."""
    jobs = {
        f"size_effect_parts/{name}": Job(
            "contactlab.experiments.size_states:solve_tasks",
            {"tasks": [*map(list, tasks)], "loads": recipe["loads"], "rtol": solver.rtol},
            # By its largest surface.
            megabytes=memory("size_effect_part", max(t.whole or t.size for t in tasks) ** 2),
            priority=1,
        )
        for name, tasks in size_jobs(recipe).items()
    }
    joined = Job(_FUNCTIONS["size_effect"], {"recipe": recipe}, {"parts": [*jobs]}, 2000, 20)
    return jobs | {"size_effect/surfaces": joined}


def _speed(recipe):
    from .accuracy.reference import problems_of
    from .methods.registry import installed_peers

    peers = tuple(installed_peers())
    jobs = {
        f"speed/{name}": Job(
            _FUNCTIONS["speed"],
            {"problem": name, "recipe": recipe},
            minutes=30,
            alone=True,
            peers=peers,
        )
        for name in problems_of(recipe)
    }
    arguments, parts = {"error": recipe["error"]}, {"problems": [*jobs]}
    return jobs | {"speed_growth/surfaces": Job(_FUNCTIONS["speed_growth"], arguments, parts, 1500)}


def _convergence(recipe):
    return {
        f"convergence/{name}": Job(
            _FUNCTIONS["convergence"], {"problem": name, "recipe": recipe}, megabytes=1500
        )
        for name in ("hertz", "punch", "richardson")
    }


def _stability(recipe):
    from .accuracy.hard_problems import KINDS
    from .methods.registry import installed_peers

    kinds, peers = list(KINDS), tuple(installed_peers())
    jobs = {
        f"stability_parts/{first}": Job(
            "contactlab.accuracy.stability:stability",
            {"kinds": kinds[first : first + KINDS_A_JOB], "draws": recipe["draws"]},
            megabytes=1500,
            peers=peers,
        )
        for first in range(0, len(kinds), KINDS_A_JOB)
    }
    draws = {"draws": recipe["elimination"]}
    return jobs | {
        "stability/scenes": Job(_FUNCTIONS["stability"], {}, {"parts": [*jobs]}, 1500),
        "elimination/scenes": Job(_FUNCTIONS["elimination"], draws, megabytes=1500),
    }
