"""Errors of the solver, in a module without heavy imports."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


class NotConverged(RuntimeError):
    """No state that satisfies the contact conditions was reached.

    Attributes
    ----------
    reason : str
    state : ContactState
        The best state that was reached.
    residual : float
        Largest violation of the conditions by that state, as in `ContactState`.
    """

    def __init__(self, reason: str, state: Any, residual: float):
        super().__init__(f"contact not solved: {reason}; best residual {residual:.3g}")
        self.reason, self.state, self.residual = reason, state, residual

    def __reduce__(self):
        return type(self), (self.reason, self.state, self.residual)


def is_interrupt(error: BaseException | None) -> bool:
    """True for KeyboardInterrupt and for the SystemError, or chain of them, that numba makes of it.

    numba raises it if an interrupt arrives while a compiled kernel is being called.
    """
    while isinstance(error, SystemError):
        error = error.__cause__
    return isinstance(error, KeyboardInterrupt)


@contextmanager
def interruptible() -> Iterator[None]:
    """Context, or decorator, that turns every interrupt into a KeyboardInterrupt."""
    try:
        yield
    except SystemError as error:
        if is_interrupt(error):
            raise KeyboardInterrupt from error
        raise
