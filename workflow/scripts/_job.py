"""What every script does around its one call: a log, and errors a user can read."""

import contextlib
import logging
import sys
import time

from fractalcontact.effort import SOLVING
from fractalcontact.errors import InputError, NotConverged


@contextlib.contextmanager
def reported(log):
    """Log to ``log[0]``; end with one clear line, not a traceback, where the input is at fault.

    The log's last line says what the job spent on its work, imports not counted, and of that on
    contact solves: ``benchmarks/study_cost.py`` adds them up.

    Yields
    ------
    logging.Logger
    """
    logging.basicConfig(filename=log[0], filemode="w", level=logging.INFO, format="%(message)s")
    begin = time.perf_counter()
    try:
        yield logging.getLogger("fractalcontact")
        logging.getLogger("fractalcontact").info(
            "worked %.3f s, of which %.3f s on %d contact problems",
            time.perf_counter() - begin,
            SOLVING.seconds,
            SOLVING.problems,
        )
    except (InputError, NotConverged) as error:
        lines = [str(error), *getattr(error, "__notes__", [])]
        message = "error: " + "; ".join(lines)
        logging.getLogger("fractalcontact").error(message)
        sys.exit(message)
    except Exception:
        logging.getLogger("fractalcontact").exception("error in the program")
        raise
