"""Conductance of the interface and its exponent over pressure, beside theory."""

import numpy as np
import xarray as xr

from ..core.estimate import Estimate
from ..core.fitting import fit_line
from ..core.labels import cf_attrs
from ..core.limits import CONDUCTANCE_EXPONENTS
from ..core.verdicts import ABOVE, BELOW, WITHIN

_CURVES = ("direction", "offset", "resolution")


def add_conductance(curves: xr.Dataset, e_star: float) -> None:
    """Conductance of the interface and its power of the pressure, into closure curves.

    Parameters
    ----------
    curves : xr.Dataset
        With ``interface_stiffness`` and ``resolved``.
    e_star : float
        E*, MPa.

    Notes
    -----
    Barber (Proc. R. Soc. A 459 (2003) 53): 1/R = 2/(E* (rho_1 + rho_2)) dF/dw. Two blocks of one
    conductivity k = 1/rho, thermal or electrical, give h_c = k/E* d sigma_0/d w_int per nominal
    area. Loads at which fewer than `RESOLVED_NODES` touch are not fitted: they act on single cells.
    """
    conductance = curves["interface_stiffness"] / e_star
    curves["conductance"] = conductance.assign_attrs(
        cf_attrs("mm-1", "conductance of the interface per nominal area and conductivity")
    )
    with np.errstate(divide="ignore"):
        resolved = xr.apply_ufunc(np.log, conductance.where(curves["resolved"]))
    pressure = np.log(curves["nominal_pressure"].values)
    rows = resolved.transpose(*_CURVES, "normal_force").values
    fits = [fit_line(pressure, row) for row in rows.reshape(-1, len(pressure))]
    exponent, at_one = (
        Estimate.stack((getattr(fit, part) for fit in fits), rows.shape[:-1])
        for part in ("slope", "intercept")
    )
    words = "exponent of conductance against pressure"
    curves.update(exponent.variables("conductance_exponent", _CURVES, "1", words))
    fitted = np.isfinite(resolved) & np.isfinite(curves["conductance_exponent"])
    curves["conductance_fitted"] = fitted.assign_attrs(
        cf_attrs("1", "load used in the power law of the conductance")
    )
    words = "conductance at 1 MPa by that power law"
    curves.update(at_one.mapped(np.exp).variables("unit_conductance", _CURVES, "mm-1", words))
    for name, end in zip(("low", "high"), np.exp(exponent.over), strict=True):
        attrs = cf_attrs("MPa", f"{name}est pressure of that fit")
        curves[f"conductance_pressure_{name}"] = _CURVES, end, attrs
    attrs = cf_attrs(
        "1", "position of the exponent's interval: within, below or above those of theory"
    )
    curves["conductance_beside_theory"] = _CURVES, beside_theory(exponent), attrs


def beside_theory(exponent: Estimate) -> np.ndarray:
    """Position of intervals of exponents relative to theory, in words; empty without a fit."""
    low, high = CONDUCTANCE_EXPONENTS
    places = [~exponent.known, exponent.high < low, exponent.low > high]
    return np.select(places, ["", BELOW, ABOVE], WITHIN)
