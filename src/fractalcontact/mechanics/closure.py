"""Closure and dilatancy of the joint from its contact states (paper, sect. 5)."""

from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.fitting import fit_line
from ..core.intervals import INTERVAL, t_quantile
from ..core.labels import cf_attrs
from ..core.ranges import within
from ..elastic.halfspace import rectangle_mean_displacement
from .area import RESOLVED_NODES
from .load_curve import left_out_misses
from .states import OF_STATES, OFFSETS, error_attrs
from .theory import Numbers

#: Points a hyperbola of two parameters needs before its interval means anything.
FEWEST_HYPERBOLA_POINTS = 4


def bulk_settlement(force: ArrayLike, e_star: float, side_y: float, side_x: float) -> np.ndarray:
    """w_b, mm: mean settlement under the force spread evenly over the nominal window.

    For a square of side b, w_b = 0.946402 F/(E* b).

    Parameters
    ----------
    force : array_like
        F, N.
    e_star : float
        E*, MPa.
    side_y, side_x : float
        Sides of the window, mm.
    """
    mean = rectangle_mean_displacement(side_y, side_x)
    return np.asarray(force) / (side_y * side_x) * mean / e_star


def interface_closure(closure: Numbers, settlement: Numbers, flush: Any = False) -> Any:
    """Interface closure w_int = w - w_b, mm.

    Parameters
    ----------
    closure : float, ndarray or xr.DataArray
        w, mm.
    settlement : float, ndarray or xr.DataArray
        w_b, mm, from :func:`bulk_settlement`.
    flush : bool, ndarray or xr.DataArray
        Where faces match everywhere (a composite topography that is flat).

    Returns
    -------
    ndarray or xr.DataArray
        0 where faces are flush: they have nothing to close. The difference would be
        -0.078 F/(E* b) there, because a flush window is loaded like a rigid punch and w_b belongs
        to a uniform pressure.
    """
    closing = closure - settlement
    if isinstance(closing, xr.DataArray):  # xr.where would drop the labels of the coordinates
        return closing.where(~flush, 0.0)
    return np.where(flush, 0.0, closing)


class Hyperbola(NamedTuple):
    """sigma = k_ni w / (1 - w/w_m) (Bandis et al. 1983), with 95 % intervals.

    ``misfit`` is the rms of the residual closure as a fraction of the largest closure fitted;
    ``reason`` says why there is no fit, else it is empty.
    """

    k_ni: float
    k_ni_low: float
    k_ni_high: float
    w_m: float
    w_m_low: float
    w_m_high: float
    misfit: float
    n: int
    reason: str


def fit_hyperbola(pressure: ArrayLike, closure: ArrayLike) -> Hyperbola:
    """Fit the closure hyperbola, least squares in the closure.

    Parameters
    ----------
    pressure : (n,) array_like
        Nominal pressure sigma, MPa.
    closure : (n,) array_like
        Interface closure w_int, mm.

    Returns
    -------
    Hyperbola
        k_ni in MPa/mm, w_m in mm. NaN, with a reason, where the curve cannot be a hyperbola.

    Notes
    -----
    Solved for w the law reads w = sigma w_m / (k_ni w_m + sigma). Both parameters are positive, so
    the fit and its Student-t interval are made in their logarithms.
    """
    from scipy import optimize

    sigma, w = np.asarray(pressure, float), np.asarray(closure, float)
    usable = np.isfinite(sigma) & np.isfinite(w) & (sigma > 0) & (w > 0)
    sigma, w = sigma[usable], w[usable]
    if sigma.size < FEWEST_HYPERBOLA_POINTS:
        return _no_hyperbola(
            sigma.size, f"{sigma.size} points with w_int > 0, {FEWEST_HYPERBOLA_POINTS} needed"
        )

    def law(sigma, log_k, log_wm):
        k, w_m = np.exp([log_k, log_wm])
        return sigma * w_m / (k * w_m + sigma)

    guess = np.log([2 * sigma[0] / w[0], 1.2 * w.max()])
    try:
        best, covariance = optimize.curve_fit(law, sigma, w, p0=guess, maxfev=5000)
    except RuntimeError:
        return _no_hyperbola(sigma.size, "the least-squares fit did not converge")
    misfit = float(np.sqrt(np.mean((law(sigma, *best) - w) ** 2)) / w.max())
    half = t_quantile(sigma.size - 2) * np.sqrt(np.diag(covariance))
    if not np.isfinite(half).all() or half.max() > np.log(100):
        return _no_hyperbola(sigma.size, "the points do not bend enough to show an asymptote")
    low, high = np.exp(best - half), np.exp(best + half)
    k_ni, w_m = np.exp(best)
    return Hyperbola(
        k_ni=float(k_ni),
        k_ni_low=float(low[0]),
        k_ni_high=float(high[0]),
        w_m=float(w_m),
        w_m_low=float(low[1]),
        w_m_high=float(high[1]),
        misfit=misfit,
        n=sigma.size,
        reason="",
    )


def _no_hyperbola(n: int, reason: str) -> Hyperbola:
    nan = np.nan
    return Hyperbola(nan, nan, nan, nan, nan, nan, nan, n, reason)


def closure_curves(
    states: xr.Dataset,
    window: tuple[float, float],
    e_star: float,
    fit_range: tuple[float, float] | None = None,
) -> xr.Dataset:
    """Closure of the interface at the scan's own resolution, and its hyperbola.

    Parameters
    ----------
    states : xr.Dataset
        From :func:`mechanics.states.combine`.
    window : (float, float)
        Sides (y, x) of the window, mm.
    e_star : float
        E*, MPa.
    fit_range : (float, float), optional
        Smallest and largest force of the fit, N; all by default.

    Returns
    -------
    xr.Dataset
        ``bulk_settlement`` and ``nominal_pressure`` (normal_force); ``interface_closure``,
        ``interface_stiffness``, ``conductance``, ``area_share``, each with an ``_error``,
        ``closure_spacing_error`` and the numbers of the states over (direction, offset, resolution,
        load); the fits over (direction, offset, resolution); what
        :data:`mechanics.states.OFFSETS` names over (direction, offset).
    """
    area = window[0] * window[1]
    result = states[[*OF_STATES, *OFFSETS]].copy()
    _add_interface(result, bulk_settlement(states["normal_force"].values, e_star, *window), area)
    _add_conductance(result, e_star)
    _add_errors(result, area, e_star)
    _add_hyperbolas(result, fit_range)
    return result


def _add_interface(curves: xr.Dataset, settlement: np.ndarray, area: float) -> None:
    """Closure, stiffness and contact of the interface alone, into ``curves``."""
    order = curves["closure"].dims
    force = curves["normal_force"].values
    curves["bulk_settlement"] = ("normal_force", settlement, cf_attrs("mm", "bulk settlement w_b"))
    curves["nominal_pressure"] = ("normal_force", force / area, cf_attrs("MPa", "F / A_0"))
    flush = curves["composite_spread"] == 0
    closing = interface_closure(curves["closure"], curves["bulk_settlement"], flush)
    curves["interface_closure"] = closing.transpose(*order)
    curves["interface_closure"].attrs = cf_attrs("mm", "interface closure w_int = w - w_b")
    curves["area_share"] = curves["area"] / area
    curves["area_share"].attrs = cf_attrs("1", "real contact area A_r / A_0")
    stiffness = interface_stiffness(
        curves["stiffness"] / area, curves["nominal_pressure"] / curves["bulk_settlement"]
    ).where(~flush)
    curves["interface_stiffness"] = stiffness.transpose(*order)
    curves["interface_stiffness"].attrs = cf_attrs(
        "MPa/mm", "stiffness of the interface d sigma / d w_int; none where faces are flush"
    )


def _add_hyperbolas(curves: xr.Dataset, fit_range: tuple[float, float] | None) -> None:
    """The hyperbola of every closure curve, into ``curves``."""
    force = curves["normal_force"].values
    fitted = within(force, *(fit_range or (force.min(), force.max())))
    dims = ("direction", "offset", "resolution")
    fits = np.empty([curves.sizes[dim] for dim in dims], object)
    closures = curves["interface_closure"].transpose(*dims, "normal_force").values
    for index in np.ndindex(fits.shape):
        fits[index] = fit_hyperbola(
            curves["nominal_pressure"].values[fitted], closures[index][fitted]
        )
    for name, units, words in HYPERBOLA_FIELDS:
        kind = str if name == "reason" else float
        values = np.array([getattr(fit, name) for fit in fits.flat], kind).reshape(fits.shape)
        curves[f"hyperbola_{name}"] = (dims, values, cf_attrs(units, words))
    curves.attrs["hyperbola_force_low"] = float(force[fitted].min(initial=np.inf))
    curves.attrs["hyperbola_force_high"] = float(force[fitted].max(initial=-np.inf))


def _add_errors(curves: xr.Dataset, area: float, e_star: float) -> None:
    """Solver error bounds of what follows from the states, and the closures' by the spacing."""
    fraction = (curves["interface_stiffness"] * area / curves["stiffness"]) ** 2
    stiffness = curves["stiffness_error"] / area * fraction
    errors = {
        "interface_closure": curves["closure_error"],
        "area_share": curves["area_error"] / area,
        "interface_stiffness": stiffness,
        "conductance": stiffness / e_star,
    }
    for name, error in errors.items():
        curves[f"{name}_error"] = error.transpose(*curves["closure"].dims)
        curves[f"{name}_error"].attrs = error_attrs(curves[name].attrs)
    curves["closure_spacing_error"] = _spacing_error(curves["closure"])


def _spacing_error(closure: xr.DataArray) -> xr.DataArray:
    """What halving the spacing has changed in the closure, mm; NaN where it was not solved twice.

    It bounds what finer spacings would still change where closures approach their limit like s or
    faster, as that of Hertz does; elsewhere it says how far the last halving went.
    """
    fine = [k for k in closure["resolution"].values if 2 * k in closure["resolution"]]
    coarser = closure.sel(resolution=[2 * k for k in fine]).assign_coords(resolution=fine)
    error = abs(closure - coarser.reindex(resolution=closure["resolution"].values))
    error.attrs = cf_attrs("mm", "closure w, change from twice the spacing to this one")
    return error.transpose(*closure.dims)


def interface_stiffness(total: xr.DataArray, bulk: xr.DataArray) -> xr.DataArray:
    """Stiffness of the interface alone, from that of the whole, of which the bulk is a part.

    The two compliances add up: 1/k = 1/k_int + 1/k_bulk.

    Parameters
    ----------
    total, bulk : xr.DataArray
        d sigma / dw and sigma / w_b, MPa/mm.

    Returns
    -------
    xr.DataArray
        d sigma / d w_int, MPa/mm; NaN where the whole is not more compliant than the bulk (contact
        so full that it answers like a punch).
    """
    compliance = 1 / total - 1 / bulk
    return 1 / compliance.where(compliance > 0)


def _add_conductance(curves: xr.Dataset, e_star: float) -> None:
    """Conductance of the interface and its power of the pressure, into ``curves``.

    Barber (Proc. R. Soc. A 459 (2003) 53): 1/R = 2/(E* (rho_1 + rho_2)) dF/dw. Two blocks of one
    conductivity k = 1/rho, thermal or electrical, give h_c = k/E* d sigma/d w_int per nominal area.
    Loads at which fewer than `RESOLVED_NODES` touch are not fitted: they act on single cells.
    """
    curves["conductance"] = curves["interface_stiffness"] / e_star
    curves["conductance"].attrs = cf_attrs(
        "mm-1", "conductance of the interface per nominal area and conductivity of the material"
    )
    dims = ("direction", "offset", "resolution")
    log_pressure = np.log(curves["nominal_pressure"].values)
    with np.errstate(divide="ignore"):
        resolved = curves["conductance"].where(curves["nodes"] >= RESOLVED_NODES)
        log_conductance = np.log(resolved.transpose(*dims, "normal_force").values)
    shape = log_conductance.shape[:-1]
    fits = [fit_line(log_pressure, row) for row in log_conductance.reshape(-1, len(log_pressure))]
    for ending, of_end in INTERVAL.items():
        values = np.array([getattr(fit, f"slope{ending}") for fit in fits]).reshape(shape)
        words = f"exponent of conductance against pressure{of_end}"
        curves[f"conductance_exponent{ending}"] = (dims, values, cf_attrs("1", words))
    for name, field in (("low", "x_min"), ("high", "x_max")):
        values = np.exp([getattr(fit, field) for fit in fits]).reshape(shape)
        words = f"{name}est pressure of that fit"
        curves[f"conductance_pressure_{name}"] = (dims, values, cf_attrs("MPa", words))


#: What is kept of each hyperbola: field, unit, long name.
HYPERBOLA_FIELDS = (
    ("k_ni", "MPa/mm", "initial normal stiffness k_ni"),
    ("k_ni_low", "MPa/mm", "initial normal stiffness, lower end of the 95 % interval"),
    ("k_ni_high", "MPa/mm", "initial normal stiffness, upper end of the 95 % interval"),
    ("w_m", "mm", "largest closure w_m, the asymptote"),
    ("w_m_low", "mm", "largest closure, lower end of the 95 % interval"),
    ("w_m_high", "mm", "largest closure, upper end of the 95 % interval"),
    ("misfit", "1", "rms misfit as a fraction of the largest closure fitted"),
    ("n", "1", "points fitted"),
    ("reason", "1", "why there is no fit"),
)


def elastic_dilatancy(curves: xr.Dataset, joint: xr.Dataset) -> xr.Dataset:
    """delta(F, v) = delta_r(v) - w_int(F, v) at the scan's own resolution (eq. 4).

    Parameters
    ----------
    curves : xr.Dataset
        From :func:`closure_curves`.
    joint : xr.Dataset
        From :func:`mechanics.joint.describe_joint`.

    Returns
    -------
    xr.Dataset
        Rigid dilatancy over (direction, rigid_offset); ``elastic_dilatancy`` and ``left_out_error``
        over (contact_direction, offset, normal_force), the latter what interpolating the closure
        curve at this force gives wrong when its own state is left out; ``offset_made`` over
        (contact_direction, offset).
    """
    result = joint[["rigid_dilatancy", "composite_rms"]].copy()
    finest = curves.sel(resolution=curves["resolution"].min(), drop=True)
    finest = finest.rename(direction="contact_direction")
    # The opening at the cells whose contact was solved: that of `joint` is at the first direction's
    # offsets, from which those of the others differ where cells are not square.
    elastic = finest["rigid_opening"] - finest["interface_closure"]
    result["elastic_dilatancy"] = elastic.transpose("contact_direction", "offset", "normal_force")
    result["elastic_dilatancy"].attrs = cf_attrs("mm", "elastic dilatancy delta = delta_r - w_int")
    misses = left_out_misses(finest["normal_force"].values, finest["closure"], finest["stiffness"])
    result["left_out_error"] = abs(misses).transpose(*result["elastic_dilatancy"].dims)
    result["left_out_error"].attrs = cf_attrs(
        "mm", "error of delta when interpolated from the states at the loads beside this one"
    )
    # Openings of rigid faces are read off the heights: they have no solver error.
    error = finest["closure_error"].transpose(*result["elastic_dilatancy"].dims)
    result["elastic_dilatancy_error"] = error
    result["elastic_dilatancy_error"].attrs = error_attrs(cf_attrs("mm", "elastic dilatancy"))
    result["offset_made"] = finest["offset_made"]
    return result
