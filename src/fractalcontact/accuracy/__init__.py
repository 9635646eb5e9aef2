"""Accuracy, speed and stability of the solver, of other solvers and of cheaper models."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "ABSOLUTE": ".refinement",
        "DEFAULT_RTOL": ".speed",
        "ERRORS": ".speed",
        "FACTORS": ".refinement",
        "FRONTS": ".speed",
        "HONEST": ".stability",
        "KINDS": ".hard_problems",
        "LEADS_BELOW": ".speed",
        "LOADS": ".reference",
        "MODEL": ".speed",
        "MODELS": ".speed",
        "NOT_OFFERED": ".stability",
        "OURS": ".speed",
        "PEER": ".speed",
        "QUANTITIES": ".convergence",
        "RIGHT": ".stability",
        "RoughProblem": ".reference",
        "SILENT": ".stability",
        "SOLVER": ".speed",
        "VERDICTS": ".stability",
        "ahead_of_ours": ".speed",
        "closure_at_fraction": ".reference",
        "curve_errors": ".refinement",
        "error_against_time": ".speed",
        "hertz_convergence": ".convergence",
        "join": ".stability",
        "load_of": ".speed",
        "problems_of": ".reference",
        "punch_convergence": ".convergence",
        "richardson_trials": ".convergence",
    },
)
