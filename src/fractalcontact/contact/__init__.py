"""The contact solver: frictionless elastic contact of a rough surface with a rigid plane."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "CandidateState": ".state",
        "ContactState": ".state",
        "SOLVING": ".effort",
        "STIFFNESS_ERROR": ".state",
        "checked_hardness": ".solve",
        "checked_problem": ".solve",
        "forget_preconditioner": ".preconditioner",
        "restrict_sum": ".nested_iteration",
        "solve_contact": ".solve",
        "unloaded_state": ".state",
    },
)
