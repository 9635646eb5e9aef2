"""Frame of every script: a log, checked inputs, checksums of outputs, readable errors."""

import contextlib
import logging
import os
import resource
import signal
import sys
import time
from pathlib import Path

# BLAS reads this when numpy is imported, so scripts import this module before numpy. Two threads of
# BLAS that wait for each other make the L-BFGS-B of another code four times slower. The threads of
# our own kernels are set elsewhere.
os.environ["OPENBLAS_NUM_THREADS"] = "1"

from fractalcontact.core import checksums
from fractalcontact.core.errors import InputError, OutputError
from roughcontact.contact.effort import SOLVING
from roughcontact.errors import NotConverged, is_interrupt

from . import running

#: Last words and exit code of a job that is told to end.
STOPPED, STOPPED_CODE = "stopped before it was done", 143
#: Line of a log below an error that every further attempt would meet again.
CERTAIN = "no further attempt can do better"
#: Bytes of the unit of ``ru_maxrss``, which differs between systems.
_KILOBYTE = 1 if sys.platform == "darwin" else 1024
log = logging.getLogger("fractalcontact")


@contextlib.contextmanager
def job(snakemake):
    """Frame of one job: inputs are checked, outputs leave checksums, everything goes to a log.

    If the input is at fault, or the disk is full, the log gets one clear line and no traceback. On
    a cluster a further attempt that would fail the same way repeats that line at once. The last
    line of the log states the time of the work, imports not counted, and of its contact solves,
    which ``benchmarks/study_cost.py`` and the result page add up.
    """
    found_before = _found_before(snakemake)
    _begin_log(snakemake.log[0])
    results, begin = Path("results") / snakemake.config["study"], time.perf_counter()
    signal.signal(signal.SIGTERM, _stop)
    try:
        if found_before:
            raise InputError(found_before)
        running.mark()
        for path in _below(results, snakemake.input):
            checksums.require_intact(results, path)
        yield log
        if _told_to_stop:  # the work may have taken the interrupt for an error of its own
            raise KeyboardInterrupt
        checksums.record(results, _below(results, snakemake.output))
        # The work is done, and the job ends at once anyway.
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        log.info(
            "%s %.3f s, of which %.3f s on %d contact problems; processor time %.3f s, "
            "memory %.0f MB",
            running.DONE,
            time.perf_counter() - begin,
            SOLVING.seconds,
            SOLVING.problems,
            time.process_time(),  # includes imports, except those loaded before the fork
            resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * _KILOBYTE / 1e6,
        )
    except (InputError, NotConverged, OutputError) as error:
        _say_error("; ".join([str(error), *getattr(error, "__notes__", [])]))
        if not isinstance(error, OutputError):
            log.info(CERTAIN)
        sys.exit(1)
    except (Exception, KeyboardInterrupt) as error:
        if is_interrupt(error) or _told_to_stop:
            log.error(STOPPED)
            sys.exit(STOPPED_CODE)
        log.exception("error in the program")
        sys.exit(1)


#: Copy of standard error, which the log takes over.
_terminal = os.dup(2)


def _begin_log(path):
    """Write to the log what the job says, and what libraries write past it."""
    try:
        logging.basicConfig(
            filename=path, filemode="w", encoding="utf-8", level=logging.INFO, format="%(message)s"
        )
        os.dup2(logging.getLogger().handlers[0].stream.fileno(), sys.stderr.fileno())
    except OSError as error:
        sys.exit(f"error: {path}: cannot be written ({error.strerror}); mend that and run again")


def _say_error(said):
    """Write an error to the log, or to the terminal if the log is on the full disk."""
    logging.raiseExceptions = False
    log.error("error: %s", said)
    if said not in Path(logging.getLogger().handlers[0].baseFilename).read_text("utf-8"):
        os.write(_terminal, f"error: {said}\n".encode())


def _found_before(snakemake):
    """Error of the previous attempt, if this attempt would fail the same way."""
    path = Path(snakemake.log[0])
    if snakemake.resources.get("attempt", 1) == 1 or not path.is_file():
        return ""
    *before, last = path.read_text(encoding="utf-8").splitlines() or [""]
    errors = [line.removeprefix("error: ") for line in before if line.startswith("error: ")]
    return errors[-1] if errors and last == CERTAIN else ""


_told_to_stop = []


def _stop(number, frame):
    """End as after Ctrl-C, so that nothing half written stays behind."""
    _told_to_stop.append(number)
    raise KeyboardInterrupt


def _below(folder, paths):
    """Paths that lie below a folder."""
    return [path for path in map(Path, paths) if path.is_relative_to(folder)]
