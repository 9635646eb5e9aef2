"""Laws of the closure from a seat, as laboratories fit them, and values at set pressures.

A laboratory measures no closure from zero load: the joint is put together under a small seating
stress, and closure counts from there (Bandis, Lumsden & Barton, Int. J. Rock Mech. Min. Sci. 20
(1983) 249). Both laws are fitted by least squares in the closure to the same states.
"""

from typing import Any

import numpy as np
import xarray as xr

from ..core.labels import cf_attrs
from ..core.limits import (
    LARGEST_MISFIT,
    PRESSURE_ROUNDING,
    REFERENCE_PRESSURES,
    SEATED_SPAN,
)
from ..core.per_curve import per_curve
from ..core.text import percent
from ..core.verdicts import TOO_WIDE
from .closure_laws import (
    MIN_CLOSURE_POINTS,
    Hyperbola,
    at_twice,
    fit_hyperbola,
    fit_semi_logarithmic,
)
from .scan_errors import on_sound_cells

#: Reason why no load can seat a joint, or a pressure has no stiffness.
ON_SUSPECTS = "suspicious cells of the scans carry most of the force"

_RANGE = "from the seating pressure on, over at most two decades"
#: Quantities of every curve: unit, long name, dimension of an array.
_NAMES = {
    "seated_k_ni": ("MPa/mm", f"initial normal stiffness k_ni of the hyperbola {_RANGE}"),
    "seated_v_m": ("mm", f"largest closure v_m of the hyperbola {_RANGE}"),
    "seated_d_0": ("mm", f"d_0 of d = d_0 + chi ln sigma, closure at 1 MPa, {_RANGE}"),
    "seated_chi": ("mm", f"chi of d = d_0 + chi ln sigma, closure per e-fold, {_RANGE}"),
    "seated_hyperbola_misfit": ("1", "rms misfit of the seated hyperbola over the largest closure"),
    "seated_logarithm_misfit": ("1", "rms misfit of the seated logarithm over the largest closure"),
    "seated_fit_points": ("1", "states fitted, above the seating pressure"),
    "seated_fit_max": ("MPa", "largest nominal pressure fitted"),
    "seated_k_ni_determined": ("1", "whether the seated hyperbola determines k_ni"),
    "seated_k_ni_reason": ("1", "why it does not, and what would help"),
}


def add_seated_laws(curves: xr.Dataset) -> None:
    """Add both laws of the seated closure to a closure stage.

    The hyperbola is sigma = k_ni w / (1 - w/v_m); the closure from the seat is its own difference,
    d = w(sigma) - w(seat). The other law is d = d_0 + chi ln(sigma / 1 MPa).
    """
    of_curve = {
        "pressure": curves["nominal_pressure"],
        "closure": curves["seated_closure"],
        "seat": curves["seating_pressure"],
        "resolved": curves["resolved"],
        "sound": on_sound_cells(curves),
    }
    curves.update(per_curve(of_curve, _seated_laws, _NAMES))
    curves["seated_k_ni_change"] = at_twice(curves["seated_k_ni"]).assign_attrs(
        cf_attrs("1", "seated k_ni at twice the spacing over that at this one, less one")
    )


def _seated_laws(
    pressure: np.ndarray,
    closure: np.ndarray,
    seat: float,
    resolved: np.ndarray,
    sound: np.ndarray,
) -> dict[str, Any]:
    """Both laws of one seated closure curve.

    States that are not resolved, or not ``sound``, are left out.
    """
    fitted = sound & (closure > 0) & within_span(pressure, seat)
    hyperbola = fit_hyperbola(pressure[fitted], closure[fitted], seat)
    logarithm = fit_semi_logarithmic(pressure[fitted], closure[fitted])
    by_scan = bool((resolved & ~sound).any())
    undetermined = _undetermined(hyperbola, int(fitted.sum()), seat, by_scan)
    return {
        "seated_k_ni": hyperbola.k_ni,
        "seated_v_m": hyperbola.w_m,
        "seated_d_0": logarithm.a,
        "seated_chi": logarithm.b,
        "seated_hyperbola_misfit": hyperbola.misfit,
        "seated_logarithm_misfit": logarithm.misfit,
        "seated_fit_points": int(fitted.sum()),
        "seated_fit_max": pressure[fitted].max() if fitted.any() else np.nan,
        "seated_k_ni_determined": not undetermined,
        "seated_k_ni_reason": undetermined,
    }


def _undetermined(hyperbola: Hyperbola, points: int, seat: float, by_scan: bool) -> str:
    """Reason why k_ni is undetermined and what would help; empty where it is determined."""
    if np.isnan(seat) and by_scan:
        return f"{ON_SUSPECTS} at every load from the seating pressure on"
    if np.isnan(seat):
        return "ten nodes touch at no load from the seating pressure on; a finer scan would help"
    if points < MIN_CLOSURE_POINTS:
        return (
            f"fewer than {MIN_CLOSURE_POINTS} states lie above the seating pressure; "
            f"more loads up to {SEATED_SPAN * seat:g} MPa would help"
        )
    if not hyperbola.k_ni.known:
        return "the closure does not bend enough to show an asymptote; heavier loads would help"
    if hyperbola.misfit > LARGEST_MISFIT:
        missed = percent(hyperbola.misfit)
        return f"the hyperbola misses the curve by {missed} rms of the largest closure"
    if not hyperbola.k_ni.determined:
        return f"{TOO_WIDE}; more loads would help"
    return ""


def within_span(pressure: np.ndarray, seat: float) -> np.ndarray:
    """Loads (n,) bool up to :data:`core.limits.SEATED_SPAN` times the seating pressure, MPa."""
    return pressure <= SEATED_SPAN * seat * (1 + PRESSURE_ROUNDING)


def at_reference_pressures(pressure: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Values (k,) at :data:`core.limits.REFERENCE_PRESSURES`, linear in logarithms between states.

    Pressures (n,) are nominal, MPa, and ascend; values above 0, such as stiffnesses, NaN where
    unknown. NaN outside the known states. Stiffnesses of rough contact are nearly powers of the
    pressure.
    """
    positive = np.isfinite(values) & (values > 0)
    if positive.sum() < 2:
        return np.full(len(REFERENCE_PRESSURES), np.nan)
    wanted, x = np.log(REFERENCE_PRESSURES), np.log(pressure[positive])
    return np.exp(np.interp(wanted, x, np.log(values[positive]), left=np.nan, right=np.nan))


#: Smallest ratio of the pressures between which the slope of a closure curve is taken: the error
#: of the closures is then a small part of their difference.
MIN_STEP = 1.25


def curve_stiffness(pressure: np.ndarray, closure: np.ndarray) -> np.ndarray:
    """Stiffness d sigma/dw (n,) of a closure curve at its states, MPa/mm.

    The slope of the parabola in ln(pressure) through each state and the nearest ones by a factor of
    :data:`MIN_STEP` below and above. NaN where there is none on either side. Pressures (n,), MPa,
    ascend; closures are in mm, NaN where unknown.
    """
    slopes = np.full(len(pressure), np.nan)
    known = np.flatnonzero(np.isfinite(closure))
    x, w = np.log(pressure[known]), closure[known]
    for i, place in enumerate(known):
        below = np.flatnonzero(x <= x[i] - np.log(MIN_STEP))
        above = np.flatnonzero(x >= x[i] + np.log(MIN_STEP))
        if not (below.size and above.size):
            continue
        a, b = below[-1], above[0]
        down, up = x[i] - x[a], x[b] - x[i]
        slope = (w[b] - w[i]) / up * down + (w[i] - w[a]) / down * up
        slopes[place] = slope / (down + up)
    return np.where(slopes > 0, pressure / np.where(slopes > 0, slopes, 1.0), np.nan)
