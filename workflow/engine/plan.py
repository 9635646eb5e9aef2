"""Plan of a run: its study, which jobs on a cluster load instead of reading it again.

Cluster jobs read the workflow again, hours later. Without a plan, edits made meanwhile and
specimens that come or go would give results of neither study; with it they affect only the next
run. The plan costs some 10 ms a run. On one machine jobs do not read the workflow and need none.
"""

import functools
import pickle
import sys
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.logging import logger
from snakemake.utils import update_config

from fractalcontact.core.atomic import atomic_write
from fractalcontact.core.checksums import Digests
from fractalcontact.core.errors import InputError
from fractalcontact.study.checks import resolve_study
from fractalcontact.study.documents import read_study
from fractalcontact.study.scan_groups import grouped_notes

#: File of the plan, in the checkout of the run.
FILE = Path(".snakemake/fractalcontact-plan.pickle")


class Plan:
    """Study of a run, as ``study``, and the SHA-256 of the files that it reads.

    ``config`` is the study as its user wrote it; in a job of a cluster it becomes that of the plan.
    ``source`` is its file, for errors.
    """

    def __init__(self, workflow, config, source):
        self._config, self._computed, self._known = config, Digests(), {}
        if workflow.is_main_process:
            try:
                read_again(workflow, config)
                self.study = checked(config, source)
            except InputError as error:
                raise WorkflowError(str(error)) from None
        else:
            planned, self.study, self._known = pickle.loads(FILE.read_bytes())
            config.clear()
            config.update(planned)
        # Digests are taken before any job: a scan replaced meanwhile belongs to the next run.
        self._digest = functools.cache(self._digest_of)

    def _digest_of(self, path):
        if path in self._known:
            return self._known[path]
        try:
            return self._computed.of(path)
        except OSError:  # no digest of a file that cannot be read; its job explains why
            return ""

    def digests(self, *files):
        """SHA-256 of scan files or laboratory tests, by path.

        Modification times are no substitute: a file may be moved, copied or unpacked over another.
        """
        return {str(path): self._digest(str(path)) for path in files}

    def all_digests(self):
        """SHA-256 of all scan files and laboratory tests of the study."""
        scans, settings = self.study.scans.values(), self.study.settings.values()
        tests = [test.file for stated in settings for test in stated.measured]
        return self.digests(*tests, *(path for scan in scans for path in scan.files))

    def save(self):
        """Write the plan, before the first job."""
        with atomic_write(FILE) as path:
            path.write_bytes(pickle.dumps((dict(self._config), self.study, self.all_digests())))
        self._computed.save()


def read_again(workflow, config):
    """Replace the configuration by the study as the program itself reads it.

    Snakemake takes the last of two equal keys without a word, and a specimen called ``no`` for
    false. What another workflow hands over to this one, as its module, stays.
    """
    if config != workflow.config:
        return
    config.clear()
    for path in workflow.configfiles:
        update_config(config, read_study(path))
    update_config(config, workflow.config_settings.config)


def checked(config, source):
    """A study that passed all checks; what its user should know is said."""
    # With --keep-going an error of one scan stops only that scan. Snakemake reads this option from
    # the command line too, but later.
    keep_going = bool({"-k", "--keep-going"} & set(sys.argv))
    study = resolve_study(config, source, leave_out=keep_going)
    if folder := config.get("scans", "scans"):
        if not study.scans:
            made_alone = "no scan files there; only what the study itself makes is used"
            logger.warning(f"{folder}: {made_alone}")
        for note in grouped_notes(folder, config.get("groups")):
            logger.warning(note)
    return study
