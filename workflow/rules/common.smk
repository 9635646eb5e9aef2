# The checked study, its specimens, and helpers for parameters and resources, which all files of rules use.
# Imports are light, without xarray, numba or matplotlib, because every job on a cluster reads this file.
#
# A script hands the files of a rule's inputs, by name, to one function of the library, and writes what that
# returns by the names of the outputs. The folder of a result is its stage.
import functools
import sys
from dataclasses import asdict
from pathlib import Path

from snakemake.exceptions import WorkflowError

# The folder of this workflow. It is right too where another workflow imports this one as a module.
ROOT = Path(workflow.current_basedir.get_path_or_uri(secret_free=True)).parents[1]
sys.path.insert(0, str(ROOT / "workflow"))

from engine import use_checkout

# Jobs import the packages in src of this checkout, not those of an installed one.
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
# The plan checks the study, reads the sidecars and digests the scans once a run, not once a job.
PLAN = Plan(workflow, config, SOURCE)
STUDY = PLAN.study
RESULTS = f"results/{config['study']}"
#: By specimen: its scan files, its settings, the scan keys of its sidecar; by contact map: its label.
SCANS, SETTINGS, OPTIONS, LABELS = STUDY.scans, STUDY.settings, STUDY.options, STUDY.labels
#: Settings of the solver, and those of each specimen, as plain data.
SOLVER = asdict(STUDY.solver)
RECORDS = {name: asdict(stated) for name, stated in SETTINGS.items()}

SPECIMENS = sorted(SETTINGS)
#: Specimens that do not slide (surfaces against a plane, and aperture maps), and all others.
FLAT = [name for name in SPECIMENS if not slides(SETTINGS[name].opposite)]
SLIDING = sorted(set(SPECIMENS) - set(FLAT))
#: Measured maps of contact, which have labels but no settings.
MAPS = list(LABELS)
#: Recipes of surfaces that the study makes, and specimens with tests in a real laboratory (rule `measured`).
RECIPES = {name: recipe for name, recipe in config.get("embedded", {}).items() if name in SETTINGS}
TESTED = [name for name in SPECIMENS if SETTINGS[name].measured]
#: Number of members of each ensemble: twins of a scan, or realisations of a surface of the study.
TWINS = {name: SETTINGS[name].twins for name in SPECIMENS if SETTINGS[name].twins}
ENSEMBLES = TWINS | {
    name: recipe["realisations"] for name, recipe in RECIPES.items() if "realisations" in recipe
}
#: True for a campaign, a study of many specimens. Its atlas.nc has one row a specimen; the results are in
#: atlas/{specimen}.nc alone. The rule `all` does not ask for every file of every specimen.
CAMPAIGN = campaign.in_parts(config, SPECIMENS)
#: Priorities by rule, 0 for all others. Snakemake begins jobs of high priority first. The longest jobs
#: begin early, so that no core works alone at the end of a run.
PRIORITY = {
    "ensemble": 2,  # closure_and_box_counts waits for it
    "windows": 1,  # the longest job of a specimen; strength waits for it
    "roll_off": 1,
    "size_strength": 1,
    "size_effect_part": 1,
    # Short jobs, for a core that has nothing else to do at the end.
    "area_slope": -1,
    "estimator_bias": -1,
    # Figures are drawn after what the atlas of the study needs, else one core makes that atlas alone at the
    # end. Figures of joints take longer and begin first. In a campaign the jobs of this
    # priority make the rows of the atlas, and are not put off.
    "figures": 0 if CAMPAIGN else -2,
    "figures_against_plane": 0 if CAMPAIGN else -3,
    "explorer": -4,  # last: no job waits for it
}


# A specimen is any name without a slash, because matching each file with ten thousand names takes
# minutes. `known` refuses names that are no specimen.
wildcard_constraints:
    specimen="[^/]+",
    direction_block=r"\d+",
    offset_block=r"\d+",
    resolution_block=r"\d+",
    refused=r"\d+",


def known(wildcards):
    """Name of a specimen, which must be one of the study."""
    if wildcards.specimen not in SETTINGS:
        raise WorkflowError(f"{SOURCE}: the study has no specimen '{wildcards.specimen}'")
    return wildcards.specimen


def names_of(some, others):
    """Constraint of {specimen} where two rules make the same files.

    ``some`` are the specimens of this rule, ``others`` those of the other rule. Without others every
    name matches; without some, none does.
    """
    return alternation(some) if others else "[^/]+" if some else alternation([])


def settings_of(section):
    """Parameter with those settings of a specimen that a class of `core.settings` has.

    A job runs again only if one of these changes. So no solve runs again for a new friction angle.
    """
    return lambda wildcards: asdict(settings.read(section, RECORDS[known(wildcards)]))


#: SHA-256 of a script and of what it imports: packages in src, and modules of workflow.
digest = functools.cache(Code(ROOT / "src", ROOT, ROOT / "workflow").digest)


def code(script, *names):
    """Parameter that changes with the code that a script of workflow/scripts runs.

    Snakemake's own trigger sees the script but not its imports. `names` are modules, or folders of
    src, that the script imports only while it runs, where the digest cannot find them.
    """
    return lambda wildcards: digest(ROOT / f"workflow/scripts/{script}.py", *names)


def recipe_named(name):
    """Recipe of a surface that the study makes, its lengths in mm."""
    return resolve_embedded(RECIPES[name], f"{SOURCE}: embedded.{name}")


@functools.cache
def face_nodes(name):
    """Upper bound of the nodes of a face of a specimen."""
    if name in SCANS:
        return estimates.nodes_of_files(SCANS[name].files)
    return estimates.nodes_of_recipe(recipe_named(name))


@functools.cache
def window_nodes(name):
    """Upper bound of the nodes of the window of a specimen."""
    spacing = OPTIONS[name].get("spacing") if name in SCANS else recipe_named(name)["spacing"]
    return estimates.nodes_of_window(SETTINGS[name], spacing, face_nodes(name))


def max_offsets(name):
    """Upper bound of the shear offsets of a specimen; "auto" settles their number only later."""
    return len(SETTINGS[name].offsets or range(AUTOMATIC_OFFSETS + 1))


def kept_states(name):
    """Contact states of a specimen that are kept at the finest resolution."""
    return estimates.states_of(SETTINGS[name], max_offsets(name))


def doubled(amount):
    """Memory or time, a number or a function of wildcards, doubled at every further attempt.

    So a job that a cluster ended for its memory or its time gets more in the next attempt.
    """
    asked = amount if callable(amount) else lambda wildcards: amount
    return lambda wildcards, attempt: asked(wildcards) * 2 ** (attempt - 1)


def memory(job, nodes=window_nodes, states=kept_states):
    """Requested megabytes of a job, by the nodes of its grid and its number of states."""
    return doubled(lambda wc: estimates.memory(job, nodes(known(wc)), states(wc.specimen)))


def minutes(job, nodes=window_nodes, states=kept_states):
    """Requested minutes of a job, by the nodes of its grid and its number of states."""
    return doubled(lambda wc: estimates.minutes(job, nodes(known(wc)), states(wc.specimen)))
