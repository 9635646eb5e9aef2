"""Who is at work in this checkout: so that nobody takes away the lock of what lives.

Snakemake's own lock is a file that a killed run leaves behind, and does not say whose it is. So
every process that works here, the runs and each of their jobs, holds a shared lock of the system on
one file for as long as it lives, however it ends. Who gets that file for itself alone knows that
nothing is at work here. (A job that still waits in a cluster's queue is not.)
"""

import errno
import fcntl
import os
import time

FILE = ".snakemake.guard"
#: First word of the last line of a job's log: it is done.
DONE = "worked"
#: File systems that know no such locks: nothing can be told there.
_NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP)


def mark():
    """Say that this process is at work, until it ends."""
    share(os.open(FILE, os.O_RDWR | os.O_CREAT, 0o666))


def alone(seconds):
    """Keep everybody else from working: a handle for `share`, None if others are at work so long.

    And whether the file system has locks. Where it has none, others may be at work.
    """
    handle, end = os.open(FILE, os.O_RDWR | os.O_CREAT, 0o666), time.monotonic() + seconds
    while time.monotonic() < end:
        try:
            return handle, _locked(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            time.sleep(0.1)
    os.close(handle)
    return None, True


def share(handle):
    """Let others work again; this process still counts as one that does.

    For a moment nobody holds the file. Another run may take it then, which finds what this one has
    just left behind: nothing that it could harm.
    """
    _locked(handle, fcntl.LOCK_SH)


def _locked(handle, kind):
    """Lock the file; False where its file system has no locks."""
    try:
        fcntl.flock(handle, kind)
    except OSError as error:
        if error.errno not in _NO_LOCKS:
            raise
    else:
        return True
    return False
