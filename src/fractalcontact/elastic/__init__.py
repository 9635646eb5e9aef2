"""The elastic half-space: displacement under a pressure, on a window or on nodes of it."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "DirectOperator": ".direct",
        "HalfSpace": ".halfspace",
        "LEAST_SPLIT_SIDE": ".split_convolution",
        "MOST_PAIRS": ".direct",
        "MultipoleLevels": ".block_pairs",
        "MultipoleOperator": ".multipole",
        "RIGID_PLATE_SELF_TERMS": ".halfspace",
        "WIDTH": ".simd",
        "forget_matrices": ".block_influence",
        "load": ".simd",
        "love_displacement": ".influence",
        "multipole_suits": ".multipole",
        "rectangle_mean_displacement": ".halfspace",
        "store": ".simd",
    },
)
