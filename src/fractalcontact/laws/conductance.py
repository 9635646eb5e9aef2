"""Conductance of the interface and its exponent over pressure, beside theory."""

from typing import Any

import numpy as np
import xarray as xr

from ..core.estimate import Estimate
from ..core.fitting import fit_line
from ..core.labels import cf_attrs
from ..core.limits import CONDUCTANCE_EXPONENTS
from ..core.per_curve import per_curve
from ..core.verdicts import ABOVE, BELOW, WITHIN

_NAMES = {
    "conductance_exponent": ("1", "exponent of conductance against pressure"),
    "conductance_fitted": ("1", "load used in the power law of the conductance", "normal_force"),
    "unit_conductance": ("mm-1", "conductance at 1 MPa by that power law"),
    "conductance_pressure_low": ("MPa", "lowest pressure of that fit"),
    "conductance_pressure_high": ("MPa", "highest pressure of that fit"),
    "conductance_beside_theory": (
        "1",
        "position of the exponent's interval: within, below or above those of theory",
    ),
}


def add_conductance(curves: xr.Dataset, e_star: float) -> None:
    """Conductance of the interface and its power of the pressure, into closure curves; E* in MPa.

    Barber (Proc. R. Soc. A 459 (2003) 53): 1/R = 2/(E* (rho_1 + rho_2)) dF/dw. Two blocks of one
    conductivity k = 1/rho, thermal or electrical, give h_c = k/E* d sigma_0/d w_int per nominal
    area. Loads at which fewer than `RESOLVED_NODES` touch are not fitted: they act on single cells.
    """
    conductance = curves["interface_stiffness"] / e_star
    curves["conductance"] = conductance.assign_attrs(
        cf_attrs("mm-1", "conductance of the interface per nominal area and conductivity")
    )
    of_curve = {
        "conductance": conductance.where(curves["resolved"]),
        "pressure": curves["nominal_pressure"],
    }
    curves.update(per_curve(of_curve, _power_law, _NAMES))


def _power_law(conductance: np.ndarray, pressure: np.ndarray) -> dict[str, Any]:
    """Power law of one curve of the conductance over the pressure."""
    with np.errstate(divide="ignore"):
        logarithm = np.log(conductance)
    exponent, at_one, _ = fit_line(np.log(pressure), logarithm)
    low, high = np.exp(exponent.over)
    return {
        "conductance_exponent": exponent,
        "conductance_fitted": np.isfinite(logarithm) & exponent.known,
        "unit_conductance": at_one.mapped(np.exp),
        "conductance_pressure_low": low,
        "conductance_pressure_high": high,
        "conductance_beside_theory": beside_theory(exponent),
    }


def beside_theory(exponent: Estimate) -> np.ndarray:
    """Position of intervals of exponents relative to theory, in words; empty without a fit."""
    low, high = CONDUCTANCE_EXPONENTS
    places = [~exponent.known, exponent.high < low, exponent.low > high]
    return np.select(places, ["", BELOW, ABOVE], WITHIN)
