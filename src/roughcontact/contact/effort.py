"""Effort of a process on contact solves, for the log of its job. Nothing else reads it."""

import contextlib
import os
import threading
import time
from collections.abc import Iterator


class Effort:
    """Contact problems solved and the seconds they took, of all threads together.

    Attributes
    ----------
    problems : int
    seconds : float
    """

    def __init__(self):
        self.problems, self.seconds = 0, 0.0
        self.renew_lock()

    def renew_lock(self) -> None:
        """Make a new lock in a fork, where a lock of another thread is never released."""
        self._lock = threading.Lock()

    @contextlib.contextmanager
    def counted(self, problems: int) -> Iterator[None]:
        """Count the problems and seconds of a block."""
        begin = time.perf_counter()
        try:
            yield
        finally:
            seconds = time.perf_counter() - begin
            with self._lock:
                self.problems += problems
                self.seconds += seconds


#: Of this process.
SOLVING = Effort()
os.register_at_fork(after_in_child=SOLVING.renew_lock)
