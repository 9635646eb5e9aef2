"""Null models of a contact domain: as many nodes at random, and the bearing-area cut.

A finite set of points has a box-counting dimension between 0 and 2 whatever its geometry: it
crosses over from points alone to full boxes. What its geometry adds is the departure from nodes
drawn at random in the same window; and what elastic interaction adds, the departure from the
bearing-area cut: as many nodes, the highest of the composite topography.
"""

from typing import Any

import numpy as np
import scipy.ndimage
import xarray as xr
from numpy.typing import ArrayLike

from ..core.datasets import labelled_dataset
from ..core.intervals import jackknife_error
from ..core.slope_of_sums import BLOCKS
from .box_counts import mean_count
from .box_dimension import dimension_of_domain, is_determined
from .clusters import NEIGHBOURS, QUADRATS, morisita_index, quadrat_counts
from .correlation import pair_counts, pair_distances, pairs_slope
from .departure import Comparison, departure_of, verdict_of
from .mean_law import block_error, find_law, mean_sizes
from .ordinary_slope import cover_slope, dyadic_sizes
from .random_nodes import expected_mean_counts, random_bands

#: Quantities that are compared with null models, in words.
QUANTITIES = {
    "delta_sigma": "box-counting dimension Delta_sigma",
    "delta_sigma_ordinary": "ordinary box-counting dimension",
    "correlation_dimension": "correlation dimension of the nodes in contact",
    "clusters": "contact clusters",
    "morisita": "Morisita's index of the contact over quadrats",
}

#: What is stored of each quantity, by the ending of its name.
_ENDINGS = {
    "_random": "mean of as many random nodes",
    "_random_low": "lower end of the 95 % band of as many random nodes",
    "_random_high": "upper end of the 95 % band of as many random nodes",
    "_cut": "that of the bearing-area cut of as many nodes",
    "_cut_difference": "less that of the bearing-area cut",
    "_cut_difference_low": "less that of the bearing-area cut, lower end of the 95 % interval",
    "_cut_difference_high": "less that of the bearing-area cut, upper end of the 95 % interval",
}

_BY_SIDE = ("normal_force", "null_scale")
_TABLE: dict[str, tuple] = {
    **{
        f"{name}{ending}": ("normal_force", "1", f"{words}: {what}")
        for name, words in QUANTITIES.items()
        for ending, what in _ENDINGS.items()
    },
    **{
        f"{name}_departure": ("normal_force", "1", f"{words}: departure from the null models")
        for name, words in QUANTITIES.items()
    },
    "null_departure": (
        "normal_force",
        "1",
        "departure of both box dimensions from the null models",
    ),
    "null_verdict": ("normal_force", "1", "that departure where the dimension is determined"),
    "null_count_random": (_BY_SIDE, "1", "minimal cover N(r) of as many random nodes, mean"),
    "null_count_random_low": (_BY_SIDE, "1", "minimal cover of random nodes, lower end of 95 %"),
    "null_count_random_high": (_BY_SIDE, "1", "minimal cover of random nodes, upper end of 95 %"),
    "null_count_cut": (_BY_SIDE, "1", "minimal cover N(r) of the bearing-area cut"),
    "null_side": ("null_scale", "mm", "side of the boxes r of the null models"),
    "null_mean_count": (
        ("normal_force", "null_mean_scale"),
        "1",
        "mean N(r) over all grid origins, expectation of as many random nodes",
    ),
    "null_mean_side": ("null_mean_scale", "mm", "side of the boxes r of that expectation"),
}


def null_models(
    domains: ArrayLike,
    spacing: float,
    composite: np.ndarray | None = None,
    *,
    fit_range: tuple[float, float] | None = None,
    mask: np.ndarray | None = None,
    whole_cells: bool | None = False,
) -> xr.Dataset:
    """Null models of contact domains in one window, and how the domains depart from them.

    Parameters
    ----------
    domains : (n, ny, nx) bool array_like
        Nodes in contact, one domain a load.
    spacing : float
        mm.
    composite : (ny, nx) ndarray, optional
        Composite topography; without it (a measured map, a set without a surface) there is no cut,
        and departures are from random nodes alone.
    fit_range : (float, float), optional
        Smallest and largest box of the dimensions, mm; by default all between the cut-offs.
    mask : (ny, nx) bool ndarray, optional
        Cells where contact could be seen; all by default. Random nodes lie in it.
    whole_cells : bool, optional
        As :func:`domain.box_dimension.dimension_of_domain` takes it.

    Returns
    -------
    xr.Dataset
        Over ``normal_force`` (without coordinate): each of :data:`QUANTITIES` with ``_random``,
        ``_random_low``, ``_random_high``, ``_cut``, ``_cut_difference`` with its ends and
        ``_departure`` in words; ``null_departure`` and ``null_verdict`` of the domain, by
        :func:`domain.departure.departure_of` and :func:`domain.departure.verdict_of`. The counts of
        the null models over the box sides ``null_side`` and ``null_mean_side`` (mm).

    Notes
    -----
    The domain and its cut share most of their hills, so the interval of their difference is that of
    pairs: the jackknife leaves the same part of the window out of both.
    """
    domains = np.asarray(domains, bool)
    limits = (0.0, np.inf) if fit_range is None else tuple(np.asarray(fit_range) / spacing)
    how = {"limits": limits, "whole_cells": whole_cells}
    rows = [_row(domain, spacing, composite, fit_range, mask, how) for domain in domains]
    shape = domains.shape[1:]
    values: dict[str, Any] = {name: [row[name] for row in rows] for name in rows[0]}
    values["null_side"] = dyadic_sizes(shape) * float(spacing)
    values["null_mean_side"] = mean_sizes(shape) * float(spacing)
    return labelled_dataset(_TABLE, values)


def nulls_of_map_states(
    states: xr.Dataset,
    spacing: float,
    composites: xr.DataArray,
    fit_range: tuple[float, float] | None = None,
) -> xr.Dataset:
    """Null models of the contact domains that are looked at closely, under every load.

    Parameters
    ----------
    states : xr.Dataset
        From :func:`mechanics.states.map_states`.
    spacing : float
        Of the scan, mm.
    composites : DataArray (offset, window_y, window_x)
        Composite topographies of the joint in the direction of the states.
    fit_range : (float, float), optional
        Smallest and largest box of the dimensions, mm; by default all between the cut-offs.

    Returns
    -------
    xr.Dataset
        From :func:`null_models`, with the loads and the scalars ``direction``, ``offset`` and
        ``resolution`` of the states.
    """
    factor = int(states["resolution"])
    here = composites.sel(offset=float(states["offset"]), method="nearest").values
    domains = states["pressure"].values > 0
    nulls = null_models(domains, spacing * factor, here[::factor, ::factor], fit_range=fit_range)
    names = ("normal_force", "direction", "offset", "resolution")
    return nulls.assign_coords({name: states[name] for name in names})


def beside_domains(domains: xr.Dataset, nulls: xr.Dataset) -> xr.Dataset:
    """The table of contact domains with the null models of those that are looked at closely.

    Parameters
    ----------
    domains : xr.Dataset
        From :func:`domain.analysis.analyse_domains`.
    nulls : xr.Dataset
        From :func:`nulls_of_map_states`.

    Returns
    -------
    xr.Dataset
        What is known by load stands over all dimensions of the table, missing in other domains.
    """
    order = ("direction", "offset", "resolution", "normal_force")
    sizes = tuple(domains.sizes[name] for name in order)
    place = (
        domains.get_index("direction").get_loc(nulls["direction"].item()),
        int(np.argmin(np.abs(domains["offset"].values - nulls["offset"].item()))),
        domains.get_index("resolution").get_loc(nulls["resolution"].item()),
    )
    added = {}
    for name, values in nulls.data_vars.items():
        if values.dims != ("normal_force",):
            added[name] = values.variable
            continue
        words = values.dtype.kind == "U"
        spread = np.full(sizes, "", values.dtype) if words else np.full(sizes, np.nan)
        spread[place] = values.values
        added[name] = xr.Variable(order, spread, values.attrs)
    return domains.assign(added)


def _row(domain, spacing, composite, fit_range, mask, how) -> dict[str, Any]:
    """What :func:`null_models` stores of one domain."""
    nodes, surface = int(np.count_nonzero(domain)), composite is not None
    box = dimension_of_domain(domain, spacing, fit_range=fit_range, whole_cells=how["whole_cells"])
    ordinary = np.nan if box.ordinary is None else box.ordinary.dimension
    values = {"delta_sigma": box.dimension, "delta_sigma_ordinary": ordinary}
    used = box.ordinary.used if box.ordinary is not None else None
    law = find_law(domain, **how) if box.estimator == "mean" else None
    bands, counts = random_bands(domain.shape, nodes, mask=mask, law=law, used=used, **how)
    cut: dict[str, tuple] = {}
    cut_count = np.full(dyadic_sizes(domain.shape).size, np.nan)
    if surface and nodes > 1:
        highest = bearing_area_cut(composite, nodes)
        cut_box = dimension_of_domain(
            highest, spacing, fit_range=fit_range, whole_cells=how["whole_cells"]
        )
        cut, cut_count = _compare_with_cut(domain, highest, box, cut_box, how)
    values |= _numbers(domain)
    row: dict[str, Any] = {}
    compared = {}
    for name in QUANTITIES:
        beside = (*bands[name], *cut.get(name, (np.nan,) * 4))
        row |= {f"{name}{end}": value for end, value in zip(_ENDINGS, beside, strict=True)}
        compared[name] = Comparison(values[name], *beside[1:3], *beside[5:])
        row[f"{name}_departure"] = departure_of([compared[name]], surface=surface)
    both = [compared["delta_sigma"], compared["delta_sigma_ordinary"]]
    row["null_departure"] = departure_of(both, surface=surface)
    row["null_verdict"] = verdict_of(row["null_departure"], is_determined(box.low, box.high))
    for name, value in zip(("", "_low", "_high"), counts, strict=True):
        row[f"null_count_random{name}"] = value
    row["null_count_cut"] = cut_count
    row["null_mean_count"] = expected_mean_counts(domain.shape, nodes, mean_sizes(domain.shape))
    return row


def _numbers(domain) -> dict[str, float]:
    """Numbers of a domain that no box counts."""
    distances = pair_distances(domain.shape)
    slope = np.nan
    if domain.any() and distances[-1] < min(domain.shape):
        pairs, lags = pair_counts(domain, distances)
        slope = pairs_slope(distances, pairs[:, 0].sum(axis=1), lags)
    return {
        "correlation_dimension": slope,
        "clusters": float(scipy.ndimage.label(domain, NEIGHBOURS)[1]),
        "morisita": morisita_index(*quadrat_counts(domain))[0],
    }


def bearing_area_cut(composite: np.ndarray, nodes: int) -> np.ndarray:
    """The highest nodes of a composite topography: contact without elastic interaction.

    Parameters
    ----------
    composite : (ny, nx) ndarray
        Heights; NaN where there is none.
    nodes : int
        How many; of equal heights the first are taken.

    Returns
    -------
    (ny, nx) bool
    """
    heights = np.where(np.isfinite(composite), composite, -np.inf).ravel()
    level = np.partition(heights, heights.size - nodes)[heights.size - nodes]
    domain = heights > level
    domain[np.flatnonzero(heights == level)[: nodes - np.count_nonzero(domain)]] = True
    return domain.reshape(composite.shape)


# -- beside the cut --------------------------------------------------------------------------------


def _compare_with_cut(domain, cut, box, cut_box, how):
    """Value of the cut, difference and its interval by quantity; minimal cover of the cut."""
    ours, theirs = _numbers(domain), _numbers(cut)
    ours["delta_sigma"], theirs["delta_sigma"] = box.dimension, cut_box.dimension
    for values, found in ((ours, box), (theirs, cut_box)):
        values["delta_sigma_ordinary"] = found.ordinary.dimension if found.ordinary else np.nan
    errors = {
        "delta_sigma": _law_error(domain, cut, how),
        "delta_sigma_ordinary": _ordinary_error(domain, cut, box, cut_box),
        "correlation_dimension": _pairs_error(domain, cut),
        "clusters": _clusters_error(domain, cut),
        "morisita": _morisita_error(domain, cut),
    }
    compared = {}
    for name in QUANTITIES:
        difference, error = ours[name] - theirs[name], errors[name]
        error = 0.0 if np.array_equal(domain, cut) else error if 0 < error < np.inf else np.nan
        compared[name] = theirs[name], difference, difference - error, difference + error
    count = np.full(dyadic_sizes(domain.shape).size, np.nan)
    if cut_box.ordinary is not None:
        count = cut_box.ordinary.counts
    return compared, count


def _law_error(domain, cut, how):
    """Error of the difference of two dimensions by the law of the mean counts."""
    laws = [find_law(one, **how) for one in (domain, cut)]
    if laws[0] is None or laws[1] is None:
        return np.nan
    first = laws[0]
    parts = [
        mean_count(d, law.sizes, blocks=BLOCKS) for d, law in zip((domain, cut), laws, strict=True)
    ]
    n = first.sizes.size

    def difference(count):
        return first.dimension_of(count[:n]) - laws[1].dimension_of(count[n:])

    return block_error(np.concatenate(parts), difference, (0, n))


def _ordinary_error(domain, cut, box, cut_box):
    """Error of the difference of two ordinary dimensions."""
    slopes = [box.ordinary, cut_box.ordinary]
    if any(slope is None or slope.n == 0 for slope in slopes):
        return np.nan
    sizes = [slope.sizes[slope.used] for slope in slopes]
    parts = [
        mean_count(d, used, blocks=BLOCKS) for d, used in zip((domain, cut), sizes, strict=True)
    ]
    n = sizes[0].size

    def difference(count):
        return cover_slope(count[:n], sizes[0]) - cover_slope(count[n:], sizes[1])

    return block_error(np.concatenate(parts), difference, (0, n))


def _pairs_error(domain, cut):
    """Error of the difference of two correlation dimensions."""
    distances = pair_distances(domain.shape)
    if distances[-1] >= min(domain.shape):
        return np.nan
    (ours, lags), (theirs, _) = (pair_counts(one, distances) for one in (domain, cut))
    ours, theirs = ours[:, 0], theirs[:, 0]
    occupied = np.flatnonzero(ours.any(axis=0) | theirs.any(axis=0))
    left = [
        pairs_slope(distances, ours.sum(axis=1) - ours[:, i], lags)
        - pairs_slope(distances, theirs.sum(axis=1) - theirs[:, i], lags)
        for i in occupied
    ]
    return jackknife_error(left)


def _clusters_error(domain, cut):
    """Error of the difference of two numbers of clusters, each in the part of its first node."""
    counts = []
    for one in (domain, cut):
        labels, _ = scipy.ndimage.label(one, NEIGHBOURS)
        first = np.unique(labels, return_index=True)[1]
        first = first[labels.ravel()[first] > 0]
        y, x = np.unravel_index(first, one.shape)
        part = y * BLOCKS // one.shape[0] * BLOCKS + x * BLOCKS // one.shape[1]
        counts.append(np.bincount(part, minlength=BLOCKS**2).reshape(1, BLOCKS, BLOCKS))
    return block_error(np.concatenate(counts), lambda count: float(count[0] - count[1]), (0, 1))


def _morisita_error(domain, cut):
    """Error of the difference of two indices of Morisita, parts of quadrats left out."""
    (ours, cells), (theirs, _) = quadrat_counts(domain), quadrat_counts(cut)
    if cells.size != QUADRATS**2:
        return np.nan
    y, x = np.divmod(np.arange(cells.size), QUADRATS)
    part = y * BLOCKS // QUADRATS * BLOCKS + x * BLOCKS // QUADRATS
    occupied = np.unique(part[(ours > 0) | (theirs > 0)])
    left = [
        morisita_index(ours[part != i], cells[part != i])[0]
        - morisita_index(theirs[part != i], cells[part != i])[0]
        for i in occupied
    ]
    return jackknife_error(left)
