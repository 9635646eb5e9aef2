# What every file of rules uses: the checked study, its specimens, and what a rule says of its jobs.
# Its imports are light, without xarray, numba or matplotlib: on a cluster every job reads it.
import functools
import sys
from dataclasses import asdict
from pathlib import Path

from snakemake.exceptions import WorkflowError

# The folder of this workflow, also where another workflow imports it as a module.
ROOT = Path(workflow.current_basedir.get_path_or_uri(secret_free=True)).parents[1]
sys.path.insert(0, str(ROOT / "workflow"))

from engine import use_checkout

# The packages of this checkout's src, not those of an installed one.
use_checkout(ROOT)

from engine.code_digest import Code
from engine.plan import Plan
from fractalcontact.core import settings
from fractalcontact.core.directions import AUTOMATIC_OFFSETS, slides
from fractalcontact.core.errors import InputError
from fractalcontact.core.patterns import alternation
from fractalcontact.study import campaign
from fractalcontact.study import resources as estimates
from fractalcontact.study.configuration import resolve_embedded

SOURCE = str(workflow.configfiles[-1]) if workflow.configfiles else "config/paper.yaml"
# Checks the study, reads the sidecars and digests the scans; once a run, not once a job.
RUN = Plan(workflow, config, SOURCE)
STUDY = RUN.study
RESULTS = f"results/{config['study']}"
SCANS, SETTINGS, OPTIONS, LABELS = STUDY.scans, STUDY.settings, STUDY.options, STUDY.labels
#: Settings of the solver, and those of each specimen, as plain data.
SOLVER = asdict(STUDY.solver)
RECORDS = {name: asdict(stated) for name, stated in SETTINGS.items()}

SPECIMENS = sorted(SETTINGS)
#: Surfaces against a plane, which cannot slide, and all others.
FLAT = [name for name in SPECIMENS if not slides(SETTINGS[name].opposite)]
SLIDING = sorted(set(SPECIMENS) - set(FLAT))
#: Measured maps of contact. They have no settings, and STUDY.labels has their labels alone; those of
#: specimens are among their settings.
MAPS = list(LABELS)
#: Surfaces that the study makes, with their recipes, and those with tests in a real laboratory.
RECIPES = {name: recipe for name, recipe in config.get("embedded", {}).items() if name in SETTINGS}
TESTED = [name for name in SPECIMENS if SETTINGS[name].measured]
#: Members of the ensembles that the study wants: twins of scans, realisations of its own surfaces.
TWINS = {name: SETTINGS[name].twins for name in SPECIMENS if SETTINGS[name].twins}
ENSEMBLES = TWINS | {
    name: recipe["realisations"] for name, recipe in RECIPES.items() if "realisations" in recipe
}
#: Whether this is a campaign: a study whose specimens each have an atlas of their own, as they
#: are many; atlas.nc holds one row of each. Then nothing asks for all that was made of each of them.
IN_PARTS = campaign.in_parts(config, SPECIMENS)


# Any name without a slash: to look for each file among ten thousand names takes minutes. Whoever
# asks for a specimen that is none is told so by `known`.
wildcard_constraints:
    specimen="[^/]+",
    directions=r"\d+",
    offsets=r"\d+",
    resolutions=r"\d+",
    refused=r"\d+",


def known(wildcards):
    """Name of a specimen, which must be one of the study."""
    if wildcards.specimen not in SETTINGS:
        raise WorkflowError(f"{SOURCE}: the study has no specimen '{wildcards.specimen}'")
    return wildcards.specimen


def names_of(some, others):
    """Constraint of {specimen} to one kind of specimens, where two rules make the same files.

    Any name where there is no other kind, and none where there is none of this kind.
    """
    return alternation(some) if others else "[^/]+" if some else alternation([])


def settings_of(section):
    """Input of `params`: the settings of a specimen that a class of `core.settings` names.

    Only these make a job run again: a changed friction angle or label solves nothing.
    """
    return lambda wildcards: asdict(settings.read(section, RECORDS[known(wildcards)]))


digest = functools.cache(Code(ROOT / "src", ROOT, ROOT / "workflow").digest)


def code(script, *names):
    """Parameter that changes with the code that a script of workflow/scripts runs.

    Snakemake's own trigger sees the script, but not what it imports. Named here are modules, or
    folders of src, that the script imports only while it runs.
    """
    return lambda wildcards: digest(ROOT / f"workflow/scripts/{script}.py", *names)


def recipe_named(name):
    """Recipe of a surface that the study makes, its lengths in mm."""
    return resolve_embedded(RECIPES[name], f"{SOURCE}: embedded.{name}")


@functools.cache
def face_nodes(name):
    """Most nodes of a face of a specimen."""
    if name in SCANS:
        return estimates.nodes_of_files(SCANS[name].files)
    return estimates.nodes_of_recipe(recipe_named(name))


@functools.cache
def window_nodes(name):
    """Most nodes of the window of a specimen."""
    spacing = OPTIONS[name].get("spacing") if name in SCANS else recipe_named(name)["spacing"]
    return estimates.nodes_of_window(SETTINGS[name], spacing, face_nodes(name))


def most_offsets(name):
    """Most shear offsets of a specimen: how many "auto" finds is known only later."""
    return len(SETTINGS[name].offsets or range(AUTOMATIC_OFFSETS + 1))


def kept_states(name):
    """Contact states of a specimen that are kept at the finest resolution."""
    return estimates.states_of(SETTINGS[name], most_offsets(name))


def doubled(amount):
    """Memory or time, a number or a function of wildcards: twice as much at every further attempt.

    So what a cluster has ended for its memory or its time is done by the next.
    """
    asked = amount if callable(amount) else lambda wildcards: amount
    return lambda wildcards, attempt: asked(wildcards) * 2 ** (attempt - 1)


def memory(job, nodes=window_nodes, states=kept_states):
    """Megabytes that a job asks for, by the nodes of its grid and its number of states."""
    return doubled(lambda wc: estimates.memory(job, nodes(known(wc)), states(wc.specimen)))


def minutes(job, nodes=window_nodes, states=kept_states):
    """Minutes that a job asks for, likewise."""
    return doubled(lambda wc: estimates.minutes(job, nodes(known(wc)), states(wc.specimen)))
