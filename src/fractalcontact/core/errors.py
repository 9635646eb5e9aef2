"""What this package raises by names of its own, without what it takes to compute anything."""

from typing import Any


class InputError(ValueError):
    """A scan, a sidecar or a study that cannot be used as it stands.

    The message is written for the person who owns the file: it names the file, key or cell, says
    what was expected and what to write instead. Programs show it without a traceback.
    """


class OutputError(OSError):
    """A result that could not be written, with the file's name and what to do."""


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
