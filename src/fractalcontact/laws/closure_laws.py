"""Laws of closure curves: the hyperbola, the semi-logarithmic law, and which of them fits better.

Both have two parameters and are fitted by least squares in the closure to the same states, so that
their misfits can be compared.
"""

from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.datasets import labelled
from ..core.estimate import NO_ESTIMATE, Estimate
from ..core.fitting import fit_line
from ..core.intervals import t_quantile
from ..core.labels import cf_attrs
from ..core.limits import GOOD_FIT, RESOLVED_NODES
from ..core.ranges import within
from ..core.text import percent
from ..core.verdicts import HYPERBOLA, NEITHER, SEMI_LOGARITHMIC, TOO_WIDE, UNDECIDED

#: States a law of two parameters needs before its interval means anything.
MIN_CLOSURE_POINTS = 4


#: Logarithms of the parameters beyond which nothing is sought.
FARTHEST = 200.0

#: Misfits this near to each other, as a fraction of the larger one, separate no laws.
EQUAL_MISFIT = 0.1


class Hyperbola(NamedTuple):
    """sigma_0 = k_ni w / (1 - w/w_m) (Bandis et al. 1983), k_ni in MPa/mm and w_m in mm.

    ``misfit`` is the rms of the residual closure as a fraction of the largest closure fitted;
    ``reason`` says why there is no fit, else it is empty.
    """

    k_ni: Estimate = NO_ESTIMATE
    w_m: Estimate = NO_ESTIMATE
    misfit: float = np.nan
    n: int = 0
    reason: str = ""


class SemiLogarithmic(NamedTuple):
    """w = a + b ln(sigma_0 / 1 MPa), a and b in mm; ``misfit``, ``reason`` as a hyperbola's.

    Bandis et al. (1983) found it for mismatched joints; where the separation u of two rough faces
    follows sigma_0 ~ exp(-u/u_0) (Persson, Phys. Rev. Lett. 99 (2007) 125502), b is u_0. Its
    tangent stiffness is sigma_0 / b.
    """

    a: Estimate = NO_ESTIMATE
    b: Estimate = NO_ESTIMATE
    misfit: float = np.nan
    n: int = 0
    reason: str = ""


def fit_hyperbola(pressure: ArrayLike, closure: ArrayLike, seat: float = 0.0) -> Hyperbola:
    """Fit the closure hyperbola, least squares in the closure.

    Parameters
    ----------
    pressure : (n,) array_like
        Nominal pressure sigma_0, MPa.
    closure : (n,) array_like
        Interface closure, mm: from first touch, or from the seat on.
    seat : float, optional
        Nominal pressure at which the closure counts from zero, MPa.

    Returns
    -------
    Hyperbola
        k_ni in MPa/mm, w_m in mm. NaN, with a reason, where the curve cannot be a hyperbola.

    Notes
    -----
    Solved for w the law reads w = sigma w_m / (k_ni w_m + sigma). A closure from the seat is its
    difference, w(sigma) - w(seat), so that both constants keep their meaning: k_ni is the slope at
    zero load and w_m the closure from there on. Both parameters are positive, so the fit and its
    Student-t interval are made in their logarithms. No state is fitted at zero load: k_ni is an
    extrapolation.
    """
    from scipy import optimize

    sigma, w = _usable(pressure, closure, seat)
    if sigma.size < MIN_CLOSURE_POINTS:
        return Hyperbola(n=sigma.size, reason=_too_few(sigma.size))

    def law(sigma, log_k, log_wm):
        # A search along a straight curve, which has no asymptote, runs far.
        k, w_m = np.exp(np.clip([log_k, log_wm], -FARTHEST, FARTHEST))
        return w_m * (sigma / (k * w_m + sigma) - seat / (k * w_m + seat))

    guess = np.log([2 * (sigma[0] - seat) / w[0], 1.2 * w.max()])
    try:
        best, covariance = optimize.curve_fit(law, sigma, w, p0=guess, maxfev=5000)
    except RuntimeError:
        return Hyperbola(n=sigma.size, reason="the least-squares fit did not converge")
    misfit = float(np.sqrt(np.mean((law(sigma, *best) - w) ** 2)) / w.max())
    half = t_quantile(sigma.size - 2) * np.sqrt(np.diag(covariance))
    if not np.isfinite(half).all() or half.max() > np.log(100):
        reason = "the points do not bend enough to show an asymptote"
        return Hyperbola(n=sigma.size, reason=reason)
    ends = np.exp([best, best - half, best + half])
    k_ni, w_m = (Estimate(float(v), float(low), float(high)) for v, low, high in ends.T)
    return Hyperbola(k_ni, w_m, misfit, sigma.size)


def fit_semi_logarithmic(pressure: ArrayLike, closure: ArrayLike) -> SemiLogarithmic:
    """Fit the semi-logarithmic law of closure, least squares in the closure.

    Parameters
    ----------
    pressure, closure
        As for :func:`fit_hyperbola`.

    Returns
    -------
    SemiLogarithmic
        a (the closure at 1 MPa) and b in mm; NaN, with a reason, where there are too few points.
    """
    sigma, w = _usable(pressure, closure)
    if sigma.size < MIN_CLOSURE_POINTS:
        return SemiLogarithmic(n=sigma.size, reason=_too_few(sigma.size))
    line = fit_line(np.log(sigma), w)
    residual = w - (line.intercept.value + line.slope.value * np.log(sigma))
    misfit = float(np.sqrt(np.mean(residual**2)) / w.max())
    return SemiLogarithmic(line.intercept, line.slope, misfit, line.n)


class Law(NamedTuple):
    """Law of a closure curve, one of :data:`LAWS`, or the reason for none."""

    name: str
    reason: str


def better_law(hyperbola: Hyperbola, semi_logarithmic: SemiLogarithmic) -> Law:
    """The law that fits a closure curve better, by its rms misfit.

    Parameters
    ----------
    hyperbola, semi_logarithmic
        Fits to the same states.

    Returns
    -------
    Law
        "neither" where the better one misses by more than `GOOD_FIT`, "undecided" where the misfits
        differ by less than `EQUAL_MISFIT` of the larger, empty where there are too few states.
    """
    if semi_logarithmic.reason:
        return Law("", semi_logarithmic.reason)
    misfits = {HYPERBOLA: hyperbola.misfit, SEMI_LOGARITHMIC: semi_logarithmic.misfit}
    misfits = {name: misfit for name, misfit in misfits.items() if np.isfinite(misfit)}
    best = min(misfits, key=misfits.__getitem__)
    if misfits[best] > GOOD_FIT:
        return Law(NEITHER, f"the better one misses by {misfits[best]:.1%} rms of the largest w")
    apart = max(misfits.values()) - misfits[best]
    if len(misfits) == 2 and apart <= EQUAL_MISFIT * max(misfits.values()):
        return Law(UNDECIDED, f"both miss by {misfits[best]:.1%} rms of the largest w")
    return Law(best, "")


def undetermined_stiffness(hyperbola: Hyperbola, law: Law) -> str:
    """Reason why k_ni of a closure curve is undetermined; empty where it is determined.

    Parameters
    ----------
    hyperbola : Hyperbola
    law : Law
        From :func:`better_law`, of the same curve.

    Returns
    -------
    str
        k_ni is a parameter of the hyperbola: it is undetermined where that is not the law of the
        curve, and where its interval is too wide to be of use.
    """
    if hyperbola.reason:
        return hyperbola.reason
    if law.name not in (HYPERBOLA, UNDECIDED):
        missed = f"{percent(hyperbola.misfit)} rms of the largest closure"
        less = ", a logarithm less" if law.name == SEMI_LOGARITHMIC else ""
        return f"the hyperbola misses the curve by {missed}{less}"
    if not hyperbola.k_ni.determined:
        return TOO_WIDE
    return ""


def _usable(
    pressure: ArrayLike, closure: ArrayLike, seat: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Points above the seat that either law can be fitted to."""
    sigma, w = np.asarray(pressure, float), np.asarray(closure, float)
    usable = np.isfinite(sigma) & np.isfinite(w) & (sigma > seat) & (w > 0)
    return sigma[usable], w[usable]


def _too_few(n: int) -> str:
    return f"{n} points with w_int > 0, {MIN_CLOSURE_POINTS} needed"


#: Parameters of both laws by their prefix in the atlas: unit, long name.
_PARAMETERS = {
    "hyperbola": {
        "k_ni": ("MPa/mm", "initial normal stiffness k_ni, extrapolated to zero load"),
        "w_m": ("mm", "largest closure w_m, the asymptote"),
    },
    "semi_logarithmic": {
        "a": ("mm", "semi-logarithmic law w_int = a + b ln(sigma_0 / 1 MPa), a"),
        "b": ("mm", "semi-logarithmic law w_int = a + b ln(sigma_0 / 1 MPa), b"),
    },
}
#: What is kept of either law besides: type, long name.
_OF_FITS = {
    "misfit": (float, "rms misfit as a fraction of the largest closure fitted"),
    "n": (float, "points fitted"),
    "reason": (str, "why there is no fit"),
}

_DIMS = ("direction", "offset", "resolution")

#: What is kept of the laws of every curve besides their parameters: unit, long name.
_OF_CURVES = {
    "hyperbola_k_ni_change": (
        "1",
        "relative change of k_ni at twice the spacing; missing where it was not solved",
    ),
    "hyperbola_k_ni_determined": ("1", "whether the hyperbola is the law, and k_ni is determined"),
    "hyperbola_k_ni_reason": ("1", "why k_ni is undetermined"),
    "softer_than_k_ni": ("1", "whether the curve is softer than its k_ni under any load"),
    "closure_law": ("1", "the law that fits better: hyperbola, semi-logarithmic, or neither"),
    "closure_law_reason": ("1", "why no law is named"),
    "closure_fit_min": ("N", "smallest force fitted"),
    "closure_fit_max": ("N", "largest force fitted"),
}


def add_closure_laws(curves: xr.Dataset, fit_range: tuple[float, float] | None) -> None:
    """Add both laws of every closure curve, and which fits better, to a closure stage.

    Parameters
    ----------
    curves : xr.Dataset
        With ``interface_closure`` and ``resolved`` over (direction, offset, resolution, load); the
        fits are added to it. States that are not resolved are not fitted.
    fit_range : (float, float) or None
        Smallest and largest force of the fits, N; all by default.
    """
    force, pressure = curves["normal_force"].values, curves["nominal_pressure"].values
    inside = within(force, *(fit_range or (force.min(), force.max())))
    order = (*_DIMS, "normal_force")
    closure = curves["interface_closure"].transpose(*order).values
    resolved = curves["resolved"].transpose(*order).values & (closure > 0)
    fitted = resolved & inside
    fits = np.empty(closure.shape[:-1], object)
    for place in np.ndindex(fits.shape):
        points = pressure[fitted[place]], closure[place][fitted[place]]
        hyperbola, semi_logarithmic = fit_hyperbola(*points), fit_semi_logarithmic(*points)
        if fitted[place].sum() < MIN_CLOSURE_POINTS:
            few = _few_states(closure[place] > 0, resolved[place], fitted[place])
            hyperbola = hyperbola._replace(reason=few)
            semi_logarithmic = semi_logarithmic._replace(reason=few)
        fits[place] = hyperbola, semi_logarithmic, better_law(hyperbola, semi_logarithmic)
    for law, (prefix, parameters) in enumerate(_PARAMETERS.items()):
        for name, words in parameters.items():
            each = Estimate.stack((getattr(fit[law], name) for fit in fits.flat), fits.shape)
            curves.update(each.variables(f"{prefix}_{name}", _DIMS, *words))
        for name, (kind, text) in _OF_FITS.items():
            each_fit: np.ndarray = np.array([getattr(fit[law], name) for fit in fits.flat], kind)
            curves[f"{prefix}_{name}"] = (_DIMS, each_fit.reshape(fits.shape), cf_attrs("1", text))
    forces = np.where(fitted, force, np.nan)
    undetermined = [undetermined_stiffness(hyperbola, law) for hyperbola, _, law in fits.flat]
    of_curves = {
        "hyperbola_k_ni_change": at_twice(curves["hyperbola_k_ni"]).transpose(*_DIMS).values,
        "hyperbola_k_ni_determined": np.array([not why for why in undetermined]),
        "hyperbola_k_ni_reason": np.array(undetermined),
        "softer_than_k_ni": _softer(curves["hyperbola_k_ni"].values, closure, pressure),
        "closure_law": np.array([fit[2].name for fit in fits.flat]),
        "closure_law_reason": np.array([fit[2].reason for fit in fits.flat]),
        "closure_fit_min": _extreme(np.fmin, forces),
        "closure_fit_max": _extreme(np.fmax, forces),
    }
    table = {name: (_DIMS, *words) for name, words in _OF_CURVES.items()}
    shaped = {name: values.reshape(fits.shape) for name, values in of_curves.items()}
    curves.update(labelled(table, shaped))


def _few_states(*states: np.ndarray) -> str:
    """Reason why too few states of a curve can be fitted and, after a colon, the remedy.

    ``states`` says which have a closure above 0, which of them are resolved, and which are fitted.
    """
    closed, resolved, fitted = (int(those.sum()) for those in states)
    if resolved >= MIN_CLOSURE_POINTS:
        lie = f"{fitted} of {resolved} states lie in hyperbola_range"
        return f"{lie}, {MIN_CLOSURE_POINTS} needed: widen it"
    if closed >= MIN_CLOSURE_POINTS:
        touch = f"{RESOLVED_NODES} nodes touch in {resolved} of {closed} states"
        more = "heavier loads or a larger or finer scan would help"
        return f"{touch}, {MIN_CLOSURE_POINTS} needed: {more}"
    return _too_few(closed)


def _extreme(which: np.ufunc, forces: np.ndarray) -> np.ndarray:
    """Smallest or largest force of each curve; NaN without a fit."""
    return which.reduce(forces, axis=-1)


def _softer(k_ni: np.ndarray, closure: np.ndarray, pressure: np.ndarray) -> np.ndarray:
    """Curves that are softer than their k_ni under any load, loads in the last axis.

    A hyperbola stiffens with load: sigma_0 / w can nowhere be below its k_ni. Where it is, the
    curve is none, and k_ni an extrapolation that light loads do not follow.
    """
    return np.any(k_ni[..., np.newaxis] * closure > pressure, axis=-1)


def at_twice(values: xr.DataArray) -> xr.DataArray:
    """Relative change of values at twice the spacing; NaN where that was not solved.

    Parameters
    ----------
    values : xr.DataArray
        Over ``resolution`` among others.
    """
    resolutions = values["resolution"]
    twice = values.reindex(resolution=2 * resolutions.values).assign_coords(resolution=resolutions)
    return (twice / values - 1).transpose(*values.dims)
