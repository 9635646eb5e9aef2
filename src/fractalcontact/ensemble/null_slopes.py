"""Local slopes of the box counts of realisations, beside those of their null models."""

import numpy as np
import xarray as xr

from ..core.datasets import labelled_dataset
from ..core.ranges import in_cells
from ..domain.box_counts import mean_count
from ..domain.mean_law import find_law
from ..domain.null_models import OCTAVES, bearing_area_cut, octaves_of
from ..domain.random_nodes import expected_mean_counts
from ..domain.slope_curves import SlopeCurve, curve_sizes, slope_curve, window_counts

_CURVES = {
    "local_slope": "local slope of the mean box counts",
    "local_slope_random": "local slope expected of as many random nodes",
    "local_slope_cut": "local slope of the bearing-area cut of as many nodes",
    "local_slope_random_difference": "local slope less that expected of as many random nodes",
    "local_slope_cut_difference": "local slope less that of the bearing-area cut",
}
#: Local slopes under every load, beside null models: dimensions, unit, long name.
NULL_SLOPES = {
    **{name: (("normal_force", "null_octave"), "1", words) for name, words in _CURVES.items()},
    "delta_sigma_cut_difference": (
        ("normal_force",),
        "1",
        "Delta_sigma by boxes less that of the bearing-area cut over the same boxes",
    ),
}


def null_slopes(
    domains: np.ndarray,
    composite: np.ndarray,
    spacing: float,
    *,
    fit_range: tuple[float, float] | None = None,
) -> xr.Dataset:
    """Local slopes of the contact domains of one realisation, and those of its null models.

    Domains (n, ny, nx), one a load, on cells of ``spacing``, mm; ``fit_range`` has the smallest and
    largest box of Delta_sigma, mm, by default all between the cut-offs. :data:`NULL_SLOPES` and
    :data:`OCTAVES`; local slopes are those of :mod:`domain.slope_curves`, NaN without a node.

    Random nodes are not drawn: an ensemble is compared with the slopes of their expected counts.
    """
    shape, sizes = composite.shape, curve_sizes(composite.shape)
    octaves = octaves_of(shape, spacing)
    whole = window_counts(shape, sizes)
    limits = in_cells(fit_range, spacing)
    rows = []
    for domain in domains:
        nodes = int(np.count_nonzero(domain))
        cut = bearing_area_cut(composite, nodes) if nodes else domain
        slopes, of_cut = SlopeCurve(domain).values, SlopeCurve(cut).values
        expected = slope_curve(expected_mean_counts(shape, nodes, sizes) / whole, sizes)
        rows.append(
            {
                "local_slope": slopes,
                "local_slope_random": expected,
                "local_slope_cut": of_cut,
                "local_slope_random_difference": slopes - expected,
                "local_slope_cut_difference": slopes - of_cut,
                "delta_sigma_cut_difference": _less_cut(domain, cut, limits),
            }
        )
    values = {name: np.array([row[name] for row in rows]) for name in NULL_SLOPES}
    if sizes.size < 2:  # the window is too small for any slope: one is missing
        none = np.full((len(rows), 1), np.nan)
        values |= dict.fromkeys(_CURVES, none)
    return labelled_dataset({**NULL_SLOPES, **OCTAVES}, values | octaves)


def _less_cut(domain, cut, limits):
    """Delta_sigma of a domain less that of its cut over the same boxes; NaN without a law."""
    law = find_law(domain, limits, False) if domain.any() else None
    if law is None:
        return np.nan
    counts = mean_count(cut, law.separating).ravel()
    return law.law.dimension - law.refound(counts, False)
