# What every rule file uses: the checked study, its specimens, files of its stages, and digests of
# scans and code, which are taken when a rule is asked for them.
import functools
import pickle
import sys
from dataclasses import asdict
from pathlib import Path

import yaml
from snakemake.exceptions import WorkflowError
from snakemake.logging import logger
from snakemake.utils import update_config

# The code of this checkout, wherever its environment was installed from: it may have been moved.
ROOT = Path(workflow.basedir)
sys.path[:0] = [str(ROOT / "src"), str(ROOT / "workflow/scripts")]

from _hashes import hash_once

# Light modules, without xarray, numba or matplotlib: on a cluster every job reads the workflow.
from fractalcontact.core import checksums
from fractalcontact.core.code_digest import Code
from fractalcontact.core.directions import AUTOMATIC_OFFSETS, slides
from fractalcontact.core.errors import InputError
from fractalcontact.core.patterns import alternation
from fractalcontact.core.stage import ENSEMBLE, GRAINS, JOINT, MAP, SPECIMEN, TESTED, module_of
from fractalcontact.study import campaign, resources, stages
from fractalcontact.study.checks import resolve_study
from fractalcontact.study.configuration import resolve_embedded
from fractalcontact.study.documents import read_study
from fractalcontact.study.figure_list import all_figures, study_figures_of
from fractalcontact.study.scan_groups import grouped_notes
from fractalcontact.study.selection import CAPPED_VARIANTS
from fractalcontact.study.sidecar import sidecar_of_matrix

SOURCE = str(workflow.configfiles[-1]) if workflow.configfiles else "config/paper.yaml"
#: What a run works with. Its jobs on a cluster read the workflow again, hours later, and take it from
#: there: what is edited meanwhile, and specimens that come or go, are the next run's.
PLAN = Path(".snakemake/fractalcontact-plan.pickle")
#: SHA-256 of the scan files that the run was planned with.
PLANNED = {}


def read_again():
    """Replace the configuration by the study as the program itself reads it.

    Snakemake takes the last of two equal keys without a word, and a specimen called ``no`` for false.
    """
    config.clear()
    for path in workflow.configfiles:
        update_config(config, read_study(path))
    update_config(config, workflow.config_settings.config)


if workflow.is_main_process:
    schema = yaml.safe_load((ROOT / "config/schema/study.schema.yaml").read_text())
    # What is wrong with one scan stops only that where the user asks so on the command line, which
    # Snakemake itself looks at later.
    keep_going = bool({"-k", "--keep-going"} & set(sys.argv))
    try:
        read_again()
        STUDY = resolve_study(config, schema, SOURCE, leave_out=keep_going)
    except InputError as error:
        raise WorkflowError(str(error))
else:
    planned, STUDY, PLANNED = pickle.loads(PLAN.read_bytes())
    config.clear()
    config.update(planned)
RESULTS, SCAN_FOLDER = f"results/{config['study']}", config.get("scans", "scans")
SCANS, SETTINGS, OPTIONS, LABELS = STUDY.scans, STUDY.settings, STUDY.options, STUDY.labels
SOLVER = STUDY.solver
if SCAN_FOLDER and workflow.is_main_process:
    if not SCANS:
        made_alone = "no scan files there; only what the study itself makes is used"
        logger.warning(f"{SCAN_FOLDER}: {made_alone}")
    for note in grouped_notes(SCAN_FOLDER, config.get("groups")):
        logger.warning(note)
#: What is wrong with scans that are left out; each has a job that says so.
REFUSED = [str(STUDY.refused[name]) for name in sorted(STUDY.refused)]

#: Measured contact maps, which have no settings.
MAPS = {name: SCANS[name] for name in LABELS}
SPECIMENS = sorted(SETTINGS)
#: Settings as the atlas keeps them.
RECORDS = {name: asdict(stated) for name, stated in SETTINGS.items()}


def recipe_named(name):
    """Recipe of an embedded specimen, its lengths in mm."""
    return resolve_embedded(config["embedded"][name], f"{SOURCE}: embedded.{name}")


@functools.cache
def nodes_of(name):
    """Most nodes of a face of a specimen, and of its window: what its jobs take follows from them."""
    if name in SCANS:
        face, spacing = resources.nodes_of_files(SCANS[name].files), OPTIONS[name].get("spacing")
    else:
        recipe = recipe_named(name)
        face, spacing = resources.nodes_of_recipe(recipe), recipe["spacing"]
    return face, resources.nodes_of_window(SETTINGS[name], spacing, face)


def most_offsets(name):
    """Most shear offsets of a specimen: how many "auto" finds is known only later."""
    stated = SETTINGS[name].offsets
    return len(stated) if stated else AUTOMATIC_OFFSETS + 1


def kept_states(wildcards):
    """Contact states of a specimen that are kept at the finest resolution."""
    return resources.states_of(SETTINGS[wildcards.specimen], most_offsets(wildcards.specimen))


def doubled(amount):
    """Memory or time of a job, of its wildcards, twice as much at every further attempt.

    So what a cluster has ended for its memory or its time is done by the next.
    """
    return lambda wildcards, attempt: amount(wildcards) * 2 ** (attempt - 1)


def asked_for(job, grid=1, states=kept_states):
    """Memory and minutes that the job of a rule asks for.

    They follow from the nodes of the window, or with grid=0 of a face, and from a number of states
    or, of an ensemble, of realisations.
    """

    def by_grid(amount):
        return doubled(lambda wc: amount(job, nodes_of(known(wc))[grid], states(wc)))

    return {"mem_mb": by_grid(resources.memory), "runtime": by_grid(resources.minutes)}


def fixed(megabytes, minutes):
    """Both of a job whose grid says nothing of them."""
    return {"mem_mb": doubled(lambda wc: megabytes), "runtime": doubled(lambda wc: minutes)}


DIGESTS = checksums.Digests()
if workflow.is_main_process:
    hash_once(DIGESTS)


@functools.cache
def digest_of(path):
    """SHA-256 of a scan file; none of one that cannot be read, which its job explains.

    Taken before any job: a scan that is replaced meanwhile belongs to the next run.
    """
    if path in PLANNED:
        return PLANNED[path]
    try:
        return DIGESTS.of(path)
    except OSError:
        return ""


def digests_of(*files):
    """SHA-256 of scan files or laboratory tests, by path: a parameter of the rules that read them.

    Times say nothing of a file that was moved, copied or unpacked over another.
    """
    return {str(path): digest_of(str(path)) for path in files}


def scan_digests():
    """The same of all scan files and tests of the study."""
    tests = [test.file for settings in SETTINGS.values() for test in settings.measured]
    return digests_of(*tests, *(path for scan in SCANS.values() for path in scan.files))


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


def settings_read_by(function):
    """Settings that a function reads of a specimen and of the solver, and no others.

    A change of others is no change: a friction angle or a label solves nothing again.
    """
    return lambda wildcards: stages.read_by(function, SETTINGS[known(wildcards)], SOLVER)


#: Surfaces against a plane, which cannot slide, and all others.
FLAT = [name for name in SPECIMENS if not slides(SETTINGS[name].opposite)]
SLIDING = sorted(set(SPECIMENS) - set(FLAT))


def kind_of(some, others):
    """Pattern of the names of one kind of specimens; any name where there is no other kind."""
    return alternation(some) if others else "[^/]+" if some else alternation([])


#: Members of the ensembles that the study wants: twins of scans, realisations of embedded specimens.
TWINS = {name: SETTINGS[name].twins for name in SPECIMENS if SETTINGS[name].twins}
ENSEMBLES = TWINS | {
    name: recipe["realisations"]
    for name, recipe in config.get("embedded", {}).items()
    if name in SETTINGS and "realisations" in recipe
}
#: Specimens that have the stages of a grain: all, those that slide, with an ensemble, with tests.
MEMBERS = {
    SPECIMEN: dict.fromkeys(SPECIMENS),
    JOINT: dict.fromkeys(SLIDING),
    ENSEMBLE: ENSEMBLES,
    TESTED: dict.fromkeys(name for name in SPECIMENS if SETTINGS[name].measured),
}


#: Whether the atlas has a file a specimen: then nothing asks for all that was made of each of them.
IN_PARTS = campaign.in_parts(config, SPECIMENS)


def files_of(paths):
    """Files of stages in the folder of the study, by stage."""
    return {stage: f"{RESULTS}/{path}" for stage, path in paths.items()}


def calling(stage):
    """Parameters by which scripts/stage.py calls the function of a stage."""
    function = stages.STAGES[stage].function
    given = {"settings": settings_read_by(function)} if stages.sections_of(function) else {}
    return {
        "function": function,
        "code": code("stage", module_of(function)),
        **given,
    }


def of_specimen(wildcards, *grains):
    """Files of the stages of some grains that a specimen has."""
    here = [grain for grain in grains if wildcards.specimen in MEMBERS[grain]]
    return files_of(stages.paths_of(*here))


# Measured contact maps stand in every atlas, beside the domains computed there.
MAP_FILES = {
    stage: expand(path, specimen=MAPS)
    for stage, path in files_of(stages.paths_of(MAP)).items()
    if MAPS
}


def grain(key, n):
    """Slices of n things for as many jobs as the study's grain asks for."""
    stated = config.get("grain", {}).get(key, "all")
    size = n if stated == "all" else stated
    return [slice(start, min(start + size, n)) for start in range(0, n, size)]


digest_of_code = functools.cache(Code(ROOT / "src", ROOT).digest)


def code(script, *names):
    """Parameter that changes with the code that a script of workflow/scripts runs.

    Named are modules, or whole rooms, that it imports by names which only exist when it runs.
    """
    return lambda wildcards: digest_of_code(ROOT / f"workflow/scripts/{script}.py", *names)
