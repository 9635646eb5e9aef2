"""How rough a surface is, and its dimension Delta_g = 3 - H by several estimators.

H comes from the slope of the line through the logarithms of each estimator's curve
(:mod:`roughness.estimators`) over a stated range.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr

from ..core.fitting import fit_line
from ..core.intervals import t_quantile
from ..core.labels import cf_attrs
from ..core.mean_plane import without_mean_plane
from .curves import Curve
from .estimator import Estimator
from .estimators.roughness_length import roughness_length_curves
from .known_bias import HURST_GRID, POINTS, Fit, extended, slopes
from .registry import ESTIMATORS
from .spectrum_model import BAND_LIMITED

#: Default fit range in cells and in parts of the smaller side. Below 4 cells interpolation and
#: aliasing show; above an eighth of the side too few independent pairs or windows are left.
FIRST_CELLS, LAST_PART = 4, 1 / 8

#: What levelling leaves of a plane, as a part of its largest height.
FLATNESS = 1e-12

#: Cells this close to square, as a part of their side, are taken as square.
SQUARENESS = 1e-3

#: Those whose slope is H itself within 0.03 for H from 0.5 to 0.9, even without correction.
LITTLE_BIASED = tuple(name for name, of in ESTIMATORS.items() if of.little_biased)

#: Added to either end of an interval for the bias that is left: at H from 0.5 to 0.9 that of made
#: surfaces is at most twice this (roughness-length at H = 0.5), mostly below it.
BIAS_LEFT = 0.015

#: Axes a measure is taken along, and the ending of the variables that go with them.
AXES = {"both": "", "x": "_x", "y": "_y"}


def surface_dimension(
    heights: np.ndarray,
    spacing: float | tuple[float, float],
    *,
    fit_range: tuple[float, float] | None = None,
    estimators: Sequence[str] | None = None,
) -> xr.Dataset:
    """Measure the Hurst exponent and the dimension of a surface by several estimators.

    Parameters
    ----------
    heights : (ny, nx) array_like
        In mm, NaN where missing. The mean plane is removed first.
    spacing : float or (dy, dx)
        In mm. Where the two differ, the finer axis is interpolated at the coarser spacing first.
    fit_range : (float, float), optional
        Shortest and longest lag of the fits, mm; windows, prisms and wavelengths go from and to as
        much longer as they must be to see that lag (variable `fit_min`, `fit_max`). By default from
        4 cells to an eighth of the smaller side. On a surface with a roll-off length state a range
        that ends well below it (a quarter): above it there is no H.
    estimators : sequence of str, optional
        Some of `ESTIMATORS`; all by default.

    Returns
    -------
    xarray.Dataset
        On `estimator`: `hurst`, `dimension` with `_low` and `_high` (95 % interval), `hurst_x` and
        `hurst_y` with theirs (of profiles along one axis; NaN for those that have no axis),
        `slope_hurst` (H before the correction of known bias), `fit_min`, `fit_max` (mm), `n` points
        fitted. On (`estimator`, `scale`), padded with NaN: `length` (mm), `measure`, and whether it
        was `used`. NaN with `n` where a line cannot be fitted.

    Raises
    ------
    ValueError
        If the fit range is empty, or the heights are not a grid.

    Notes
    -----
    Known bias is taken off (:mod:`roughness.known_bias`): levelling takes a part of the long
    waves along with the plane, which lowers variogram and prisms by 0.1 at H = 0.9; cubes and
    islands are corrected by what they find on made surfaces. Nothing is corrected for a roll-off:
    state a range well below it.

    The interval is the wider of the regression's and the jackknife's over parts of the surface (4 x
    4 blocks; 8 strips for the spectrum), the latter widened by the estimator's `spread`, because
    the parts of one surface share its long waves; and `BIAS_LEFT` beyond either end. What is not
    known is whether the nodes are points of a finer surface, or the surface lacks waves shorter
    than two nodes, as made surfaces do: then all but cubes and islands find H too high, by up to
    0.06 at 0.3, 0.025 at 0.5 and 0.005 at 0.8. The interval spans both.
    :mod:`experiments.delta_g` measures bias, scatter and how often it holds the truth.
    """
    estimates = hurst_exponents(heights, spacing, fit_range=fit_range, estimators=estimators)
    found = list(estimates.values())
    scales = max(len(estimate.length) for estimate in found)
    on_scale = {
        name: np.full((len(found), scales), fill)
        for name, fill in (("length", np.nan), ("measure", np.nan), ("used", False))
    }
    for row, estimate in enumerate(found):
        for name, values in on_scale.items():
            values[row, : len(estimate.length)] = getattr(estimate, name)
    result = xr.Dataset(
        {name: (("estimator", "scale"), values) for name, values in on_scale.items()},
        coords={"estimator": list(estimates), "scale": np.arange(scales)},
    )
    for axis, ending in AXES.items():
        for i, end in enumerate(("", "_low", "_high")):
            result[f"hurst{ending}{end}"] = "estimator", [e.hurst[axis][i] for e in found]
    result["slope_hurst"] = "estimator", [e.slope_hurst for e in found]
    result["dimension"] = 3 - result["hurst"]
    result["dimension_low"] = 3 - result["hurst_high"]
    result["dimension_high"] = 3 - result["hurst_low"]
    fitted = result["length"].where(result["used"] & result["hurst"].notnull())
    result["fit_min"], result["fit_max"] = fitted.min("scale"), fitted.max("scale")
    result["n"] = result["used"].sum("scale")
    chosen = [ESTIMATORS[name] for name in estimates]
    for name, words, values in (
        ("length_kind", "what the length is", [e.length for e in chosen]),
        ("measure_kind", "what was measured", [e.measure for e in chosen]),
        ("measure_units", "unit of what was measured", [e.units for e in chosen]),
    ):
        result[name] = ("estimator", values, cf_attrs("1", words))
    return _described(result)


class Estimate(NamedTuple):
    """What one estimator found."""

    length: np.ndarray
    """(k,), mm."""
    measure: np.ndarray
    """(k,), NaN where it has no logarithm."""
    used: np.ndarray
    """(k,) bool: taken into the fit."""
    hurst: dict[str, tuple[float, float, float]]
    """H and the ends of its 95 % interval by axis: "both", "x" and "y"."""
    slope_hurst: float
    """H along both axes before the correction of known bias."""


def hurst_exponents(
    heights: np.ndarray,
    spacing: float | tuple[float, float],
    *,
    fit_range: tuple[float, float] | None = None,
    estimators: Sequence[str] | None = None,
) -> dict[str, Estimate]:
    """What `surface_dimension` finds, as plain numbers by estimator; same parameters and errors."""
    heights = np.asarray(heights, float)
    if heights.ndim != 2:
        raise ValueError(f"heights must be a (y, x) grid, not of shape {heights.shape}")
    heights, spacing = _on_square_cells(heights, spacing)
    if fit_range is None:  # on a small grid this is empty, and there is no dimension
        fit_range = FIRST_CELLS * spacing, LAST_PART * min(heights.shape) * spacing
    elif not 0 < fit_range[0] < fit_range[1]:
        raise ValueError(f"fit range {fit_range} mm must rise from above 0")

    levelled = without_mean_plane(heights)
    if np.nanmax(np.abs(levelled), initial=0) <= FLATNESS * np.nanmax(np.abs(heights), initial=0):
        levelled[...] = 0  # a plane but for rounding, which has no dimension
    return {
        name: _estimate(ESTIMATORS[name], levelled, spacing, fit_range)
        for name in estimators or ESTIMATORS
    }


def best_dimension(dimensions: xr.Dataset) -> tuple[float, float, float]:
    """Delta_g by the estimators with little bias (`LITTLE_BIASED`).

    Parameters
    ----------
    dimensions : xr.Dataset
        From `surface_dimension`.

    Returns
    -------
    mean, lowest, highest : float
        Their mean, and the ends of the widest of their intervals; NaN where none of them found a
        dimension.
    """
    chosen = dimensions.sel(estimator=list(LITTLE_BIASED))
    return (
        float(chosen["dimension"].mean()),
        float(chosen["dimension_low"].min()),
        float(chosen["dimension_high"].max()),
    )


def _on_square_cells(heights: np.ndarray, spacing) -> tuple[np.ndarray, float]:
    """Heights at the coarser of two spacings along both axes, and that spacing."""
    spacings = np.broadcast_to(np.asarray(spacing, float), 2)
    coarse = spacings.max()
    for axis, own in enumerate(spacings):
        if own < (1 - SQUARENESS) * coarse:
            z = np.moveaxis(heights, axis, 0)
            place = np.arange(0, len(z) - 1, coarse / own)
            before = place.astype(int)
            part = (place - before)[:, np.newaxis]
            heights = np.moveaxis((1 - part) * z[before] + part * z[before + 1], 0, axis)
    return heights, float(coarse)


def _estimate(
    estimator: Estimator, heights: np.ndarray, spacing: float, fit_range: tuple[float, float]
) -> Estimate:
    """Curve and fits of one estimator."""
    curves = estimator.curves(heights, spacing)
    length, measure = curves["both"].length, curves["both"].measure()
    shortest, longest = (estimator.factor * end for end in fit_range)
    tolerance = 1e-9 * longest  # lengths are multiples of the spacing, ends often are too
    used = (length >= shortest - tolerance) & (length <= longest + tolerance)
    measure = np.where(measure > 0, measure, np.nan)  # a flat surface has no logarithm, nor an H
    used &= np.isfinite(measure)

    side = np.sqrt(np.count_nonzero(np.isfinite(heights)))
    hurst = dict.fromkeys(AXES, (np.nan,) * 3)
    slope_hurst = np.nan
    for axis, curve in curves.items():
        slope, half = _hurst_of_slope(estimator, curve, used)
        if axis == "both":
            slope_hurst = slope
        if np.isfinite(slope):
            fit = Fit(length[used] / spacing, side, axis)
            hurst[axis] = _corrected(estimator, fit, slope, half)
    return Estimate(length, measure, used, hurst, slope_hurst)


def _corrected(
    estimator: Estimator, fit: Fit, slope: float, half: float
) -> tuple[float, float, float]:
    """H without known bias, and an interval that holds whatever the nodes stand for."""
    ends = np.array([slope, slope - half, slope + half])
    of_either = {
        nodes: extended(ends, estimator.expected_hurst(fit, nodes), HURST_GRID)
        for nodes in (BAND_LIMITED, POINTS)
    }
    every = np.concatenate(list(of_either.values()))
    return float(of_either[estimator.nodes][0]), float(every.min()), float(every.max())


def _hurst_of_slope(estimator: Estimator, curve: Curve, used: np.ndarray) -> tuple[float, float]:
    """H as the slope has it, and half of its 95 % interval."""
    measures = np.vstack([curve.measure(), curve.without_each_part()])[:, used]
    x, y = np.log(curve.length[used]), np.log(np.where(measures > 0, measures, np.nan))
    line = fit_line(x, y[0])
    of_regression = (line.slope_high - line.slope) / abs(estimator.slope_per_hurst)
    every = (slopes(x, y) - estimator.slope_at_zero) / estimator.slope_per_hurst
    without = every[1:][np.isfinite(every[1:])]
    parts = len(without)
    if not np.isfinite(of_regression) or parts < 2:
        return np.nan, np.nan
    error = np.sqrt((parts - 1) / parts * np.sum((without - without.mean()) ** 2))
    of_parts = t_quantile(parts - 1) * estimator.spread * error
    return every[0], max(of_regression, of_parts) + BIAS_LEFT


def _described(result: xr.Dataset) -> xr.Dataset:
    """The dataset with units and long names."""
    ends = {"": "", "_low": ", lower end of 95 % interval", "_high": ", upper end of 95 % interval"}
    along = {"": "", "_x": " along x", "_y": " along y"}
    for end, words in ends.items():
        for axis, where in along.items():
            result[f"hurst{axis}{end}"].attrs = cf_attrs("1", f"Hurst exponent H{where}{words}")
        result[f"dimension{end}"].attrs = cf_attrs("1", f"surface dimension Delta_g = 3 - H{words}")
    for name, units, words in (
        ("slope_hurst", "1", "Hurst exponent before the correction of known bias"),
        ("fit_min", "mm", "shortest length fitted"),
        ("fit_max", "mm", "longest length fitted"),
        ("n", "1", "points fitted"),
        ("length", "mm", "length at which the measure was taken"),
        ("measure", "see measure_units", "measured quantity"),
        ("used", "1", "taken into the fit"),
    ):
        result[name].attrs = cf_attrs(units, words)
    return result


def dimension_table(dimensions: xr.Dataset) -> dict[str, float]:
    """Range and mean of Delta_g over the estimators, as the paper states them.

    Parameters
    ----------
    dimensions : xr.Dataset
        From `surface_dimension`.

    Returns
    -------
    dict
        ``lowest``, ``highest``, ``mean`` (NaN without a fit) and ``n``, how many gave a dimension.
    """
    found = dimensions["dimension"].values
    found = found[np.isfinite(found)]
    if not found.size:
        return dict.fromkeys(("lowest", "highest", "mean"), np.nan) | {"n": 0}
    return {
        "lowest": float(found.min()),
        "highest": float(found.max()),
        "mean": float(found.mean()),
        "n": found.size,
    }


def roughness_length(heights: np.ndarray, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Rms height about the local mean plane (mm) in square windows of side b (mm): grows as b^H.

    See :func:`roughness.estimators.roughness_length.roughness_length_curves`.
    """
    curve = roughness_length_curves(np.asarray(heights, float), spacing)["both"]
    return curve.length, np.sqrt(curve.measure())


# -- statistics that the classical theories ask for ------------------------------------------------


def _mean_square(differences) -> float:
    """Mean square of all finite values in several arrays; NaN where there is none."""
    total, count = 0.0, 0
    for values in differences:
        known = values[np.isfinite(values)]
        total += np.dot(known, known)
        count += known.size
    return total / count if count else np.nan


def slope_statistics(heights: np.ndarray, spacing: float | tuple[float, float]) -> xr.Dataset:
    """Heights, slopes and spectral moments of a surface at its own resolution.

    Parameters
    ----------
    heights : (ny, nx) array_like
        In mm, NaN where missing; the mean plane is removed first.
    spacing : float or (dy, dx)
        In mm.

    Returns
    -------
    xarray.Dataset
        Scalars: `rms_height` (mm), `z2_x`, `z2_y` (rms slope of profiles), `rms_slope` (h'_rms, of
        the surface), and the moments of profiles `m0` (mm2), `m2` (1), `m4` (mm-2), means of x
        and y. Slopes are differences of neighbours, so all but the height depend on the spacing.

    Notes
    -----
    Z2 as in Tse & Cruden, Int. J. Rock Mech. 16 (1979) 303; moments as in McCool, Wear 107 (1986)
    37: mean squares of height, slope and second derivative of a profile.
    """
    z = without_mean_plane(heights)
    spacings = np.broadcast_to(np.asarray(spacing, float), 2)
    m0 = _mean_square([z])
    z2_y, z2_x = (np.sqrt(_mean_square([np.diff(z, axis=a)])) / d for a, d in enumerate(spacings))
    m4 = np.mean([_mean_square([np.diff(z, 2, axis=a)]) / d**4 for a, d in enumerate(spacings)])
    values = {
        "rms_height": (np.sqrt(m0), "mm", "root mean square height"),
        "z2_x": (z2_x, "1", "rms slope of profiles along x"),
        "z2_y": (z2_y, "1", "rms slope of profiles along y"),
        "rms_slope": (np.hypot(z2_x, z2_y), "1", "rms slope of the surface"),
        "m0": (m0, "mm2", "mean square height"),
        "m2": ((z2_x**2 + z2_y**2) / 2, "1", "mean square slope of profiles"),
        "m4": (m4, "mm-2", "mean square second derivative of profiles"),
    }
    return xr.Dataset(
        {
            name: ((), value, {"units": units, "long_name": words})
            for name, (value, units, words) in values.items()
        }
    )
