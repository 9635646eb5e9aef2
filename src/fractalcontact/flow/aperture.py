"""Aperture map: slope, empirical laws of its hydraulic aperture."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.estimate import Estimate
from ..core.fitting import fit_line
from ..core.text import percent

#: Quantiles of the aperture that are kept.
QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)


def rms_slope(gap: np.ndarray, spacing: tuple[float, float]) -> float:
    """Rms slope of the gap between neighbouring open cells; NaN where no two are neighbours."""
    sums, faces = 0.0, 0
    for axis, step in enumerate(spacing):
        turned = np.moveaxis(gap, axis, 0)
        slopes = np.diff(turned, axis=0)[(turned[1:] > 0) & (turned[:-1] > 0)] / step
        sums, faces = sums + float(slopes @ slopes), faces + slopes.size
    # The mean square of each component, of half of the faces, counts once.
    return float(np.sqrt(2 * sums / faces)) if faces else np.nan


#: Largest volume of crushed rock, as a fraction of the gap that is left, at which T is stated: the
#: model lets it vanish, where gouge would fill the gap.
MAX_CRUSHED = 0.3


def crushed_reason(fraction: float) -> str:
    """Reason why crushed rock leaves T unknown; empty up to :data:`MAX_CRUSHED` of the gap."""
    if not fraction > MAX_CRUSHED:
        return ""
    return f"crushed rock, {percent(fraction)} of the volume of the gap, may fill it as gouge"


def zimmerman_bodvarsson_aperture(
    mean: ArrayLike, deviation: ArrayLike, contact: ArrayLike
) -> np.ndarray:
    """Hydraulic aperture by Zimmerman and Bodvarsson's law, mm.

    h^3 = <g>^3 (1 - 1.5 s^2/<g>^2) (1 - 2 c), as quoted of Transp. Porous Media 23 (1996) 1.

    Parameters
    ----------
    mean, deviation : array_like
        <g> and standard deviation s of the gap over the nominal area, mm, with 0 in contact. Means
        over the open part alone, which some authors take, give larger apertures.
    contact : array_like
        Contact fraction c.

    Returns
    -------
    ndarray
        NaN where the law has no positive value: where s > 0.82 <g> or c >= 0.5.
    """
    mean, deviation, contact = (np.asarray(one, float) for one in (mean, deviation, contact))
    with np.errstate(invalid="ignore", divide="ignore"):
        spread, open_part = 1 - 1.5 * (deviation / mean) ** 2, 1 - 2 * contact
        cubed = np.where((spread > 0) & (open_part > 0), spread * open_part, np.nan)
    return mean * np.cbrt(cubed)


def barton_aperture(mechanical: ArrayLike, jrc: float) -> np.ndarray:
    """Hydraulic aperture by Barton's law, mm: e = E^2 / JRC^2.5, both in micrometres.

    As quoted of Barton, Bandis and Bakhtar (Int. J. Rock Mech. Min. Sci. 22 (1985) 121).

    Parameters
    ----------
    mechanical : array_like
        Mechanical aperture E, mm.
    jrc : float
        Joint roughness coefficient.

    Returns
    -------
    ndarray
        NaN where the law would give more than the mechanical aperture.
    """
    micrometres = 1e3 * np.asarray(mechanical, float)
    if not jrc > 0:
        return np.full_like(micrometres, np.nan)
    hydraulic = micrometres**2 / jrc**2.5
    return np.where(hydraulic <= micrometres, hydraulic, np.nan) / 1e3


#: Constants of the permeability over pressure: unit, long name.
PERMEABILITY = {
    "permeability_k_0": (
        "mm2",
        "k_0 of k = k_0 exp(-alpha sigma_0), k = h_h^2/12, along the sliding",
    ),
    "permeability_alpha": ("MPa-1", "alpha of the same law"),
}
#: Ends of the range of that law, which all branches share: unit, long name.
PERMEABILITY_RANGE = {
    "permeability_pressure_low": ("MPa", "lowest pressure that the law is fitted over"),
    "permeability_pressure_high": ("MPa", "highest pressure that the law is fitted over"),
}


def permeability_law(
    pressure: ArrayLike, transmissivity: ArrayLike, may_fit: ArrayLike
) -> dict[str, Any]:
    """:data:`PERMEABILITY` and :data:`PERMEABILITY_RANGE` of k = k_0 exp(-alpha sigma).

    k = h_h^2/12 = (12 T)^(2/3)/12; least squares in ln k. Codes of flow take both constants, of the
    effective stress: the pressure on the joint where its water has none. All branches are fitted
    over the same loads, as their constants would differ by their ranges alone.

    Parameters
    ----------
    pressure : (n,) array_like
        MPa.
    transmissivity : (branch, n) array_like
        T, mm3. A branch without any passage has no law.
    may_fit : (n,) array_like of bool
        Loads that a fit may take.

    Returns
    -------
    dict
        Estimates of the constants over the branches, with the intervals of the fit alone, and the
        ends of the range; NaN where fewer than three loads have a passage on every branch.
    """
    pressure = np.asarray(pressure, float)
    with np.errstate(divide="ignore", invalid="ignore"):
        logarithm = np.log(np.cbrt(12 * np.asarray(transmissivity, float)) ** 2 / 12)
    passes = np.isfinite(logarithm)
    shared = np.asarray(may_fit, bool) & passes[passes.any(axis=1)].all(axis=0)
    lines = [fit_line(pressure[shared], of_branch[shared]) for of_branch in logarithm]
    slope = Estimate.stack([line.slope for line in lines])
    intercept = Estimate.stack([line.intercept for line in lines])
    low, high = slope[slope.known].over if slope.known.any() else ([np.nan], [np.nan])
    values = intercept.mapped(np.exp), slope.mapped(np.negative, falling=True), low[0], high[0]
    return dict(zip((*PERMEABILITY, *PERMEABILITY_RANGE), values, strict=True))


#: Water at 20 degrees: viscosity, MPa s, and density, N s2/mm4.
WATER_VISCOSITY, WATER_DENSITY = 1.002e-9, 9.982e-10


def reynolds_gradient(transmissivity: ArrayLike) -> np.ndarray:
    """Pressure gradient at which water at 20 degrees has a Reynolds number of 1, MPa/mm.

    Re = rho Q/(mu W), where Q/W = T grad p/mu is the flow per unit width. The cubic law holds for
    Re well below 1 (Zimmerman and Bodvarsson 1996).

    Parameters
    ----------
    transmissivity : array_like
        T, mm3; NaN for T = 0.
    """
    transmissivity = np.asarray(transmissivity, float)
    open_gap = np.where(transmissivity > 0, transmissivity, np.nan)
    return WATER_VISCOSITY**2 / (WATER_DENSITY * open_gap)
