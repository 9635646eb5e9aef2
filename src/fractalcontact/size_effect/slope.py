"""Where windows of all sizes have the same sigma*, and the slope of that over their side b."""

import numpy as np
import xarray as xr

from ..core.fitting import fit_line
from ..core.intervals import INTERVAL
from ..core.labels import cf_attrs
from .load_ladder import real_pressure


def equal_pressure(pressures, values, target):
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
        it, so that the place is below the pressures known, infinity if all lies below; NaN without
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


def real_pressures(pressed):
    """Geometric mean of sigma_n over the resolutions, MPa, of each size and of each window.

    Returns
    -------
    together : (part, step) ndarray
        Of all windows of a size: sum of F over sum of A_n. NaN where they hold fewer than
        `FEWEST_NODES` nodes on the average at a resolution.
    single : (part, window, step) ndarray
        NaN where the window holds fewer at a resolution.
    """
    s = pressed["spacing"].values
    nodes = pressed["nodes"].transpose("part", "window", "step", "resolution")
    force = pressed["side"].values[:, np.newaxis] ** 2 * pressed["ladder_pressure"].values
    together = real_pressure(force, nodes.mean("window").values, s)
    return together, real_pressure(force[:, np.newaxis], nodes.values, s)


def real_pressure_errors(pressed):
    """How far off the logarithms of :func:`real_pressures` may be by the solver.

    Returns
    -------
    together : (part, step) ndarray
    single : (part, window, step) ndarray
        Infinite where no node is certain to touch, NaN where the windows were not pressed.
    """
    dims = ("part", "window", "step", "resolution")
    nodes, undecided = (pressed[name].transpose(*dims) for name in ("nodes", "nodes_error"))
    with np.errstate(divide="ignore"):
        return tuple(
            abs(np.log1p(-np.minimum(off / touch.where(touch > 0), 1))).mean("resolution").values
            for touch, off in (
                (nodes.mean("window"), undecided.mean("window")),
                (nodes, undecided),
            )
        )


def _places(pressed, together, single, n_loads):
    """Where every size and every window has the real pressure of the whole under each load.

    Parameters
    ----------
    pressed : xr.Dataset
    together, single : ndarray
        As :func:`real_pressures` has them.
    n_loads : int

    Returns
    -------
    equal, times : (load, part) ndarray
        Pressures and crossings of all windows of a size.
    one : (load, part, window) ndarray
        Pressures of the windows one by one.
    """
    pressures = pressed["ladder_pressure"].values
    parts, windows = single.shape[:2]
    equal, times = np.full((n_loads, parts), np.nan), np.zeros((n_loads, parts), int)
    one = np.full((n_loads, parts, windows), np.nan)
    for load in np.flatnonzero(np.isfinite(together[0, :n_loads])):
        target = together[0, load]
        for i in range(parts):
            equal[load, i], times[load, i] = equal_pressure(pressures, together[i], target)
            for j in range(int(pressed["windows"][i])):
                one[load, i, j], _ = equal_pressure(pressures, single[i, j], target)
    return equal, times, one


def _at_end(curves, errors, sign):
    """Curves of parts as high, and of the whole as low, as errors let them be; -1 for the reverse.

    NaN where an error has no bound.
    """
    moved = []
    for curve, off in zip(curves, errors, strict=True):
        by = sign * off
        by[0] *= -1
        moved.append(np.where(np.isfinite(off), curve * np.exp(by), np.nan))
    return moved


def _off(found, ends):
    """How far pressures may be off: to the farther of those at both ends of what is certain.

    Infinite where the value is not reached at one of them.
    """
    off = np.max([abs(_found(end) - found) for end in ends], axis=0)
    return np.where(np.isfinite(found) & ~np.isfinite(off), np.inf, off)


def slopes_at_equal_star(pressed, n_loads):
    """Pressures at equal sigma*, their slope over b, and what explains it.

    Parameters
    ----------
    pressed : xr.Dataset
        From :func:`size_effect.load_ladder.press_parts`.
    n_loads : int
        The first steps, under which the whole window is tested.

    Returns
    -------
    xr.Dataset
        See :func:`size_effect.eq6.size_test`.
    """
    log_b, pressures = np.log(pressed["side"].values), pressed["ladder_pressure"].values
    together, single = curves = real_pressures(pressed)
    errors = real_pressure_errors(pressed)
    equal, times, one = _places(pressed, together, single, n_loads)
    ends = [_places(pressed, *_at_end(curves, errors, sign), n_loads) for sign in (-1, 1)]
    equal = _found(equal)
    median = _median(one)
    equal_off = _off(equal, [end[0] for end in ends])
    median_off = _off(median, [_median(end[2]) for end in ends])
    with_whole = np.isfinite(together[0, :n_loads, np.newaxis])
    below, above = ((one == end).sum(axis=2) for end in (0, np.inf))
    unknown = with_whole * (pressed["windows"].values - np.isfinite(np.log1p(one)).sum(axis=2))
    of_size = ("load", "part")
    result = xr.Dataset(
        {
            "real_pressure": (
                ("part", "step"),
                together,
                cf_attrs("MPa", "real mean pressure sigma_n, geometric mean over resolutions"),
            ),
            "equal_pressure": (
                of_size,
                equal,
                cf_attrs(
                    "MPa", "sigma_0 at which all windows of a size have the sigma* of the whole"
                ),
            ),
            "real_pressure_error": (
                ("part", "step"),
                together * np.expm1(errors[0]),
                cf_attrs("MPa", "real mean pressure sigma_n, error by the solver"),
            ),
            "equal_pressure_error": (
                of_size,
                equal_off,
                cf_attrs("MPa", "sigma_0 at equal sigma*, error by the solver"),
            ),
            "window_pressure_error": (
                of_size,
                median_off,
                cf_attrs("MPa", "median of windows one by one, error by the solver"),
            ),
            "crossings": (
                of_size,
                times,
                cf_attrs("1", "places where sigma*(sigma_0) of that size has that value"),
            ),
            "window_pressure": (of_size, median, cf_attrs("MPa", "median of windows one by one")),
            "windows_below": (
                of_size,
                below,
                cf_attrs("1", "windows above that sigma* at all loads with nodes enough"),
            ),
            "windows_above": (
                of_size,
                above,
                cf_attrs("1", "windows below that sigma* at all loads pressed"),
            ),
            "windows_unknown": (
                of_size,
                unknown - above,
                cf_attrs("1", "windows without nodes enough at any load"),
            ),
            "sensitivity": (
                "load",
                np.gradient(np.log(together[0]), np.log(pressures))[:n_loads],
                cf_attrs("1", "d log sigma* / d log sigma_0 of the whole window"),
            ),
        }
    )
    for name, curves, words in (
        ("slope", equal, "slope of log sigma_0 over log b at equal sigma*, all windows of a size"),
        ("window_slope", median, "slope of log sigma_0 over log b at equal sigma*, median windows"),
        ("share_exponent", 1 / together[:, :n_loads].T, "exponent of A_r/A_0 at equal sigma_0"),
    ):
        _add_lines(result, name, [fit_line(log_b, row) for row in np.log(curves)], words)
    return result


def _found(pressures):
    """Pressures without those known to lie below or above some value."""
    return np.where((pressures > 0) & np.isfinite(pressures), pressures, np.nan)


def _median(pressures):
    """Median over the last axis, in which what lies below or above counts; NaN if it lies there."""
    ordered = np.sort(pressures, axis=-1)  # NaN last
    n = np.isfinite(np.where(ordered == np.inf, 0.0, ordered)).sum(axis=-1)
    middle = np.stack([np.maximum(n - 1, 0) // 2, n // 2], axis=-1)
    middle = np.minimum(middle, ordered.shape[-1] - 1)
    return np.exp(np.log(_found(np.take_along_axis(ordered, middle, axis=-1))).mean(axis=-1))


def _add_lines(result, name, lines, words):
    for ending, more in INTERVAL.items():
        values = [getattr(line, f"slope{ending}") for line in lines]
        result[f"{name}{ending}"] = ("load", values, cf_attrs("1", f"{words}{more}"))
    result[f"{name}_n"] = ("load", [x.n for x in lines], cf_attrs("1", f"{words}, points fitted"))
    for ending, field in (("_b_min", "x_min"), ("_b_max", "x_max")):
        values = np.exp([getattr(line, field) for line in lines])
        which = "smallest" if ending == "_b_min" else "largest"
        result[f"{name}{ending}"] = ("load", values, cf_attrs("mm", f"{which} b of that fit"))
