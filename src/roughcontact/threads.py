"""Number of threads of the solver, and objects shared between threads.

Cached objects are stored without a lock, so that no thread and no fork of the process ever waits
for one. Two threads may compute the same object at once; all continue with the first.
"""

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from numba.core.compiler_lock import global_compiler_lock


def count() -> int:
    """Number of threads: OMP_NUM_THREADS if it is set, else the cores this process may use."""
    stated = os.environ.get("OMP_NUM_THREADS", "")
    if stated.isdigit() and int(stated) > 0:
        return int(stated)
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


# Pools by their number of threads.
_POOLS: dict[int, ThreadPoolExecutor] = {}
# A fork inherits the pools of its parent without their threads, and would wait for ever.
os.register_at_fork(after_in_child=_POOLS.clear)
# numba compiles and loads kernels under one lock; forking waits until no thread holds it.
os.register_at_fork(
    before=global_compiler_lock.acquire,
    after_in_parent=global_compiler_lock.release,
    after_in_child=global_compiler_lock.release,
)


def _pool(workers):
    return _POOLS.get(workers) or _POOLS.setdefault(workers, ThreadPoolExecutor(workers))


def in_parts(function: Callable[[int, int], object], n: int, *, smallest: int) -> None:
    """Call ``function(start, stop)`` for parts of range(n) in parallel, none below ``smallest``.

    The function must release the interpreter's lock, and write to its own part only.
    """
    most = n // smallest
    # Small windows call this often: threads are counted only if there is more than one part.
    parts = min(count(), most) if most > 1 else 1
    if parts == 1:
        function(0, n)
        return
    edges = [n * k // parts for k in range(parts + 1)]
    list(_pool(parts).map(function, edges[:-1], edges[1:]))


class computed_once:
    """Property computed at its first use and kept in the object.

    `functools.cached_property` of Python 3.11 holds one lock for all objects while it computes: a
    process forked at that moment would wait for ever. ``make`` may be called by several threads at
    once, and must return the same for equal objects.
    """

    def __init__(self, make: Callable[[Any], Any]):
        self._make, self.__doc__ = make, make.__doc__

    def __set_name__(self, owner, name):
        self._name = name

    def __get__(self, instance, owner=None):
        if instance is None:
            return self
        return vars(instance).setdefault(self._name, self._make(instance))
