"""One table over all contact states of a specimen: box counts, clusters, renormalisation."""

from typing import Any

import numpy as np
import xarray as xr

from ..core.arrays import padded
from ..core.datasets import domains_by_resolution, labelled
from ..core.estimate import rows_of
from ..core.fitting import MIN_POINTS
from ..core.labels import cf_attrs
from ..core.limits import CORRECTED_NODES
from ..core.per_curve import stacked
from ..core.ranges import within
from .box_counts import window_sizes
from .box_dimension import ESTIMATORS, dimension_of_domain
from .cluster_laws import cluster_laws
from .clusters import CLUSTER_FIELDS, cluster_statistics
from .count_law import law_count
from .mean_law import mean_sizes
from .renormalisation import area_bend, compare_dimensions, renormalisation

#: Numbers kept of every contact domain: name, unit, long name.
DOMAIN_FIELDS = {
    **rows_of("delta_sigma", "1", "box-counting dimension Delta_sigma of the contact domain"),
    "delta_sigma_error": ("1", "Delta_sigma, solver error bound"),
    "fit_min": ("mm", "smallest box fitted"),
    "fit_max": ("mm", "largest box fitted"),
    "fit_n": ("1", "box sizes fitted"),
    "fit_misfit": ("1", "root mean square of the counts about the law, fraction of them"),
    **rows_of(
        "delta_sigma_ordinary",
        "1",
        "ordinary box-counting dimension: least-squares slope of log N over log r, minimal cover",
    ),
    "ordinary_fit_min": ("mm", "smallest box in the fit of the ordinary dimension"),
    "ordinary_fit_max": ("mm", "largest box in the fit of the ordinary dimension"),
    "ordinary_fit_n": ("1", "box sizes in the fit of the ordinary dimension"),
    **CLUSTER_FIELDS,
}

NOT_NEEDED = "not solved, since nothing shown needs it"

#: Dimensions of the table of contact domains.
_ORDER = ("direction", "offset", "resolution", "normal_force")

#: Variables of the table: unit, long name, and dimensions of an array of each domain.
_TABLE: dict[str, tuple[str, ...]] = {
    **DOMAIN_FIELDS,
    "cluster_octaves": ("1", "contact clusters of 2^k to 2^(k+1) - 1 nodes, by octave k", "octave"),
    "reason": ("1", "why there is no dimension, or none with an interval"),
    "estimator": ("1", "estimator of delta_sigma"),
    "determined": ("1", "whether delta_sigma has an interval"),
    "ordinary_determined": ("1", "whether delta_sigma_ordinary has an interval"),
    "box_count": ("1", "occupied boxes N(r), minimal cover over all grid origins", "scale"),
    "box_used": ("1", "box size used in the fit", "scale"),
    "ordinary_used": ("1", "box size used in the fit of the ordinary dimension", "scale"),
    "mean_count": ("1", "occupied boxes N(r), mean over all grid origins", "mean_scale"),
    "law_count": ("1", "box counts by the law that Delta_sigma is fitted with", "mean_scale"),
    "ordinary_count": (
        "1",
        "box counts by the line that the ordinary dimension is fitted with",
        "scale",
    ),
}
_WORDS = ("reason", "estimator")
_FLAGS = ("determined", "ordinary_determined", "box_used", "ordinary_used")

_SIDES = {
    "box_side": (("resolution", "scale"), "mm", "side of the boxes r"),
    "mean_side": (("resolution", "mean_scale"), "mm", "side of the boxes of the mean counts r"),
}


def analyse_domains(
    fields: xr.Dataset,
    spacing: float,
    *,
    fit_range: tuple[float, float] | None = None,
    whole_cells: bool | None = False,
) -> xr.Dataset:
    """Box counts, Delta_sigma and clusters of every contact domain.

    Parameters
    ----------
    fields : xr.Dataset
        ``in_contact_k`` over (direction, offset, normal_force, y_k, x_k) and, of solved domains,
        ``solved`` and ``nodes_error``: :func:`states.states.contact_domains`.
    spacing : float
        Spacing of the scan, mm; a domain at resolution k has k times this.
    fit_range, whole_cells
        As of :func:`domain.box_dimension.box_dimension`; nodes of a solution are centres of cells.

    Returns
    -------
    xr.Dataset
        The variables of :data:`_TABLE`, and those of :func:`domain.cluster_laws.cluster_laws`.
        ``law_count`` and ``ordinary_count`` are given at the box sides of their fits.

    Notes ----- The solver error bound of the dimension is the fraction of the nodes whose contact
    is ambiguous: in 95 to 98 % of 250 states of three twins, solved to 1e-5 to 1e-2, the dimension
    was off by no more than that.
    """
    domains = {k: domain.values for k, domain in domains_by_resolution(fields).items()}
    factors = list(domains)
    windows = {k: domains[k].shape[-2:] for k in factors}
    sides = {
        "box_side": padded([window_sizes(windows[k]) * k * spacing for k in factors]),
        "mean_side": padded([mean_sizes(windows[k]) * k * spacing for k in factors]),
    }
    n_direction, n_offset, n_load, *_ = domains[factors[0]].shape
    shape = (n_direction, n_offset, len(factors), n_load)
    # Number of octaves of the finest domain; a coarser domain has fewer nodes and no clusters in
    # the last octaves.
    n_octaves = int(np.prod(windows[factors[0]])).bit_length()
    solved, ambiguous = _solver_state(fields, shape)
    missing = _missing_values(
        scale=sides["box_side"].shape[1], mean_scale=sides["mean_side"].shape[1], octave=n_octaves
    )
    rows, nodes = [], np.zeros(shape, int)
    for place in np.ndindex(shape):
        direction, offset, k, load = place
        if not solved[place]:
            rows.append(missing | {"reason": NOT_NEEDED})
            continue
        domain = domains[factors[k]][direction, offset, load]
        nodes[place] = domain.sum()
        row = _row(
            domain,
            factors[k] * spacing,
            ambiguous[place],
            fit_range=fit_range,
            whole_cells=whole_cells,
        )
        octaves = row["cluster_octaves"]
        row["cluster_octaves"] = np.pad(octaves, (0, n_octaves - octaves.size))
        rows.append(_with_all_values(row, missing))
    coords: dict[str, Any] = {
        name: fields[name] for name in ("direction", "offset", "normal_force")
    }
    coords["resolution"] = (
        "resolution",
        factors,
        cf_attrs("1", "multiple k of the scan's spacing"),
    )
    coords["octave"] = ("octave", np.arange(n_octaves), cf_attrs("1", "octave k of cluster sizes"))
    table = stacked(rows, _TABLE, _ORDER, shape) | labelled(_SIDES, sides)
    result = xr.Dataset(table, coords)
    return result.merge(cluster_laws(result, nodes, spacing))


def _solver_state(fields, shape):
    """True for each solved domain, and its number of ambiguous nodes; NaN for measured maps."""
    if "solved" not in fields:
        return np.ones(shape, bool), np.full(shape, np.nan)
    return tuple(fields[name].transpose(*_ORDER).values for name in ("solved", "nodes_error"))


def _missing_values(**lengths: int) -> dict[str, np.ndarray]:
    """Row of the table without any value; ``lengths`` are those of its arrays by dimension."""
    fills = dict.fromkeys(_TABLE, np.nan) | dict.fromkeys(_WORDS, "") | dict.fromkeys(_FLAGS, False)
    return {
        name: np.full([lengths[dim] for dim in own], fills[name])
        for name, (_, _, *own) in _TABLE.items()
    }


def _with_all_values(row, missing) -> dict[str, Any]:
    """Row with arrays as long as those of a missing row, filled up with its values."""
    arrays = {}
    for name, empty in missing.items():
        if name in row and empty.ndim:
            arrays[name] = empty.copy()
            arrays[name][: len(row[name])] = row[name]
    return missing | row | arrays


def _row(domain, spacing, ambiguous, **how) -> dict:
    """Row of the table for one domain; ``how`` are the options of the box dimension."""
    box = dimension_of_domain(domain, spacing, **how)
    sides = mean_sizes(domain.shape) * spacing
    with np.errstate(invalid="ignore"):  # r - c is below 0 by rounding if a box is as wide as c
        law = law_count(sides, box.dimension, box.terms)
    return {
        **box.columns("delta_sigma"),
        "delta_sigma_error": ambiguous / domain.sum() if box.known else np.nan,
        "fit_min": box.over[0],
        "fit_max": box.over[1],
        "fit_n": float(box.n),
        "fit_misfit": box.misfit,
        **_ordinary(box, spacing),
        **cluster_statistics(domain, spacing),
        "reason": box.reason,
        "estimator": ESTIMATORS.get(box.estimator, ""),
        "determined": box.determined,
        "box_count": box.count,
        "box_used": box.used,
        "mean_count": box.means.counts,
        "law_count": np.where(within(sides, *box.over), law, np.nan),
    }


def _ordinary(box, spacing) -> dict:
    """Columns of the ordinary dimension of a domain; none where there is no such dimension."""
    ordinary = box.ordinary
    if ordinary is None:
        return {}
    used = np.isin(np.round(box.r / spacing), ordinary.sizes[ordinary.used])
    line = np.full(box.r.shape, np.nan)
    if used.any():
        # The line goes through the mean of the logarithms of the counts fitted.
        level = np.mean(np.log(box.count[used]) + ordinary.value * np.log(box.r[used]))
        inside = within(box.r, *(end * spacing for end in ordinary.over))
        line = np.where(inside, np.exp(level) * box.r**-ordinary.value, np.nan)
    return {
        **ordinary.columns("delta_sigma_ordinary"),
        "ordinary_fit_min": ordinary.over[0] * spacing,
        "ordinary_fit_max": ordinary.over[1] * spacing,
        "ordinary_fit_n": float(ordinary.n),
        "ordinary_determined": ordinary.determined,
        "ordinary_used": used,
        "ordinary_count": line,
    }


def scaling_over_resolutions(
    curves: xr.Dataset,
    counts: xr.Dataset,
    spacing: float,
    *,
    left: xr.DataArray | None = None,
    fit_range: tuple[float, float] | None = None,
) -> xr.Dataset:
    """Renormalisation over resolutions: Delta_sigma from A_r(s), compared with that of box counts.

    ``curves`` has ``area``, ``area_corrected``, ``area_sampling`` and ``nodes`` over (direction,
    offset, resolution, normal_force); of ``counts``, from :func:`analyse_domains`, the box counts
    at the scan's own resolution are used. ``spacing`` is that of the scan, ``fit_range`` the
    smallest and largest spacing s of the fits, mm, all by default; ``left`` comes from
    :func:`states.left_out.left_of_fields`, and without it there is no interval.

    The dataset has the variables of :func:`domain.renormalisation.renormalisation`, both estimates
    of Delta_sigma and their difference, and ``area_bend`` of
    :func:`domain.renormalisation.area_bend`.

    Areas are those corrected for the cells on their edge, at resolutions where `CORRECTED_NODES`
    touch: the raw area exceeds the true one by a fraction that grows with the spacing, which lowers
    Delta_sigma. Mixing both would put a step into the line where one takes over from the other.
    """
    s, force = _spacings(curves, spacing), curves["normal_force"]
    result = corrected_scaling(curves, spacing, left=left, fit_range=fit_range)
    used = result["sigma_n"].notnull() & result["delta_sigma"].notnull()
    result["area_used"] = used.assign_attrs(cf_attrs("1", "resolution in the fit of delta_sigma"))
    # The pressure does not depend on which spacings are fitted.
    enough = curves["nodes"] >= CORRECTED_NODES
    result["sigma_n"] = force / curves["area_corrected"].where(enough)
    words = f"real mean pressure F / A_r; missing below {CORRECTED_NODES} nodes in contact"
    result["sigma_n"].attrs = cf_attrs("MPa", words)
    result["sigma_n_raw"] = force / curves["area"].where(curves["area"] > 0)
    result["sigma_n_raw"].attrs = cf_attrs("MPa", "F / A_r of the area not corrected for its edge")
    result["fitted_area"] = result["hausdorff_measure"] * s ** (2 - result["delta_sigma"])
    result["fitted_area"].attrs = cf_attrs("mm2", "contact area by the law of delta_sigma")
    finest = counts.sel(resolution=counts["resolution"].min())
    result = result.merge(compare_dimensions(result, finest), compat="override", join="exact")
    result.update(_reasons(result, finest))
    result["spacing"] = s
    for name in ("area", "area_corrected", "nodes"):
        result[name] = curves[name]
    return result.drop_vars([n for n in result.coords if n not in result.dims])


def corrected_scaling(
    curves: xr.Dataset,
    spacing: float,
    *,
    left: xr.DataArray | None = None,
    fit_range: tuple[float, float] | None = None,
) -> xr.Dataset:
    """Renormalisation of the corrected areas alone, with the bend of their law and its interval.

    Parameters are those of :func:`scaling_over_resolutions`.
    """
    s, nodes = _spacings(curves, spacing), _nodes_between(curves, spacing, fit_range)
    area = curves["area_corrected"]
    samples = nodes, CORRECTED_NODES, left, curves["area_sampling"]
    result = renormalisation(s, area, curves["normal_force"], *samples)
    words = "Delta_sigma from the area of the two finest resolutions less that of the two coarsest"
    bend = area_bend(s, area, *samples)
    for (name, row), value in zip(rows_of("area_bend", "1", words).items(), bend.ends, strict=True):
        result[name] = value.assign_attrs(cf_attrs(*row))
    return result


def _spacings(curves, spacing):
    return (curves["resolution"] * spacing).assign_attrs(cf_attrs("mm", "spacing s"))


def _nodes_between(curves, spacing, fit_range):
    """Nodes in contact at the spacings of the fit; missing at others."""
    inside = True if fit_range is None else within(_spacings(curves, spacing), *fit_range)
    return curves["nodes"].where(inside)


def _reasons(scaling, finest):
    """Reason why Delta_sigma or its interval is missing; empty if neither is."""
    of = f"of the {MIN_POINTS} resolutions needed"
    why = [f"no fit: enough contact at {n} {of}" for n in scaling["n"].values.flat]
    area = scaling["n"].copy(data=np.reshape(np.array(why, object), scaling["n"].shape))
    area = area.where(scaling["delta_sigma"].isnull(), "")
    no_box = finest["reason"].astype(object)
    missing = finest["delta_sigma"].isnull()
    reasons = {
        "delta_sigma_area_reason": area,
        "delta_sigma_box_reason": xr.where(missing, "no dimension: " + no_box, no_box),
    }
    for name, reason in reasons.items():
        reason.attrs = cf_attrs(
            "1", f"why there is no {name.removesuffix('_reason')}, or no interval"
        )
    return {
        name: reason.drop_vars("resolution", errors="ignore").astype(str)
        for name, reason in reasons.items()
    }
