"""Null models of a contact domain: as many nodes at random, and the bearing-area cut.

A finite set of points has a box-counting dimension between 0 and 2 whatever its geometry: its
counts cross over from single points to full boxes. The departure from nodes drawn at random in the
same window shows its geometry; the departure from the bearing-area cut, as many nodes that are the
highest of the composite topography, shows elastic interaction.
"""

from collections.abc import Collection
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.datasets import labelled
from ..core.estimate import NO_ESTIMATE, Estimate
from ..core.limits import MIN_NODES
from ..core.per_curve import stacked
from ..core.ranges import in_cells
from ..core.reported import states_at
from .box_dimension import dimension_of_domain
from .counted_domain import DOMAIN_QUANTITIES, CountedDomain, errors_of
from .departure import departure_of
from .mean_law import mean_sizes
from .ordinary_dimension import dyadic_sizes
from .random_nodes import band_of, expected_mean_counts, random_bands
from .slope_curves import (
    NOT_COMPARED,
    SlopeCurve,
    curve_sizes,
    departure_from_draws,
    paired_departure,
    random_curves,
)

#: Long names of numbers of the cut, of random nodes and of the difference, by the ending of a name.
_CUT = "that of the bearing-area cut of as many nodes"
_ESTIMATES = {
    "_random": "as many random nodes, mean and 95 % band",
    "_cut_difference": "less that of the bearing-area cut",
}
#: Quantities that have these numbers.
_COMPARED = {
    "_random": ("delta_sigma", "clusters"),
    "_cut_difference": ("delta_sigma", "correlation_dimension"),
}

#: Long names of the curves of local slopes, by the ending of a name.
_CURVES = {"": "of the domain"} | _ESTIMATES
#: Reason of a window with no local slope.
TOO_SMALL = "the window is too small for local slopes"

#: Box sides of the local slopes: dimension, unit, long name.
OCTAVES = {
    "local_slope_side": ("null_octave", "mm", "geometric middle of two box sides r"),
    "local_slope_side_min": ("null_octave", "mm", "smaller of the two box sides r"),
    "local_slope_side_max": ("null_octave", "mm", "larger of the two box sides r"),
}
_SIDES = {
    **OCTAVES,
    "null_side": ("null_scale", "mm", "side of the boxes r of the null models"),
    "null_mean_side": ("null_mean_scale", "mm", "side of the boxes r of that expectation"),
}


def _rows(name: str, words: str, endings: Collection[str], *own: str) -> dict[str, tuple]:
    """Variables of a quantity of null models, by endings: unit, long name, dimensions of arrays."""
    long_names = {"_cut": _CUT} | {ending: _CURVES[ending] for ending in endings}
    return {
        f"{name}{ending}": ("1", f"{words}: {long_name}", *own)
        for ending, long_name in long_names.items()
    }


_P = "probability (p-value) of such a departure of local slopes by chance, from those of"
_SIDE = "box side r of the largest departure of local slopes from those of"

#: Variables of each domain: unit, long name, dimensions of arrays.
_TABLE: dict[str, tuple] = {
    **{
        of: row
        for name, words in DOMAIN_QUANTITIES.items()
        for of, row in _rows(
            name, words, [of for of, names in _COMPARED.items() if name in names]
        ).items()
    },
    **_rows("local_slope", "local slope of the mean box counts", _CURVES, "null_octave"),
    "local_slope_random_p": ("1", f"{_P} as many random nodes"),
    "local_slope_random_side": ("mm", f"{_SIDE} as many random nodes"),
    "local_slope_cut_p": ("1", f"{_P} the bearing-area cut"),
    "local_slope_cut_side": ("mm", f"{_SIDE} the bearing-area cut"),
    "null_verdict": ("1", "null models from which the local slopes differ"),
    "null_reason": ("1", "why the local slopes are not compared; empty else"),
    "null_count_random": (
        "1",
        "minimal cover N(r) of as many random nodes, mean and band",
        "null_scale",
    ),
    "null_count_cut": ("1", "minimal cover N(r) of the bearing-area cut", "null_scale"),
    "null_mean_count": (
        "1",
        "mean N(r) over all grid origins, expectation of as many random nodes",
        "null_mean_scale",
    ),
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
    """Null models of contact domains in one window, and the domains' departures from them.

    Parameters
    ----------
    domains : (n, ny, nx) bool array_like
        Nodes in contact, one domain for each load.
    spacing : float
        mm.
    composite : (ny, nx) ndarray, optional
        Composite topography; without it (a measured map, a set without a surface) there is no cut,
        and departures are from random nodes alone.
    fit_range, whole_cells
        As of :func:`domain.box_dimension.dimension_of_domain`.
    mask : (ny, nx) bool ndarray, optional
        Cells where contact could be seen; all by default. Random nodes lie in it.

    Returns
    -------
    xr.Dataset
        Over ``normal_force`` (without coordinate): ``_cut`` of each of :data:`DOMAIN_QUANTITIES`;
        ``_random``, ``_random_low`` and ``_random_high`` of Delta_sigma and of the clusters;
        ``_cut_difference`` with its ends of both dimensions; the counts of the null models over the
        box sides ``null_side`` and ``null_mean_side`` (mm). The ``local_slope`` of
        :mod:`domain.slope_curves` over ``local_slope_side`` (mm), likewise;
        ``local_slope_random_p`` and ``_side``, the probability of its largest departure from random
        nodes and the box side of that, and those of the cut; ``null_verdict``, by
        :func:`domain.departure.departure_of`, and ``null_reason``.

    Notes
    -----
    The domain and its cut share most of their hills, so the interval of their difference is that of
    pairs: the jackknife leaves the same part of the window out of both. Both models are fitted over
    the boxes of the domain, so that the choice of these has the same effect on all three.
    """
    domains = np.asarray(domains, bool)
    limits = in_cells(fit_range, spacing)
    how = {"limits": limits, "whole_cells": whole_cells}
    rows = [_row(domain, spacing, composite, fit_range, mask, how) for domain in domains]
    shape = domains.shape[1:]
    sides = octaves_of(shape, spacing)
    sides["null_side"] = dyadic_sizes(shape) * float(spacing)
    sides["null_mean_side"] = mean_sizes(shape) * float(spacing)
    return xr.Dataset(
        stacked(rows, _TABLE, ("normal_force",), (len(rows),)) | labelled(_SIDES, sides)
    )


def nulls_of_map_states(
    states: xr.Dataset,
    spacing: float,
    composites: xr.DataArray,
    fit_range: tuple[float, float] | None = None,
) -> xr.Dataset:
    """Null models of the map states, :func:`states.states.map_states`, under every load.

    The composites (offset, window_y, window_x) are those of the joint in the direction of the
    states; spacing and fit range are in mm. The dataset is that of :func:`null_models`, with the
    loads and the scalars ``direction``, ``offset`` and ``resolution`` of the states.
    """
    factor = int(states["resolution"])
    composite = states_at(composites, offset=float(states["offset"])).values
    domains = states["pressure"].values > 0
    nulls = null_models(
        domains, spacing * factor, composite[::factor, ::factor], fit_range=fit_range
    )
    names = ("normal_force", "direction", "offset", "resolution")
    return nulls.assign_coords({name: states[name] for name in names})


def beside_domains(counts: xr.Dataset, nulls: xr.Dataset) -> xr.Dataset:
    """Table of contact domains with the null models of the map states, missing in other domains.

    From :func:`domain.analysis.analyse_domains` and :func:`nulls_of_map_states`.
    """
    order = ("direction", "offset", "resolution", "normal_force")
    sizes = tuple(counts.sizes[name] for name in order)
    place = (
        counts.get_index("direction").get_loc(nulls["direction"].item()),
        int(np.argmin(np.abs(counts["offset"].values - nulls["offset"].item()))),
        counts.get_index("resolution").get_loc(nulls["resolution"].item()),
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
    return counts.assign(added)


def _row(domain, spacing, composite, fit_range, mask, how) -> dict[str, Any]:
    """Row of :func:`null_models` for one domain."""

    def counted(nodes):
        box = dimension_of_domain(
            nodes, spacing, fit_range=fit_range, whole_cells=how["whole_cells"]
        )
        return CountedDomain(nodes, box, **how)

    ours = counted(domain)
    box, nodes = ours.box, int(np.count_nonzero(domain))
    law = ours.law if box.estimator == "mean" else None
    bands, counts = random_bands(domain.shape, nodes, mask=mask, law=law, **how)
    of_cut = dict.fromkeys(DOMAIN_QUANTITIES, np.nan)
    beyond_cut = dict.fromkeys(_COMPARED["_cut_difference"], NO_ESTIMATE)
    count = np.full(dyadic_sizes(domain.shape).size, np.nan)
    highest_nodes = None
    if composite is not None and nodes > 1:
        highest_nodes = bearing_area_cut(composite, nodes)
        highest = counted(highest_nodes)
        of_cut, beyond_cut = highest.values, _less_cut(ours, highest)
        if highest.box.ordinary is not None:
            count = highest.box.ordinary.counts
    row: dict[str, Any] = {f"{name}_cut": value for name, value in of_cut.items()}
    row |= {f"{name}_random": band for name, band in bands.items()}
    row |= {f"{name}_cut_difference": difference for name, difference in beyond_cut.items()}
    row |= _compared_slopes(domain, highest_nodes, mask, spacing)
    row["null_count_random"] = counts
    row["null_count_cut"] = count
    row["null_mean_count"] = expected_mean_counts(domain.shape, nodes, mean_sizes(domain.shape))
    return row


def octaves_of(shape: tuple[int, ...], spacing: float) -> dict[str, np.ndarray]:
    """Box sides of the local slopes, mm; NaN alone in a window too small for any."""
    sides = np.append(curve_sizes(shape), np.full(2, np.nan))[: max(curve_sizes(shape).size, 2)]
    low, high = sides[:-1] * float(spacing), sides[1:] * float(spacing)
    return {
        "local_slope_side": np.sqrt(low * high),
        "local_slope_side_min": low,
        "local_slope_side_max": high,
    }


def _compared_slopes(domain, cut, mask, spacing):
    """Local slopes of one domain and its null models, with the result of :func:`null_models`."""
    sides = octaves_of(domain.shape, spacing)["local_slope_side"]
    nodes = int(np.count_nonzero(domain))
    curve = SlopeCurve(domain, mask)
    none = np.full(sides.size, np.nan)
    missing = dict.fromkeys(_CURVES, Estimate(none, none, none))
    curves = missing | {"": curve.interval}
    cut_values, departures = none, dict.fromkeys(("random", "cut"), NOT_COMPARED)
    reason = _why_not_compared(nodes, curve.values.size)
    if nodes > 1:
        draws = random_curves(domain.shape, nodes, mask)
        curves["_random"] = band_of(draws).in_plane()
        departures["random"] = departure_from_draws(curve.values, draws)
    if cut is not None:
        highest = SlopeCurve(cut, mask)
        cut_values = highest.values
        curves["_cut_difference"], departures["cut"] = paired_departure(curve, highest)
        if not (reason or np.isfinite(departures["cut"].p)):
            reason = "contact in too few parts of the window to compare with the bearing-area cut"
    if not curve.values.size:
        # A window too small for any slope has a single missing one, as axes need a length.
        curves, cut_values = missing, none
    row: dict[str, Any] = {f"local_slope{ending}": values for ending, values in curves.items()}
    row["local_slope_cut"] = cut_values
    if nodes < MIN_NODES:
        departures = dict.fromkeys(departures, NOT_COMPARED)
    for null, departure in departures.items():
        row |= departure.columns(null, sides)
    verdict = departure_of(*departures.values(), surface=cut is not None)
    return row | {"null_verdict": verdict, "null_reason": reason}


def _why_not_compared(nodes, slopes):
    """Reason why local slopes are not compared with null models; empty where they are."""
    if nodes < MIN_NODES:
        return f"fewer than {MIN_NODES} nodes in contact ({nodes})"
    return "" if slopes else TOO_SMALL


def _less_cut(domain, cut) -> dict[str, Estimate]:
    """Differences of a domain's dimensions from those of the cut."""
    less = {}
    same = np.array_equal(domain.nodes, cut.nodes)
    for name, error in errors_of(domain, cut).items():
        difference, half = domain.values[name] - cut.values[name], 0.0 if same else error
        less[name] = Estimate(difference, difference - half, difference + half)
    return less


def bearing_area_cut(composite: np.ndarray, nodes: int) -> np.ndarray:
    """The highest nodes of a composite topography (ny, nx): contact without elastic interaction.

    Nodes without a height (NaN) are the last; of equal heights the first are taken.
    """
    heights = np.where(np.isfinite(composite), composite, -np.inf).ravel()
    level = np.partition(heights, heights.size - nodes)[heights.size - nodes]
    domain = heights > level
    domain[np.flatnonzero(heights == level)[: nodes - np.count_nonzero(domain)]] = True
    return domain.reshape(composite.shape)
