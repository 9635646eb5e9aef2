"""Whether the two estimators of Delta_sigma agree, on made surfaces against a plane.

Eq. 5 takes Delta_sigma from the real area over resolutions, A_r ~ s^(2 - Delta_sigma), and from box
counts of the contact domain, as if they were one. At light load A_r = kappa F / (E* h'_rms(s)) with
h'_rms ~ s^(H - 1), so that the first is 1 + H = 4 - Delta_g whatever the load; nothing of the kind
is known of the second. Here both are taken from the same states, over many surfaces, sizes and
loads, and with a hardness up to where the whole window yields.
"""

import numpy as np
import xarray as xr

from ..core.fitting import fit_line
from ..core.intervals import INTERVAL, mean_interval
from ..core.labels import cf_attrs
from ..domain.box_counts import box_count
from ..domain.box_dimension import box_dimension
from ..domain.correlation import correlation_dimension
from ..domain.renormalisation import renormalisation
from ..elastic.halfspace import HalfSpace
from ..mechanics.joint import prefractal
from ..mechanics.sweep import load_steps
from ..roughness.dimension import slope_statistics
from ..surface.synthesis import self_affine

#: The problem depends on no length and no stress: both are units.
SIDE = 1.0  # mm
E_STAR = 1.0  # MPa
#: Rms height as a part of the side; the elastic problem is linear in heights.
RMS_PART = 0.01

#: What the paper reads off its Fig. 8, of a surface of this dimension.
PAPER_DELTA_SIGMA, PAPER_DIMENSION = 1.39, 2.1

#: What is kept of every surface under every load.
FIELDS = {
    "delta_area": "Delta_sigma from A_r(s) over the resolutions at one force",
    "delta_area_low": "Delta_sigma from A_r(s), lower end of its 95 % interval",
    "delta_area_high": "Delta_sigma from A_r(s), upper end of its 95 % interval",
    "delta_box": "Delta_sigma from box counts at the finest resolution",
    "delta_box_low": "Delta_sigma from box counts, lower end of its 95 % interval",
    "delta_box_high": "Delta_sigma from box counts, upper end of its 95 % interval",
    "delta_pairs": "correlation dimension of the contact domain at the finest resolution",
    "delta_pairs_low": "correlation dimension, lower end of its 95 % interval",
    "delta_pairs_high": "correlation dimension, upper end of its 95 % interval",
    "box_fit_min": "smallest box fitted over the finest spacing",
    "box_fit_max": "largest box fitted over the finest spacing",
}


def dimension_test(recipe, rtol=1e-6):
    """Delta_sigma by both estimators over surfaces, sizes, seeds and loads.

    Parameters
    ----------
    recipe : mapping
        ``dimensions`` Delta_g, ``sizes`` in nodes a side, ``seeds``, ``loads`` as values of
        p / (E* h'_rms) and ``resolutions``, multiples k of the finest spacing. With
        ``same_pressure`` true the loads are those of the smallest size, and larger ones, which are
        the same surface seen more finely, get the same nominal pressure; else (the default)
        h'_rms is that of each, and about the same part of it touches. Optional are ``hardness``,
        H / (E* h'_rms), ``capped_loads``, values of F / (H A_0), and ``capped_size``.
    rtol : float
        Of the solves.

    Returns
    -------
    xr.Dataset
        :data:`FIELDS`, ``difference`` (area less box) and ``boxes_per_node`` over (dimension, size,
        seed, load); ``mean_delta_area``, ``mean_delta_box``, ``mean_delta_pairs`` and
        ``mean_difference`` over the seeds with ``_low`` and ``_high`` (95 %, Student's t) and
        ``_n``; ``light_load_delta`` (dimension) = 4 - Delta_g; ``growth`` (dimension, load), change
        of the difference with each doubling of the size, ``decade`` (dimension, size) with each
        decade of load. With a hardness the same names after ``capped_``, over (dimension, seed,
        capped_load).

    Notes
    -----
    If a coarser pre-fractal's domain were that of the finer one seen through coarser boxes, the
    boxes of side k s that meet the finest domain would be as many as the nodes that touch at
    resolution k: ``boxes_per_node`` (last dimension resolution) would be 1, and the two estimators
    the same. How it goes with k is how they differ.
    """
    sizes = sorted(recipe["sizes"])
    factors = sorted(recipe["resolutions"])
    axes = {
        "dimension": list(recipe["dimensions"]),
        "size": sizes,
        "seed": list(recipe["seeds"]),
        "load": np.unique(recipe["loads"]),
    }
    shape = tuple(len(values) for values in axes.values())
    table = {name: np.full(shape, np.nan) for name in FIELDS}
    nodes, met = np.full((*shape, len(factors)), np.nan), np.full((*shape, len(factors)), np.nan)
    slope = np.full(shape[:3], np.nan)
    for i, j, k in np.ndindex(shape[:3]):
        dimension, size, seed = axes["dimension"][i], sizes[j], axes["seed"][k]
        surface = made_surface(dimension, size, seed)
        slope[i, j, k] = slope_statistics(surface, SIDE / size)["rms_slope"]
        finer = (sizes[0] / size) ** (dimension - 2) if recipe.get("same_pressure") else 1.0
        forces = axes["load"] * finer * E_STAR * slope[i, j, k] * SIDE**2
        found = _estimates(surface, forces, factors, rtol)
        for name in FIELDS:
            table[name][i, j, k] = found[name]
        nodes[i, j, k], met[i, j, k] = found["nodes"], found["met"]
    result = _labelled(axes, table)
    result["rms_slope"] = (
        tuple(axes)[:3],
        slope,
        cf_attrs("1", "rms slope h'_rms at the finest spacing"),
    )
    result = result.assign_coords(
        resolution=("resolution", factors, cf_attrs("1", "multiple k of the finest spacing"))
    )
    dims = (*axes, "resolution")
    result["nodes"] = (dims, nodes, cf_attrs("1", "nodes in contact at each resolution"))
    result["boxes_per_node"] = (
        dims,
        met / np.where(nodes > 0, nodes, np.nan),
        cf_attrs("1", "boxes of side k s that meet the finest domain over nodes in contact at k"),
    )
    _add_means(result, "load")
    _add_trends(result)
    if "capped_loads" in recipe:
        result = result.merge(_capped(recipe, axes, factors, rtol))
    result.attrs = {
        "paper_delta_sigma": PAPER_DELTA_SIGMA,
        "paper_dimension": PAPER_DIMENSION,
        "same_pressure": int(bool(recipe.get("same_pressure"))),
        **({"hardness": float(recipe["hardness"])} if "hardness" in recipe else {}),
    }
    return result.assign_attrs(summary=summary(result))


def made_surface(dimension, size, seed):
    """Heights (size, size) of a self-affine surface of side `SIDE` without a roll-off, mm."""
    rms = RMS_PART * SIDE
    return self_affine((size, size), SIDE / size, 3 - dimension, rms=rms, seed=seed)


def _estimates(surface, forces, factors, rtol, hardness=np.inf):
    """Both estimates under rising forces: `FIELDS` by name, ``nodes`` and ``met`` (load, k)."""
    size = len(surface)
    spacing = SIDE / size
    nodes, met = np.zeros((2, len(forces), len(factors)))
    boxes, pairs = [], []
    for j, factor in enumerate(factors):
        h = prefractal(surface, factor)
        space = HalfSpace(h.shape, (factor * spacing,) * 2, E_STAR)
        where = f"made surface of {size} x {size} nodes, resolution {factor}"
        solving = {"hardness": hardness, "rtol": rtol}
        states = load_steps(h, space, forces, solving, where)
        for i, state in enumerate(states):
            nodes[i, j] = np.count_nonzero(state.in_contact)
            if j == 0:
                boxes.append(box_dimension(state.in_contact, spacing))
                pairs.append(correlation_dimension(state.in_contact, spacing))
                met[i] = box_count(state.in_contact, np.array(factors, float))
    s = xr.DataArray(spacing * np.array(factors), dims="resolution")
    area = xr.DataArray(nodes, dims=("load", "resolution")) * s**2
    by_area = renormalisation(s, area, xr.DataArray(forces, dims="load"))
    return {
        **{f"delta_area{end}": by_area[f"delta_sigma{end}"].values for end in INTERVAL},
        "delta_box": [box.dimension for box in boxes],
        "delta_box_low": [box.low for box in boxes],
        "delta_box_high": [box.high for box in boxes],
        "delta_pairs": [line.value for line in pairs],
        "delta_pairs_low": [line.low for line in pairs],
        "delta_pairs_high": [line.high for line in pairs],
        "box_fit_min": [box.r_min / spacing for box in boxes],
        "box_fit_max": [box.r_max / spacing for box in boxes],
        "nodes": nodes,
        "met": met,
    }


def _capped(recipe, axes, factors, rtol):
    """Both estimates with a hardness, up to where the whole window yields."""
    size = recipe["capped_size"]
    parts = np.unique(recipe["capped_loads"])
    dimensions, seeds = axes["dimension"], axes["seed"]
    shape = (len(dimensions), len(seeds), len(parts))
    table = {name: np.full(shape, np.nan) for name in FIELDS}
    share = np.full(shape, np.nan)
    for i, j in np.ndindex(shape[:2]):
        surface = made_surface(dimensions[i], size, seeds[j])
        slope = float(slope_statistics(surface, SIDE / size)["rms_slope"])
        hardness = recipe["hardness"] * E_STAR * slope
        found = _estimates(surface, parts * hardness * SIDE**2, factors, rtol, hardness)
        for name in FIELDS:
            table[name][i, j] = found[name]
        share[i, j] = found["nodes"][:, 0] / size**2
    capped = _labelled({"dimension": dimensions, "seed": seeds, "load": parts}, table)
    capped["area_share"] = (
        ("dimension", "seed", "load"),
        share,
        cf_attrs("1", "real contact area A_r / A_0"),
    )
    _add_means(capped, "load")
    capped = capped.drop_vars("light_load_delta")
    names = {name: f"capped_{name}" for name in [*capped.data_vars, "load"]}
    capped = capped.rename(names)
    capped["capped_load"].attrs = cf_attrs("1", "F / (H A_0)")
    capped.attrs = {}
    return capped


def _labelled(axes, table):
    """The dataset from the numbers of every surface and load."""
    words = {
        "dimension": "dimension Delta_g of the surface",
        "size": "nodes a side",
        "seed": "seed of the surface",
        "load": "p / (E* h'_rms)",
    }
    coords = {name: (name, values, cf_attrs("1", words[name])) for name, values in axes.items()}
    result = xr.Dataset(
        {
            name: (tuple(axes), values, cf_attrs("1", FIELDS[name]))
            for name, values in table.items()
        },
        coords=coords,
    )
    result["difference"] = result["delta_area"] - result["delta_box"]
    result["difference"].attrs = cf_attrs("1", "Delta_sigma from A_r(s) less that from box counts")
    result["light_load_delta"] = 4.0 - result["dimension"]
    result["light_load_delta"].attrs = cf_attrs("1", "Delta_sigma = 1 + H of A_r(s) at light load")
    return result


def _add_means(result, last):
    """Means over the seeds with their intervals, into ``result``."""
    for name in ("delta_area", "delta_box", "delta_pairs", "difference"):
        values = result[name]
        dims = tuple(dim for dim in values.dims if dim != "seed")
        found = mean_interval(values.values, axis=values.dims.index("seed"))
        for ending, mean in zip(INTERVAL, found[:3], strict=True):
            words = f"mean over seeds of {values.attrs['long_name']}{INTERVAL[ending]}"
            result[f"mean_{name}{ending}"] = (dims, mean, cf_attrs("1", words))
        result[f"mean_{name}_n"] = (dims, found.n, cf_attrs("1", "seeds that have it"))


def _add_trends(result):
    """How the difference goes with size and with load, over all surfaces, into ``result``."""
    values = result["difference"]
    doubling, decade = np.log2(result["size"].values), np.log10(result["load"].values)
    by_size = values.transpose("dimension", "load", "size", "seed").values
    by_load = values.transpose("dimension", "size", "load", "seed").values
    for name, rows, x, dims, words in (
        ("growth", by_size, doubling, ("dimension", "load"), "with each doubling of the size"),
        ("decade", by_load, decade, ("dimension", "size"), "with each decade of the load"),
    ):
        x = np.repeat(x, rows.shape[3])
        lines = [fit_line(x, rows[index].ravel()) for index in np.ndindex(rows.shape[:2])]
        for ending, field in (("", "slope"), ("_low", "slope_low"), ("_high", "slope_high")):
            fitted = np.reshape([getattr(line, field) for line in lines], rows.shape[:2])
            text = f"change of the difference {words}{INTERVAL[ending]}"
            result[f"{name}{ending}"] = (dims, fitted, cf_attrs("1", text))


def summary(result):
    """In words, by dimension: whether the two estimators agree, and where they tend.

    Parameters
    ----------
    result : xr.Dataset
        From :func:`dimension_test`.

    Returns
    -------
    str
    """
    rows = []
    for dimension in result["dimension"].values:
        one = result.sel(dimension=dimension)
        low, high = one["mean_difference_low"].values, one["mean_difference_high"].values
        known = np.isfinite(low)
        if not known.any():
            rows.append(f"Delta_g = {dimension:g}: too few values to compare")
            continue
        agree = int(((low <= 0) & (high >= 0))[known].sum())
        mean = one["mean_difference"].values[known]
        rows.append(
            f"Delta_g = {dimension:g}: area less box counts is {mean.min():.2f} to "
            f"{mean.max():.2f} in the mean, zero lies in its interval at {agree} of "
            f"{int(known.sum())} sizes and loads; with size it "
            f"{_trend(one, 'growth', 'loads')}, with load it {_trend(one, 'decade', 'sizes')}"
        )
    return "; ".join(rows)


def _trend(one, name, of):
    low, high = one[f"{name}_low"].values, one[f"{name}_high"].values
    known = np.isfinite(low)
    if not known.any():
        return "cannot be told to change"
    falls, rises = int((high[known] < 0).sum()), int((low[known] > 0).sum())
    return f"falls at {falls} and rises at {rises} of {int(known.sum())} {of}"
