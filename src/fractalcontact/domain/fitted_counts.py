"""Box counts by the laws that dimensions are fitted with: curves over the sides of the boxes."""

import numpy as np
import xarray as xr

from ..core.datasets import labelled_dataset
from ..core.ranges import within
from .count_law import LawTerms, law_count

_STATES = ("direction", "offset", "resolution", "normal_force")
_TABLE = {
    "law_count": (
        (*_STATES, "mean_scale"),
        "1",
        "box counts by the law that Delta_sigma is fitted with",
    ),
    "ordinary_count": (
        (*_STATES, "scale"),
        "1",
        "box counts by the line that the ordinary dimension is fitted with",
    ),
}


def fitted_counts(domains: xr.Dataset) -> xr.Dataset:
    """Box counts of the count law and of the ordinary slope, over the sides they are fitted to.

    Parameters
    ----------
    domains : xr.Dataset
        Counts and dimensions of contact domains, from :func:`domain.analysis.analyse_domains`.

    Returns
    -------
    xr.Dataset
        ``law_count`` over the sides ``mean_side`` and ``ordinary_count`` over ``box_side``; NaN at
        sides outside the range of the fit, and where there is none.
    """
    counts = {"law_count": _by_the_law(domains), "ordinary_count": _by_the_line(domains)}
    values = {name: counts[name].transpose(*dims).values for name, (dims, *_) in _TABLE.items()}
    return labelled_dataset(_TABLE, values)


def _by_the_law(domains):
    side, dimension = domains["mean_side"], domains["delta_sigma"]
    terms = LawTerms(*(domains[f"law_{field}"] for field in LawTerms._fields))
    with np.errstate(invalid="ignore"):
        counts = xr.apply_ufunc(
            lambda r, d, *t: law_count(r, d, LawTerms(*t)), side, dimension, *terms
        )
    return counts.where(within(side, domains["fit_min"], domains["fit_max"]))


def _by_the_line(domains):
    names = ("box_side", "box_count", "ordinary_used")
    ends = ("ordinary_fit_min", "ordinary_fit_max")
    return xr.apply_ufunc(
        _line_counts,
        *(domains[name] for name in (*names, "delta_sigma_ordinary", *ends)),
        input_core_dims=[["scale"]] * len(names) + [[]] * 3,
        output_core_dims=[["scale"]],
        vectorize=True,
    )


def _line_counts(r, count, used, dimension, smallest, largest):
    """Counts of the line of this dimension through the mean of the logarithms of those fitted."""
    if not used.any():
        return np.full(r.shape, np.nan)
    level = np.mean(np.log(count[used]) + dimension * np.log(r[used]))
    line = np.exp(level) * r**-dimension
    return np.where(within(r, smallest, largest), line, np.nan)
