"""Real contact area: its correction for the grid, its law, and the theories beside it."""

import numpy as np
import xarray as xr

from ..core.fitting import FEWEST_POINTS, fit_line
from ..core.intervals import mean_interval
from ..core.labels import cf_attrs
from ..roughness.dimension import slope_statistics
from . import theory
from .joint import composite_topography, direction_spacing

#: Area that the cells along the edge of contact have too much, as a part of cell side times
#: staircase perimeter. Yastrebov, Anciaux & Molinari, Tribol. Int. 114 (2017) 161.
EDGE_EXCESS = (np.pi - 1 + np.log(2)) / 24

#: A domain of fewer nodes is left out of the fits of area: one node more or less is 10 % of it.
FEWEST_NODES = 10

#: Light load, on which the theories' straight lines are compared: largest p / (E* h'_rms).
LIGHT_LOAD = 0.02

#: Faces whose composite topography is less steep than this are flush: the rest is rounding.
FLUSH = 1e-9

#: What is kept of a composite topography, by its name in :func:`slope_statistics`.
STATISTICS = ("rms_height", "rms_slope", "m0", "m2", "m4")

#: Why there is no law of the area.
FULL_CONTACT = "the faces touch everywhere at every load"


def contact_perimeter(in_contact, spacing):
    """Length of the cell sides between contact and gap, inside the window, mm.

    Parameters
    ----------
    in_contact : (..., ny, nx) bool array_like
        Contact domains.
    spacing : float or (dy, dx)
        Sides of a cell, mm.

    Returns
    -------
    (...) float64
        The staircase along the sides of cells; sides on the window's own edge do not count, for
        what lies beyond is not known.
    """
    dy, dx = np.broadcast_to(np.asarray(spacing, float), 2)
    above, beside = _edges(in_contact)
    return above * dx + beside * dy


def corrected_area(in_contact, spacing):
    """Real contact area without what the grid adds along its edge, mm2.

    Parameters
    ----------
    in_contact : (..., ny, nx) bool array_like
        Contact domains of solved states.
    spacing : float or (dy, dx)
        Sides of a cell, mm.

    Returns
    -------
    (...) float64
        mm2, never below 0.

    Notes
    -----
    A cell that the true contact cuts carries pressure even where less than half of it touches, so
    that N s^2 is too large by about (pi - 1 + ln 2)/24 S_d s, S_d being the staircase perimeter
    (Yastrebov, Anciaux & Molinari, Tribol. Int. 114 (2017) 161). On cells that are not square each
    side counts with the cell's area, as if the axes were stretched to make it square. A node on its
    own keeps 0.53 of its cell. On six rough surfaces at p/(E* h'_rms) = 0.01, beside the corrected
    area on a grid 8 times finer: the raw area was 36 to 70 % and the corrected one 1 to 13 % too
    large where the shortest waves were two cells long, 16 to 31 % and less than 4 % off at four.
    """
    dy, dx = np.broadcast_to(np.asarray(spacing, float), 2)
    edges = np.sum(_edges(in_contact), axis=0)
    nodes = np.count_nonzero(in_contact, axis=(-2, -1))
    return np.maximum(nodes - EDGE_EXCESS * edges, 0.0) * dy * dx


def _edges(in_contact):
    """Number of cell sides between contact and gap, along x (cells above each other) and y."""
    domain = np.asarray(in_contact, bool)
    return tuple(
        np.count_nonzero(first != second, axis=(-2, -1))
        for first, second in (
            (domain[..., 1:, :], domain[..., :-1, :]),
            (domain[..., :, 1:], domain[..., :, :-1]),
        )
    )


def composite_statistics(specimen, direction, cells):
    """Heights, slopes and spectral moments of the composite topography at each offset.

    Parameters
    ----------
    specimen, direction
        As for :func:`mechanics.joint.composite_topography`.
    cells : (n,) int array_like
        Offsets in cells.

    Returns
    -------
    xr.Dataset
        :data:`STATISTICS` over (offset,), at the scan's own spacing: slopes are differences of
        neighbouring nodes and grow as the spacing falls. Attributes ``spacing_y``, ``spacing_x``.

    Notes
    -----
    On a self-affine surface of H = 0.8 whose spectrum reaches to the smallest wave of the grid the
    differences give 0.93 to 0.94 of the slope of the waves themselves.
    """
    spacing = specimen.attrs["spacing_y"], specimen.attrs["spacing_x"]
    made = np.asarray(cells, int) * direction_spacing(specimen, direction)
    each = [
        slope_statistics(composite_topography(specimen, direction, n), spacing)[list(STATISTICS)]
        for n in cells
    ]
    result = xr.concat(each, "offset", combine_attrs="override")
    result["offset"] = ("offset", made, cf_attrs("mm", "shear offset v"))
    result.attrs = {"spacing_y": float(spacing[0]), "spacing_x": float(spacing[1])}
    return result


def joint_statistics(specimen, joint):
    """`composite_statistics` of every direction whose contact is solved.

    Parameters
    ----------
    specimen : xr.Dataset
    joint : xr.Dataset
        From :func:`mechanics.joint.describe_joint`.

    Returns
    -------
    xr.Dataset
        :data:`STATISTICS` over (direction, offset), offsets ascending and, as in
        :func:`mechanics.states.combine`, those of the first direction.
    """
    directions = [str(name) for name in joint["contact_direction"].values]
    each = [
        composite_statistics(
            specimen, name, joint["offset_cells"].sel(contact_direction=name).values
        ).sortby("offset")
        for name in directions
    ]
    result = xr.concat(each, "direction", join="override", combine_attrs="override")
    return result.assign_coords(direction=directions)


def area_laws(curves, statistics, e_star, dimension):
    """How the real contact area grows with the force, and what the theories make of the surface.

    Parameters
    ----------
    curves : xr.Dataset
        From :func:`mechanics.closure.closure_curves`; the finest resolution is used.
    statistics : xr.Dataset
        From :func:`joint_statistics`, of the same directions and offsets.
    e_star : float
        E*, MPa.
    dimension : float
        Delta_g of the surface, for Majumdar and Bhushan's law; NaN leaves that out.

    Returns
    -------
    xr.Dataset
        Over (direction, offset): the statistics; the law A_r ~ F^m as :data:`LAW` has it, and with
        ``corrected_`` before its name that of the corrected area; ``departure``, the largest
        deviation of A_r/F from its geometric mean over the loads fitted; means of kappa at light
        load; ``no_law`` and ``no_mean_kappa``, reasons; the asperities. Over (direction, offset,
        load): ``fitted``, ``light``, ``reduced_pressure``, ``kappa`` and ``corrected_kappa``, and
        the shares A_r/A_0 of the theories. ``departure`` and the kappas have an ``_error``, by the
        solver.

    Notes
    -----
    Flush faces have no slope: kappa and all theories are NaN, and full contact is no law. The
    interval of a mean kappa is over loads on one surface; other surfaces scatter more (see
    :mod:`experiments.area_slope`).
    """
    finest = curves.sel(resolution=curves["resolution"].min(), drop=True)
    finest, statistics = xr.align(finest, statistics, join="exact")
    spacing = statistics.attrs["spacing_y"], statistics.attrs["spacing_x"]
    node_share = np.prod(spacing) * finest["nominal_pressure"] / finest["load"]
    touching = finest["area_share"] > (FEWEST_NODES - 0.5) * node_share
    result = statistics.copy()
    result["fitted"] = touching & (finest["area_share"] < 1 - 0.5 * node_share)
    result["fitted"].attrs = cf_attrs("1", "load used in the fits of area against force")
    _add_laws(result, finest)
    _add_kappa(result, finest, e_star, touching)
    _add_theories(result, finest, e_star, dimension, float(np.sqrt(np.prod(spacing))))
    return result.transpose("direction", "offset", "load", ...)


#: What is kept of a law A_r ~ F^m: name, field of the fit in logarithms, unit, long name.
LAW = (
    ("exponent", "slope", "1", "exponent m of real contact area against force"),
    ("exponent_low", "slope_low", "1", "exponent m, lower end of the 95 % interval"),
    ("exponent_high", "slope_high", "1", "exponent m, upper end of the 95 % interval"),
    ("unit_area", "intercept", "mm2", "real contact area at 1 N by the fitted law"),
    ("unit_area_low", "intercept_low", "mm2", "that area, lower end of the 95 % interval"),
    ("unit_area_high", "intercept_high", "mm2", "that area, upper end of the 95 % interval"),
    ("force_low", "x_min", "N", "smallest force fitted"),
    ("force_high", "x_max", "N", "largest force fitted"),
    ("n", "n", "1", "loads fitted"),
)

#: Fields of a fit in logarithms that are logarithms themselves.
_LOGARITHMS = ("intercept", "intercept_low", "intercept_high", "x_min", "x_max")


def _add_laws(result, curves):
    """Power laws of raw and corrected area, departure from linearity, reasons for none."""
    dims = ("direction", "offset")
    force = np.log(curves["load"].values)
    fitted = result["fitted"].transpose(*dims, "load").values
    for prefix, name in (("", "area"), ("corrected_", "area_corrected")):
        area = np.log(curves[name].transpose(*dims, "load").where(fitted).values)
        lines = np.empty(area.shape[:2], object)
        for index in np.ndindex(lines.shape):
            lines[index] = fit_line(force[fitted[index]], area[index][fitted[index]])
        for key, field, units, words in LAW:
            values = np.array([getattr(line, field) for line in lines.flat]).reshape(lines.shape)
            values = np.exp(values) if field in _LOGARITHMS else values
            kind = ", corrected area" if prefix else ""
            result[prefix + key] = (dims, values, cf_attrs(units, words + kind))

    log_ratio = np.log(curves["area"] / curves["load"]).where(result["fitted"])
    deviation = np.exp(np.abs(log_ratio - log_ratio.mean("load")).max("load")) - 1
    result["departure"] = deviation.where(np.isfinite(result["exponent"]))
    result["departure"].attrs = cf_attrs(
        "1", "largest deviation of A_r/F from its geometric mean, a part of it"
    )
    share = np.minimum(curves["area_error"] / curves["area"], 1)
    with np.errstate(divide="ignore"):  # a law of which nothing is sure
        off = abs(np.log1p(-share)).where(result["fitted"])
    error = (1 + result["departure"]) * np.expm1(off.max("load") + off.mean("load"))
    result["departure_error"] = error.assign_attrs(
        cf_attrs("1", "largest deviation of A_r/F from its geometric mean, error by the solver")
    )
    full = (curves["area_share"] > 0.5).all("load") & ~result["fitted"].any("load")
    reasons = [
        "" if n >= FEWEST_POINTS else FULL_CONTACT if whole else _too_few(n)
        for n, whole in zip(
            result["n"].values.ravel().astype(int), full.values.ravel(), strict=True
        )
    ]
    reasons = np.array(reasons).reshape(result["n"].shape)
    result["no_law"] = (dims, reasons, cf_attrs("1", "why there is no law of the area"))


def _too_few(n):
    return f"{n} of {FEWEST_POINTS} loads with {FEWEST_NODES} nodes in contact, but not all"


def _add_kappa(result, curves, e_star, touching):
    """kappa of A/A0 = kappa p / (E* h'_rms), raw and corrected, and its mean at light load."""
    slope = result["rms_slope"].where(result["rms_slope"] > FLUSH)
    reduced = curves["nominal_pressure"] / (e_star * slope)
    result["reduced_pressure"] = reduced.assign_attrs(cf_attrs("1", "p / (E* h'_rms)"))
    light = touching & (reduced <= LIGHT_LOAD)
    result["light"] = light.assign_attrs(
        cf_attrs("1", f"{FEWEST_NODES} nodes or more touch and p / (E* h'_rms) <= {LIGHT_LOAD:g}")
    )
    nominal = curves["load"] / curves["nominal_pressure"]
    for prefix, name, words in (
        ("", "area", "area slope kappa = (A_r/A_0) E* h'_rms / p"),
        ("corrected_", "area_corrected", "area slope kappa, corrected area"),
    ):
        kappa = curves[name] / nominal / reduced
        result[f"{prefix}kappa"] = kappa.assign_attrs(cf_attrs("1", words))
        result[f"{prefix}kappa_error"] = (curves[f"{name}_error"] / nominal / reduced).assign_attrs(
            cf_attrs("1", f"{words}, error by the solver")
        )
        means = xr.apply_ufunc(
            lambda values: mean_interval(values, axis=-1)[:3],
            kappa.where(light),
            input_core_dims=[["load"]],
            output_core_dims=[[], [], []],
        )
        ends = ("", ", lower end of the 95 % interval", ", upper end of the 95 % interval")
        for key, mean, end in zip(("", "_low", "_high"), means, ends, strict=True):
            text = f"mean of {words}, at light load{end}"
            result[f"{prefix}mean_kappa{key}"] = mean.assign_attrs(cf_attrs("1", text))
    result["mean_kappa_n"] = light.sum("load").assign_attrs(cf_attrs("1", "loads in the mean"))
    reason = xr.where(
        np.isnan(slope),
        "the faces are flush and have no slope",
        f"no load with p / (E* h'_rms) <= {LIGHT_LOAD:g} and {FEWEST_NODES} nodes in contact",
    )
    reason = xr.where(result["mean_kappa_n"] > 0, "", reason)
    result["no_mean_kappa"] = reason.assign_attrs(cf_attrs("1", "why there is no mean of kappa"))


def _add_theories(result, curves, e_star, dimension, spacing):
    """Asperities and fractal parameters of the surface, and the areas the theories make of them."""
    rough = result.where(result["rms_slope"] > FLUSH)
    force, pressure = curves["load"], curves["nominal_pressure"]
    nominal = force / pressure
    summits = theory.asperities(rough["m0"], rough["m2"], rough["m4"])
    deviation = result["m0"].copy(data=summits.height_deviation)
    profile = float(dimension) - 1
    scale = theory.roughness_scale(rough["m2"] * spacing**2, spacing, profile)
    bush = theory.linear_area(pressure, e_star, rough["rms_slope"], theory.BUSH_GIBSON_THOMAS_KAPPA)
    greenwood = theory.greenwood_williamson_area(force, e_star, summits.radius, deviation)
    majumdar = theory.majumdar_bhushan_area(force, e_star, profile, scale)
    for name, values, units, words in (
        ("summit_density", summits.density, "mm-2", "summits per area"),
        ("summit_radius", summits.radius, "mm", "mean radius R of the summits"),
        ("summit_deviation", deviation, "mm", "standard deviation sigma_s of summit heights"),
        ("fractal_scale", scale, "mm", "Majumdar and Bhushan's G, from S at one cell's lag"),
        (
            "persson_share",
            theory.persson_area(pressure, e_star, rough["rms_slope"]),
            "1",
            "A_r/A_0 by Persson",
        ),
        ("bush_gibson_thomas_share", bush, "1", "A_r/A_0 by Bush, Gibson and Thomas"),
        ("greenwood_williamson_share", greenwood / nominal, "1", "A_r/A_0 by Greenwood-Williamson"),
        ("majumdar_bhushan_share", majumdar / nominal, "1", "A_r/A_0 by Majumdar and Bhushan"),
    ):
        result[name] = values.assign_attrs(cf_attrs(units, words))
    result["profile_dimension"] = ((), profile, cf_attrs("1", "D = Delta_g - 1 of the profiles"))
    result["majumdar_bhushan_exponent"] = (
        (),
        2 / (3 - profile) if 1 < profile < 1.5 else np.nan,
        cf_attrs("1", "exponent 2/(3-D) of area against force by Majumdar and Bhushan"),
    )
    levels = np.arange(1, 4)
    result["archard_exponent"] = (
        "archard_level",
        theory.archard_exponent(levels),
        cf_attrs("1", "exponent 1 - 3^-n of area against force by Archard"),
    )
    result["archard_level"] = (
        "archard_level",
        levels,
        cf_attrs("1", "generations n of spheres upon spheres"),
    )
    result.attrs |= {
        "e_star": float(e_star),
        "persson_kappa": float(theory.PERSSON_KAPPA),
        "bush_gibson_thomas_kappa": float(theory.BUSH_GIBSON_THOMAS_KAPPA),
        "computed_kappa": list(theory.COMPUTED_KAPPA),
    }
