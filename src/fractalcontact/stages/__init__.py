"""Stages: what the jobs of a study compute, each from the stages before it."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "convergence": ".accuracy",
        "specimen_stages": ".specimen",
    },
)
