"""Error of the solver, in a module that imports nothing to compute with."""

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
