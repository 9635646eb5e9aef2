"""Seconds and memory of calls, measured so that they can be compared."""

import ctypes
import resource
import sys
import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from fractalcontact.core.child_process import ChildFailed, in_child

#: Longest call, seconds, whose memory is measured.
LONGEST = 3600.0


def timed(call: Callable[[], Any]) -> tuple[Any, float]:
    """Value that a call returns, and the seconds it takes."""
    begin = time.perf_counter()
    value = call()
    return value, time.perf_counter() - begin


def repeated(
    calls: Sequence[Callable[[], Any]], first: Sequence[float], *, runs: int, longest: float
) -> list[list[float]]:
    """Seconds of repeated calls, in turn, so that a disturbance of the machine affects all alike.

    Each call was made once before, in ``first`` seconds, which counts as one of its ``runs``. A
    call that took more than ``longest`` seconds is not made again.
    """
    seconds = [[took] for took in first]
    for _ in range(runs - 1):
        for call, so_far in zip(calls, seconds, strict=True):
            if so_far[0] <= longest:
                so_far.append(timed(call)[1])
    return seconds


def peak_memory(call: Callable[[], Any]) -> float:
    """Largest memory, bytes, that a call adds to that of the process.

    The call is made in a child process, on one thread, since the parent's threads do not exist
    there. NaN if it ends in an error, or takes longer than `LONGEST`.
    """
    _hand_back()
    try:
        return in_child(partial(_added_memory, call), seconds=LONGEST)
    except ChildFailed:
        return float("nan")


def _hand_back():
    """Return freed memory to the system where the C library can; a child would use it unnoticed."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if trim is not None:
        trim(0)


def _added_memory(call):
    before = _largest_resident()
    call()
    return _largest_resident() - before


def _largest_resident():
    """Largest resident memory of this process, bytes; a child starts with that of its parent."""
    # Linux counts in KiB, the BSDs in bytes.
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit
