"""Laws of closure curves: the hyperbola, the semi-logarithmic law, and which of them fits better.

Both laws have two parameters and are fitted by least squares in the closure to the same states, so
that their misfits can be compared.
"""

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.estimate import NO_ESTIMATE, Estimate
from ..core.fitting import fit_line
from ..core.intervals import t_quantile
from ..core.labels import cf_attrs
from ..core.limits import GOOD_FIT, RESOLVED_NODES
from ..core.per_curve import per_curve
from ..core.ranges import within
from ..core.text import percent
from ..core.verdicts import HYPERBOLA, NEITHER, SEMI_LOGARITHMIC, TOO_WIDE, UNDECIDED
from .scan_errors import on_sound_cells

#: Fewest states for a law of two parameters: with fewer its interval means nothing.
MIN_CLOSURE_POINTS = 4


#: Largest absolute logarithm of the parameters in the search.
FARTHEST = 200.0

#: Difference of misfits, as a fraction of the larger one, up to which they separate no laws.
EQUAL_MISFIT = 0.1


@dataclass(frozen=True, kw_only=True)
class Fit:
    """Fit of a law to a closure curve.

    ``misfit`` is the rms of the residual closure as a fraction of the largest closure fitted, ``n``
    the number of points; ``reason`` says why there is no fit, else it is empty.
    """

    misfit: float = np.nan
    n: int = 0
    reason: str = ""


@dataclass(frozen=True, kw_only=True)
class Hyperbola(Fit):
    """sigma_0 = k_ni w / (1 - w/w_m) (Bandis et al. 1983), k_ni in MPa/mm and w_m in mm."""

    k_ni: Estimate = NO_ESTIMATE
    w_m: Estimate = NO_ESTIMATE


@dataclass(frozen=True, kw_only=True)
class SemiLogarithmic(Fit):
    """w = a + b ln(sigma_0 / 1 MPa), a and b in mm.

    Bandis et al. (1983) found it for mismatched joints; where the separation u of two rough faces
    follows sigma_0 ~ exp(-u/u_0) (Persson, Phys. Rev. Lett. 99 (2007) 125502), b is u_0. Its
    tangent stiffness is sigma_0 / b.
    """

    a: Estimate = NO_ESTIMATE
    b: Estimate = NO_ESTIMATE


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
        # A straight curve has no asymptote: its search would overflow without this limit.
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
    return Hyperbola(k_ni=k_ni, w_m=w_m, misfit=misfit, n=sigma.size)


def fit_semi_logarithmic(pressure: ArrayLike, closure: ArrayLike) -> SemiLogarithmic:
    """Least-squares fit of the semi-logarithmic law in the closure: a, that at 1 MPa, and b."""
    sigma, w = _usable(pressure, closure)
    if sigma.size < MIN_CLOSURE_POINTS:
        return SemiLogarithmic(n=sigma.size, reason=_too_few(sigma.size))
    line = fit_line(np.log(sigma), w)
    residual = w - (line.intercept.value + line.slope.value * np.log(sigma))
    misfit = float(np.sqrt(np.mean(residual**2)) / w.max())
    return SemiLogarithmic(a=line.intercept, b=line.slope, misfit=misfit, n=line.n)


class Law(NamedTuple):
    """Law of a closure curve, one of :data:`LAWS`, or the reason for none."""

    name: str
    reason: str


def better_law(hyperbola: Hyperbola, semi_logarithmic: SemiLogarithmic) -> Law:
    """The law that fits a closure curve better, by its rms misfit; both fitted to the same states.

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
    difference = max(misfits.values()) - misfits[best]
    if len(misfits) == 2 and difference <= EQUAL_MISFIT * max(misfits.values()):
        return Law(UNDECIDED, f"both miss by {misfits[best]:.1%} rms of the largest w")
    return Law(best, "")


def undetermined_stiffness(hyperbola: Hyperbola, law: Law) -> str:
    """Reason why k_ni of a closure curve is undetermined; empty where it is determined.

    k_ni is a parameter of the hyperbola: it is undetermined where that is not the law of the curve,
    and where its interval is too wide to be of use.
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


_OF_FIT = {
    "misfit": ("1", "rms misfit as a fraction of the largest closure fitted"),
    "n": ("1", "points fitted"),
    "reason": ("1", "why there is no fit"),
}
#: Quantities of both laws of every curve and of the choice between them: unit, long name.
_NAMES = {
    "hyperbola_k_ni": ("MPa/mm", "initial normal stiffness k_ni, extrapolated to zero load"),
    "hyperbola_w_m": ("mm", "largest closure w_m, the asymptote"),
    **{f"hyperbola_{name}": words for name, words in _OF_FIT.items()},
    "semi_logarithmic_a": ("mm", "semi-logarithmic law w_int = a + b ln(sigma_0 / 1 MPa), a"),
    "semi_logarithmic_b": ("mm", "semi-logarithmic law w_int = a + b ln(sigma_0 / 1 MPa), b"),
    **{f"semi_logarithmic_{name}": words for name, words in _OF_FIT.items()},
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

    ``fit_range`` has the smallest and largest force of the fits, N; by default they take all loads.
    States that are not resolved, or rest on suspicious cells of the scans, are not fitted.
    """
    force = curves["normal_force"]
    of_curve = {
        "closure": curves["interface_closure"],
        "resolved": on_sound_cells(curves),
        "inside": within(force, *(fit_range or (force.min(), force.max()))),
        "pressure": curves["nominal_pressure"],
        "force": force,
    }
    curves.update(per_curve(of_curve, _closure_laws, _NAMES))
    curves["hyperbola_k_ni_change"] = at_twice(curves["hyperbola_k_ni"]).assign_attrs(
        cf_attrs(
            "1", "relative change of k_ni at twice the spacing; missing where it was not solved"
        )
    )


def _closure_laws(
    closure: np.ndarray,
    resolved: np.ndarray,
    inside: np.ndarray,
    pressure: np.ndarray,
    force: np.ndarray,
) -> dict[str, Any]:
    """Both laws of one closure curve, and which fits better."""
    resolved = resolved & (closure > 0)
    fitted = resolved & inside
    hyperbola = fit_hyperbola(pressure[fitted], closure[fitted])
    semi_logarithmic = fit_semi_logarithmic(pressure[fitted], closure[fitted])
    if fitted.sum() < MIN_CLOSURE_POINTS:
        few = _few_states(closure > 0, resolved, fitted)
        hyperbola = replace(hyperbola, reason=few)
        semi_logarithmic = replace(semi_logarithmic, reason=few)
    law = better_law(hyperbola, semi_logarithmic)
    undetermined = undetermined_stiffness(hyperbola, law)
    forces = force[fitted] if fitted.any() else np.array([np.nan])
    return {
        **_named("hyperbola", hyperbola),
        **_named("semi_logarithmic", semi_logarithmic),
        "hyperbola_k_ni_determined": not undetermined,
        "hyperbola_k_ni_reason": undetermined,
        # A hyperbola stiffens with load: sigma_0 / w is nowhere below its k_ni. A curve that is
        # softer is no hyperbola, and light loads do not follow the extrapolated k_ni.
        "softer_than_k_ni": bool((hyperbola.k_ni.value * closure > pressure).any()),
        "closure_law": law.name,
        "closure_law_reason": law.reason,
        "closure_fit_min": forces.min(),
        "closure_fit_max": forces.max(),
    }


def _named(prefix: str, fit: Fit) -> dict[str, Any]:
    """Fields of a fit by their names in the atlas, where numbers of points are floats."""
    return {f"{prefix}_{name}": value for name, value in vars(fit).items()} | {
        f"{prefix}_n": float(fit.n)
    }


def _few_states(*states: np.ndarray) -> str:
    """Reason why too few states of a curve can be fitted and, after a colon, the remedy.

    ``states`` says which have a closure above 0, which of them are resolved, and which are fitted.
    """
    closed, resolved, fitted = (int(of_curve.sum()) for of_curve in states)
    if resolved >= MIN_CLOSURE_POINTS:
        lie = f"{fitted} of {resolved} states lie in hyperbola_range"
        return f"{lie}, {MIN_CLOSURE_POINTS} needed: widen it"
    if closed >= MIN_CLOSURE_POINTS:
        touch = f"{RESOLVED_NODES} nodes touch in {resolved} of {closed} states"
        more = "heavier loads or a larger or finer scan would help"
        return f"{touch}, {MIN_CLOSURE_POINTS} needed: {more}"
    return _too_few(closed)


def at_twice(values: xr.DataArray) -> xr.DataArray:
    """Relative change of values at twice the spacing; NaN where that was not solved."""
    resolutions = values["resolution"]
    twice = values.reindex(resolution=2 * resolutions.values).assign_coords(resolution=resolutions)
    return (twice / values - 1).transpose(*values.dims)
