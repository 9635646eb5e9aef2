# What every rule file uses: the checked study, its specimens, files of its stages, and digests of
# scans and code.
import functools
import os
import sys
from dataclasses import asdict
from pathlib import Path

import snakemake
import yaml
from snakemake.exceptions import WorkflowError
from snakemake.logging import logger

# The code of this checkout, wherever its environment was installed from: it may have been moved.
SOURCES = Path(workflow.basedir) / "src"
PACKAGE = SOURCES / "fractalcontact"
SCRIPTS = Path(workflow.basedir) / "workflow/scripts"
sys.path.insert(0, str(PACKAGE.parent))
sys.path.append(str(SCRIPTS))
os.environ.update(
    PYTHONPATH=os.pathsep.join(filter(None, [str(PACKAGE.parent), os.environ.get("PYTHONPATH")]))
)
# On a cluster jobs are begun again after any error: theirs, which stay, they then only repeat.
os.environ.update(FRACTALCONTACT_ATTEMPT=str(workflow.attempt))

import _provenance
import _running

# Light modules, without xarray, numba or matplotlib: on a cluster every job reads the workflow.
from fractalcontact.core import checksums, sources
from fractalcontact.core.directions import AUTOMATIC_OFFSETS
from fractalcontact.core.errors import InputError
from fractalcontact.core.patterns import one_of
from fractalcontact.core.stage import EXPERIMENT, GRAINS, JOINT, MAP, SPECIMEN
from fractalcontact.study import campaign, crate, guards, plan, resources, stages
from fractalcontact.study.checks import resolve_study
from fractalcontact.study.configuration import resolve_embedded, resolve_roll_off
from fractalcontact.study.figure_list import all_figures, study_figures_of
from fractalcontact.study.scan_groups import grouped_notes
from fractalcontact.study.sidecar import sidecar_of_matrix
from contactlab.experiments.size_tasks import size_jobs

SCHEMA = yaml.safe_load((Path(workflow.basedir) / "config/schema/study.schema.yaml").read_text())
SOURCE = str(workflow.configfiles[-1]) if workflow.configfiles else "config/paper.yaml"
if workflow.is_main_process and "FRACTALCONTACT_ALONE" not in os.environ:
    # Held as long as this process lives; jobs hold their own. workflow/run.py alone lets nobody
    # else work while it looks at what killed runs left.
    AT_WORK = _running.mark()

DIGESTS = checksums.Digests(".snakemake/fractalcontact-digests.json")
# What is wrong with one scan stops only that where the user asks so on the command line, which
# Snakemake itself looks at later. Jobs read the workflow too, after the run has decided.
LEAVE_OUT = not workflow.is_main_process or bool({"-k", "--keep-going"} & set(sys.argv))
try:
    STUDY = resolve_study(config, SCHEMA, SOURCE, leave_out=LEAVE_OUT)
    RESULTS, SCAN_FOLDER = f"results/{config['study']}", config.get("scans", "scans")
    if workflow.is_main_process:
        if SCAN_FOLDER and not STUDY.scans:
            made_alone = "no scan files there; only what the study itself makes is used"
            logger.warning(f"{SCAN_FOLDER}: {made_alone}")
        for note in grouped_notes(SCAN_FOLDER, config.get("groups")) if SCAN_FOLDER else ():
            logger.warning(note)
        # Whoever runs it says these two, never a study: workflow/run.py, that it has set damaged
        # files aside, and the user, that specimens may go.
        if "FRACTALCONTACT_CHECKED" not in os.environ:
            guards.refuse_damage(RESULTS, DIGESTS.of)
        if "FRACTALCONTACT_DROP" not in os.environ:
            guards.refuse_loss(RESULTS, [*STUDY.settings, *STUDY.labels])
        if again := _provenance.mark_without_provenance(RESULTS, workflow.workflow_settings):
            logger.warning(
                f"{RESULTS}: {again} of its files will be made again, since Snakemake's record of "
                "how a file was made (in .snakemake), or a file that it was made from, is missing "
                "or damaged"
            )
except InputError as error:
    raise WorkflowError(str(error))

SCANS, SETTINGS, OPTIONS, LABELS = STUDY.scans, STUDY.settings, STUDY.options, STUDY.labels
SOLVER = STUDY.solver
#: What the run was planned with, for its jobs on a cluster, each of which reads all this again: what
#: they have to say before they work, and specimens that came meanwhile, which are the next run's.
PLAN, PLANNED = ".snakemake/fractalcontact-plan.json", None
os.environ.update(FRACTALCONTACT_CHANGED="")
if not workflow.is_main_process:
    try:
        PLANNED = plan.read_plan(PLAN)
    except InputError as error:
        os.environ.update(FRACTALCONTACT_CHANGED=str(error))
    else:
        for named in (SCANS, SETTINGS, OPTIONS, LABELS):
            for name in named.keys() - PLANNED["specimens"]:
                del named[name]
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


def states_of(name):
    """Most contact states that are kept of a specimen at its finest resolution."""
    return resources.states_of(SETTINGS[name], most_offsets(name))


def memory_for(job):
    """Megabytes that the job of a rule asks for, twice as many at every further attempt."""
    return lambda wildcards, attempt: resources.memory(
        job,
        nodes_of(known(wildcards))[1],
        states=states_of(wildcards.specimen),
        attempt=attempt,
    )


def minutes_for(job):
    """Minutes that the job of a rule asks for, likewise."""
    return lambda wildcards, attempt: resources.minutes(
        job,
        nodes_of(known(wildcards))[1],
        states=states_of(wildcards.specimen),
        attempt=attempt,
    )


def digest_of(path):
    """SHA-256 of a scan file; none of one that cannot be read, which its job explains."""
    try:
        return DIGESTS.of(path)
    except OSError:
        return ""


def digests_of(scan):
    """SHA-256 of the scan files of a specimen, by path: parameters of the rules that read them.

    Times say nothing of a file that was moved, copied or unpacked over another.
    """
    return {str(path): DIGEST_OF_SCAN[path] for path in scan.files}


# Taken now, before any job: a scan that is replaced meanwhile belongs to the next run.
DIGEST_OF_SCAN = {path: digest_of(path) for scan in SCANS.values() for path in scan.files}
NOW = plan.plan_of(config, RECORDS, OPTIONS, {str(p): d for p, d in DIGEST_OF_SCAN.items()})
if workflow.is_main_process:
    DIGESTS.save()
elif PLANNED:
    DIGEST_OF_SCAN |= {p: PLANNED["scans"].get(str(p), d) for p, d in DIGEST_OF_SCAN.items()}
    os.environ.update(FRACTALCONTACT_CHANGED=plan.changed_since(PLANNED, NOW, SOURCE))


# Any name without a slash: to look for each file among ten thousand names takes minutes. Whoever
# asks for a specimen that is none is told so by `known`.
wildcard_constraints:
    specimen="[^/]+",
    map=one_of(MAPS),
    directions=r"\d+",
    offsets=r"\d+",
    resolutions=r"\d+",
    part=r"\d+",
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


def doubled(amount):
    """Megabytes or minutes that a job asks for, twice as many at every further attempt.

    So what a cluster has ended for its memory or its time is done by the next.
    """
    return lambda wildcards, attempt: amount * 2 ** (attempt - 1)


def is_pair(specimen):
    """Whether both faces of a specimen were scanned."""
    return specimen in SCANS and SCANS[specimen].upper is not None


#: Surfaces against a plane, which cannot slide, and all others.
FLAT = [name for name in SPECIMENS if SETTINGS[name].opposite == "flat" and not is_pair(name)]
SLIDING = sorted(set(SPECIMENS) - set(FLAT))
SLIDING_NAMES = set(SLIDING)


def kind_of(some, others):
    """Pattern of the names of one kind of specimens; any name where there is no other kind."""
    return one_of(some) if others else "[^/]+" if some else one_of([])


#: Whether the atlas has a file a specimen: then nothing asks for all that was made of each of them.
IN_PARTS = campaign.in_parts(config, SPECIMENS)


def files_of(paths):
    """Files of stages in the folder of the study, by stage."""
    return {stage: f"{RESULTS}/{path}" for stage, path in paths.items()}


def inputs_of(stage):
    """Files of the stages that a stage needs, for the rule that makes it."""
    return files_of(stages.needed_by(stage))


def outputs_of(stage, grains=GRAINS):
    """Files that the job of a stage makes: also of the other stages of its function."""
    return files_of(stages.made_together(stage, grains))


def calling(stage):
    """Parameters by which scripts/stage.py calls the function of a stage."""
    function, module = stages.STAGES[stage].function, stages.STAGES[stage].module
    given = {"settings": settings_read_by(function)} if stages.sections_of(function) else {}
    return {"function": function, "code": code("stage", module), **given}


#: Files of the stages that every specimen has, and of those that only joints that slide have.
STAGE_FILES = files_of(stages.paths_of(SPECIMEN))
SLIDING_FILES = files_of(stages.paths_of(JOINT))
# Measured contact maps stand in every atlas, beside the domains computed there.
MAP_FILES = (
    {stage: expand(path, map=MAPS) for stage, path in files_of(stages.paths_of(MAP)).items()}
    if MAPS
    else {}
)
# What the study has once.
STUDY_FILES = {
    stage: path
    for stage, path in files_of(stages.paths_of(EXPERIMENT)).items()
    if stage in config
}


def figure_modules(names):
    """Modules that draw figures, for `code`: they are imported by name when they are called."""
    return [all_figures()[name].module for name in names]


def grain(key, n):
    """Slices of n things for as many jobs as the study's grain asks for."""
    stated = config.get("grain", {}).get(key, "all")
    size = n if stated == "all" else stated
    return [[start, min(start + size, n)] for start in range(0, n, size)]


def code(script, *modules):
    """Digest of all that a script runs: a change of it reruns the rule.

    Parameters
    ----------
    script : str
        Of workflow/scripts; with it count all files it imports, of the package and beside it, and
        the versions of the libraries that any of them imports.
    *modules : str
        Of the package, which are imported by names that only exist when it runs.
    """
    if (script, *modules) not in CODE:
        paths = [SCRIPTS / f"{script}.py", *(SOURCES / f"{module}.py" for module in modules)]
        files = sources.source_files(paths, package=PACKAGE)
        versions = sources.versions_of(sources.libraries(files))
        CODE[script, *modules] = sources.digest(files, root=workflow.basedir, versions=versions)
    return CODE[script, *modules]


# Two rules may run one script, in every process that reads the workflow.
CODE = {}


#: What made a study, for its crate of linked data.
WORKFLOW = crate.Workflow(
    folder=Path(workflow.basedir),
    main="Snakefile",
    parts=(
        *("workflow/*.py", "workflow/rules/*.smk", "workflow/scripts/*.py"),
        *(
            "config/schema/*.yaml",
            "environment.yml",
            "requirements.lock",
            "CITATION.cff",
            "LICENSE",
        ),
    ),
    language="Snakemake",
    url="https://snakemake.github.io",
    version=snakemake.__version__,
)


def write_records():
    """Checksums of all that was made, and what it is: after the last job, be it done or not."""
    checksums.write_manifest(RESULTS)
    scans = {str(path): digest for path, digest in DIGEST_OF_SCAN.items() if digest}
    crate.write_crate(RESULTS, WORKFLOW, config["study"], scans)
