"""One table over all contact states of a specimen: box counts, clusters, renormalisation."""

from typing import Any

import numpy as np
import xarray as xr

from ..core.arrays import padded
from ..core.datasets import domains_by_resolution, labelled_dataset
from ..core.estimate import rows_of
from ..core.fitting import MIN_POINTS
from ..core.labels import cf_attrs
from ..core.limits import CORRECTED_NODES
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

#: The table: dimensions, unit and long name.
_TABLE = {
    **{name: (_ORDER, *words) for name, words in DOMAIN_FIELDS.items()},
    "cluster_octaves": (
        (*_ORDER, "octave"),
        "1",
        "contact clusters of 2^k to 2^(k+1) - 1 nodes, by octave k",
    ),
    "reason": (_ORDER, "1", "why there is no dimension, or none with an interval"),
    "estimator": (_ORDER, "1", "estimator of delta_sigma"),
    "determined": (_ORDER, "1", "whether delta_sigma has an interval"),
    "ordinary_determined": (_ORDER, "1", "whether delta_sigma_ordinary has an interval"),
    "box_count": (
        (*_ORDER, "scale"),
        "1",
        "occupied boxes N(r), minimal cover over all grid origins",
    ),
    "box_used": ((*_ORDER, "scale"), "1", "box size used in the fit"),
    "ordinary_used": (
        (*_ORDER, "scale"),
        "1",
        "box size used in the fit of the ordinary dimension",
    ),
    "box_side": (("resolution", "scale"), "mm", "side of the boxes r"),
    "mean_count": ((*_ORDER, "mean_scale"), "1", "occupied boxes N(r), mean over all grid origins"),
    "law_count": (
        (*_ORDER, "mean_scale"),
        "1",
        "box counts by the law that Delta_sigma is fitted with",
    ),
    "ordinary_count": (
        (*_ORDER, "scale"),
        "1",
        "box counts by the line that the ordinary dimension is fitted with",
    ),
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
        ``in_contact_k`` over (direction, offset, normal_force, y_k, x_k) and, of domains that were
        not measured, ``solved`` and ``nodes_error``: :func:`states.states.contact_domains`.
    spacing : float
        Of the scan, mm; a domain at resolution k has k times this.
    fit_range : (float, float), optional
        Smallest and largest box of the fits, mm; by default all between the cut-offs.
    whole_cells : bool, optional
        What is known of the nodes, see :func:`domain.box_dimension.box_dimension`; those of a
        solution are centres of cells.

    Returns
    -------
    xr.Dataset
        :data:`DOMAIN_FIELDS`, ``reason`` (why there is no dimension, or no interval) and
        ``determined`` over (direction, offset, resolution, load); ``box_count`` and ``box_used``
        with a last dimension scale, ``mean_count`` with mean_scale, ``cluster_octaves`` with
        octave; ``box_side`` and ``mean_side`` (resolution, ...) in mm; over the
        sides fitted ``law_count`` of the count law and ``ordinary_count`` of the ordinary slope;
        what :func:`domain.cluster_laws.cluster_laws` finds.

    Notes
    -----
    The dimension is that of :func:`domain.box_dimension.dimension_of_domain`. Its solver error
    bound is the fraction of the nodes whose contact is ambiguous: in 95 to 98 % of 250 states of
    three twins, solved to 1e-5 to 1e-2, the dimension was off by no more than that.
    """
    domains = {k: domain.values for k, domain in domains_by_resolution(fields).items()}
    factors = list(domains)
    shapes = {k: domains[k].shape[-2:] for k in factors}
    sizes = {
        "box_side": [window_sizes(shapes[k]) * k * spacing for k in factors],
        "mean_side": [mean_sizes(shapes[k]) * k * spacing for k in factors],
    }
    n_direction, n_offset, n_load, *window = domains[factors[0]].shape
    shape = (n_direction, n_offset, len(factors), n_load)
    # A coarser domain has fewer nodes and fewer octaves of cluster sizes: none in the others.
    n_octaves = int(np.prod(window)).bit_length()
    solved, ambiguous = _solver_state(fields, shape)
    n_scales, n_means = (max(map(len, of_all)) for of_all in sizes.values())
    table = _empty_table(shape, n_scales, n_means, n_octaves)
    nodes = np.zeros(shape, int)
    for place in np.ndindex(shape):
        direction, offset, k, load = place
        if not solved[place]:
            table["reason"][place] = NOT_NEEDED
            continue
        factor = factors[k]
        domain = domains[factor][direction, offset, load]
        nodes[place] = domain.sum()
        row = _row(
            domain,
            factor * spacing,
            ambiguous[place],
            fit_range=fit_range,
            whole_cells=whole_cells,
        )
        table["cluster_octaves"][place] = 0
        for name, value in row.items():
            if np.ndim(value):
                table[name][place][: len(value)] = value
            else:
                table[name][place] = value
    table |= {name: table[name].astype(str) for name in ("reason", "estimator")}
    table |= {name: padded(of_all) for name, of_all in sizes.items()}
    multiples = ("resolution", factors, cf_attrs("1", "multiple k of the scan's spacing"))
    octaves = ("octave", np.arange(n_octaves), cf_attrs("1", "octave k of cluster sizes"))
    coords: dict[str, Any] = {
        name: fields[name] for name in ("direction", "offset", "normal_force")
    }
    coords |= {"resolution": multiples, "octave": octaves}
    result = labelled_dataset(_TABLE, table, coords=coords)
    return result.merge(cluster_laws(result, nodes, spacing))


def _solver_state(fields, shape):
    """True for each solved domain, and its ambiguous nodes; NaN for measured maps."""
    if "solved" not in fields:
        return np.ones(shape, bool), np.full(shape, np.nan)
    return tuple(fields[name].transpose(*_ORDER).values for name in ("solved", "nodes_error"))


def _empty_table(shape, n_scales, n_means, n_octaves) -> dict[str, np.ndarray]:
    """Values of :data:`_TABLE` before any domain is measured, but the sides of the boxes."""
    return {
        **{name: np.full(shape, np.nan) for name in DOMAIN_FIELDS},
        "cluster_octaves": np.full((*shape, n_octaves), np.nan),
        "reason": np.full(shape, "", object),
        "estimator": np.full(shape, "", object),
        "determined": np.zeros(shape, bool),
        "ordinary_determined": np.zeros(shape, bool),
        "box_count": np.full((*shape, n_scales), np.nan),
        "box_used": np.zeros((*shape, n_scales), bool),
        "ordinary_used": np.zeros((*shape, n_scales), bool),
        **{name: np.full((*shape, n_means), np.nan) for name in ("mean_count", "law_count")},
        "ordinary_count": np.full((*shape, n_scales), np.nan),
    }


def _row(domain, spacing, ambiguous, **how) -> dict:
    """Row of the table for one domain; ``how`` chooses the estimator of its dimension."""
    box = dimension_of_domain(domain, spacing, **how)
    sides = mean_sizes(domain.shape) * spacing
    with np.errstate(invalid="ignore"):  # of a box as large as what a node stands for, to rounding
        law = law_count(sides, box.dimension, box.terms)
    return {
        **box.columns("delta_sigma"),
        "delta_sigma_error": ambiguous / domain.sum() if box.known else np.nan,
        "fit_min": box.over[0],
        "fit_max": box.over[1],
        "fit_n": box.n,
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
    """The ordinary dimension of a domain, nothing where there is none."""
    slope = box.ordinary
    if slope is None:
        return {}
    used = np.isin(np.round(box.r / spacing), slope.sizes[slope.used])
    line = np.full(box.r.shape, np.nan)
    if used.any():
        # Through the mean of the logarithms of the counts fitted.
        level = np.mean(np.log(box.count[used]) + slope.value * np.log(box.r[used]))
        inside = within(box.r, *(end * spacing for end in slope.over))
        line = np.where(inside, np.exp(level) * box.r**-slope.value, np.nan)
    return {
        **slope.columns("delta_sigma_ordinary"),
        "ordinary_fit_min": slope.over[0] * spacing,
        "ordinary_fit_max": slope.over[1] * spacing,
        "ordinary_fit_n": slope.n,
        "ordinary_determined": slope.determined,
        "ordinary_used": used,
        "ordinary_count": line,
    }


def scaling_over_resolutions(
    curves: xr.Dataset,
    domains: xr.Dataset,
    spacing: float,
    *,
    left: xr.DataArray | None = None,
    fit_range: tuple[float, float] | None = None,
) -> xr.Dataset:
    """Renormalisation over resolutions: Delta_sigma from A_r(s) beside that of the box counts.

    Parameters
    ----------
    curves : xr.Dataset
        With ``area``, ``area_corrected``, ``area_sampling`` and ``nodes`` over (direction, offset,
        resolution, normal_force).
    domains : xr.Dataset
        From :func:`analyse_domains`.
    spacing : float
        Of the scan, mm.
    left : DataArray, optional
        From :func:`states.left_out.left_of_fields`; no interval without it.
    fit_range : (float, float), optional
        Smallest and largest spacing s of the fits, mm; all by default.

    Returns
    -------
    xr.Dataset
        The renormalisation of :func:`domain.renormalisation.renormalisation` over (direction,
        offset, load), and both estimates of Delta_sigma with their difference; the box counts are
        those at the scan's own resolution; ``area``, ``area_corrected`` and ``nodes`` are those of
        the states. ``sigma_n`` is F / A_r of the corrected area wherever `CORRECTED_NODES` touch,
        ``sigma_n_raw`` that of the raw one; ``area_used`` says which areas Delta_sigma is fitted
        to, ``fitted_area`` is their law. ``delta_sigma_area_reason`` and ``delta_sigma_box_reason``
        say why there is no estimate, or no interval; ``area_bend`` is how much more Delta_sigma the
        two finest resolutions have than the two coarsest.

    Notes
    -----
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
    finest = domains.sel(resolution=domains["resolution"].min())
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
    """Renormalisation of the corrected areas alone, with the bend of their law.

    Parameters
    ----------
    curves, spacing, left, fit_range
        As of :func:`scaling_over_resolutions`.

    Returns
    -------
    xr.Dataset
        As of :func:`domain.renormalisation.renormalisation`, and ``area_bend`` with its interval.
    """
    s, nodes = _spacings(curves, spacing), _nodes_between(curves, spacing, fit_range)
    area = curves["area_corrected"]
    each = nodes, CORRECTED_NODES, left, curves["area_sampling"]
    result = renormalisation(s, area, curves["normal_force"], *each)
    words = "Delta_sigma from the area of the two finest resolutions less that of the two coarsest"
    bend = area_bend(s, area, *each)
    for (name, row), value in zip(rows_of("area_bend", "1", words).items(), bend.ends, strict=True):
        result[name] = value.assign_attrs(cf_attrs(*row))
    return result


def _spacings(curves, spacing):
    return (curves["resolution"] * spacing).assign_attrs(cf_attrs("mm", "spacing s"))


def _nodes_between(curves, spacing, fit_range):
    """Nodes in contact at the spacings that are fitted, else missing."""
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
