"""Constants of the closure laws from the seat, with the errors of two scans in their intervals."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from ..core.estimate import Estimate
from ..core.intervals import t_quantile
from ..core.labels import cf_attrs
from ..core.text import percent
from ..laws.closure_laws import fit_hyperbola, fit_semi_logarithmic
from ..laws.seated_laws import within_span
from ..states.seat import closure_from, seat_of
from ..states.state_quantities import SOUND

#: Constants by name: variable of the stage ``closure``, unit, long name.
CONSTANTS = {
    "k_ni": ("seated_k_ni", "MPa/mm", "initial stiffness k_ni of the hyperbola from the seat"),
    "v_m": ("seated_v_m", "mm", "asymptote v_m of the hyperbola from the seat"),
    "chi": ("seated_chi", "mm", "chi of the logarithm from the seat"),
}
_HOLDS = "interval of the fit and, of two scans, of their errors"


def closure_constants(
    curve: xr.Dataset,
    seating_pressure: float,
    readings: Mapping[str, np.ndarray] | None,
    motions: Mapping[str, np.ndarray] | None,
) -> dict[str, tuple]:
    """Constants of one closure curve, as ``xr.Dataset`` takes them.

    Parameters
    ----------
    curve : xr.Dataset
        The stage ``closure`` at one state, over the loads.
    seating_pressure : float
        That of the study, MPa.
    readings, motions : mapping of str to (variant, load) ndarray, or None
        From :func:`error_budget.two_scans.reading_values`, this reading first, and from
        :func:`error_budget.two_scans.registration_values`; None of what is no pair.

    Notes
    -----
    Every variant is seated and fitted as this one is: from its own lightest load that fits take.
    To the interval of the fit the larger of two is added: the distance of the farthest reading, and
    the 95 % spread over registrations. Where other readings exist and none can be fitted, the
    interval is unbounded.

    ``k_ni_determined`` and ``k_ni_reason`` are those of the fit, and False where k_ni at twice the
    spacing lies outside of the interval: another grid would then give another number.
    """
    pressure = curve["nominal_pressure"].values
    of_readings, of_motions = (
        _constants(variants, pressure, seating_pressure) for variants in (readings, motions)
    )
    apart = {
        name: np.fmax(
            _farthest(of_readings[name][1:], float(curve[variable])), _spread(of_motions[name])
        )
        for name, (variable, *_) in CONSTANTS.items()
    }
    variables: dict[str, tuple] = {}
    for name, (variable, unit, words) in CONSTANTS.items():
        value, low, high = Estimate.read(curve, variable).ends
        half = 0.0 if np.isnan(apart[name]) else apart[name]
        wider = Estimate(
            value,
            np.maximum(low - half, 0.0),
            high + half,
        )
        variables |= wider.variables(name, (), unit, f"{words}, {_HOLDS}")
        if name == "k_ni":
            reason = str(curve["seated_k_ni_reason"].item()) or _off_at_twice(
                wider, float(curve["seated_k_ni_change"])
            )
    words = "whether the hyperbola determines k_ni, on this grid as on one of twice the spacing"
    return variables | {
        "k_ni_determined": ((), not reason, cf_attrs("1", words)),
        "k_ni_reason": ((), reason, cf_attrs("1", "why it does not, and what would help")),
    }


def _off_at_twice(k_ni: Estimate, change: float) -> str:
    """Reason why a k_ni that twice the spacing changes so, a fraction, is undetermined, or ""."""
    at_twice = k_ni.value * (1 + change)
    if not (at_twice < k_ni.low or at_twice > k_ni.high):
        return ""
    by = percent(change, sign="+")
    return f"twice the spacing changes it by {by}, out of its interval; a finer scan would help"


def _constants(
    values: Mapping[str, np.ndarray] | None, pressure: np.ndarray, seating_pressure: float
) -> dict[str, np.ndarray]:
    """Constants (variant,) by name; NaN of a variant that has no fit."""
    variants = (
        []
        if values is None
        else [
            seated_constants(pressure, closure, sound > 0, seating_pressure)
            for closure, sound in zip(values["closure"], values[SOUND], strict=True)
        ]
    )
    return {name: np.array([of[name] for of in variants]) for name in CONSTANTS}


def seated_constants(
    pressure: np.ndarray, closure: np.ndarray, sound: np.ndarray, seating_pressure: float
) -> dict[str, float]:
    """Constants of a closure curve (load,), mm, from its lightest sound load at the seat or above.

    Pressures (load,) and that of the seat are in MPa; ``sound`` (load,) are the states that fits
    take. As of :mod:`laws.seated_laws`.
    """
    seat = float(seat_of(pressure, seating_pressure, sound))
    if np.isnan(seat):
        return dict.fromkeys(CONSTANTS, np.nan)
    seated = closure_from(closure, pressure, seat)
    fitted = sound & (seated > 0) & (pressure > seat) & within_span(pressure, seat)
    hyperbola = fit_hyperbola(pressure[fitted], seated[fitted], seat)
    logarithm = fit_semi_logarithmic(pressure[fitted], seated[fitted])
    return {
        "k_ni": float(hyperbola.k_ni.value),
        "v_m": float(hyperbola.w_m.value),
        "chi": float(logarithm.b.value),
    }


def _farthest(values: np.ndarray, own: float) -> float:
    """Largest distance of other readings from a value; infinite where none of them has one."""
    if not values.size:
        return np.nan
    known = values[np.isfinite(values)]
    return float(np.abs(known - own).max()) if known.size else np.inf


def _spread(values: np.ndarray) -> float:
    """Half-width at 95 % of the spread over registrations; NaN below two."""
    known = values[np.isfinite(values)]
    if known.size < 2:
        return np.nan
    return float(t_quantile(known.size - 1) * known.std(ddof=1))
