"""What a process has spent on contact solves, for the log of its job. Nothing else reads it."""

import contextlib
import time
from dataclasses import dataclass


@dataclass
class Effort:
    """Contact problems solved and the seconds they took."""

    problems: int = 0
    seconds: float = 0.0

    @contextlib.contextmanager
    def counted(self, problems):
        """Add what the block takes, and the problems it solves."""
        begin = time.perf_counter()
        try:
            yield
        finally:
            self.problems += problems
            self.seconds += time.perf_counter() - begin


#: Of this process.
SOLVING = Effort()
