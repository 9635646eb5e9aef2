"""Roughness of a surface: its dimension Delta_g, its spectrum, and how good a scan is."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "AXES": ".quality_words",
        "ESTIMATORS": ".registry",
        "FIRST_CELLS": ".dimension",
        "LAST_PART": ".dimension",
        "best_dimension": ".dimension",
        "dimension_table": ".dimension",
        "hurst_exponents": ".dimension",
        "length_words": ".quality_words",
        "noise_words": ".quality_words",
        "range_words": ".quality_words",
        "scan_quality": ".quality",
        "slope_statistics": ".dimension",
        "surface_dimension": ".dimension",
    },
)
