# What a run looks at before its first job, and leaves behind after its last: a guard of results, its
# plan, checksums, and what was made of what in linked data.
import os
import threading

import snakemake
from engine import provenance, running
from engine.ending import answer_in_thread
from fractalcontact.core import checksums
from fractalcontact.study import crate, guards
from snakemake.logging import logger


def remake_without_record():
    """Mark results that Snakemake would take for up to date though its record of them is lost."""
    if workflow.is_main_process and (
        again := provenance.mark_without_provenance(RESULTS, workflow.workflow_settings)
    ):
        logger.warning(
            f"{RESULTS}: {again} of its files will be made again, since Snakemake's record of "
            "how a file was made (in .snakemake), or a file that it was made from, is missing "
            "or damaged"
        )


def begin():
    """Refuse what would lose results; else say that a run is at work, and its plan."""
    running.mark()
    # Elsewhere no signal is answered: another program may call Snakemake from any thread.
    if threading.current_thread() is threading.main_thread():
        answer_in_thread()
    try:
        # Only the user says that specimens may go, never a study.
        if "FRACTALCONTACT_DROP" not in os.environ:
            guards.refuse_loss(RESULTS, [*SETTINGS, *LABELS])
        RUN.save()
    except InputError as error:
        raise WorkflowError(str(error))


def end():
    """Write checksums of all that was made, and what it is: be everything done or not."""
    checksums.write_manifest(RESULTS)
    scans = {path: digest for path, digest in RUN.all_digests().items() if digest}
    crate.write_crate(RESULTS, WORKFLOW, config["study"], scans)


#: What made a study, for its crate of linked data.
WORKFLOW = crate.Workflow(
    folder=ROOT,
    main="Snakefile",
    parts=(
        *(
            "workflow/*.py",
            "workflow/rules/*.smk",
            "workflow/scripts/*.py",
            "workflow/engine/**/*.py",
            "config/schema/*.json",
        ),
        *("environment.yml", "requirements.lock", "CITATION.cff", "LICENSE"),
    ),
    language="Snakemake",
    url="https://snakemake.github.io",
    version=snakemake.__version__,
)
