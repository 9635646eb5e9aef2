"""The size effect: windows of one joint, how its mechanics goes with size, and eq. 6."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "AGREES": ".size_verdict",
        "FLATTER": ".size_verdict",
        "NOT_TESTED": ".size_verdict",
        "STEEPER": ".size_verdict",
        "joint_by_size": ".laws",
        "predict_whole_strength": ".prediction",
        "size_test": ".eq6",
    },
)
