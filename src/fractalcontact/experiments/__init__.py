"""Experiments on synthetic surfaces and joints, whose right answer is known."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "SURFACES": ".roll_off",
        "solve_task": ".size_states",
    },
)
