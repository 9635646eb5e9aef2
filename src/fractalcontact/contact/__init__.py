"""The contact solver: frictionless elastic contact of a rough surface with a rigid plane."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "CandidateState": ".state",
        "ContactState": ".state",
        "LEAST_FINE_SIDE": ".full_approximation",
        "SOLVING": ".effort",
        "STIFFNESS_ERROR": ".state",
        "checked_hardness": ".solve",
        "checked_problem": ".solve",
        "forget_preconditioner": ".preconditioner",
        "solve_contact": ".solve",
        "unloaded_state": ".state",
    },
)
