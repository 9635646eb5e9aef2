# Work before the first job and after the last: a guard of results, the plan of the run, checksums, and
# provenance as linked data.
import os
import threading

import snakemake
from engine import provenance, running
from engine.ending import answer_in_thread
from fractalcontact.core import checksums
from fractalcontact.study import crate, guards
from snakemake.logging import logger


def remake_without_record():
    """Mark results whose record is lost, which Snakemake would take for up to date."""
    if workflow.is_main_process and (
        again := provenance.mark_without_provenance(RESULTS, workflow.workflow_settings)
    ):
        logger.warning(
            f"{RESULTS}: {again} of its files will be made again, since Snakemake's record of "
            "how a file was made (in .snakemake), or a file that it was made from, is missing "
            "or damaged"
        )


def begin():
    """Mark this run as at work, refuse to lose specimens, and save the plan of the run."""
    running.mark()
    # Python answers signals in the main thread alone; a program may call Snakemake from another.
    if threading.current_thread() is threading.main_thread():
        answer_in_thread()
    try:
        # The user alone may let specimens go, not the file of a study.
        if "FRACTALCONTACT_DROP" not in os.environ:
            guards.refuse_loss(RESULTS, [*SETTINGS, *LABELS])
        PLAN.save()
    except InputError as error:
        raise WorkflowError(str(error))


def end():
    """Write checksums and the RO-Crate of the results, whether or not the run succeeded."""
    checksums.write_manifest(RESULTS)
    scans = {path: digest for path, digest in PLAN.all_digests().items() if digest}
    crate.write_crate(RESULTS, WORKFLOW, config["study"], scans)


#: The workflow, for the RO-Crate of the results.
WORKFLOW = crate.Workflow(
    folder=ROOT,
    main="Snakefile",
    parts=(
        "workflow/*.py",
        "workflow/rules/*.smk",
        "workflow/scripts/*.py",
        "workflow/engine/**/*.py",
        "config/schema/*.json",
        "environment.yml",
        "requirements/study.lock",
        "CITATION.cff",
        "LICENSE",
    ),
    language="Snakemake",
    url="https://snakemake.github.io",
    version=snakemake.__version__,
)
