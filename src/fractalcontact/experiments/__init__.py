"""Experiments on synthetic surfaces and joints, whose right answer is known."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "SURFACES": ".roll_off",
        "dimension_test": ".delta_sigma",
        "estimator_bias": ".delta_g",
        "roll_off_effect": ".roll_off",
    },
)
