"""Pressures at which windows of all sizes have the same sigma*, and their slope over b."""

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.datasets import labelled_dataset
from ..states.states import SOLVER_ERROR
from .load_ladder import real_pressure
from .window_means import add_law


def equal_pressure(pressures: ArrayLike, values: ArrayLike, target: float) -> tuple[float, int]:
    """Pressure at which a curve has a value, by lines between the logarithms, and its crossings.

    Values (n,) are NaN where unknown. The pressure is the geometric mean of all places where the
    curve has the value; 0 if all of the curve lies above it, so that the place is below the
    pressures solved, infinity if all lies below; NaN without a curve.
    """
    finite = np.isfinite(values)
    if not finite.any():
        return np.nan, 0
    x, above = np.log(pressures), np.log(values) - np.log(target)
    places = []
    for i in np.flatnonzero(finite[:-1] & finite[1:]):
        left, right = above[i], above[i + 1]
        if (left < 0) != (right < 0):
            places.append(x[i] - left * (x[i + 1] - x[i]) / (right - left))
        elif left == 0 and not finite[:i].any():  # the curve starts at the value
            places.append(x[i])
    if places:
        return float(np.exp(np.mean(places))), len(places)
    return (0.0 if np.nanmin(above) >= 0 else np.inf), 0


def real_pressures(states: xr.Dataset) -> np.ndarray:
    """Geometric mean of sigma_n over the resolutions, MPa, (part, step), of all windows of a size.

    From the sum of F over the sum of A_n. NaN where the windows hold fewer than
    `MIN_NODES_PER_RESOLUTION` nodes on the average at a resolution.
    """
    nodes = states["nodes"].mean("window").transpose("part", "step", "resolution")
    force = states["side"].values[:, np.newaxis] ** 2 * states["ladder_pressure"].values
    return real_pressure(force, nodes.values, states["spacing"].values)


def real_pressure_errors(states: xr.Dataset) -> np.ndarray:
    """Solver error bounds of the logarithms of :func:`real_pressures`, (part, step).

    Infinite where no node is certain to touch, NaN where the windows were not solved.
    """
    nodes, off = (
        states[name].mean("window").transpose("part", "step", "resolution")
        for name in ("nodes", "nodes_error")
    )
    with np.errstate(divide="ignore"):
        lost = np.log1p(-np.minimum(off / nodes.where(nodes > 0), 1))
    return abs(lost).mean("resolution").values


def _places(
    pressures: np.ndarray, curves: np.ndarray, n_loads: int
) -> tuple[np.ndarray, np.ndarray]:
    """Pressures at which each size has the real pressure of the whole window, and crossings.

    Both are (normal_force, part). Curves (part, step) are those of :func:`real_pressures`, over the
    pressures (step,).
    """
    equal = np.full((n_loads, len(curves)), np.nan)
    crossings = np.zeros(equal.shape, int)
    for load in np.flatnonzero(np.isfinite(curves[0, :n_loads])):
        for i, curve in enumerate(curves):
            equal[load, i], crossings[load, i] = equal_pressure(pressures, curve, curves[0, load])
    return _reached(equal), crossings


def _at_end(curves: np.ndarray, errors: np.ndarray, sign: int) -> np.ndarray:
    """Curves of the parts at their upper error and of the whole at its lower; the reverse for -1.

    NaN where an error has no bound.
    """
    by = sign * errors
    by[0] *= -1
    return np.where(np.isfinite(errors), curves * np.exp(by), np.nan)


def _error_bound(pressures: np.ndarray, ends: list[np.ndarray]) -> np.ndarray:
    """Error bound of pressures: the larger distance to both ends of the certain range.

    Infinite where the value is not reached at one end.
    """
    off = np.max([abs(end - pressures) for end in ends], axis=0)
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
    "crossings": (_OF_SIZE, "1", "places where sigma*(sigma_0) of that size has that value"),
    "sensitivity": ("normal_force", "1", "d log sigma* / d log sigma_0 of the whole window"),
}


def slopes_at_equal_star(states: xr.Dataset, n_loads: int) -> xr.Dataset:
    """Pressures at equal sigma*, their slope over b, and its explanation: see `size_test`.

    The whole window is tested under the first ``n_loads`` steps.
    """
    pressures = states["ladder_pressure"].values
    curves, errors = real_pressures(states), real_pressure_errors(states)
    equal, crossings = _places(pressures, curves, n_loads)
    ends = [_places(pressures, _at_end(curves, errors, sign), n_loads)[0] for sign in (-1, 1)]
    sensitivity = np.gradient(np.log(curves[0]), np.log(pressures))
    result = labelled_dataset(
        _TABLE,
        {
            "real_pressure": curves,
            "real_pressure_error": curves * np.expm1(errors),
            "equal_pressure": equal,
            "equal_pressure_error": _error_bound(equal, ends),
            "crossings": crossings,
            "sensitivity": sensitivity[:n_loads],
        },
    )
    words = "slope of log sigma_0 over log b at equal sigma*, all windows of a size"
    add_law(result, "slope", states["side"], result["equal_pressure"], words, "points fitted")
    return result


def _reached(pressures: np.ndarray) -> np.ndarray:
    """Pressures without those that lie below or above all that were solved."""
    return np.where((pressures > 0) & np.isfinite(pressures), pressures, np.nan)
