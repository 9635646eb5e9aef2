"""The figures: one module each, drawn from an atlas and nothing else."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "draw_figures": ".draw",
        "draw_study_figures": ".draw",
    },
)
