"""Guard of a checkout: locks that tell whether a run or a job is still at work in it.

Snakemake's own lock is a file that a killed run leaves behind without the number of its process.
Therefore every run and every job holds a shared lock of the system on one file for as long as its
process lives, however it ends. A process that gets the exclusive lock knows that no other is at
work here. (A job that still waits in a cluster's queue is not at work.)
"""

import errno
import fcntl
import os
import time

FILE = ".snakemake.guard"
#: First word of the last line in the log of a job that is done.
DONE = "worked"
#: Errors of file systems without locks.
_NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP)


def mark():
    """Take the shared lock until this process ends."""
    share(os.open(FILE, os.O_RDWR | os.O_CREAT, 0o666))


def alone(seconds):
    """Handle of the exclusive lock, and whether the file system has locks.

    The handle is None if others work for that many seconds. Without locks others may be at work.
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
    """Turn the exclusive lock into a shared one, so that others may work again.

    For a moment nobody holds a lock. Another run may take the exclusive one then; it finds what
    this run has just left behind, and can harm nothing.
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
