"""How rough a surface is, and its dimension Delta_g = 3 - H by several estimators.

Each estimator measures a quantity that grows as a known power of a length on a self-affine
surface; H comes from the slope of the line through its logarithms over a stated range. All of them
work on surfaces with missing cells and any outline: they use what is complete at each length.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import scipy.fft
import xarray as xr

from .fitting import fit_line, without_mean_plane

#: Lengths measured in each doubling.
LENGTHS_PER_OCTAVE = 4

#: Default fit range in cells and in parts of the smaller side. Below 4 cells interpolation and
#: aliasing show; above an eighth of the side too few independent pairs or windows are left.
FIRST_CELLS, LAST_PART = 4, 1 / 8

#: What levelling leaves of a plane, as a part of its largest height.
FLATNESS = 1e-12

#: Cells this close to square, as a part of their side, are taken as square.
SQUARENESS = 1e-3

#: A window counts where at least this part of it was measured.
WINDOW_COVER = 0.9

#: A profile segment must hold this many points for a spectrum to be worth taking.
SHORTEST_SEGMENT = 32


class Estimator(NamedTuple):
    """One way of measuring H."""

    curve: Callable[[np.ndarray, float], tuple[np.ndarray, np.ndarray]]
    """Takes heights and spacing in mm; gives lengths in mm and the measure at each."""
    slope_per_hurst: float
    slope_at_zero: float
    """d log(measure) / d log(length) = slope_at_zero + slope_per_hurst H."""
    length: str
    measure: str
    units: str
    factor: float
    """The fit range, stated as a lag, is this many times longer for the estimator's own length."""


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
        On `estimator`: `hurst`, `dimension` with `_low` and `_high` (95 % interval of the
        regression, which knows nothing of the scatter between specimens), `fit_min`, `fit_max`
        (mm), `n` points fitted. On (`estimator`, `scale`), padded with NaN: `length` (mm),
        `measure`, and whether it was `used`. NaN with `n` where a line cannot be fitted.

    Raises
    ------
    ValueError
        If the fit range is empty, or the heights are not a grid.

    Notes
    -----
    Known bias, mean over 20 made surfaces of 512 x 512 (second value: roll-off of 5 mm on 20 mm,
    fitted up to a quarter of it): variogram and triangular prism are low by 0.01 (0.07) at H = 0.5,
    0.07 (0.19) at 0.8 and 0.12 (0.25) at 0.9, because what lies beyond the range, taken off with
    the plane or cut by the roll-off, was part of their growth. The other three stay within 0.04.
    The scatter of one surface's H about the mean was 0.02-0.03, more than its regression interval.
    """
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
    chosen = {name: ESTIMATORS[name] for name in estimators or ESTIMATORS}
    results = [_estimate(e, levelled, spacing, fit_range) for e in chosen.values()]
    result = xr.concat(results, "estimator", join="outer", coords="minimal", compat="override")
    result["estimator"] = list(chosen)
    result["used"] = result["used"].fillna(False).astype(bool)
    for name, words, values in (
        ("length_kind", "what the length is", [e.length for e in chosen.values()]),
        ("measure_kind", "what was measured", [e.measure for e in chosen.values()]),
        ("measure_units", "unit of what was measured", [e.units for e in chosen.values()]),
    ):
        result[name] = ("estimator", values, {"units": "1", "long_name": words})
    return _described(result)


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
) -> xr.Dataset:
    """Curve, fit and dimension by one estimator."""
    length, measure = estimator.curve(heights, spacing)
    measure = np.where(measure > 0, measure, np.nan)  # a flat surface has no logarithm, nor an H
    shortest, longest = (estimator.factor * end for end in fit_range)
    tolerance = 1e-9 * longest  # lengths are multiples of the spacing, ends often are too
    used = (length >= shortest - tolerance) & (length <= longest + tolerance)
    used &= np.isfinite(measure)

    line = fit_line(np.log(length[used]), np.log(measure[used]))
    hurst, *ends = (
        (slope - estimator.slope_at_zero) / estimator.slope_per_hurst
        for slope in (line.slope, line.slope_low, line.slope_high)
    )
    low, high = sorted(ends)
    return xr.Dataset(
        {
            "hurst": hurst,
            "hurst_low": low,
            "hurst_high": high,
            "dimension": 3 - hurst,
            "dimension_low": 3 - high,
            "dimension_high": 3 - low,
            "fit_min": np.exp(line.x_min),
            "fit_max": np.exp(line.x_max),
            "n": line.n,
            "length": ("scale", length),
            "measure": ("scale", measure),
            "used": ("scale", used),
        },
        coords={"scale": np.arange(length.size)},
    )


def _described(result: xr.Dataset) -> xr.Dataset:
    """The dataset with units and long names."""
    interval = {
        "_low": ", lower end of 95 % interval",
        "_high": ", upper end of 95 % interval",
        "": "",
    }
    for ending, words in interval.items():
        result[f"hurst{ending}"].attrs = {"units": "1", "long_name": f"Hurst exponent H{words}"}
        result[f"dimension{ending}"].attrs = {
            "units": "1",
            "long_name": f"surface dimension Delta_g = 3 - H{words}",
        }
    result["fit_min"].attrs = {"units": "mm", "long_name": "shortest length fitted"}
    result["fit_max"].attrs = {"units": "mm", "long_name": "longest length fitted"}
    result["n"].attrs = {"units": "1", "long_name": "points fitted"}
    result["length"].attrs = {"units": "mm", "long_name": "length at which the measure was taken"}
    result["measure"].attrs = {"long_name": "measured quantity", "units": "see measure_units"}
    result["used"].attrs = {"units": "1", "long_name": "taken into the fit"}
    return result


# -- estimators ------------------------------------------------------------------------------------


def variogram(heights: np.ndarray, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Mean square height difference (mm2) over lags along x and y (mm): grows as h^(2H)."""
    lags = _lengths(1, min(heights.shape) // 2)
    return lags * spacing, np.array(
        [_mean_square(z[lag:] - z[:-lag] for z in (heights, heights.T)) for lag in lags]
    )


def second_differences(heights: np.ndarray, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Mean square second difference (mm2) over lags along x and y (mm): grows as h^(2H).

    Blind to any plane, and free of the variogram's bias at high H (Kent & Wood, J. R. Stat. Soc. B
    59 (1997) 679).
    """
    lags = _lengths(1, min(heights.shape) // 4)
    return lags * spacing, np.array(
        [
            _mean_square(
                z[2 * lag :] - 2 * z[lag:-lag] + z[: -2 * lag] for z in (heights, heights.T)
            )
            for lag in lags
        ]
    )


def roughness_length(heights: np.ndarray, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Rms height about the local mean plane (mm) in square windows of side b (mm): grows as b^H.

    Malinverno, Geophys. Res. Lett. 17 (1990) 1953. Windows tile the middle of the grid; one that is
    less than `WINDOW_COVER` measured is left out.
    """
    sides = _lengths(4, min(heights.shape))
    return sides * spacing, np.array([_windows_rms(heights, side) for side in sides])


def power_spectrum(heights: np.ndarray, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Mean profile spectrum C(q) (mm3) along x and y against wavelength (mm): grows as l^(1 + 2H).

    Welch's method: unbroken segments of one length, as long as a quarter of the complete ones
    allows, each detrended and tapered (Hann); the mean is averaged in bins of equal ratio.
    """
    segments = _unbroken_segments(heights)
    n = segments.shape[1]
    if n == 0:
        return np.empty(0), np.empty(0)
    # Hann's side lobes fall as q^-6: no leakage from the long waves into q^-(1 + 2H).
    taper = np.hanning(n + 1)[:-1]
    transform = scipy.fft.rfft(_without_trend(segments) * taper, axis=1)
    density = np.mean(np.abs(transform) ** 2, axis=0) * spacing / np.sum(taper**2)

    order = np.arange(2, n // 2)  # order 1 is what detrending and the taper leave of the trend
    ratio = np.round(np.log2(order) * LENGTHS_PER_OCTAVE).astype(int)
    _, which = np.unique(ratio, return_inverse=True)
    members = np.bincount(which)
    mean_order = np.exp(np.bincount(which, np.log(order)) / members)
    mean_density = np.bincount(which, density[order]) / members
    return (n * spacing / mean_order)[::-1], mean_density[::-1]


def triangular_prism(heights: np.ndarray, spacing: float) -> tuple[np.ndarray, np.ndarray]:
    """Area of triangular prisms of side b, for heights exaggerated without end: grows as b^(H-1).

    Clarke, Comput. Geosci. 12 (1986) 713. His area follows b^(2 - Delta_g) only on a surface that
    is steep at every length, and so depends on the unit of height: a gently rough surface gives 2
    whatever its H. In the limit of infinite exaggeration the area per unit of it is the mean slope
    of the facets, which has neither defect.
    """
    sides = _lengths(1, min(heights.shape) // 2)
    return sides * spacing, np.array([_mean_facet_slope(heights, b) / (b * spacing) for b in sides])


#: The estimators by name. The factor makes each look at about the same waves: a wave of length l
#: is seen by a lag of l/2, by a window of l, by second differences over 2 lags = l.
ESTIMATORS = {
    "variogram": Estimator(variogram, 2, 0, "lag", "mean square difference", "mm2", 1),
    "second_differences": Estimator(
        second_differences, 2, 0, "lag", "mean square second difference", "mm2", 1
    ),
    "roughness_length": Estimator(
        roughness_length, 1, 0, "window side", "rms height about the local plane", "mm", 2
    ),
    "power_spectrum": Estimator(
        power_spectrum, 2, 1, "wavelength", "power spectral density of profiles", "mm3", 2
    ),
    "triangular_prism": Estimator(
        triangular_prism, 1, -1, "prism side", "mean facet slope", "1", 1
    ),
}


#: Those whose mean bias stays within 0.04 (see `surface_dimension`).
LITTLE_BIASED = ("second_differences", "roughness_length", "power_spectrum")


def _lengths(first: int, last: int) -> np.ndarray:
    """Whole numbers of cells from `first` to `last`, about evenly spaced on a logarithmic axis."""
    if last < first:
        return np.empty(0, int)
    octaves = np.arange(np.floor(np.log2(last / first) * LENGTHS_PER_OCTAVE) + 1)
    return np.unique(np.round(first * 2 ** (octaves / LENGTHS_PER_OCTAVE)).astype(int))


def _mean_square(differences) -> float:
    """Mean square of all finite values in several arrays; NaN where there is none."""
    total, count = 0.0, 0
    for values in differences:
        known = values[np.isfinite(values)]
        total += np.dot(known, known)
        count += known.size
    return total / count if count else np.nan


def _windows_rms(heights: np.ndarray, side: int) -> float:
    """Rms residual about the window's own plane, over all windows that are measured well enough."""
    tiles = [n // side for n in heights.shape]
    first = [(n - t * side) // 2 for n, t in zip(heights.shape, tiles, strict=True)]
    middle = heights[tuple(slice(f, f + t * side) for f, t in zip(first, tiles, strict=True))]
    windows = middle.reshape(tiles[0], side, tiles[1], side).swapaxes(1, 2).reshape(-1, side**2)
    known = np.isfinite(windows)
    enough = known.sum(axis=1) >= WINDOW_COVER * side**2
    windows, known = windows[enough], known[enough]
    if not windows.size:
        return np.nan
    y, x = (a.ravel() - (side - 1) / 2 for a in np.mgrid[:side, :side])
    basis = np.stack([np.ones(side**2), y, x])
    values = np.where(known, windows, 0.0)
    products = (basis[:, np.newaxis] * basis).reshape(9, -1)
    normal = (known.astype(float) @ products.T).reshape(-1, 3, 3)
    plane = np.linalg.solve(normal, (values @ basis.T)[..., np.newaxis])[..., 0]
    residual = np.where(known, values - plane @ basis, 0.0)
    # Three degrees of freedom went into the plane.
    return float(np.sqrt(np.mean(np.sum(residual**2, axis=1) / (known.sum(axis=1) - 3))))


def _unbroken_segments(heights: np.ndarray) -> np.ndarray:
    """Complete profile segments of one length from rows and columns, (segments, length).

    The length is the longest at which complete segments cover a quarter of the measured cells
    (counted along x and y); none if that is below `SHORTEST_SEGMENT`.
    """
    known = np.isfinite(heights)
    length = min(heights.shape)
    while length >= SHORTEST_SEGMENT:
        found = [_cut_segments(z, length) for z in (heights, heights.T)]
        if sum(f.size for f in found) >= 0.25 * 2 * known.sum() > 0:
            return np.concatenate(found)
        length = length * 7 // 8
    return np.empty((0, 0))


def _cut_segments(profiles: np.ndarray, length: int) -> np.ndarray:
    """Complete segments of the rows of `profiles`, each starting where the one before ended."""
    known = np.isfinite(profiles)
    segments = []
    free_from = np.zeros(len(profiles), int)
    run = np.zeros(len(profiles), int)
    for end in range(1, profiles.shape[1] + 1):
        run = np.where(known[:, end - 1], run + 1, 0)
        complete = (run >= length) & (end - free_from >= length)
        if complete.any():
            segments.append(profiles[complete, end - length : end])
            free_from[complete] = end
    return np.concatenate(segments) if segments else np.empty((0, length))


def _without_trend(profiles: np.ndarray) -> np.ndarray:
    """Each row less its own least-squares line."""
    x = np.arange(profiles.shape[1]) - (profiles.shape[1] - 1) / 2
    slope = profiles @ x / np.dot(x, x)
    return profiles - profiles.mean(axis=1, keepdims=True) - np.outer(slope, x)


def _mean_facet_slope(heights: np.ndarray, side: int) -> float:
    """Mean rise over `side` of the four facets that meet at a prism's centre, over all prisms."""
    a, b = heights[:-side, :-side], heights[:-side, side:]
    d, c = heights[side:, :-side], heights[side:, side:]
    # The centre is the mean of the corners, so opposite facets share their slope across.
    across_y, across_x = (d + c - a - b) / 2, (b + c - a - d) / 2
    facets = [np.hypot(b - a, across_y), np.hypot(c - d, across_y)]
    facets += [np.hypot(d - a, across_x), np.hypot(c - b, across_x)]
    mean = sum(facets) / 4
    known = mean[np.isfinite(mean)]
    return known.mean() if known.size else np.nan


# -- statistics that the classical theories ask for ------------------------------------------------


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
