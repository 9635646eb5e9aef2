"""Roughness of a surface: its dimension Delta_g, its spectrum, and how good a scan is."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "AXES": ".quality_words",
        "ESTIMATORS": ".registry",
        "FEWEST_CELLS": ".fit_range",
        "FIRST_CELLS": ".fit_range",
        "FitRange": ".fit_range",
        "LAST_PART": ".fit_range",
        "RECOMMENDED": ".recommended",
        "below_offset": ".fit_range",
        "best_dimension": ".dimension",
        "beyond_roll_off": ".recommended",
        "dimension_table": ".recommended",
        "dimension_words": ".recommended",
        "length_words": ".quality_words",
        "measured_exponents": ".dimension",
        "noise_words": ".quality_words",
        "overlap_words": ".quality_words",
        "range_words": ".quality_words",
        "ratio": ".curves",
        "scan_quality": ".quality",
        "slope_statistics": ".dimension",
        "surface_dimension": ".dimension",
        "suspect_words": ".quality_words",
    },
)
