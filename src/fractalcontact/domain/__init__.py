"""The contact domain: box counts, dimension Delta_sigma, clusters, renormalisation."""
