"""How many threads the solver uses: set here, and nowhere else."""

import os
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache


def count():
    """Threads to use: OMP_NUM_THREADS where it is set, else every core this process may use."""
    stated = os.environ.get("OMP_NUM_THREADS", "")
    if stated.isdigit() and int(stated) > 0:
        return int(stated)
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@lru_cache
def _pool(workers):
    return ThreadPoolExecutor(workers)


def in_parts(function, n, *, smallest):
    """Call ``function(start, stop)`` for parts of range(n), side by side.

    Parameters
    ----------
    function : callable
        Must release the interpreter's lock, and write to its own part alone.
    n : int
    smallest : int
        Parts are no smaller than this.
    """
    most = n // smallest
    # How many threads there are is asked only where it matters: small windows call this a lot.
    parts = min(count(), most) if most > 1 else 1
    if parts == 1:
        function(0, n)
        return
    edges = [n * k // parts for k in range(parts + 1)]
    list(_pool(parts).map(function, edges[:-1], edges[1:]))
