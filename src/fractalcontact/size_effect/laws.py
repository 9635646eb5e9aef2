"""Laws of sigma_z, closure, compliance and strength over the side b (eq. 2, sect. 5)."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from ..core.estimate import Estimate, names_of
from ..core.labels import cf_attrs
from ..core.limits import CORRECTED_NODES, RESOLVED_NODES
from ..core.ranges import within
from ..core.settings import Friction
from ..joint.jrc import profile_roughness
from .division import spread_windows
from .size_exponents import add_size_exponents, of_usable_sizes
from .strength_laws import add_slope_trends, strength_by_size
from .window_means import add_law, add_mean, power_through

#: Cells, and fraction of the window's side, between which eq. 2 is fitted unless a range is given:
#: the range of the roughness-length estimator of :mod:`roughness.dimension`.
FIRST_FITTED_CELLS, LAST_FITTED_FRACTION = 8, 1 / 4

#: Means over sub-windows that are fitted as powers of b: name of the exponent, fewest nodes in
#: contact of every sub-window of a size.
_OVER_LOADS = {
    "interface_closure": ("closure_exponent", RESOLVED_NODES, "exponent of w_int against b"),
    "interface_compliance": (
        "compliance_exponent",
        RESOLVED_NODES,
        "exponent of interface compliance against b",
    ),
    "corrected_area_share": (
        "area_exponent",
        CORRECTED_NODES,
        "exponent of corrected A_r/A_0 against b",
    ),
}
#: A null model of the voids, in words.
RANDOM_VOID = "the largest void among as many random nodes"

#: Means without the part of the bulk; below 0 they mean nothing.
_OF_INTERFACE = ("interface_closure", "interface_compliance")


def joint_by_size(
    states: xr.Dataset,
    specimen: xr.Dataset,
    dimension: Estimate,
    lags: Sequence[float] | None,
    material: Friction,
) -> xr.Dataset:
    """Size laws of a joint: closure, roughness and strength of its sub-windows against b.

    As :func:`size_laws`, with the JRC of the face and eq. 2 fitted over windows that look at the
    waves of the lags, mm, stated for Delta_g or below a roll-off.
    """
    roughness, direction = np.nan, states["direction"].item()
    if direction != "none":
        roughness = float(profile_roughness(specimen, direction)["jrc_used"])
    # A window of side b looks at waves of b, a lag at waves of twice its length.
    sides = None if lags is None else [2 * lag for lag in lags]
    return size_laws(states, material, roughness, dimension, sides)


def size_laws(
    states: xr.Dataset,
    material: Friction,
    roughness: float,
    dimension: Estimate,
    fit_range: Sequence[float] | None = None,
) -> xr.Dataset:
    """Means over the sub-windows of each size, and the powers of b they follow.

    ``states`` are those of :func:`size_effect.windows.window_states`, ``roughness`` is the JRC of
    the face as used in Barton's law (``jrc_used`` of :func:`joint.jrc.profile_roughness`; NaN for
    a joint that does not slide), and ``dimension`` a Delta_g of the face that does not come from
    sigma_z: eq. 2 expects H = 3 - Delta_g. The fits of sigma_z take sides b within ``fit_range``,
    mm, by default from `FIRST_FITTED_CELLS` cells to `LAST_FITTED_FRACTION` of the window.

    Eq. 2: ``hurst`` (offset) of the composite topography, ``face_hurst`` and ``expected_hurst``,
    and the curves they come from. Closure: ``interface_closure``, ``interface_compliance``,
    ``area_share``, ``corrected_area_share`` and ``mean_gap`` (part, offset, load) with the interval
    of the mean over the sub-windows and the ``_error`` of the solver, and the exponents of closure,
    compliance and corrected area (offset, normal_force) with intervals over disjoint sub-windows,
    see :func:`size_effect.size_exponents.size_exponent`. Strength, where the joint slides: see
    :func:`size_effect.strength_laws.strength_by_size`.

    Any other power law is a line through the logarithms of the means, one a size. The largest size
    is one window: nothing is known of the scatter of its value, and it weighs as much as the
    others. Small sub-windows are pieces of large ones, so that the sizes are not independent
    either.
    """
    result = states[["side", "nominal_pressure", "scale_side", "scale_n"]].copy()
    result["windows"] = states["sigma_z"].isel(offset=0).notnull().sum("window")
    result["windows"].attrs = cf_attrs("1", "sub-windows solved of each size")
    _add_hurst(result, states, dimension, fit_range)
    _add_exponents(result, states)
    for name in ("sigma_z", "mean_gap"):
        add_mean(result, name, states[name])
    if states["direction"].item() != "none":
        result = result.merge(strength_by_size(states, material, roughness))
        add_slope_trends(result)
    return result.assign_attrs(states.attrs)


def _add_exponents(result: xr.Dataset, states: xr.Dataset) -> None:
    """Means under every load, and exponents of sizes whose contact is resolved, into ``result``."""
    add_mean(result, "area_share", states["area_share"], states["area_share_error"])
    places = [
        spread_windows(int(parts), int(count))
        for parts, count in zip(states["part"], result["windows"], strict=True)
    ]
    dims = ("part", "window", "offset", "normal_force")
    nodes = states["nodes"].transpose(*dims)
    heights = states["sigma_z"].broadcast_like(nodes).transpose(*dims)
    for values, exponent, words in (
        (states["largest_void"].transpose(*dims), "void_exponent", "the largest void"),
        (states["random_void"].transpose(*dims), "random_void_exponent", RANDOM_VOID),
        (states["mean_gap"].transpose(*dims), "gap_exponent", "the mean gap"),
        (heights, "roughness_exponent", "sigma_z about the own plane"),
    ):
        usable = values.copy(data=of_usable_sizes(values.values, nodes.values, RESOLVED_NODES))
        add_size_exponents(result, exponent, usable, places, f"exponent of {words} against b")
    for name, (exponent, fewest, words) in _OVER_LOADS.items():
        values, error, of_nodes = states[name], states[f"{name}_error"], nodes
        if name == "corrected_area_share":
            occupied = states["occupied"] != 0
            values, error, of_nodes = (of.where(occupied) for of in (values, error, nodes))
            of_nodes = of_nodes.transpose(*dims)
        add_mean(result, name, values, error)
        if name in _OF_INTERFACE:
            # Contact is too full there to separate the interface from the bulk.
            below = result[name] < 0
            for kept in (*names_of(name), f"{name}_error"):
                result[kept] = result[kept].where(~below)
        values = values.transpose(*dims)
        values = values.copy(data=of_usable_sizes(values.values, of_nodes.values, fewest))
        add_size_exponents(result, exponent, values, places, words)
    add_fitted(result)
    add_lines(result)


def add_fitted(result: xr.Dataset) -> None:
    """Means that each exponent is fitted to, marked in ``result`` as ``NAME_fitted``."""
    for name, (exponent, *_) in _OVER_LOADS.items():
        inside = within(result["side"], result[f"{exponent}_b_min"], result[f"{exponent}_b_max"])
        fitted = result[exponent].notnull() & (result[name] > 0) & inside
        attrs = cf_attrs("1", f"size that {exponent} is fitted to")
        result[f"{name}_fitted"] = fitted.transpose(*result[name].dims).assign_attrs(attrs)
    fitted = result["scale_used"] & result["face_sigma_z"].notnull()
    fitted &= result["face_hurst"].notnull()
    attrs = cf_attrs("1", "size that H of the lower face is fitted to")
    result["face_sigma_z_fitted"] = fitted.assign_attrs(attrs)


def add_lines(result: xr.Dataset) -> None:
    """Lines of the power laws over the sizes that they are fitted to, into ``result``.

    ``interface_closure_law``, ``interface_compliance_law`` and ``face_sigma_z_expected``, eq. 2.
    """
    for name in _OF_INTERFACE:
        fitted, exponent = result[name].where(result[f"{name}_fitted"]), _OVER_LOADS[name][0]
        words = f"power law of {name} over b with {exponent}"
        result[f"{name}_law"] = power_through(fitted, result["side"], result[exponent], words)
    face = result["face_sigma_z"].where(result["face_sigma_z_fitted"])
    words = "sigma_z of the lower face over b as eq. 2 expects it from Delta_g"
    result["face_sigma_z_expected"] = power_through(
        face, result["scale_side"], result["expected_hurst"], words
    )


def _add_hurst(
    result: xr.Dataset,
    states: xr.Dataset,
    dimension: Estimate,
    fit_range: Sequence[float] | None,
) -> None:
    """Eq. 2 of composite topography and face, and its expectation, stored in ``result``."""
    side = states["scale_side"]
    if fit_range is None:
        cell = side.values[0] / np.sqrt(states["scale_cells"].values[0])
        fit_range = FIRST_FITTED_CELLS * cell, LAST_FITTED_FRACTION * side.values[0]
    used = within(side, *fit_range)
    result["scale_used"] = used.assign_attrs(cf_attrs("1", "size taken into the fit of eq. 2"))
    for curve, name, surface in (
        ("sigma_z_all", "hurst", "composite topography"),
        ("face_sigma_z", "face_hurst", "lower face"),
    ):
        result.update(states[names_of(curve)])
        add_law(result, name, side, states[curve].where(used), f"H of eq. 2, {surface}")
    expected = dimension.mapped(lambda delta: 3.0 - float(delta), falling=True)
    words = "H = 3 - Delta_g that eq. 2 expects"
    result.update(expected.variables("expected_hurst", (), "1", words))
