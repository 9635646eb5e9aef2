"""What every script does around its one call: a log, checked inputs, errors a user can read."""

import contextlib
import logging
import os
import resource
import signal
import sys
import time
from pathlib import Path

# The code of this checkout, wherever its environment was installed from: it may have been moved.
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "src"))
# Read when numpy is imported. Two threads of BLAS that wait for each other make the L-BFGS-B of
# another code four times slower; our own threads are another matter.
os.environ["OPENBLAS_NUM_THREADS"] = "1"

import _running

from fractalcontact.core import checksums
from fractalcontact.core.errors import InputError, OutputError
from roughcontact.contact.effort import SOLVING
from roughcontact.errors import NotConverged, is_interrupt

#: What a job says, and exits with, that is told to end.
STOPPED, STOPPED_CODE = "stopped before it was done", 143
#: What stands in a log below an error that every further attempt would find again.
CERTAIN = "no further attempt can do better"
#: What systems count memory in.
_KILOBYTE = 1 if sys.platform == "darwin" else 1024
log = logging.getLogger("fractalcontact")


@contextlib.contextmanager
def job(snakemake):
    """One job: its inputs are as they were made, its outputs leave their checksums, it has a log.

    Where the input is at fault, or the disk is full, its log has one clear line and no traceback.
    What a further attempt on a cluster would find again it says at once, without working again.
    The log's last line says what the job spent on its work, imports not counted, and of that on
    contact solves: ``benchmarks/study_cost.py`` and the result page add them up.
    """
    found_before = _found_before(snakemake)
    _begin_log(snakemake.log[0])
    results, begin = Path("results") / snakemake.config["study"], time.perf_counter()
    signal.signal(signal.SIGTERM, _stop)
    try:
        if found_before:
            raise InputError(found_before)
        _running.mark()
        for path in _below(results, snakemake.input):
            checksums.require_intact(results, path)
        yield log
        if _told_to_stop:  # the work may have taken the interrupt for an error of its own
            raise KeyboardInterrupt
        checksums.record(results, _below(results, snakemake.output))
        signal.signal(signal.SIGTERM, signal.SIG_IGN)  # done: it ends at once anyway
        log.info(
            "worked %.3f s, of which %.3f s on %d contact problems; processor time %.3f s, "
            "memory %.0f MB",
            time.perf_counter() - begin,
            SOLVING.seconds,
            SOLVING.problems,
            time.process_time(),  # imports counted, but where a warm interpreter had them
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


#: Standard error as it was before the log took it.
_terminal = os.dup(2)


def _begin_log(path):
    """Let the log take what the job says, and what libraries write past it."""
    try:
        logging.basicConfig(
            filename=path, filemode="w", encoding="utf-8", level=logging.INFO, format="%(message)s"
        )
        os.dup2(logging.getLogger().handlers[0].stream.fileno(), sys.stderr.fileno())
    except OSError as error:
        sys.exit(f"error: {path}: cannot be written ({error.strerror}); mend that and run again")


def _say_error(said):
    """In the log, or in the terminal where the log stands on the same full disk."""
    logging.raiseExceptions = False
    log.error("error: %s", said)
    if said not in Path(logging.getLogger().handlers[0].baseFilename).read_text("utf-8"):
        os.write(_terminal, f"error: {said}\n".encode())


def _found_before(snakemake):
    """The error of the attempt before this one, if it would be that of this one too."""
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
    """Those files that the study itself makes."""
    return [path for path in map(Path, paths) if path.is_relative_to(folder)]


def require_unchanged(digests):
    """Refuse what was made of scan files whose digests are no longer those of the plan.

    The results would not belong to them, and nothing would show it.
    """
    for path, digest in digests.items():
        if digest and (not Path(path).is_file() or checksums.sha256(path) != digest):
            raise InputError(f"{path}: changed while the study ran; run it again")
