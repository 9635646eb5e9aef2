"""Shear strength over the side b of a joint, at one v and at one v/b (sect. 5)."""

from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.datasets import labelled
from ..core.estimate import Estimate
from ..core.fitting import MIN_POINTS, slope_with_bounds
from ..core.intervals import mean_interval
from ..core.labels import cf_attrs
from ..core.limits import JRC_RANGE, LARGEST_FRICTION_ANGLE, MOSTLY_TRUNCATED
from ..core.settings import Friction
from ..core.verdicts import FALLING, RISING
from ..joint.barton import barton_strength, scaled_joint
from ..laws.strength import (
    FIELDS,
    angles_with_errors,
    from_flush,
    peak,
    slopes_apart,
    strength_with_error,
)
from .window_means import add_exponents, add_law, add_mean, power_through

#: Offsets, as fractions of the side b, at which sizes are compared. Barton and Bandis put the peak
#: of a laboratory joint at 1 to 3 % of its length (L/500 (JRC/L)^0.33, in m).
OFFSET_FRACTIONS = (0.01, 0.02, 0.05, 0.1)


def strength_by_size(states: xr.Dataset, material: Friction, roughness: float) -> xr.Dataset:
    """Strength of the sub-windows, each from its own elastic dilatancy curve.

    Arguments as for :func:`size_effect.laws.size_laws`. Means over sub-windows with their interval
    and the ``_error`` of the solver: ``peak_strength`` (part, normal_force), and
    ``truncated_fraction_at_peak``, the fraction of sub-windows whose angle was truncated there;
    ``barton_scaled_strength`` with the JRC and JCS of that size by Barton and Bandis' law (which
    was measured on joints of 50 mm and more), none where that JRC is beyond Barton's scale of 0 to
    20.

    At offsets in proportion to the size, v = (v/b) b, over (share, part, load): mean
    ``strength_at_equal_v_over_b`` and ``slope_at_equal_v_over_b`` (d delta/dv, not truncated),
    ``truncated_fraction_at_equal_v_over_b`` and their exponents (share, load), where the v of the
    sizes lie in three steps of sliding or more. ``share`` holds the fractions v/b.
    ``strength_of_whole_at_equal_v`` and ``slope_of_whole_at_equal_v`` are those of the whole window
    at the same v, and ``slope_at_equal_v_exponent`` (share, load) is the exponent against b of the
    slope of the sub-windows over it. Besides those of :func:`with_slope_angles`.

    A strength whose angle is truncated is a lower bound: the exponent at one v/b is the largest
    that the bounds allow, and its interval has no lower end.

    At one v/b both v and b grow, and a face without any effect of size has the slopes of its whole
    window at these v: ``slope_at_equal_v_exponent`` is then 0. A self-affine face has d delta/dv ~
    v^(H - 1), which at one v/b falls as b^(H - 1).

    The largest of several noisy values grows with their noise, which is larger in a small
    sub-window, so part of any size effect on a peak is scatter itself, as in a laboratory.
    """
    side = states["side"]
    offset, curve, error = _dilatancy_curves(states)
    midpoint, angle, angle_off = angles_with_errors(offset, curve, error)
    friction = material.basic_friction_angle + angle
    pressure = states["nominal_pressure"].values
    strength, bound, off = strength_with_error(pressure, friction, angle_off)
    truncated, raised = (np.where(np.isnan(strength), np.nan, bound == end) for end in (1, -1))

    result = xr.Dataset()
    slopes = [slopes_apart(offset, curve, sign * error) for sign in (0, 1)]
    at_peak = [peak(midpoint, intervals)[0] for intervals in (strength, off)]
    at_fractions = {
        "strength_at_equal_v_over_b": (strength, off),
        "slope_at_equal_v_over_b": (slopes[0], slopes[1] - slopes[0]),
    }
    quantities: dict[str, tuple] = {"peak_strength": (_DIMS, at_peak)}
    for name, of_intervals in at_fractions.items():
        taken = [_at_fractions(offset, side.values, intervals) for intervals in of_intervals]
        quantities[name] = ("share", *_DIMS), taken
    for name, (dims, (values, errors)) in quantities.items():
        mean_of = xr.DataArray(values, dims=dims, attrs=cf_attrs(*_MEANS[name]))
        add_mean(result, name, mean_of, mean_of.copy(data=errors))
    _add_whole_window(result, side, offset, {"strength": strength, "slope": slopes[0]})
    attrs = cf_attrs("1", "offset as a fraction of the side, v/b")
    result["share"] = ("share", np.array(OFFSET_FRACTIONS), attrs)
    # Comparisons with NaN are False, so that missing sub-windows count as not truncated.
    at_least, at_most = (
        np.any(_at_fractions(offset, side.values, intervals) > 0, axis=2)
        for intervals in (truncated, raised)
    )
    in_steps = xr.DataArray(_in_three_steps(offset, side.values), dims="share")
    strengths = result["strength_at_equal_v_over_b"]
    strengths = strengths.where(in_steps & strengths.copy(data=~at_most))
    name = "strength_at_equal_v_over_b"
    bounds = strengths.copy(data=at_least)
    curves = {"strength": strengths, "bound": bounds, "side": side}
    words = f"exponent of {name} against b, the largest where angles are truncated"
    add_exponents(
        result, f"{name}_exponent", curves, _largest_exponent, side.dims, words, "sizes fitted"
    )
    name = "slope_at_equal_v_over_b"
    words = f"exponent of {name} against b"
    add_law(result, f"{name}_exponent", side, result[name].where(in_steps), words)
    of_truncated = {
        "truncated_fraction_at_peak": mean_interval(peak(midpoint, truncated)[0], axis=1).value,
        "truncated_fraction_at_equal_v_over_b": mean_interval(
            _at_fractions(offset, side.values, truncated), axis=2
        ).value,
    }
    result = result.assign(
        labelled(_TRUNCATED, of_truncated)
        | labelled(_BARTON, _by_barton(states, material, roughness))
    )
    return with_slope_angles(result, pressure)


def with_slope_angles(laws: xr.Dataset, pressure: np.ndarray) -> xr.Dataset:
    """Size laws with strengths at one v/b as limit slope angles, degrees (Fig. 11).

    ``limit_slope_angle`` and ``strength_at_equal_v_over_b_valid`` (share, part, normal_force), and
    ``barton_slope_angle`` (part, normal_force). Pressures sigma_0 (n_load,) in MPa.
    """
    dims = ("share", *_DIMS[::2])
    strength = Estimate.read(laws.transpose(*dims, ...), "strength_at_equal_v_over_b")
    angle = strength.mapped(partial(slope_angle, pressure=pressure))
    by_barton = slope_angle(laws["barton_scaled_strength"].values, pressure)
    valid = ~(
        laws["truncated_fraction_at_equal_v_over_b"].transpose(*dims).values > MOSTLY_TRUNCATED
    )
    return laws.assign(
        angle.variables("limit_slope_angle", dims, "degree", "limit slope angle atan(tau/sigma_0)")
        | labelled(
            _ANGLES, {"barton_slope_angle": by_barton, "strength_at_equal_v_over_b_valid": valid}
        )
    )


def add_slope_trends(laws: xr.Dataset) -> None:
    """Slope of the dilatancy over b at one v/b, and that of a self-affine face, into ``laws``.

    ``slope_at_equal_v_over_b_trend`` (share, normal_force), and
    ``slope_at_equal_v_over_b_expected`` (share, part), b^(H - 1) through the mean over the loads of
    the sizes whose slopes are all positive, if three are.
    """
    exponent = Estimate.read(laws, "slope_at_equal_v_over_b_exponent")
    trend = np.where(exponent.high < 0, FALLING, np.where(exponent.low > 0, RISING, ""))
    attrs = cf_attrs("1", f"{RISING}, {FALLING}, or empty where the exponent leaves it open")
    variable = laws["slope_at_equal_v_over_b_exponent"]
    laws["slope_at_equal_v_over_b_trend"] = variable.copy(data=trend).assign_attrs(attrs)
    slope = laws["slope_at_equal_v_over_b"]
    everywhere = slope.where((slope > 0).all("normal_force"))
    middle = xr.ufuncs.exp(xr.ufuncs.log(everywhere).mean("normal_force"))
    middle = middle.where(middle.count("part") >= MIN_POINTS).assign_attrs(slope.attrs)
    words = "slope d delta/dv at one v/b as a self-affine face has it, b^(H - 1)"
    laws["slope_at_equal_v_over_b_expected"] = power_through(
        middle, laws["side"], laws["expected_hurst"] - 1, words
    )


def slope_angle(strength: ArrayLike, pressure: ArrayLike) -> np.ndarray:
    """Limit slope angle atan(tau / sigma_0), degrees: a block on a plane so steep just slides."""
    return np.degrees(np.arctan(np.asarray(strength) / pressure))


_DIMS = ("part", "window", "normal_force")

#: Means over sub-windows: unit, long name.
_MEANS = {
    "peak_strength": FIELDS["peak_strength"][:2],
    "strength_at_equal_v_over_b": ("MPa", "shear strength at one v/b"),
    "slope_at_equal_v_over_b": ("1", "slope d delta/dv at one v/b"),
}

_TRUNCATED_FRACTION = f"fraction of sub-windows truncated at {LARGEST_FRICTION_ANGLE:g} degrees"
_TRUNCATED = {
    "truncated_fraction_at_peak": (
        ("part", "normal_force"),
        "1",
        f"{_TRUNCATED_FRACTION} at their peak",
    ),
    "truncated_fraction_at_equal_v_over_b": (
        ("share", "part", "normal_force"),
        "1",
        f"{_TRUNCATED_FRACTION} at one v/b",
    ),
}

_BARTON = {
    "barton_roughness": ("part", "1", "JRC_n by Barton and Bandis' scale law; missing above 20"),
    "barton_scaled_strength": (
        ("part", "normal_force"),
        "MPa",
        "peak strength by Barton's law with JRC_n and JCS_n of each size",
    ),
}

_ANGLES = {
    "barton_slope_angle": (
        ("part", "normal_force"),
        "degree",
        "limit slope angle by Barton's law with JRC_n and JCS_n of each size",
    ),
    "strength_at_equal_v_over_b_valid": (
        ("share", "part", "normal_force"),
        "1",
        "the angle of at most half of the sub-windows was truncated",
    ),
}


def _dilatancy_curves(states: xr.Dataset) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Offsets (n,), elastic dilatancy (n, part, window, load) of the sub-windows, its error, mm."""
    elastic = states["rigid_opening"] - states["interface_closure"]
    order = ("offset", "part", "window", "normal_force")
    curve = elastic.transpose(*order).values
    error = states["interface_closure_error"].transpose(*order).values
    offset = states["offset"].values
    if states.attrs["opposite"] == "match":
        absent = np.isnan(curve[:1])
        _, error = from_flush(offset, error)
        offset, curve = from_flush(offset, curve)
        curve[:1][absent] = error[:1][absent] = np.nan
    return offset, curve, error


def _largest_exponent(strength: np.ndarray, bound: np.ndarray, side: np.ndarray) -> Estimate:
    """Exponent of strengths (part,) against b, some of which are lower bounds."""
    positive = np.where(strength > 0, strength, np.nan)
    return slope_with_bounds(np.log(side), np.log(positive), bound)


def _add_whole_window(
    result: xr.Dataset,
    side: xr.DataArray,
    offset: np.ndarray,
    over_offsets: dict[str, np.ndarray],
) -> None:
    """Strength and slope of the whole window at the v of each size, and slopes over that.

    ``over_offsets`` has ``strength``, MPa, and ``slope`` (n - 1, part, window, load) between the
    offsets (n,), mm. The first part is the whole window.
    """
    for name, values in over_offsets.items():
        of_sizes = result[f"{name}_at_equal_v_over_b"]
        of_whole = np.repeat(values[:, :1, :1], side.size, axis=1)
        whole = of_sizes.copy(data=_at_fractions(offset, side.values, of_whole)[:, :, 0])
        words = f"{name} of the whole window at the v of each size"
        whole.attrs = of_sizes.attrs | {"long_name": words}
        result[f"{name}_of_whole_at_equal_v"] = whole
    of_sizes, whole = result["slope_at_equal_v_over_b"], result["slope_of_whole_at_equal_v"]
    ratio = (of_sizes / whole.where(whole > 0)).where(side < side.max())
    words = "exponent against b of the slope of sub-windows over that of the whole window at one v"
    add_law(result, "slope_at_equal_v_exponent", side, ratio, words)


def _in_three_steps(offset: np.ndarray, side: np.ndarray) -> np.ndarray:
    """True (share,) where the v of the sizes lie in three steps of sliding or more.

    In two steps a law would be the one difference between them.
    """
    step = np.arange(offset.size - 1.0)[:, np.newaxis, np.newaxis, np.newaxis]
    steps = _at_fractions(offset, side, np.repeat(step, side.size, axis=1))[:, :, 0, 0]
    return np.array(
        [
            np.unique(of_fraction[np.isfinite(of_fraction)]).size >= MIN_POINTS
            for of_fraction in steps
        ],
        bool,
    )


def _by_barton(states: xr.Dataset, material: Friction, roughness: float) -> dict[str, np.ndarray]:
    """Barton's law with the JRC and JCS of each size."""
    lengths = states["side_along"].values
    scaled = scaled_joint(roughness, material.joint_wall_strength, lengths)
    # Barton's law was not measured on joints beyond his scale.
    on_scale = np.where(np.asarray(scaled[0]) <= JRC_RANGE[1], scaled[0], np.nan)
    strength = barton_strength(
        states["nominal_pressure"].values,
        material.basic_friction_angle,
        *(np.asarray(of_size)[:, np.newaxis] for of_size in (on_scale, scaled[1])),
    )
    return {"barton_roughness": on_scale, "barton_scaled_strength": np.asarray(strength)}


def _at_fractions(offset: np.ndarray, side: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Values of the interval of offsets that holds v, for each v/b of `OFFSET_FRACTIONS` and b.

    Offsets (n,), mm, are the ends of the intervals, sides (part,) in mm, values (n - 1, part,
    window, load). Of them (share, part, window, normal_force) are taken, NaN where v is smaller
    than the first step of sliding or larger than the last offset.
    """
    taken = np.full((len(OFFSET_FRACTIONS), *values.shape[1:]), np.nan)
    tolerance = 1e-9 * offset[-1]
    slid = offset[offset > 0]
    for i, fraction in enumerate(OFFSET_FRACTIONS):
        for k, b in enumerate(side):
            v = fraction * b + tolerance
            if len(values) and slid[0] <= v <= offset[-1] + 2 * tolerance:
                interval = min(np.searchsorted(offset, v, side="right") - 1, len(values) - 1)
                if interval >= 0:
                    taken[i, k] = values[interval, k]
    return taken
