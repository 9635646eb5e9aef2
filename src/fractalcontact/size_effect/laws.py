"""How sigma_z, closure, compliance and strength go with the side b of a joint (eq. 2, sect. 5)."""

import numpy as np
import xarray as xr

from ..core.fitting import fit_line
from ..core.intervals import mean_interval
from ..core.labels import cf_attrs
from ..mechanics.strength import (
    FIELDS,
    angles_with_errors,
    from_flush,
    peak,
    profile_roughness,
    residual,
    slopes_apart,
    strength_with_error,
)
from ..mechanics.theory import LARGEST_FRICTION_ANGLE, barton_strength, scaled_joint
from .windows import ENDINGS, FIRST_CELLS, LAST_PART, window_states

#: Offsets, as shares of the side b, at which sizes are compared. Barton and Bandis put the peak of
#: a laboratory joint at 1 to 3 % of its length (L/500 (JRC/L)^0.33, in m).
SHARES = (0.01, 0.02, 0.05, 0.1)

#: Of every power law: field of the line, what it is.
_LAW = {
    "": ("slope", ""),
    "_low": ("slope_low", ", lower end of the 95 % interval"),
    "_high": ("slope_high", ", upper end of the 95 % interval"),
    "_n": ("n", ", sizes fitted"),
}

#: Means over sub-windows that are fitted as powers of b: name of the exponent.
_OVER_LOADS = {
    "interface_closure": ("closure_exponent", "exponent of w_int against b"),
    "interface_compliance": ("compliance_exponent", "exponent of interface compliance against b"),
    "area_share": ("area_exponent", "exponent of A_r/A_0 against b"),
}


def joint_by_size(specimen, direction, cells, settings, solver, dimension):
    """Press parts of the window, and fit how closure, roughness and strength go with their size.

    Parameters
    ----------
    specimen : xr.Dataset
    direction : str
    cells : (n,) int array_like
        Offsets in cells, ascending.
    settings : dict
        From :func:`study.configuration.resolve_settings`.
    solver : dict
        ``rtol`` and ``kernel``.
    dimension : (float, float, float)
        As for :func:`size_laws`.

    Returns
    -------
    xr.Dataset
        From :func:`size_laws`.
    """
    states = window_states(specimen, direction, cells, settings, solver)
    slides = direction != "none"
    roughness = float(profile_roughness(specimen, direction)["jrc_used"]) if slides else np.nan
    lags = settings["surface_range"]
    # A window of side b looks at waves of b, a lag at waves of twice its length.
    sides = None if lags is None else [2 * lag for lag in lags]
    return size_laws(states, settings["material"], roughness, dimension, sides)


def size_laws(states, material, roughness, dimension, fit_range=None):
    """Means over the sub-windows of each size, and the powers of b they follow.

    Parameters
    ----------
    states : xr.Dataset
        From :func:`size_effect.windows.window_states`.
    material : dict
        ``basic_friction_angle`` (degrees) and ``joint_wall_strength`` (MPa), NaN where not stated.
    roughness : float
        JRC of the window as used in Barton's law (``jrc_used`` of
        :func:`mechanics.strength.profile_roughness`); NaN for a joint that does not slide.
    dimension : (float, float, float)
        Delta_g of the face and its 95 % interval: eq. 2 expects H = 3 - Delta_g.
    fit_range : (float, float), optional
        Smallest and largest b of the fits of sigma_z, mm. By default from `FIRST_CELLS` cells to
        `LAST_PART` of the window. Where the study states a range of lags for Delta_g, twice that.

    Returns
    -------
    xr.Dataset
        Eq. 2: ``hurst`` (offset) of the composite topography and ``face_hurst``, with ``_low``,
        ``_high``, ``_n``; ``expected_hurst`` with its interval; the curves they come from.
        Closure: ``interface_closure``, ``interface_compliance`` and ``area_share`` (part, offset,
        load) with the interval of the mean over the sub-windows and the ``_error`` of the solver,
        and their exponents (offset, load). Strength, where the joint slides: see
        :func:`strength_by_size`.

    Notes
    -----
    A power law is a line through the logarithms of the means, one a size. The largest size is one
    window: nothing is known of the scatter of its value, and it weighs as much as the others. Small
    sub-windows are pieces of large ones, so that the sizes are not independent either.
    """
    result = states[["side", "nominal_pressure", "scale_side", "scale_n"]].copy()
    result["windows"] = states["sigma_z"].isel(offset=0).notnull().sum("window")
    result["windows"].attrs = cf_attrs("1", "sub-windows pressed of each size")
    _add_hurst(result, states, dimension, fit_range)
    for name, (exponent, words) in _OVER_LOADS.items():
        _add_mean(result, states[name], name, states[f"{name}_error"])
        _add_law(result, result["side"], result[name], "part", exponent, words)
    for name in ("sigma_z", "tilt_share"):
        _add_mean(result, states[name], name)
    if states["direction"].item() != "none":
        result = result.merge(strength_by_size(states, material, roughness))
    return result.assign_attrs(states.attrs)


def strength_by_size(states, material, roughness):
    """Peak and residual strength of the sub-windows, each from its own elastic dilatancy curve.

    Parameters
    ----------
    states, material, roughness
        As for :func:`size_laws`.

    Returns
    -------
    xr.Dataset
        Means over sub-windows with ``_low``, ``_high`` and the ``_error`` of the solver:
        ``peak_strength``,
        ``peak_dilatancy_angle`` (which is not held), ``residual_strength`` (part, load) and
        ``shear_strength`` (part, interval, load); ``held_share`` (part, load) of the sub-windows
        whose peak was held; ``strength_exponent``, ``residual_exponent`` (load) and
        ``shear_exponent`` (interval, load); ``barton_strength`` (part, load) with the JRC and JCS
        of that size by Barton and Bandis' law (which was measured on joints of 50 mm and more).

        At offsets in proportion to the size, v = share b, over (part, share, load): mean
        ``similar_strength`` and ``similar_slope`` (d delta/dv, not held), ``similar_held`` (share
        of sub-windows whose angle was held there) and their exponents (share, load).

    Notes
    -----
    Where a peak is held, its size says nothing; ``peak_dilatancy_angle`` then does. At one v a
    large sub-window is at an earlier stage of its sliding than a small one; only at one v/b are
    they alike. There a self-affine face has d delta/dv ~ b^(H - 1), which falls with size.

    The largest of several noisy values grows with their noise, which is larger in a small
    sub-window, so part of any size effect on a peak is scatter itself, as in a laboratory.
    """
    pressure = states["nominal_pressure"].values
    side = states["side"]
    offset, curve, error = _dilatancy_curves(states)
    midpoint, angle, angle_off = angles_with_errors(offset, curve, error)
    friction = material["basic_friction_angle"] + angle
    strength, held, off = strength_with_error(pressure, friction, angle_off)
    held = np.where(np.isnan(strength), np.nan, held == 1)

    words = cf_attrs("mm", "middle of the interval of offsets")
    result = xr.Dataset(coords={"interval": ("interval", midpoint, words)})
    dims = ("part", "window", "load")
    largest = states["offset"].values[-1]
    of_curves = {
        "peak_strength": [peak(midpoint, values)[0] for values in (strength, off)],
        "peak_dilatancy_angle": [peak(midpoint, values)[0] for values in (angle, angle_off)],
        "residual_strength": [residual(midpoint, values, largest)[0] for values in (strength, off)],
        "shear_strength": [strength, off],
    }
    for name, (values, errors) in of_curves.items():
        over = dims if values.ndim == 3 else ("interval", *dims)
        values = xr.DataArray(values, dims=over, attrs=cf_attrs(*FIELDS[name]))
        _add_mean(result, values, name, values.copy(data=errors))
    slopes = [slopes_apart(offset, curve, sign * error) for sign in (0, 1)]
    for name, values, errors, units, text in (
        ("similar_strength", strength, off, "MPa", "shear strength at v = share b"),
        ("similar_slope", slopes[0], slopes[1] - slopes[0], "1", "slope d delta/dv at v = share b"),
    ):
        values, errors = (_at_shares(offset, side.values, found) for found in (values, errors))
        values = xr.DataArray(values, dims=("share", *dims), attrs=cf_attrs(units, text))
        _add_mean(result, values, name, values.copy(data=errors))
    result["share"] = (
        "share",
        np.array(SHARES),
        cf_attrs("1", "offset as a share of the side, v/b"),
    )
    for name, exponent in _STRENGTH_EXPONENTS.items():
        _add_law(result, side, result[name], "part", exponent, f"exponent of {name} against b")
    ever, there = peak(midpoint, held)[0], _at_shares(offset, side.values, held)
    words = f"share of sub-windows held at {LARGEST_FRICTION_ANGLE:g} degrees"
    result["held_share"] = (
        ("part", "load"),
        mean_interval(ever, axis=1)[0],
        cf_attrs("1", f"{words} at their peak"),
    )
    result["similar_held"] = (
        ("share", "part", "load"),
        mean_interval(there, axis=2)[0],
        cf_attrs("1", f"{words} at v = share b"),
    )
    _add_barton(result, states, material, roughness)
    return result


#: Exponents against b by what they are of.
_STRENGTH_EXPONENTS = {
    "similar_strength": "similar_strength_exponent",
    "similar_slope": "similar_slope_exponent",
    "peak_strength": "strength_exponent",
    "residual_strength": "residual_exponent",
    "shear_strength": "shear_exponent",
}


def _dilatancy_curves(states):
    """Offsets (n,), elastic dilatancy (n, part, window, load) of the sub-windows, its error, mm."""
    elastic = states["rigid_opening"] - states["interface_closure"]
    order = ("offset", "part", "window", "load")
    curve = elastic.transpose(*order).values
    error = states["interface_closure_error"].transpose(*order).values
    offset = states["offset"].values
    if states.attrs["opposite"] == "match":
        absent = np.isnan(curve[:1])
        _, error = from_flush(offset, error)
        offset, curve = from_flush(offset, curve)
        curve[:1][absent] = error[:1][absent] = np.nan
    return offset, curve, error


def _add_barton(result, states, material, roughness):
    """Barton's law with the JRC and JCS of each size, into ``result``."""
    lengths = states["side_along"].values
    jrc, jcs = scaled_joint(roughness, material["joint_wall_strength"], lengths)
    strength = barton_strength(
        states["nominal_pressure"].values,
        material["basic_friction_angle"],
        jrc[:, np.newaxis],
        jcs[:, np.newaxis],
    )
    result["barton_roughness"] = (
        "part",
        jrc,
        cf_attrs("1", "JRC_n by Barton and Bandis' scale law"),
    )
    result["barton_strength"] = (
        ("part", "load"),
        strength,
        cf_attrs("MPa", "peak strength by Barton's law with JRC_n and JCS_n of each size"),
    )


def _at_shares(offset, side, values):
    """Values of the interval of offsets that holds v = share b, for each of `SHARES` and size.

    Parameters
    ----------
    offset : (n,) ndarray
        Ends of the intervals, mm.
    side : (part,) ndarray
        b, mm.
    values : (n - 1, part, window, load) ndarray

    Returns
    -------
    (share, part, window, load) ndarray
        NaN where v is smaller than the first step of sliding or larger than the last offset.
    """
    found = np.full((len(SHARES), *values.shape[1:]), np.nan)
    tolerance = 1e-9 * offset[-1]
    slid = offset[offset > 0]
    for i, share in enumerate(SHARES):
        for k, b in enumerate(side):
            v = share * b + tolerance
            if len(values) and slid[0] <= v <= offset[-1] + 2 * tolerance:
                interval = min(np.searchsorted(offset, v, side="right") - 1, len(values) - 1)
                if interval >= 0:
                    found[i, k] = values[interval, k]
    return found


def _add_mean(result, values, name, errors=None):
    """Mean of ``values`` over the sub-windows with its interval, into ``result``.

    And the mean of their ``errors`` by the solver, which is a bound on that of the mean.
    """
    dims = tuple(dim for dim in values.dims if dim != "window")
    found = mean_interval(values.values, axis=values.dims.index("window"))[:3]
    for ending, mean in zip(ENDINGS, found, strict=True):
        words = f"{values.attrs['long_name']}, mean over sub-windows{ENDINGS[ending]}"
        result[f"{name}{ending}"] = (dims, mean, cf_attrs(values.attrs["units"], words))
    if errors is not None:
        words = f"{values.attrs['long_name']}, mean over sub-windows, error by the solver"
        result[f"{name}_error"] = errors.mean("window").transpose(*dims)
        result[f"{name}_error"].attrs = cf_attrs(values.attrs["units"], words)


def _add_law(result, side, values, dim, name, words):
    """Exponent of ``values`` against ``side`` along ``dim``, into ``result``.

    Values that are not positive, or missing, are left out.
    """
    dims = tuple(d for d in values.dims if d != dim)
    rows = values.transpose(*dims, dim).values
    positive = np.where(rows > 0, rows, np.nan)
    shape = rows.shape[:-1]
    lines = [fit_line(np.log(side.values), np.log(positive[index])) for index in np.ndindex(shape)]
    for ending, (field, more) in _LAW.items():
        fitted = np.array([getattr(line, field) for line in lines], float).reshape(shape)
        result[f"{name}{ending}"] = (dims, fitted, cf_attrs("1", f"{words}{more}"))
    for ending, field in (("_b_min", "x_min"), ("_b_max", "x_max")):
        fitted = np.exp([getattr(line, field) for line in lines]).reshape(shape)
        which = "smallest" if ending == "_b_min" else "largest"
        result[f"{name}{ending}"] = (dims, fitted, cf_attrs("mm", f"{which} b of that fit"))


def _add_hurst(result, states, dimension, fit_range):
    """Eq. 2 of the composite topography and of the face, and what it expects, into ``result``."""
    side = states["scale_side"]
    if fit_range is None:
        cell = side.values[0] / np.sqrt(states["scale_cells"].values[0])
        fit_range = FIRST_CELLS * cell, LAST_PART * side.values[0]
    tolerance = 1e-9 * fit_range[1]
    used = (side >= fit_range[0] - tolerance) & (side <= fit_range[1] + tolerance)
    result["scale_used"] = used.assign_attrs(cf_attrs("1", "size taken into the fit of eq. 2"))
    for curve, name, of in (
        ("sigma_z_all", "hurst", "composite topography"),
        ("face_sigma_z", "face_hurst", "lower face"),
    ):
        for ending in ENDINGS:
            result[f"{curve}{ending}"] = states[f"{curve}{ending}"]
        words = f"H of eq. 2, {of}"
        _add_law(result, side, states[curve].where(used), "scale", name, words)
    value, low, high = dimension
    for ending, number in (("", value), ("_low", high), ("_high", low)):
        words = f"H = 3 - Delta_g that eq. 2 expects{_LAW[ending][1]}"
        result[f"expected_hurst{ending}"] = ((), 3.0 - float(number), cf_attrs("1", words))
