"""Number of threads of the solver, and objects shared between threads.

What is kept for later is kept without a lock, so that neither a thread nor a fork of the process
ever waits for one: two threads may make the same thing at once, and all go on with the first.
"""

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from numba.core.compiler_lock import global_compiler_lock


def count() -> int:
    """Threads to use: OMP_NUM_THREADS where it is set, else every core this process may use."""
    stated = os.environ.get("OMP_NUM_THREADS", "")
    if stated.isdigit() and int(stated) > 0:
        return int(stated)
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


# By the number of their threads.
_POOLS: dict[int, ThreadPoolExecutor] = {}
# A fork has the pools of its parent, but none of their threads: it would wait for ever.
os.register_at_fork(after_in_child=_POOLS.clear)
# Kernels are compiled, and read from disk, under one lock: a fork waits until no thread has it.
os.register_at_fork(
    before=global_compiler_lock.acquire,
    after_in_parent=global_compiler_lock.release,
    after_in_child=global_compiler_lock.release,
)


def _pool(workers):
    return _POOLS.get(workers) or _POOLS.setdefault(workers, ThreadPoolExecutor(workers))


def in_parts(function: Callable[[int, int], object], n: int, *, smallest: int) -> None:
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


class computed_once:
    """Property computed at its first use and kept in the object.

    `functools.cached_property` holds a lock meanwhile, one for all objects (up to Python 3.11): a
    process forked at that moment would wait for it for ever.

    Parameters
    ----------
    make : callable
        Takes the object; the same for equal objects, as several threads may call it at once.
    """

    def __init__(self, make: Callable[[Any], Any]):
        self._make, self.__doc__ = make, make.__doc__

    def __set_name__(self, owner, name):
        self._name = name

    def __get__(self, instance, owner=None):
        if instance is None:
            return self
        return vars(instance).setdefault(self._name, self._make(instance))
