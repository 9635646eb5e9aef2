"""The contact domain: box counts, dimension Delta_sigma, clusters, renormalisation."""

from ..core.lazy import exports

__getattr__, __dir__, __all__ = exports(
    __name__,
    {
        "FEWEST_NODES": ".renormalisation",
        "RESOLUTION": ".renormalisation",
        "analyse_domains": ".analysis",
        "box_count": ".box_counts",
        "box_sizes": ".box_counts",
        "correlation_dimension": ".correlation",
        "follows_law": ".clusters",
        "hausdorff_measure": ".renormalisation",
        "local_slopes": ".box_dimension",
        "mean_count": ".box_counts",
        "measures_of_map_states": ".measures",
        "measures_of_states": ".measures",
        "nominal_pressure": ".renormalisation",
        "read_contact_map": ".measured_map",
        "scaling_over_resolutions": ".analysis",
        "spans": ".box_dimension",
        "whole_sizes": ".box_counts",
    },
)
