"""Real contact areas that the classical theories make of a composite topography (sect. 2)."""

from typing import Any

import numpy as np
import xarray as xr

from ..core.datasets import labelled
from ..core.estimate import Estimate
from ..core.labels import cf_attrs
from ..core.verdicts import ABOVE, BELOW, WITHIN
from . import theory

#: Smallest rms slope of faces that are not flush; less is rounding.
FLUSH = 1e-9

#: Areas by the theories of every composite topography: unit, long name.
_OF_THEORIES = {
    "persson_share": ("1", "A_r/A_0 by Persson"),
    "bush_gibson_thomas_share": ("1", "A_r/A_0 by Bush, Gibson and Thomas"),
    "greenwood_williamson_share": ("1", "A_r/A_0 by Greenwood-Williamson"),
    "majumdar_bhushan_share": ("1", "A_r/A_0 by Majumdar and Bhushan"),
}

#: Variables that do not depend on the topography.
_EXPONENTS = {
    "no_majumdar_bhushan": ((), "1", "why there is no area by Majumdar and Bhushan"),
    "archard_level": ("archard_level", "1", "generations n of spheres upon spheres"),
}


def add_theories(
    result: xr.Dataset, curves: xr.Dataset, e_star: float, dimension: float, spacing: float
) -> None:
    """Add the areas that theories make of the surface to the laws, over (direction, offset, load).

    ``result`` holds the statistics of the composite topographies, ``curves`` the loads; E* in MPa,
    the scan's spacing in mm. Delta_g = NaN leaves Majumdar and Bhushan out.
    """
    rough = result.where(result["rms_slope"] > FLUSH)
    force, pressure = curves["normal_force"], curves["nominal_pressure"]
    nominal, slope = force / pressure, rough["rms_slope"]
    summits = theory.asperities(rough["m0"], rough["m2"], rough["m4"])
    profile = float(dimension) - 1
    scale = theory.roughness_scale(rough["m2"] * spacing**2, spacing, profile)
    greenwood = theory.greenwood_williamson_area(force, e_star, *summits)
    majumdar = theory.majumdar_bhushan_area(force, e_star, profile, scale)
    values: dict[str, Any] = {
        "persson_share": theory.persson_area(pressure, e_star, slope),
        "bush_gibson_thomas_share": theory.linear_area(
            pressure, e_star, slope, theory.BUSH_GIBSON_THOMAS_KAPPA
        ),
        "greenwood_williamson_share": greenwood / nominal,
        "majumdar_bhushan_share": majumdar / nominal,
    }
    for name, words in _OF_THEORIES.items():
        result[name] = values[name].assign_attrs(cf_attrs(*words))
    levels = np.arange(1, 4)
    exponents = {
        "no_majumdar_bhushan": theory.no_majumdar_bhushan(profile),
        "archard_level": levels,
    }
    result.update(labelled(_EXPONENTS, exponents))
    result.attrs |= {"e_star": float(e_star)} | theory.KAPPA_ATTRS


def add_comparison(result: xr.Dataset) -> None:
    """Add the theories that the laws agree with, and Persson's kappa over their pressures."""
    low, high = (result[f"corrected_exponent_{end}"] for end in ("low", "high"))
    levels = result["archard_level"]
    archard = levels.copy(data=theory.archard_exponent(levels.values))
    words = "whether Archard's exponent lies in the interval of that of the corrected area"
    result["archard_fits"] = ((low <= archard) & (archard <= high)).assign_attrs(
        cf_attrs("1", words)
    )
    kappa = Estimate.read(result, "corrected_mean_kappa")
    least, most = (result.attrs[f"{name}_kappa"] for name in ("persson", "bush_gibson_thomas"))
    first, second = (
        (kappa.low <= theoretical) & (theoretical <= kappa.high) for theoretical in (least, most)
    )
    places = [~kappa.known, first & second, first, second, kappa.value < least, kappa.value > most]
    position = np.select(places, ["", "both", "Persson", "Bush", BELOW, ABOVE], WITHIN)
    words = "which theories the mean kappa of the corrected area agrees with, or where it lies"
    dims = result["corrected_mean_kappa"].dims
    result["kappa_beside_theories"] = dims, position, cf_attrs("1", words)
    fitted = result["reduced_pressure"].where(result["fitted"])
    ends = (getattr(fitted, end)(["offset", "normal_force"]).values for end in ("min", "max"))
    lines = [theory.persson_line(*pair) for pair in zip(*ends, strict=True)]
    result.update(xr.concat(lines, result["direction"]))
