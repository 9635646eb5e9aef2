"""Bias, scatter and coverage of the estimators of Delta_g, on synthetic surfaces of known H.

Each surface is measured as a scan would be: over the default range, with the interval of every
scan, and with the search for a roll-off. An interval is honest if it holds
the exponent of the synthesis in most cases.
"""

from collections.abc import Mapping
from itertools import product
from typing import Any

import numpy as np
import xarray as xr

from fractalcontact.core.datasets import labelled_dataset, titled
from fractalcontact.core.estimate import Estimate
from fractalcontact.core.intervals import mean_interval
from fractalcontact.core.labels import cf_attrs
from fractalcontact.roughness.curves import ratio
from fractalcontact.roughness.dimension import measured_exponents
from fractalcontact.roughness.fit_range import FIRST_CELLS, LAST_PART
from fractalcontact.roughness.recommended import RECOMMENDED
from fractalcontact.roughness.registry import ESTIMATORS
from fractalcontact.surface.synthesis import self_affine

from .units import SPACING

#: Root mean square height, mm: H does not depend on it.
RMS = 1.0

#: Least H of the surfaces that the verdicts rest on: those of natural joints are as smooth.
FROM_HURST = 0.5
#: Largest bias of at least three estimators at the H of the verdicts, and least fraction of the
#: intervals that hold H.
TOLERATED, PROMISED = 0.03, 0.9


@titled("estimators of Delta_g on surfaces of known dimension")
def estimator_bias(recipe: Mapping[str, Any]) -> xr.Dataset:
    """Bias, scatter and coverage of every estimator on synthetic surfaces.

    Parameters
    ----------
    recipe : mapping
        ``hurst`` (values of H), ``sizes`` (nodes per side), ``seeds`` and, if any, ``roll_offs``:
        wavelengths of the roll-off as fractions of the side, None for a surface without.

    Returns
    -------
    xr.Dataset
        ``found``, ``found_low`` and ``found_high``: H and its 95 % interval over (estimator, hurst,
        size, roll_off, seed), with the coordinate ``roll_off`` infinite where there is none. Over
        the same without the seed: ``bias`` (mean of H found less H) with ``_low`` and ``_high``
        (95 %, Student's t over the seeds), ``slope_bias`` of the slopes before known bias is taken
        off, ``scatter`` (standard deviation between surfaces), ``rms_error``, ``half_width`` (mean
        of the intervals' halves), ``coverage`` (fraction of the intervals that hold H) and
        ``fitted`` (fraction of surfaces with one: a short roll-off leaves too few lags). Over
        (hurst, size, roll_off): ``roll_off_seen``, fraction of surfaces. Over estimator, for H >=
        0.5: ``worst_bias``, ``overall_error`` (rms) and ``min_coverage``. Attributes
        ``first_cells`` and ``last_part``: default range; ``recommended``: estimator;
        ``tolerated_bias`` and ``promised_coverage``: what is aimed at.
    """
    exponents, sizes, seeds = (np.unique(recipe[key]) for key in ("hurst", "sizes", "seeds"))
    stated = [np.inf if part is None else float(part) for part in recipe.get("roll_offs", [None])]
    roll_offs = np.unique(stated)[::-1]
    shape = len(exponents), len(sizes), len(roll_offs), len(seeds)
    rows = [_measured(*surface) for surface in product(exponents, sizes, roll_offs, seeds)]
    estimates = np.stack([row for row, _ in rows], axis=-1).reshape(4, len(ESTIMATORS), *shape)
    seen = np.reshape([seen for _, seen in rows], shape)
    coords = {
        "estimator": list(ESTIMATORS),
        "hurst": ("hurst", exponents, cf_attrs("1", "Hurst exponent of the surfaces")),
        "size": ("size", sizes, cf_attrs("1", "nodes per side")),
        "roll_off": (
            "roll_off",
            roll_offs,
            cf_attrs("1", "wavelength of the roll-off over the side, infinite without one"),
        ),
        "seed": ("seed", seeds, cf_attrs("1", "seed of the surface")),
    }
    return _with_verdicts(_judged(estimates, seen, coords))


def _measured(hurst: float, nodes: int, part: float, seed: int) -> tuple[np.ndarray, bool]:
    """H, the ends of its interval and the H of the slope (4, estimators) of one surface; whether it
    rolls off.
    """
    roll_off = part * nodes * SPACING if np.isfinite(part) else None
    surface = self_affine(
        (nodes, nodes), SPACING, hurst, rms=RMS, seed=int(seed), roll_off=roll_off
    )
    curves, fit_range = measured_exponents(surface, SPACING)
    numbers = [(*curve.hurst["both"].ends, curve.slope_hurst) for curve in curves.values()]
    return np.transpose(numbers), np.isfinite(fit_range.roll_off.value)


def _judged(estimates: np.ndarray, seen: np.ndarray, coords: Mapping[str, Any]) -> xr.Dataset:
    """Dataset of H, the ends of its interval, the slopes' H, and roll-offs seen."""
    dims = tuple(coords)
    *ends, slope = estimates
    value, low, high = ends
    truth = coords["hurst"][1][:, np.newaxis, np.newaxis, np.newaxis]
    bias = mean_interval(value - truth, axis=-1)
    covered = (low <= truth) & (truth <= high)
    over = dims[:-1]
    n = np.isfinite(value).sum(axis=-1)
    n = np.where(n > 1, n, np.nan)
    table = {
        "slope_bias": (over, "1", "mean bias of H before known bias is taken off"),
        "scatter": (over, "1", "standard deviation of H between surfaces"),
        "rms_error": (over, "1", "root mean square error of H"),
        "half_width": (over, "1", "half of the 95 % interval, mean"),
        "coverage": (over, "1", "fraction of intervals that hold H"),
        "fitted": (over, "1", "fraction of surfaces with enough lags for a fit"),
        "roll_off_seen": (over[1:], "1", "fraction of surfaces on which a roll-off is seen"),
    }
    values = {
        "slope_bias": mean_interval(slope - truth, axis=-1).value,
        "scatter": np.sqrt(_mean((value - _mean(value)[..., np.newaxis]) ** 2) * n / (n - 1)),
        "rms_error": np.sqrt(_mean((value - truth) ** 2)),
        "half_width": _mean(high - low) / 2,
        "coverage": _mean(np.where(np.isfinite(value), covered, np.nan)),
        "fitted": np.isfinite(value).mean(axis=-1),
        "roll_off_seen": seen.mean(axis=-1),
    }
    result = labelled_dataset(table, values, coords=coords)
    estimate = Estimate(value, low, high)
    result.update(estimate.variables("found", dims, "1", "Hurst exponent by the estimator"))
    result.update(bias.variables("bias", over, "1", "mean bias of H"))
    return result


def _mean(values: np.ndarray) -> np.ndarray:
    """Means over the seeds with a value; NaN without any."""
    finite = np.isfinite(values)
    return ratio(np.where(finite, values, 0.0).sum(axis=-1), finite.sum(axis=-1))


def _with_verdicts(result: xr.Dataset) -> xr.Dataset:
    """Table with numbers over all natural surfaces, (estimator)."""
    natural = result.where(result["hurst"] >= FROM_HURST)
    all_surfaces = ["hurst", "size", "roll_off"]
    of = f"H from {FROM_HURST:g}"
    table = {
        "worst_bias": f"largest mean bias, {of}",
        "overall_error": f"root mean square error of H, {of}",
        "min_coverage": f"smallest coverage of any H, size and roll-off, {of}",
    }
    values: dict[str, Any] = {
        "worst_bias": abs(natural["bias"]).max(all_surfaces),
        "overall_error": np.sqrt((natural["rms_error"] ** 2).mean(all_surfaces)),
        "min_coverage": natural["coverage"].min(all_surfaces),
    }
    for name, words in table.items():
        result[name] = values[name].assign_attrs(cf_attrs("1", words))
    result.attrs = {
        "tolerated_bias": TOLERATED,
        "promised_coverage": PROMISED,
        "first_cells": FIRST_CELLS,
        "last_part": LAST_PART,
        "from_hurst": FROM_HURST,
        "recommended": RECOMMENDED,
    }
    return result
