"""Experiments on synthetic surfaces and joints, whose right answer is known."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "NO_EFFECT": ".size_decision",
        "PROBABILITY": ".size_decision",
        "REFUTED": ".size_decision",
        "SURFACES": ".roll_off",
        "UPHELD": ".size_decision",
        "solve_task": ".size_states",
    },
)
