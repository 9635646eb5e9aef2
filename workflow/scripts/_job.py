"""What every script does around its one call: a log, checked inputs, errors a user can read."""

import contextlib
import logging
import os
import signal
import sys
import time
from pathlib import Path

import _running
import _warm

from fractalcontact.core import checksums
from fractalcontact.core.errors import InputError, OutputError
from roughcontact.contact.effort import SOLVING
from roughcontact.errors import NotConverged

_warm.hand_over()  # before the script imports what takes long

#: What a job says, and exits with, that is told to end.
STOPPED, STOPPED_CODE = "stopped before it was done", 143
#: What stands in a log below an error that every further attempt would find again.
CERTAIN = "no further attempt can do better"


@contextlib.contextmanager
def job(snakemake):
    """One job: its inputs are as they were made, its outputs leave their checksums, it has a log.

    Where the input is at fault, or the disk is full, it ends with one clear line and no traceback.
    What a further attempt on a cluster would find again it says at once, without working again.
    The log's last line says what the job spent on its work, imports not counted, and of that on
    contact solves: ``benchmarks/study_cost.py`` adds them up.

    Parameters
    ----------
    snakemake : object
        What Snakemake puts into every script.

    Yields
    ------
    logging.Logger
    """
    found_before = _found_before(snakemake.log[0])
    try:
        logging.basicConfig(
            filename=snakemake.log[0], filemode="w", level=logging.INFO, format="%(message)s"
        )
    except PermissionError:
        why = "cannot be written, no permission; allow writing there and run again"
        sys.exit(f"error: {snakemake.log[0]}: {why}")
    log = logging.getLogger("fractalcontact")
    results = Path("results") / snakemake.config["study"]
    signal.signal(signal.SIGTERM, _stop)
    begin = time.perf_counter()
    if found_before:
        log.error("%s\n%s", found_before, CERTAIN)
        sys.exit(found_before)
    try:
        with _running.marked():
            if changed := os.environ.get("FRACTALCONTACT_CHANGED"):
                raise InputError(changed)
            for path in _below(results, snakemake.input):
                checksums.require_intact(results, path)
            yield log
            if _told_to_stop:  # the work may have taken the interrupt for an error of its own
                raise KeyboardInterrupt
            checksums.record(results, _below(results, snakemake.output))
        signal.signal(signal.SIGTERM, signal.SIG_IGN)  # done: it ends at once anyway
        log.info(
            "worked %.3f s, of which %.3f s on %d contact problems; processor time %.3f s",
            time.perf_counter() - begin,
            SOLVING.seconds,
            SOLVING.problems,
            time.process_time(),  # imports counted, but where a warm interpreter had them
        )
    except (InputError, NotConverged, OutputError) as error:
        lines = [str(error), *getattr(error, "__notes__", [])]
        message = "error: " + "; ".join(lines)
        logging.raiseExceptions = False  # the log may stand on the same full disk
        log.error(message)
        if not isinstance(error, OutputError):
            log.info(CERTAIN)
        sys.exit(message)
    except (Exception, KeyboardInterrupt) as error:
        # Inside a compiled kernel the interrupt ends as an error of another kind.
        if isinstance(error, KeyboardInterrupt) or _told_to_stop:
            log.error(STOPPED)
            sys.exit(STOPPED_CODE)
        log.exception("error in the program")
        raise


def _found_before(log):
    """The error of the attempt before this one, if it would be that of this one too."""
    if int(os.environ.get("FRACTALCONTACT_ATTEMPT", 1)) == 1 or not Path(log).is_file():
        return ""
    *before, last = Path(log).read_text(encoding="utf-8").splitlines() or [""]
    errors = [line for line in before if line.startswith("error: ")]
    return errors[-1] if errors and last == CERTAIN else ""


_told_to_stop = []


def _stop(number, frame):
    """End as after Ctrl-C, so that nothing half written stays behind."""
    _told_to_stop.append(number)
    raise KeyboardInterrupt


def _below(folder, paths):
    """Those files that the study itself makes."""
    return [path for path in map(Path, paths) if path.is_relative_to(folder)]


def require_unchanged(digests):
    """Refuse what was made of scan files that are no longer those the study was planned with.

    Parameters
    ----------
    digests : mapping of str to str
        SHA-256 by path, taken when the workflow was read.

    Raises
    ------
    InputError
        If one is another by now: the results would not belong to it, and nothing would show it.
    """
    for path, digest in digests.items():
        if digest and (not Path(path).is_file() or checksums.sha256(path) != digest):
            raise InputError(f"{path}: changed while the study ran; run it again")
