"""Closure and dilatancy of the joint from its contact states (paper, sect. 5)."""

from typing import NamedTuple

import numpy as np
from scipy import optimize, special

from .fitting import CONFIDENCE
from .halfspace import rectangle_mean_displacement
from .labels import about
from .sweep import OFFSETS, SCALARS

#: Points a hyperbola of two parameters needs before its interval means anything.
FEWEST_POINTS = 4


def bulk_settlement(force, e_star, side_y, side_x):
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


class Hyperbola(NamedTuple):
    """sigma = k_ni w / (1 - w/w_m) (Bandis et al. 1983), with 95 % intervals.

    ``misfit`` is the rms of the residual closure as a share of the largest closure fitted;
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


def fit_hyperbola(pressure, closure):
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
    sigma, w = np.asarray(pressure, float), np.asarray(closure, float)
    usable = np.isfinite(sigma) & np.isfinite(w) & (sigma > 0) & (w > 0)
    sigma, w = sigma[usable], w[usable]
    if sigma.size < FEWEST_POINTS:
        return _no_hyperbola(
            sigma.size, f"{sigma.size} points with w_int > 0, {FEWEST_POINTS} needed"
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
    half = special.stdtrit(sigma.size - 2, (1 + CONFIDENCE) / 2) * np.sqrt(np.diag(covariance))
    if not np.isfinite(half).all() or half.max() > np.log(100):
        return _no_hyperbola(sigma.size, "the points do not bend enough to show an asymptote")
    low, high = np.exp(best - half), np.exp(best + half)
    k_ni, w_m = np.exp(best)
    return Hyperbola(
        *(float(x) for x in (k_ni, low[0], high[0], w_m, low[1], high[1])),
        misfit,
        sigma.size,
        "",
    )


def _no_hyperbola(n, reason):
    return Hyperbola(*[np.nan] * 7, n=n, reason=reason)


def closure_curves(states, window, e_star, fit_range=None):
    """Closure of the interface at the scan's own resolution, and its hyperbola.

    Parameters
    ----------
    states : xr.Dataset
        From :func:`fractalcontact.sweep.combine`.
    window : (float, float)
        Sides (y, x) of the window, mm.
    e_star : float
        E*, MPa.
    fit_range : (float, float), optional
        Smallest and largest force of the fit, N; all by default.

    Returns
    -------
    xr.Dataset
        ``bulk_settlement`` and ``nominal_pressure`` (load); ``interface_closure``, ``area_share``
        and the scalars of the states over (direction, offset, resolution, load); the fit over
        (direction, offset, resolution); offset made and rigid opening over (direction, offset).
    """
    force = states["load"]
    result = states[[*SCALARS, *OFFSETS]].copy()
    settlement = bulk_settlement(force.values, e_star, *window)
    area = window[0] * window[1]
    result["bulk_settlement"] = ("load", settlement, about("mm", "bulk settlement w_b"))
    result["nominal_pressure"] = ("load", force.values / area, about("MPa", "F / A_0"))
    result["interface_closure"] = result["closure"] - result["bulk_settlement"]
    result["interface_closure"].attrs = about("mm", "interface closure w_int = w - w_b")
    result["area_share"] = result["area"] / area
    result["area_share"].attrs = about("1", "real contact area A_r / A_0")

    lowest, highest = fit_range or (force.values.min(), force.values.max())
    fitted = (force.values >= lowest * (1 - 1e-9)) & (force.values <= highest * (1 + 1e-9))
    dims = ("direction", "offset", "resolution")
    fits = np.empty([result.sizes[dim] for dim in dims], object)
    for index in np.ndindex(fits.shape):
        curve = result["interface_closure"].transpose(*dims, "load").values[index]
        fits[index] = fit_hyperbola(result["nominal_pressure"].values[fitted], curve[fitted])
    for name, units, words in HYPERBOLA_FIELDS:
        kind = str if name == "reason" else float
        values = np.array([getattr(fit, name) for fit in fits.flat], kind).reshape(fits.shape)
        result[f"hyperbola_{name}"] = (dims, values, about(units, words))
    result.attrs["hyperbola_force_low"] = float(force.values[fitted].min(initial=np.inf))
    result.attrs["hyperbola_force_high"] = float(force.values[fitted].max(initial=-np.inf))
    return result


#: What is kept of each hyperbola: field, unit, long name.
HYPERBOLA_FIELDS = (
    ("k_ni", "MPa/mm", "initial normal stiffness k_ni"),
    ("k_ni_low", "MPa/mm", "initial normal stiffness, lower end of the 95 % interval"),
    ("k_ni_high", "MPa/mm", "initial normal stiffness, upper end of the 95 % interval"),
    ("w_m", "mm", "largest closure w_m, the asymptote"),
    ("w_m_low", "mm", "largest closure, lower end of the 95 % interval"),
    ("w_m_high", "mm", "largest closure, upper end of the 95 % interval"),
    ("misfit", "1", "rms misfit as a share of the largest closure fitted"),
    ("n", "1", "points fitted"),
    ("reason", "1", "why there is no fit"),
)


def elastic_dilatancy(curves, joint):
    """delta(F, v) = delta_r(v) - w_int(F, v) at the scan's own resolution (eq. 4).

    Parameters
    ----------
    curves : xr.Dataset
        From :func:`closure_curves`.
    joint : xr.Dataset
        From :func:`fractalcontact.joint.describe_joint`.

    Returns
    -------
    xr.Dataset
        Rigid dilatancy over (direction, rigid_offset) and ``elastic_dilatancy`` over
        (contact_direction, offset, load), with ``offset_made`` over (contact_direction, offset).
    """
    result = joint[["rigid_dilatancy", "composite_rms"]].copy()
    finest = curves.sel(resolution=curves["resolution"].min(), drop=True)
    finest = finest.rename(direction="contact_direction")
    # The opening at the cells whose contact was solved: that of `joint` is at the first direction's
    # offsets, from which those of the others differ where cells are not square.
    elastic = finest["rigid_opening"] - finest["interface_closure"]
    result["elastic_dilatancy"] = elastic.transpose("contact_direction", "offset", "load")
    result["elastic_dilatancy"].attrs = about("mm", "elastic dilatancy delta = delta_r - w_int")
    result["offset_made"] = finest["offset_made"]
    return result
