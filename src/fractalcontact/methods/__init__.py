"""Other solvers of the same contact problem, for comparison only."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "Failed": ".peers",
        "Load": ".peers",
        "METHODS": ".registry",
        "Method": ".registry",
        "NotOffered": ".common",
        "PATIENCE": ".peers",
        "PEERS": ".registry",
        "PublicCode": ".peers",
        "clearance_of": ".peers",
        "influence_matrix": ".common",
        "installed_peers": ".registry",
        "state_of": ".peers",
    },
)
