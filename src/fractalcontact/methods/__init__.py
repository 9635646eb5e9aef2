"""Other solvers of the same contact problem, for comparison only."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "METHODS": ".registry",
        "influence_matrix": ".common",
    },
)
