"""Agreement of the two estimators of Delta_sigma, on synthetic surfaces against a plane.

Eq. 5 takes Delta_sigma from the real area over resolutions, A_r ~ s^(2 - Delta_sigma), and from box
counts of the contact domain, as if they were one. At light load A_r = kappa F / (E* h'_rms(s)) with
h'_rms ~ s^(H - 1), so that the first is 1 + H = 4 - Delta_g whatever the load; nothing of the kind
is known of the second. Here both are taken from the same states, over many surfaces, sizes and
loads, and with a hardness up to where the whole window yields.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from fractalcontact.core.datasets import labelled, labelled_dataset
from fractalcontact.core.estimate import Estimate, rows_of
from fractalcontact.core.fitting import fit_line
from fractalcontact.core.intervals import mean_interval
from fractalcontact.core.labels import cf_attrs
from fractalcontact.domain.box_counts import box_count
from fractalcontact.domain.box_dimension import dimension_of_domain
from fractalcontact.domain.correlation import correlation_dimension
from fractalcontact.domain.renormalisation import renormalisation
from fractalcontact.mechanics.joint import prefractal
from fractalcontact.mechanics.sweep import load_steps
from fractalcontact.roughness.dimension import slope_statistics
from fractalcontact.surface.synthesis import self_affine
from roughcontact.elastic.halfspace import HalfSpace

from .units import E_STAR, RMS_FRACTION, SIDE

#: What the paper reads off its Fig. 8, of a surface of this dimension.
PAPER_DELTA_SIGMA, PAPER_DIMENSION = 1.39, 2.1


def _words_of(name: str, words: str) -> dict[str, str]:
    return {of: text for of, (_, text) in rows_of(name, "1", words).items()}


#: What is kept of every surface under every load, without a unit.
ESTIMATES = {
    **_words_of("delta_sigma_area", "Delta_sigma from A_r(s) over the resolutions at one force"),
    **_words_of("delta_sigma_box", "Delta_sigma from box counts at the finest resolution"),
    **_words_of(
        "delta_pairs", "correlation dimension of the contact domain at the finest resolution"
    ),
}


def dimension_test(recipe: Mapping[str, Any], rtol: float = 1e-6) -> xr.Dataset:
    """Delta_sigma by both estimators over surfaces, sizes, seeds and loads.

    Parameters
    ----------
    recipe : mapping
        ``dimensions`` Delta_g, ``sizes`` in nodes per side, ``seeds``, ``loads`` as values of
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
        :data:`ESTIMATES`, ``difference`` (area less box) and ``boxes_per_node`` over (dimension,
        size, seed, load); ``mean_delta_sigma_area``, ``mean_delta_sigma_box``,
        ``mean_delta_pairs`` and ``mean_difference`` over the seeds with ``_low`` and ``_high``
        (95 %, Student's t) and ``_n``; ``difference_agrees``, where zero lies in the last;
        ``light_load_delta`` (dimension) = 4 - Delta_g; ``growth`` (dimension, load), change of the
        difference with each doubling of the size, ``decade`` (dimension, size) with each decade of
        load. With a hardness the same names after ``capped_``, over (dimension, seed,
        capped_pressure).

    Notes
    -----
    If a coarser pre-fractal's domain were that of the finer one seen through coarser boxes, the
    boxes of side k s that the finest domain occupies would be as many as the nodes that touch at
    resolution k: ``boxes_per_node`` (last dimension resolution) would be 1, and the two estimators
    the same. How it goes with k is how they differ.
    """
    factors = sorted(recipe["resolutions"])
    axes = {
        "dimension": list(recipe["dimensions"]),
        "size": sorted(recipe["sizes"]),
        "seed": list(recipe["seeds"]),
        "reduced_pressure": np.unique(recipe["loads"]),
    }
    values = _uncapped(axes, factors, rtol, same_pressure=bool(recipe.get("same_pressure")))
    result = _labelled(axes, {name: values[name] for name in ESTIMATES})
    nodes, occupied = values["nodes"], values["occupied"]
    result = result.assign_coords(
        resolution=("resolution", factors, cf_attrs("1", "multiple k of the finest spacing"))
    ).assign(
        labelled(
            _OF_SURFACES,
            {
                "rms_slope": values["rms_slope"],
                "nodes": nodes,
                "boxes_per_node": occupied / np.where(nodes > 0, nodes, np.nan),
            },
        )
    )
    _add_means(result)
    add_agreement(result)
    add_mean_boxes(result)
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


_AXES = ("dimension", "size", "seed", "reduced_pressure")
_OF_SURFACES = {
    "rms_slope": (_AXES[:3], "1", "rms slope h'_rms at the finest spacing"),
    "nodes": ((*_AXES, "resolution"), "1", "nodes in contact at each resolution"),
    "boxes_per_node": (
        (*_AXES, "resolution"),
        "1",
        "boxes of side k s that the finest domain occupies over nodes in contact at k",
    ),
}


def add_mean_boxes(result: xr.Dataset) -> None:
    """Add ``mean_boxes_per_node``, over the seeds."""
    words = f"mean over seeds of {_OF_SURFACES['boxes_per_node'][2]}"
    mean = result["boxes_per_node"].mean("seed")
    result["mean_boxes_per_node"] = mean.assign_attrs(cf_attrs("1", words))


def _uncapped(
    axes: Mapping[str, Any], factors: Sequence[int], rtol: float, *, same_pressure: bool
) -> dict[str, np.ndarray]:
    """Both estimates without a hardness, over the axes, with nodes, occupied boxes and slopes."""
    shape = tuple(len(along) for along in axes.values())
    values = {name: np.full(shape, np.nan) for name in ESTIMATES}
    values |= {name: np.full((*shape, len(factors)), np.nan) for name in ("nodes", "occupied")}
    slope = np.full(shape[:3], np.nan)
    sizes = axes["size"]
    for i, j, k in np.ndindex(shape[:3]):
        dimension, size, seed = axes["dimension"][i], sizes[j], axes["seed"][k]
        surface = synthetic_surface(dimension, size, seed)
        slope[i, j, k] = slope_statistics(surface, SIDE / size)["rms_slope"]
        finer = (sizes[0] / size) ** (dimension - 2) if same_pressure else 1.0
        forces = axes["reduced_pressure"] * finer * E_STAR * slope[i, j, k] * SIDE**2
        for name, of_loads in _estimates(surface, forces, factors, rtol).items():
            values[name][i, j, k] = of_loads
    return values | {"rms_slope": slope}


def synthetic_surface(dimension: float, size: int, seed: int) -> np.ndarray:
    """Heights (size, size) of a self-affine surface of side `SIDE` without a roll-off, mm."""
    rms = RMS_FRACTION * SIDE
    return self_affine((size, size), SIDE / size, 3 - dimension, rms=rms, seed=seed)


def _estimates(
    surface: np.ndarray,
    forces: np.ndarray,
    factors: Sequence[int],
    rtol: float,
    hardness: float = np.inf,
) -> dict[str, np.ndarray | list[float]]:
    """`ESTIMATES` (load) under rising forces, ``nodes`` and ``occupied`` boxes (load, k)."""
    size = len(surface)
    spacing = SIDE / size
    nodes, occupied = np.zeros((2, len(forces), len(factors)))
    boxes, pairs = [], []
    for j, factor in enumerate(factors):
        h = prefractal(surface, factor)
        space = HalfSpace(h.shape, (factor * spacing,) * 2, E_STAR)
        where = f"synthetic surface of {size} x {size} nodes, resolution {factor}"
        solving = {"hardness": hardness, "rtol": rtol}
        states = load_steps(h, space, forces, solving, where)
        for i, state in enumerate(states):
            nodes[i, j] = np.count_nonzero(state.in_contact)
            if j == 0:
                boxes.append(dimension_of_domain(state.in_contact, spacing))
                pairs.append(correlation_dimension(state.in_contact, spacing))
                occupied[i] = box_count(state.in_contact, np.array(factors, float))
    s = xr.DataArray(spacing * np.array(factors), dims="resolution")
    area = xr.DataArray(nodes, dims=("reduced_pressure", "resolution")) * s**2
    by_area = renormalisation(s, area, xr.DataArray(forces, dims="reduced_pressure"))
    return {
        **Estimate.read(by_area, "delta_sigma").columns("delta_sigma_area"),
        **Estimate.stack(boxes).columns("delta_sigma_box"),
        **Estimate.stack(pairs).columns("delta_pairs"),
        "nodes": nodes,
        "occupied": occupied,
    }


def _capped(
    recipe: Mapping[str, Any], axes: Mapping[str, Any], factors: Sequence[int], rtol: float
) -> xr.Dataset:
    """Both estimates with a hardness, up to where the whole window yields."""
    size = recipe["capped_size"]
    loads = np.unique(recipe["capped_loads"])
    dimensions, seeds = axes["dimension"], axes["seed"]
    shape = (len(dimensions), len(seeds), len(loads))
    table = {name: np.full(shape, np.nan) for name in ESTIMATES}
    fraction = np.full(shape, np.nan)
    for i, j in np.ndindex(shape[:2]):
        surface = synthetic_surface(dimensions[i], size, seeds[j])
        slope = float(slope_statistics(surface, SIDE / size)["rms_slope"])
        hardness = recipe["hardness"] * E_STAR * slope
        values = _estimates(surface, loads * hardness * SIDE**2, factors, rtol, hardness)
        for name in ESTIMATES:
            table[name][i, j] = values[name]
        fraction[i, j] = np.asarray(values["nodes"])[:, 0] / size**2
    capped = _labelled({"dimension": dimensions, "seed": seeds, "reduced_pressure": loads}, table)
    attrs = cf_attrs("1", "real contact area A_r / A_0")
    capped["area_share"] = (("dimension", "seed", "reduced_pressure"), fraction, attrs)
    _add_means(capped)
    capped = capped.drop_vars("light_load_delta")
    names = {name: f"capped_{name}" for name in capped.data_vars}
    capped = capped.rename(names | {"reduced_pressure": "capped_pressure"})
    capped["capped_pressure"].attrs = cf_attrs("1", "F / (H A_0)")
    capped.attrs = {}
    return capped


_AXIS_WORDS = {
    "dimension": "dimension Delta_g of the surface",
    "size": "nodes per side",
    "seed": "seed of the surface",
    "reduced_pressure": "p / (E* h'_rms)",
}


def _labelled(axes: Mapping[str, Any], values: Mapping[str, np.ndarray]) -> xr.Dataset:
    """The dataset from the `ESTIMATES` of every surface and load."""
    result = labelled_dataset(
        {name: (tuple(axes), "1", words) for name, words in ESTIMATES.items()},
        values,
        coords={
            name: (name, along, cf_attrs("1", _AXIS_WORDS[name])) for name, along in axes.items()
        },
    )
    result["difference"] = result["delta_sigma_area"] - result["delta_sigma_box"]
    result["difference"].attrs = cf_attrs("1", "Delta_sigma from A_r(s) less that from box counts")
    result["light_load_delta"] = 4.0 - result["dimension"]
    result["light_load_delta"].attrs = cf_attrs("1", "Delta_sigma = 1 + H of A_r(s) at light load")
    return result


def _add_means(result: xr.Dataset) -> None:
    """Means over the seeds with their intervals, into ``result``."""
    for name in ("delta_sigma_area", "delta_sigma_box", "delta_pairs", "difference"):
        values = result[name]
        dims = tuple(dim for dim in values.dims if dim != "seed")
        mean = mean_interval(values.values, axis=values.dims.index("seed"))
        words = f"mean over seeds of {values.attrs['long_name']}"
        result.update(mean.variables(f"mean_{name}", dims, "1", words))
        result[f"mean_{name}_n"] = (dims, mean.n, cf_attrs("1", "seeds that have it"))


def add_agreement(result: xr.Dataset) -> None:
    """Add ``difference_agrees``: True if zero lies in the interval of the mean difference."""
    low, high = result["mean_difference_low"], result["mean_difference_high"]
    attrs = cf_attrs("1", "whether both estimates may be one: zero lies in the interval")
    result["difference_agrees"] = ((low <= 0) & (high >= 0)).assign_attrs(attrs)


def _add_trends(result: xr.Dataset) -> None:
    """Trend of the difference with size and load over all surfaces, stored in ``result``."""
    values = result["difference"]
    doubling, decade = np.log2(result["size"].values), np.log10(result["reduced_pressure"].values)
    by_size = values.transpose("dimension", "reduced_pressure", "size", "seed").values
    by_load = values.transpose("dimension", "size", "reduced_pressure", "seed").values
    for name, rows, x, dims, words in (
        (
            "growth",
            by_size,
            doubling,
            ("dimension", "reduced_pressure"),
            "with each doubling of the size",
        ),
        ("decade", by_load, decade, ("dimension", "size"), "with each decade of the load"),
    ):
        x = np.repeat(x, rows.shape[3])
        each = (fit_line(x, rows[index].ravel()).slope for index in np.ndindex(rows.shape[:2]))
        change = Estimate.stack(each, rows.shape[:2])
        result.update(change.variables(name, dims, "1", f"change of the difference {words}"))


def summary(result: xr.Dataset) -> str:
    """Agreement and trend of the two estimators in words, by dimension.

    Parameters
    ----------
    result : xr.Dataset
        From :func:`dimension_test`.
    """
    rows = []
    for dimension in result["dimension"].values:
        one = result.sel(dimension=dimension)
        mean, known = one["mean_difference"].values, one["mean_difference_low"].notnull().values
        if not known.any():
            rows.append(f"Delta_g = {dimension:g}: too few values to compare")
            continue
        agree = int(one["difference_agrees"].sum())
        mean = mean[known]
        rows.append(
            f"Delta_g = {dimension:g}: area less box counts is {mean.min():.2f} to "
            f"{mean.max():.2f} in the mean, zero lies in its interval at {agree} of "
            f"{int(known.sum())} sizes and loads; with size it "
            f"{_trend(one, 'growth', 'loads')}, with load it {_trend(one, 'decade', 'sizes')}"
        )
    return "; ".join(rows)


def _trend(one: xr.Dataset, name: str, of: str) -> str:
    _, low, high = Estimate.read(one, name).ends
    known = np.isfinite(low)
    if not known.any():
        return "shows no trend"
    falls, rises = int((high[known] < 0).sum()), int((low[known] > 0).sum())
    return f"falls at {falls} and rises at {rises} of {int(known.sum())} {of}"
