"""Errors of the solver, in a module that imports nothing to compute with."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


class NotConverged(RuntimeError):
    """No state satisfying the contact conditions was reached.

    Attributes
    ----------
    reason : str
    state : ContactState
        The best state reached; its ``residual`` says how far it is from being one.
    residual : float
    """

    def __init__(self, reason: str, state: Any, residual: float):
        super().__init__(f"contact not solved: {reason}; best residual {residual:.3g}")
        self.reason, self.state, self.residual = reason, state, residual

    def __reduce__(self):
        return type(self), (self.reason, self.state, self.residual)


def is_interrupt(error: BaseException | None) -> bool:
    """True of KeyboardInterrupt, and of the SystemError that numba makes of it.

    An interrupt that arrives while a compiled kernel is called ends as a SystemError, or a chain of
    them, caused by it.
    """
    while isinstance(error, SystemError):
        error = error.__cause__
    return isinstance(error, KeyboardInterrupt)


@contextmanager
def interruptible() -> Iterator[None]:
    """Context, or decorator, in which every interrupt ends as KeyboardInterrupt."""
    try:
        yield
    except SystemError as error:
        if is_interrupt(error):
            raise KeyboardInterrupt from error
        raise
