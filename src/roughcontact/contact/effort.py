"""Number and time of a process's contact solves, for the log of its job only."""

import contextlib
import os
import threading
import time
from collections.abc import Iterator


class Effort:
    """Number of contact problems solved and seconds spent, of all threads together."""

    def __init__(self):
        self.problems, self.seconds = 0, 0.0
        self.renew_lock()

    def renew_lock(self) -> None:
        """New lock for a fork, in which a lock held by another thread is never released."""
        self._lock = threading.Lock()

    @contextlib.contextmanager
    def counted(self, problems: int) -> Iterator[None]:
        """Context that counts problems and the seconds of its block."""
        begin = time.perf_counter()
        try:
            yield
        finally:
            seconds = time.perf_counter() - begin
            with self._lock:
                self.problems += problems
                self.seconds += seconds


#: Effort of this process.
SOLVING = Effort()
os.register_at_fork(after_in_child=SOLVING.renew_lock)
