"""What every script does around its one call: a log, and errors a user can read."""

import contextlib
import logging
import sys

from fractalcontact.errors import InputError, NotConverged


@contextlib.contextmanager
def reported(log):
    """Log to ``log[0]``; end with one clear line, not a traceback, where the input is at fault.

    Yields
    ------
    logging.Logger
    """
    logging.basicConfig(filename=log[0], filemode="w", level=logging.INFO, format="%(message)s")
    try:
        yield logging.getLogger("fractalcontact")
    except (InputError, NotConverged) as error:
        lines = [str(error), *getattr(error, "__notes__", [])]
        message = "error: " + "; ".join(lines)
        logging.getLogger("fractalcontact").error(message)
        sys.exit(message)
    except Exception:
        logging.getLogger("fractalcontact").exception("error in the program")
        raise
