"""Laws of the closure from a seat, as laboratories fit them, and the stiffness at set pressures.

A laboratory measures no closure from zero load: the joint is put together under a small seating
stress, and closure counts from there (Bandis, Lumsden & Barton, Int. J. Rock Mech. Min. Sci. 20
(1983) 249). Both laws are fitted by least squares in the closure to the same states.
"""

from functools import partial

import numpy as np
import xarray as xr

from ..core.datasets import labelled
from ..core.estimate import Estimate
from ..core.limits import LARGEST_MISFIT, REFERENCE_PRESSURES, SEATED_SPAN
from ..core.text import percent
from ..core.verdicts import TOO_WIDE
from ..states.separation import ROUNDING
from .closure_laws import MIN_CLOSURE_POINTS, at_twice, fit_hyperbola, fit_semi_logarithmic

_DIMS = ("direction", "offset", "resolution")
_RANGE = "from the seating pressure on, over at most two decades"
#: Parameters of the laws: unit, long name.
_PARAMETERS = {
    "seated_k_ni": ("MPa/mm", f"initial normal stiffness k_ni of the hyperbola {_RANGE}"),
    "seated_v_m": ("mm", f"largest closure v_m of the hyperbola {_RANGE}"),
    "seated_d_0": ("mm", f"d_0 of d = d_0 + chi ln sigma, closure at 1 MPa, {_RANGE}"),
    "seated_chi": (
        "mm",
        f"chi of d = d_0 + chi ln sigma, closure per e-fold, {_RANGE}",
    ),
}
#: Other numbers of the fits: unit, long name.
_OF_FITS = {
    "seated_hyperbola_misfit": ("1", "rms misfit of the seated hyperbola over the largest closure"),
    "seated_logarithm_misfit": ("1", "rms misfit of the seated logarithm over the largest closure"),
    "seated_fit_points": ("1", "states fitted, above the seating pressure"),
    "seated_fit_max": ("MPa", "largest nominal pressure fitted"),
    "seated_k_ni_determined": ("1", "whether the seated hyperbola determines k_ni"),
    "seated_k_ni_reason": ("1", "why it does not, and what would help"),
    "seated_k_ni_change": ("1", "seated k_ni at twice the spacing over that at this one, less one"),
}


def add_seated_laws(curves: xr.Dataset) -> None:
    """Add both laws of the seated closure, and tangent stiffnesses, to a closure stage.

    Parameters
    ----------
    curves : xr.Dataset
        With ``seated_closure``, ``seating_pressure``, ``resolved``, ``interface_stiffness`` and its
        error over (direction, offset, resolution, load); what is found is added to it.

    Notes
    -----
    The hyperbola is sigma = k_ni w / (1 - w/v_m); the closure from the seat is its own difference,
    d = w(sigma) - w(seat). The other law is d = d_0 + chi ln(sigma / 1 MPa).
    The stiffness at a reference pressure is read between the states beside it, straight in
    logarithms: stiffnesses of rough contact are nearly powers of the pressure.
    """
    order = (*_DIMS, "normal_force")
    pressure = curves["nominal_pressure"].values
    closure = curves["seated_closure"].where(curves["resolved"]).transpose(*order).values
    seats = curves["seating_pressure"].transpose(*_DIMS).values
    fits = np.empty(seats.shape, object)
    for place in np.ndindex(seats.shape):
        fits[place] = _Fit(pressure, closure[place], float(seats[place]))
    for name, words in _PARAMETERS.items():
        each = Estimate.stack((getattr(fit, name) for fit in fits.flat), seats.shape)
        curves.update(each.variables(name, _DIMS, *words))
    values = {
        name: np.array([getattr(fit, name) for fit in fits.flat]).reshape(seats.shape)
        for name in _OF_FITS
        if name != "seated_k_ni_change"
    }
    values["seated_k_ni_change"] = at_twice(curves["seated_k_ni"]).transpose(*_DIMS).values
    curves.update(labelled({name: (_DIMS, *words) for name, words in _OF_FITS.items()}, values))
    _add_reference_stiffness(curves)


def within_span(pressure: np.ndarray, seat: float) -> np.ndarray:
    """Loads (n,) bool up to :data:`core.limits.SEATED_SPAN` times the seating pressure, MPa."""
    return pressure <= SEATED_SPAN * seat * (1 + ROUNDING)


class _Fit:
    """Both laws of one curve, under the names of the atlas."""

    def __init__(self, pressure: np.ndarray, closure: np.ndarray, seat: float):
        fitted = np.isfinite(closure) & (closure > 0) & within_span(pressure, seat)
        hyperbola = fit_hyperbola(pressure[fitted], closure[fitted], seat)
        logarithm = fit_semi_logarithmic(pressure[fitted], closure[fitted])
        self.seated_k_ni, self.seated_v_m = hyperbola.k_ni, hyperbola.w_m
        self.seated_d_0, self.seated_chi = logarithm.a, logarithm.b
        self.seated_hyperbola_misfit = hyperbola.misfit
        self.seated_logarithm_misfit = logarithm.misfit
        self.seated_fit_points = int(fitted.sum())
        self.seated_fit_max = float(pressure[fitted].max()) if fitted.any() else np.nan
        self.seated_k_ni_reason = self._reason(seat)
        self.seated_k_ni_determined = not self.seated_k_ni_reason

    def _reason(self, seat: float) -> str:
        if np.isnan(seat):
            return (
                "ten nodes touch at no load from the seating pressure on; a finer scan would help"
            )
        if self.seated_fit_points < MIN_CLOSURE_POINTS:
            return (
                f"fewer than {MIN_CLOSURE_POINTS} states lie above the seating pressure; "
                f"more loads up to {SEATED_SPAN * seat:g} MPa would help"
            )
        if not self.seated_k_ni.known:
            return "the closure does not bend enough to show an asymptote; heavier loads would help"
        if self.seated_hyperbola_misfit > LARGEST_MISFIT:
            missed = percent(self.seated_hyperbola_misfit)
            return f"the hyperbola misses the curve by {missed} rms of the largest closure"
        if not self.seated_k_ni.determined:
            return f"{TOO_WIDE}; more loads would help"
        return ""


def at_reference_pressures(pressure: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Values at :data:`core.limits.REFERENCE_PRESSURES`, straight in logarithms between states.

    Parameters
    ----------
    pressure : (n,) ndarray
        Nominal, MPa, ascending.
    values : (n,) ndarray
        Above zero, such as stiffnesses; NaN where unknown.

    Returns
    -------
    (k,) ndarray
        NaN outside the states that are known.
    """
    known = np.isfinite(values) & (values > 0)
    if known.sum() < 2:
        return np.full(len(REFERENCE_PRESSURES), np.nan)
    wanted, x = np.log(REFERENCE_PRESSURES), np.log(pressure[known])
    return np.exp(np.interp(wanted, x, np.log(values[known]), left=np.nan, right=np.nan))


def _add_reference_stiffness(curves: xr.Dataset) -> None:
    """Tangent stiffness of the interface at set nominal pressures, into ``curves``."""
    order, dims = (*_DIMS, "normal_force"), (*_DIMS, "reference_pressure")
    stiffness = curves["interface_stiffness"].where(curves["resolved"]).transpose(*order).values
    pressure = curves["nominal_pressure"].values
    value = np.apply_along_axis(partial(at_reference_pressures, pressure), -1, stiffness)
    table = {
        "reference_stiffness": (dims, "MPa/mm", "tangent stiffness of the interface at a pressure"),
    }
    curves.coords["reference_pressure"] = (
        "reference_pressure",
        np.array(REFERENCE_PRESSURES),
        {"units": "MPa", "long_name": "nominal pressure at which the stiffness is stated"},
    )
    curves.update(labelled(table, {"reference_stiffness": value}))
