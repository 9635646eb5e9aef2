"""Commands: check scans, verify results, compile kernels."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "results_of": ".verify",
    },
)
