"""Pressures at which windows of all sizes have the same sigma*, and their slope over b."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.datasets import labelled_dataset
from ..core.fitting import fit_line
from ..mechanics.states import SOLVER_ERROR
from .load_ladder import real_pressure
from .power_laws import add_exponents


def equal_pressure(pressures: ArrayLike, values: ArrayLike, target: float) -> tuple[float, int]:
    """Pressures at which a curve has a value, by lines between the logarithms.

    Parameters
    ----------
    pressures, values : (n,) array_like
        The curve; NaN where it is not known.
    target : float

    Returns
    -------
    pressure : float
        Geometric mean of all places where the curve has the value; 0 if all of the curve lies above
        it, so that the place is below the pressures solved, infinity if all lies below; NaN without
        a curve.
    crossings : int
    """
    known = np.isfinite(values)
    if not known.any():
        return np.nan, 0
    x, above = np.log(pressures), np.log(values) - np.log(target)
    places = []
    for i in np.flatnonzero(known[:-1] & known[1:]):
        left, right = above[i], above[i + 1]
        if (left < 0) != (right < 0):
            places.append(x[i] - left * (x[i + 1] - x[i]) / (right - left))
        elif left == 0 and not known[:i].any():  # the curve starts at the value
            places.append(x[i])
    if places:
        return float(np.exp(np.mean(places))), len(places)
    return (0.0 if np.nanmin(above) >= 0 else np.inf), 0


def real_pressures(states: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Geometric mean of sigma_n over the resolutions, MPa, of each size and of each window.

    Returns
    -------
    together : (part, step) ndarray
        Of all windows of a size: sum of F over sum of A_n. NaN where they hold fewer than
        `MIN_NODES_PER_RESOLUTION` nodes on the average at a resolution.
    single : (part, window, step) ndarray
        NaN where the window holds fewer at a resolution.
    """
    s = states["spacing"].values
    nodes = states["nodes"].transpose("part", "window", "step", "resolution")
    force = states["side"].values[:, np.newaxis] ** 2 * states["ladder_pressure"].values
    together = real_pressure(force, nodes.mean("window").values, s)
    return together, real_pressure(force[:, np.newaxis], nodes.values, s)


def real_pressure_errors(states: xr.Dataset) -> tuple[np.ndarray, ...]:
    """Solver error bounds of the logarithms of :func:`real_pressures`.

    Returns
    -------
    together : (part, step) ndarray
    single : (part, window, step) ndarray
        Infinite where no node is certain to touch, NaN where the windows were not solved.
    """
    dims = ("part", "window", "step", "resolution")
    nodes, ambiguous = (states[name].transpose(*dims) for name in ("nodes", "nodes_error"))
    with np.errstate(divide="ignore"):
        return tuple(
            abs(np.log1p(-np.minimum(off / touch.where(touch > 0), 1))).mean("resolution").values
            for touch, off in (
                (nodes.mean("window"), ambiguous.mean("window")),
                (nodes, ambiguous),
            )
        )


def _places(
    states: xr.Dataset, curves: Sequence[np.ndarray], n_loads: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Pressures at which every window has the real pressure of the whole, under each load.

    Parameters
    ----------
    states : xr.Dataset
    curves : (together, single)
        As :func:`real_pressures` has them.
    n_loads : int

    Returns
    -------
    equal, times : (normal_force, part) ndarray
        Pressures and crossings of all windows of a size.
    one : (normal_force, part, window) ndarray
        Pressures of the windows one by one.
    """
    together, single = curves
    pressures = states["ladder_pressure"].values
    parts, windows = single.shape[:2]
    equal, times = np.full((n_loads, parts), np.nan), np.zeros((n_loads, parts), int)
    one = np.full((n_loads, parts, windows), np.nan)
    for load in np.flatnonzero(np.isfinite(together[0, :n_loads])):
        target = together[0, load]
        for i in range(parts):
            equal[load, i], times[load, i] = equal_pressure(pressures, together[i], target)
            for j in range(int(states["windows"][i])):
                one[load, i, j], _ = equal_pressure(pressures, single[i, j], target)
    return equal, times, one


def _at_end(
    curves: tuple[np.ndarray, ...], errors: tuple[np.ndarray, ...], sign: int
) -> list[np.ndarray]:
    """Curves of parts at their upper and of the whole at its lower error; -1 for the reverse.

    NaN where an error has no bound.
    """
    moved = []
    for curve, off in zip(curves, errors, strict=True):
        by = sign * off
        by[0] *= -1
        moved.append(np.where(np.isfinite(off), curve * np.exp(by), np.nan))
    return moved


def _error_bound(pressures: np.ndarray, ends: list[np.ndarray]) -> np.ndarray:
    """Error bound of pressures: the larger distance to both ends of the certain range.

    Infinite where the value is not reached at one of them.
    """
    off = np.max([abs(_reached(end) - pressures) for end in ends], axis=0)
    return np.where(np.isfinite(pressures) & ~np.isfinite(off), np.inf, off)


_OF_STEPS, _OF_SIZE = ("part", "step"), ("normal_force", "part")
_TABLE = {
    "real_pressure": (
        _OF_STEPS,
        "MPa",
        "real mean pressure sigma_n, geometric mean over resolutions",
    ),
    "real_pressure_error": (_OF_STEPS, "MPa", f"real mean pressure sigma_n, {SOLVER_ERROR}"),
    "equal_pressure": (
        _OF_SIZE,
        "MPa",
        "sigma_0 at which all windows of a size have the sigma* of the whole",
    ),
    "equal_pressure_error": (_OF_SIZE, "MPa", f"sigma_0 at equal sigma*, {SOLVER_ERROR}"),
    "window_pressure": (_OF_SIZE, "MPa", "median of windows one by one"),
    "window_pressure_error": (_OF_SIZE, "MPa", f"median of windows one by one, {SOLVER_ERROR}"),
    "crossings": (_OF_SIZE, "1", "places where sigma*(sigma_0) of that size has that value"),
    "windows_below": (_OF_SIZE, "1", "windows above that sigma* at all loads with nodes enough"),
    "windows_above": (_OF_SIZE, "1", "windows below that sigma* at all loads solved"),
    "windows_unknown": (_OF_SIZE, "1", "windows without nodes enough at any load"),
    "sensitivity": ("normal_force", "1", "d log sigma* / d log sigma_0 of the whole window"),
}

#: Slopes over log b: what they are of.
_SLOPES = {
    "slope": "slope of log sigma_0 over log b at equal sigma*, all windows of a size",
    "window_slope": "slope of log sigma_0 over log b at equal sigma*, median windows",
    "share_exponent": "exponent of A_r/A_0 at equal sigma_0",
}


def slopes_at_equal_star(states: xr.Dataset, n_loads: int) -> xr.Dataset:
    """Pressures at equal sigma*, their slope over b, and its explanation.

    Parameters
    ----------
    states : xr.Dataset
        From :func:`size_effect.load_ladder.solve_sub_windows`.
    n_loads : int
        The first steps, under which the whole window is tested.

    Returns
    -------
    xr.Dataset
        See :func:`size_effect.eq6.size_test`.
    """
    pressures = states["ladder_pressure"].values
    curves = real_pressures(states)
    together = curves[0]
    errors = real_pressure_errors(states)
    equal, crossings, one = _places(states, curves, n_loads)
    ends = [_places(states, _at_end(curves, errors, sign), n_loads) for sign in (-1, 1)]
    equal, median = _reached(equal), _median(one)
    with_whole = np.isfinite(together[0, :n_loads, np.newaxis])
    below, above = ((one == end).sum(axis=2) for end in (0, np.inf))
    unknown = with_whole * (states["windows"].values - np.isfinite(np.log1p(one)).sum(axis=2))
    sensitivity = np.gradient(np.log(together[0]), np.log(pressures))
    result = labelled_dataset(
        _TABLE,
        {
            "real_pressure": together,
            "real_pressure_error": together * np.expm1(errors[0]),
            "equal_pressure": equal,
            "equal_pressure_error": _error_bound(equal, [end[0] for end in ends]),
            "window_pressure": median,
            "window_pressure_error": _error_bound(median, [_median(end[2]) for end in ends]),
            "crossings": crossings,
            "windows_below": below,
            "windows_above": above,
            "windows_unknown": unknown - above,
            "sensitivity": sensitivity[:n_loads],
        },
    )
    log_b = np.log(states["side"].values)
    over_sizes = {
        "slope": equal,
        "window_slope": median,
        "share_exponent": 1 / together[:, :n_loads].T,
    }
    for name, words in _SLOPES.items():
        slopes = [fit_line(log_b, row).slope for row in np.log(over_sizes[name])]
        add_exponents(result, name, slopes, "normal_force", words)
    return result


def _reached(pressures: np.ndarray) -> np.ndarray:
    """Pressures without those that lie below or above all that were solved."""
    return np.where((pressures > 0) & np.isfinite(pressures), pressures, np.nan)


def _median(pressures: np.ndarray) -> np.ndarray:
    """Median over the last axis, counting values below or above range; NaN if it is one of them."""
    ordered = np.sort(pressures, axis=-1)  # NaN last
    n = np.isfinite(np.where(ordered == np.inf, 0.0, ordered)).sum(axis=-1)
    middle = np.stack([np.maximum(n - 1, 0) // 2, n // 2], axis=-1)
    middle = np.minimum(middle, ordered.shape[-1] - 1)
    return np.exp(np.log(_reached(np.take_along_axis(ordered, middle, axis=-1))).mean(axis=-1))
