"""The contact domain: box counts, dimension Delta_sigma, clusters, renormalisation."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "BEYOND_BOTH": ".departure",
        "FEWEST_NODES": ".renormalisation",
        "LIKE_CUT": ".departure",
        "LIKE_RANDOM": ".departure",
        "LawTerms": ".count_law",
        "OrdinarySlope": ".ordinary_slope",
        "RESOLUTION": ".renormalisation",
        "Trend": ".pressure_trend",
        "UNDETERMINED": ".departure",
        "WIDEST": ".box_dimension",
        "analyse_domains": ".analysis",
        "beside_domains": ".null_models",
        "box_count": ".box_counts",
        "box_sizes": ".box_counts",
        "correlation_dimension": ".correlation",
        "dimension_of_domain": ".box_dimension",
        "follows_law": ".clusters",
        "is_determined": ".box_dimension",
        "law_count": ".count_law",
        "local_slopes": ".box_dimension",
        "mean_count": ".box_counts",
        "measures_of_map_states": ".measures",
        "measures_of_states": ".measures",
        "nominal_pressure": ".renormalisation",
        "nulls_of_map_states": ".null_models",
        "read_contact_map": ".measured_map",
        "scaling_over_resolutions": ".analysis",
        "spans": ".box_dimension",
        "whole_sizes": ".box_counts",
    },
)
