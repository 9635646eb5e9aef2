"""Who is at work in this checkout: so that nobody takes away the lock of what lives.

Snakemake's own lock is a file that a killed run leaves behind, and does not say whose it is. So
every process that works here, the runs and each of their jobs, holds a shared lock of the system on
one file for as long as it lives, however it ends. Who gets that file for itself alone knows that
nothing is at work here. (A job that still waits in a cluster's queue is not.)
"""

import contextlib
import errno
import fcntl
import os
import time

FILE = ".snakemake.guard"
#: File systems that know no such locks: nothing can be told there.
_NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP)


def _locked(handle, kind):
    """Whether a lock was got; None where the file system knows none."""
    try:
        fcntl.flock(handle, kind | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError as error:
        if error.errno in _NO_LOCKS:
            return None
        raise
    return True


def mark():
    """Say that this process is at work, until it ends or closes the file descriptor given back."""
    handle = os.open(FILE, os.O_RDWR | os.O_CREAT, 0o666)
    while _locked(handle, fcntl.LOCK_SH) is False:
        time.sleep(0.05)  # held alone for a moment, by a run that looks whether others live
    return handle


@contextlib.contextmanager
def marked():
    """The same for a block."""
    handle = mark()
    try:
        yield
    finally:
        os.close(handle)


def alone(seconds):
    """Keep everybody else from working.

    Parameters
    ----------
    seconds : float
        How long to wait for others.

    Returns
    -------
    handle : int or None
        For :func:`share`; None if others are at work.
    has_locks : bool
        Whether the file system has locks. Where it has none, others may be at work.
    """
    handle = os.open(FILE, os.O_RDWR | os.O_CREAT, 0o666)
    end = time.monotonic() + seconds
    while (locked := _locked(handle, fcntl.LOCK_EX)) is False:
        if time.monotonic() > end:
            os.close(handle)
            return None, True
        time.sleep(0.1)
    return handle, locked is not None


def share(handle):
    """Let others work again; this process still counts as one that does.

    For a moment nobody holds the file. Another run may take it then, which finds what this one has
    just left behind: nothing that it could harm.
    """
    _locked(handle, fcntl.LOCK_SH)
