"""Null models of a contact domain: as many nodes at random, and the bearing-area cut.

A finite set of points has a box-counting dimension between 0 and 2 whatever its geometry: it
crosses over from points alone to full boxes. What its geometry adds is the departure from nodes
drawn at random in the same window; and what elastic interaction adds, the departure from the
bearing-area cut: as many nodes, the highest of the composite topography.
"""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.datasets import labelled_dataset
from .box_dimension import dimension_of_domain, is_determined
from .counted_domain import QUANTITIES, CountedDomain, errors_of
from .departure import Comparison, departure_of, verdict_of
from .mean_law import mean_sizes
from .ordinary_slope import dyadic_sizes
from .random_nodes import expected_mean_counts, random_bands

#: What is stored of each quantity, by the ending of its name.
_ENDINGS = {
    "_random": "mean of as many random nodes",
    "_random_low": "lower end of the 95 % band of as many random nodes",
    "_random_high": "upper end of the 95 % band of as many random nodes",
    "_random_difference": "less that of as many random nodes",
    "_random_difference_low": "less that of random nodes, lower end of the 95 % interval",
    "_random_difference_high": "less that of random nodes, upper end of the 95 % interval",
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
        "departure of box-counting and correlation dimension from the null models",
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
        ``_random_low``, ``_random_high``, ``_random_difference`` with its ends, ``_cut``,
        ``_cut_difference`` with its ends and ``_departure`` in words; ``null_departure`` and
        ``null_verdict`` of the domain, by :func:`domain.departure.departure_of` and
        :func:`domain.departure.verdict_of`. The counts of the null models over the box sides
        ``null_side`` and ``null_mean_side`` (mm).

    Notes
    -----
    The domain and its cut share most of their hills, so the interval of their difference is that of
    pairs: the jackknife leaves the same part of the window out of both. Random nodes share nothing
    with it: the interval of that difference is the root of the sum of the squares of the domain's
    own by the jackknife and of half the band. Both models are fitted over the boxes of the domain,
    so that what the choice of these changes is common and in neither.
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

    def counted(nodes):
        box = dimension_of_domain(
            nodes, spacing, fit_range=fit_range, whole_cells=how["whole_cells"]
        )
        return CountedDomain(nodes, box, **how)

    ours = counted(domain)
    box, nodes = ours.box, int(np.count_nonzero(domain))
    used = None if box.ordinary is None else box.ordinary.used
    law = ours.law if box.estimator == "mean" else None
    bands, counts = random_bands(domain.shape, nodes, mask=mask, law=law, used=used, **how)
    random = _less_random(ours, bands)
    cut, count = (
        dict.fromkeys(QUANTITIES, (np.nan,) * 4),
        np.full(dyadic_sizes(domain.shape).size, np.nan),
    )
    if composite is not None and nodes > 1:
        highest = counted(bearing_area_cut(composite, nodes))
        cut = _less_cut(ours, highest)
        if highest.box.ordinary is not None:
            count = highest.box.ordinary.counts
    row: dict[str, Any] = {}
    surface = composite is not None
    compared = {}
    for name in QUANTITIES:
        beside = (*bands[name], *random[name], *cut[name])
        row |= {f"{name}{end}": value for end, value in zip(_ENDINGS, beside, strict=True)}
        (_, *less_random), (_, _, *less_cut) = random[name], cut[name]
        compared[name] = Comparison(*less_random, *less_cut)
        row[f"{name}_departure"] = departure_of([compared[name]], surface=surface)
    # The ordinary slope would say the same thing twice, less well: it counts the same boxes.
    both = [compared["delta_sigma"], compared["correlation_dimension"]]
    row["null_departure"] = departure_of(both, surface=surface)
    row["null_verdict"] = verdict_of(row["null_departure"], is_determined(box.low, box.high))
    for name, value in zip(("", "_low", "_high"), counts, strict=True):
        row[f"null_count_random{name}"] = value
    row["null_count_cut"] = count
    row["null_mean_count"] = expected_mean_counts(domain.shape, nodes, mean_sizes(domain.shape))
    return row


def _less_random(domain, bands):
    """What each quantity of a domain is less that of random nodes, and its interval."""
    less = {}
    for name, error in errors_of([domain]).items():
        band, difference = bands[name], domain.values[name] - bands[name].value
        less[name] = (
            difference,
            difference - np.hypot(error, band.high - band.value),
            difference + np.hypot(error, band.value - band.low),
        )
    return less


def _less_cut(domain, cut):
    """Each quantity of the cut, what that of the domain is less it, and its interval."""
    less = {}
    same = np.array_equal(domain.nodes, cut.nodes)
    for name, error in errors_of([domain, cut]).items():
        difference, half = domain.values[name] - cut.values[name], 0.0 if same else error
        less[name] = cut.values[name], difference, difference - half, difference + half
    return less


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
