"""Bias, scatter and coverage of the estimators of Delta_g, on synthetic surfaces of known H.

Each surface is measured as a scan would be: over the default range, with the interval every scan
gets. An interval is honest if it holds the exponent of the synthesis in most cases.
"""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import xarray as xr

from ..core.intervals import INTERVAL, mean_interval
from ..core.labels import cf_attrs
from ..roughness.dimension import FIRST_CELLS, LAST_PART, hurst_exponents
from ..roughness.registry import ESTIMATORS
from ..surface.synthesis import self_affine
from .units import SPACING

#: H does not depend on the unit of height.
RMS = 1.0  # mm

#: Verdicts are about surfaces at least this smooth, as those of natural joints are.
FROM_HURST = 0.5


def estimator_bias(recipe: Mapping[str, Any]) -> xr.Dataset:
    """Bias, scatter and coverage of every estimator on synthetic surfaces.

    Parameters
    ----------
    recipe : mapping
        ``hurst`` (values of H), ``sizes`` (nodes per side) and ``seeds``.

    Returns
    -------
    xr.Dataset
        ``found``, ``found_low`` and ``found_high``: H and its 95 % interval over (estimator, hurst,
        size, seed). Over (estimator, hurst, size): ``bias`` (mean of H found less H) with ``_low``
        and ``_high`` (95 %, Student's t over the seeds), ``slope_bias`` of the slopes before known
        bias is taken off, ``scatter`` (standard deviation between surfaces), ``half_width`` (mean
        of the intervals' halves) and ``coverage`` (fraction of the intervals that hold H, of all
        seeds). ``worst_bias`` and ``mean_coverage`` over estimator, for H >= 0.5: largest |bias| of
        H and size, and mean coverage. Attributes ``first_cells`` and ``last_part``: default range.
    """
    exponents, sizes, seeds = (np.unique(recipe[key]) for key in ("hurst", "sizes", "seeds"))
    names = list(ESTIMATORS)
    estimates = np.full((4, len(names), len(exponents), len(sizes), len(seeds)), np.nan)
    for (i, hurst), (j, nodes), (k, seed) in _numbered(exponents, sizes, seeds):
        surface = self_affine((nodes, nodes), SPACING, hurst, rms=RMS, seed=int(seed))
        for n, estimate in enumerate(hurst_exponents(surface, SPACING).values()):
            estimates[:, n, i, j, k] = *estimate.hurst["both"], estimate.slope_hurst
    return _judged(estimates, names, exponents, sizes, seeds)


def _numbered(*values: np.ndarray) -> Iterator[list[tuple[int, Any]]]:
    """Every combination of the values, each value with its place."""
    grids = np.meshgrid(*(np.arange(len(v)) for v in values), indexing="ij")
    for places in zip(*(grid.ravel() for grid in grids), strict=True):
        yield [(place, v[place]) for place, v in zip(places, values, strict=True)]


def _judged(
    estimates: np.ndarray,
    names: list[str],
    exponents: np.ndarray,
    sizes: np.ndarray,
    seeds: np.ndarray,
) -> xr.Dataset:
    """The dataset from H, the ends of its interval and the slopes' H, the first axis."""
    dims = ("estimator", "hurst", "size", "seed")
    value, low, high, slope = estimates
    result = xr.Dataset(
        {
            f"found{end}": (dims, values, cf_attrs("1", f"Hurst exponent by the estimator{words}"))
            for (end, words), values in zip(INTERVAL.items(), (value, low, high), strict=True)
        },
        coords={
            "estimator": names,
            "hurst": ("hurst", exponents, cf_attrs("1", "Hurst exponent of the surfaces")),
            "size": ("size", sizes, cf_attrs("1", "nodes per side")),
            "seed": ("seed", seeds, cf_attrs("1", "seed of the surface")),
        },
    )
    truth = exponents[:, np.newaxis, np.newaxis]
    bias = mean_interval(value - truth, axis=-1)
    half = (result["found_high"] - result["found_low"]).mean("seed") / 2
    covered = (low <= truth) & (truth <= high)
    over = dims[:3]
    for (end, words), values in zip(INTERVAL.items(), bias[:3], strict=True):
        result[f"bias{end}"] = (over, values, cf_attrs("1", f"mean bias of H{words}"))
    result["slope_bias"] = (
        over,
        mean_interval(slope - truth, axis=-1).value,
        cf_attrs("1", "mean bias of H before known bias is taken off"),
    )
    result["scatter"] = result["found"].std("seed", ddof=1)
    result["scatter"].attrs = cf_attrs("1", "standard deviation of H between surfaces")
    result["half_width"] = half.assign_attrs(cf_attrs("1", "half of the 95 % interval, mean"))
    words = "fraction of intervals that hold H"
    result["coverage"] = (over, covered.mean(axis=-1), cf_attrs("1", words))
    natural = result.where(result["hurst"] >= FROM_HURST)
    of_natural = f"H from {FROM_HURST:g}"
    result["worst_bias"] = abs(natural["bias"]).max(["hurst", "size"])
    result["worst_bias"].attrs = cf_attrs("1", f"largest mean bias of all sizes, {of_natural}")
    result["mean_coverage"] = natural["coverage"].mean(["hurst", "size"])
    result["mean_coverage"].attrs = cf_attrs("1", f"{words}, {of_natural}")
    result.attrs = {"first_cells": FIRST_CELLS, "last_part": LAST_PART, "from_hurst": FROM_HURST}
    return result
