"""Surface dimension Delta_g = 3 - H by several estimators, and roughness statistics.

H comes from the slope of the line through the logarithms of each estimator's curve
(:mod:`roughness.estimators`) over a stated range.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from ..core.datasets import labelled, labelled_dataset
from ..core.estimate import NO_ESTIMATE, Estimate
from ..core.fitting import fit_line
from ..core.intervals import t_quantile
from ..core.mean_plane import without_mean_plane
from ..core.per_curve import stacked
from ..core.ranges import within
from .curves import Curve, jackknife_standard_error
from .estimator import Estimator
from .fit_range import FitRange, choose_fit_range
from .known_bias import HURST_GRID, POINTS, Fit, extended, slopes
from .recommended import recommended_variables, variables_of_all
from .registry import ESTIMATORS
from .roll_off import RollOff
from .spectrum_model import BAND_LIMITED

#: Largest remainder of a plane after levelling, as a fraction of its largest height.
FLATNESS = 1e-12

#: Largest difference of the sides of a cell, as a fraction, that is taken as square.
SQUARENESS = 1e-3

#: Remaining bias, added to either end of an interval: at H from 0.5 to 0.9 on synthetic surfaces it
#: is at most twice this (roughness-length at H = 0.5), mostly below it.
BIAS_LEFT = 0.015

#: Bounds of the intervals of H: beyond the last exponents of the tables a curve determines little.
FARTHEST = (-0.5, 1.5)

#: Axes of a measure with the endings of its variables' names and long names.
AXES = {"both": ("", ""), "x": ("_x", " along x"), "y": ("_y", " along y")}


def surface_dimension(
    heights: np.ndarray,
    spacing: float | tuple[float, float],
    *,
    fit_range: tuple[float, float] | FitRange | None = None,
    estimators: Sequence[str] | None = None,
    known_dimension: float = np.nan,
) -> xr.Dataset:
    """Hurst exponent and dimension Delta_g of a surface by several estimators.

    Parameters
    ----------
    heights : (ny, nx) array_like
        In mm, NaN where missing. The mean plane is removed first.
    spacing : float or (dy, dx)
        In mm. Where the two differ, the finer axis is interpolated at the coarser spacing first.
    fit_range : (float, float) or FitRange, optional
        Shortest and longest lag of the fits, mm; windows, prisms and wavelengths go from and to as
        much longer as they must be to see that lag (variable `fit_min`, `fit_max`). By default from
        4 cells to an eighth of the smaller side, or to a quarter of a roll-off that is seen: see
        :func:`roughness.fit_range.choose_fit_range`. A roll-off is looked for whatever the range,
        unless a FitRange states it.
    estimators : sequence of str, optional
        Some of `ESTIMATORS`; all by default.
    known_dimension : float, optional
        Delta_g of a synthetic surface, stored with the estimates.

    Returns
    -------
    xarray.Dataset
        On `estimator`: `hurst`, `dimension` with `_low` and `_high` (95 % interval), `hurst_x` and
        `hurst_y` with theirs (of profiles along one axis; NaN for those that have no axis),
        `fit_min`, `fit_max` (mm), `n` points
        fitted. On (`estimator`, `scale`), padded with NaN: `length` (mm), `measure`, and whether it
        was `used`. NaN with `n` where a line cannot be fitted. Of the surface: `roll_off` with its
        interval (mm; infinite where none is seen, `roll_off_low` then the shortest not excluded),
        the lags `range_min` and `range_max` and `range_reason`; the `recommended` estimator with
        its `reason`, `recommended_dimension` with its interval, or `no_dimension`, the reason
        (:func:`roughness.recommended.recommended_variables`); `known_dimension`; of all
        estimators together the counts of :func:`roughness.recommended.variables_of_all`.

    Raises
    ------
    ValueError
        If the fit range is empty, or the heights are not a grid.

    Notes
    -----
    Known bias is taken off (:mod:`roughness.known_bias`): levelling takes a part of the long
    waves along with the plane, which lowers variogram and prisms by 0.1 at H = 0.9; cubes and
    islands are corrected by their mean on synthetic surfaces. Where the surface rolls off, a part
    of the long waves is missing that variogram and prisms feel far below it (0.15 at H = 0.8 over
    lags up to a quarter of it): the effect of the seen roll-off is taken off too.

    The interval is the wider of the regression's and the jackknife's over parts of the surface (4 x
    4 blocks; 8 strips for the spectrum), the latter widened by the estimator's `spread`, because
    the parts of one surface share its long waves; and `BIAS_LEFT` beyond either end. It spans the
    roll-offs and their shapes that cannot be excluded. It also spans two samplings that heights
    alone do not separate: nodes that are points of a finer surface, and a surface that lacks waves
    shorter than two nodes, as synthetic surfaces do. In the second case all but cubes and islands
    give H too high, by up to 0.06 at 0.3, 0.025 at 0.5 and 0.005 at 0.8, and twice that from lags
    of two cells. :mod:`experiments.delta_g` measures bias, scatter and coverage of the interval.
    """
    estimates, chosen_range = measured_exponents(
        heights, spacing, fit_range=fit_range, estimators=estimators
    )
    rows = [_row(ESTIMATORS[name], estimate) for name, estimate in estimates.items()]
    values = {
        "roll_off_shape": chosen_range.roll_off.shape,
        "range_min": chosen_range.shortest,
        "range_max": chosen_range.longest,
        "range_reason": chosen_range.reason,
        "known_dimension": known_dimension,
    }
    words = "wavelength above which the spectrum is flat"
    result = xr.Dataset(
        {
            **stacked(rows, _OF_ESTIMATOR, ("estimator",), (len(rows),)),
            **labelled(_OF_SURFACE, values),
            **chosen_range.roll_off.variables("roll_off", (), "mm", words),
        },
        coords={"estimator": list(estimates)},
    )
    result = result.assign_coords(scale=np.arange(result.sizes["scale"]))
    return result.assign(recommended_variables(result) | variables_of_all(result))


#: Variables of each estimator: unit, long name, dimensions of arrays.
_OF_ESTIMATOR = {
    "length": ("mm", "length at which the measure was taken", "scale"),
    "measure": ("see measure_units", "measured quantity", "scale"),
    "used": ("1", "taken into the fit", "scale"),
    "fit_min": ("mm", "shortest length fitted"),
    "fit_max": ("mm", "longest length fitted"),
    "n": ("1", "points fitted"),
    "length_kind": ("1", "kind of length"),
    "measure_units": ("1", "unit of what was measured"),
    **{f"hurst{ending}": ("1", f"Hurst exponent H{along}") for ending, along in AXES.values()},
    "dimension": ("1", "surface dimension Delta_g = 3 - H"),
}
_OF_SURFACE = {
    "roll_off_shape": ((), "1", "form of the spectrum about it: sharp, or smooth as von Karman's"),
    "range_min": ((), "mm", "shortest lag of the fits"),
    "range_max": ((), "mm", "longest lag of the fits"),
    "range_reason": ((), "1", "why this range"),
    "known_dimension": ((), "1", "known Delta_g of a synthetic surface"),
}


def _row(estimator: Estimator, estimate: "MeasuredCurve") -> dict[str, Any]:
    """Values of :data:`_OF_ESTIMATOR` by one estimator."""
    hurst = estimate.hurst
    fitted = estimate.length[estimate.used] if hurst["both"].known else np.array([np.nan])
    return {
        "length": estimate.length,
        "measure": estimate.measure,
        "used": estimate.used,
        "fit_min": fitted.min(),
        "fit_max": fitted.max(),
        "n": estimate.used.sum(),
        "length_kind": estimator.length,
        "measure_units": estimator.units,
        **{f"hurst{ending}": hurst[axis] for axis, (ending, _) in AXES.items()},
        "dimension": hurst["both"].mapped(lambda exponent: 3 - exponent, falling=True),
    }


class MeasuredCurve(NamedTuple):
    """Curve and Hurst exponent by one estimator."""

    length: np.ndarray
    """Lengths (k,), mm."""
    measure: np.ndarray
    """Measure (k,), NaN where it has no logarithm."""
    used: np.ndarray
    """Lengths that the fit takes, (k,) bool."""
    hurst: dict[str, Estimate]
    """H by axis: "both", "x" and "y"."""
    slope_hurst: float
    """H along both axes before the correction of known bias."""


def measured_exponents(
    heights: np.ndarray,
    spacing: float | tuple[float, float],
    *,
    fit_range: tuple[float, float] | FitRange | None = None,
    estimators: Sequence[str] | None = None,
) -> tuple[dict[str, MeasuredCurve], FitRange]:
    """Curve and Hurst exponent by estimator, and the range of the fits.

    Parameters and errors are those of :func:`surface_dimension`.
    """
    heights = np.asarray(heights, float)
    if heights.ndim != 2:
        raise ValueError(f"heights must be a (y, x) grid, not of shape {heights.shape}")
    heights, spacing = on_square_cells(heights, spacing)
    levelled = without_mean_plane(heights)
    if np.nanmax(np.abs(levelled), initial=0) <= FLATNESS * np.nanmax(np.abs(heights), initial=0):
        levelled[...] = 0  # a plane but for rounding, which has no dimension
    if isinstance(fit_range, FitRange):
        chosen = fit_range
    else:
        chosen = choose_fit_range(levelled, spacing, fit_range)
    return {
        name: _estimate(ESTIMATORS[name], levelled, spacing, chosen)
        for name in (ESTIMATORS if estimators is None else estimators)
    }, chosen


def on_square_cells(
    heights: np.ndarray, spacing: float | tuple[float, ...]
) -> tuple[np.ndarray, float]:
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
    estimator: Estimator, heights: np.ndarray, spacing: float, fit_range: FitRange
) -> MeasuredCurve:
    """Curve and fits of one estimator."""
    curves = estimator.curves(heights, spacing)
    length, measure = curves["both"].length, curves["both"].measure()
    shortest, longest = (estimator.factor * end for end in fit_range[:2])
    used = within(length, shortest, longest)
    measure = np.where(measure > 0, measure, np.nan)  # a flat surface has no logarithm, nor an H
    used &= np.isfinite(measure)

    side = np.sqrt(np.count_nonzero(np.isfinite(heights)))
    hurst = dict.fromkeys(AXES, NO_ESTIMATE)
    slope_hurst = np.nan
    for axis, curve in curves.items():
        slope, half = _hurst_of_slope(estimator, curve, used)
        if axis == "both":
            slope_hurst = slope
        if np.isfinite(slope):
            fit = Fit(length[used] / spacing, side, axis)
            roll_off = fit_range.roll_off.scaled(1 / spacing)
            hurst[axis] = _corrected(estimator, fit, slope, half, roll_off)
    return MeasuredCurve(length, measure, used, hurst, slope_hurst)


def _corrected(
    estimator: Estimator, fit: Fit, slope: float, half: float, roll_off: RollOff
) -> Estimate:
    """H without known bias; its interval covers both kinds of nodes and every roll-off."""
    ends = np.array([slope, slope - half, slope + half])
    of_each = {
        (nodes, of): extended(
            ends,
            estimator.expected_hurst(fit._replace(roll_off=of[1], shape=of[0]), nodes),
            HURST_GRID,
        )
        for nodes in (BAND_LIMITED, POINTS)
        for of in roll_off.cases()
    }
    estimates = np.clip(np.concatenate(list(of_each.values())), *FARTHEST)
    value = float(of_each[estimator.nodes, roll_off.cases()[0]][0])
    return Estimate(value, float(min(estimates.min(), value)), float(max(estimates.max(), value)))


def _hurst_of_slope(estimator: Estimator, curve: Curve, used: np.ndarray) -> tuple[float, float]:
    """H from the slope, and half of its 95 % interval."""
    measures = np.vstack([curve.measure(), curve.without_each_part()])[:, used]
    x, y = np.log(curve.length[used]), np.log(np.where(measures > 0, measures, np.nan))
    slope = fit_line(x, y[0]).slope
    of_regression = (slope.high - slope.value) / abs(estimator.slope_per_hurst)
    estimates = (slopes(x, y) - estimator.slope_at_zero) / estimator.slope_per_hurst
    without = estimates[1:][np.isfinite(estimates[1:])]
    parts = len(without)
    if not np.isfinite(of_regression) or parts < 2:
        return np.nan, np.nan
    of_parts = t_quantile(parts - 1) * estimator.spread * jackknife_standard_error(without)
    return estimates[0], max(of_regression, of_parts) + BIAS_LEFT


# -- statistics that the classical theories ask for ------------------------------------------------


def _mean_square(differences) -> float:
    """Mean square of all finite values in several arrays; NaN without any."""
    total, count = 0.0, 0
    for values in differences:
        finite = values[np.isfinite(values)]
        total += np.dot(finite, finite)
        count += finite.size
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
        "rms_height": np.sqrt(m0),
        "z2_x": z2_x,
        "z2_y": z2_y,
        "rms_slope": np.hypot(z2_x, z2_y),
        "m0": m0,
        "m2": (z2_x**2 + z2_y**2) / 2,
        "m4": m4,
    }
    return labelled_dataset(_STATISTICS, values)


_STATISTICS = {
    "rms_height": ((), "mm", "root mean square height"),
    "z2_x": ((), "1", "rms slope of profiles along x"),
    "z2_y": ((), "1", "rms slope of profiles along y"),
    "rms_slope": ((), "1", "rms slope of the surface"),
    "m0": ((), "mm2", "mean square height"),
    "m2": ((), "1", "mean square slope of profiles"),
    "m4": ((), "mm-2", "mean square second derivative of profiles"),
}
