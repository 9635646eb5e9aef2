"""Area slope kappa at light load on synthetic surfaces, for which theories bound its value.

Theories put kappa of A_r/A_0 = kappa p / (E* h'_rms) between Persson's sqrt(8/pi) and Bush, Gibson
and Thomas' sqrt(2 pi) for a surface with many hills in the window. A solution between them checks
the whole chain; the scatter of single surfaces is the uncertainty of one scan.
"""

from collections.abc import Mapping
from itertools import product
from typing import Any

import numpy as np
import xarray as xr

from fractalcontact.core.datasets import titled
from fractalcontact.core.labels import cf_attrs
from fractalcontact.core.per_curve import stacked
from fractalcontact.laws import theory
from fractalcontact.laws.area import AREA_SLOPE, CORRECTED_AREA_SLOPE
from fractalcontact.roughness.dimension import slope_statistics
from fractalcontact.states.sweep import load_steps
from fractalcontact.surface.synthesis import self_affine
from roughcontact.contact.corrected_area import corrected_area
from roughcontact.elastic.halfspace import HalfSpace

from .units import E_STAR, RMS_FRACTION, SPACING, SURFACES


@titled("real contact area at light load, on surfaces with and without a roll-off")
def area_slope(recipe: Mapping[str, Any], rtol: float = 1e-6) -> xr.Dataset:
    """Area slopes of synthetic surfaces, raw and corrected, with and without a roll-off.

    Parameters
    ----------
    recipe : mapping
        ``dimension`` Delta_g, ``nodes`` per side, ``seeds``, ``roll_off_share`` (roll-off length as
        a fraction of the side) and ``loads``, values of p / (E* h'_rms).
    rtol : float
        Tolerance of the solves.

    Returns
    -------
    xr.Dataset
        ``kappa`` and ``corrected_kappa`` over (surface, seed, load), where ``load`` is
        p / (E* h'_rms); ``area_share`` and ``corrected_share`` of the same; ``rms_slope``
        (surface, seed).

    Notes
    -----
    h'_rms is that of differences between neighbouring nodes, as for a scan. Waves reach down to two
    nodes here, so that h'_rms of the waves themselves, which the theories and most computations in
    the literature take, is 6-7 % larger at H = 0.8 and kappa with it.
    """
    loads, seeds = np.unique(recipe["loads"]), list(recipe["seeds"])
    roll_offs = (recipe["roll_off_share"] * recipe["nodes"] * SPACING, None)
    rows = [_one_surface(recipe, *surface, loads, rtol) for surface in product(roll_offs, seeds)]
    result = xr.Dataset(
        stacked(rows, _OF_SURFACE, ("surface", "seed"), (len(roll_offs), len(seeds))),
        coords={
            "surface": list(SURFACES),
            "seed": ("seed", seeds, cf_attrs("1", "seed of the surface")),
            "reduced_pressure": ("reduced_pressure", loads, cf_attrs("1", "p / (E* h'_rms)")),
        },
    )
    result.attrs = {
        "nodes": recipe["nodes"],
        "dimension": float(recipe["dimension"]),
        "roll_off_share": float(recipe["roll_off_share"]),
    } | theory.KAPPA_ATTRS
    return result.assign(theory.persson_line(loads.min(), loads.max()))


#: Variables of a surface: unit, long name, dimension of those over the load.
_OF_SURFACE = {
    "rms_slope": ("1", "rms slope h'_rms of the surface"),
    "area_share": ("1", "A_r/A_0 (raw)", "reduced_pressure"),
    "kappa": ("1", AREA_SLOPE, "reduced_pressure"),
    "corrected_share": ("1", "A_r/A_0 (corrected)", "reduced_pressure"),
    "corrected_kappa": ("1", CORRECTED_AREA_SLOPE, "reduced_pressure"),
}


def _one_surface(
    recipe: Mapping[str, Any], roll_off: float | None, seed: int, loads: np.ndarray, rtol: float
) -> dict[str, Any]:
    """Values of :data:`_OF_SURFACE` of one surface."""
    nodes, side = recipe["nodes"], recipe["nodes"] * SPACING
    space = HalfSpace((nodes, nodes), (SPACING, SPACING), E_STAR)
    hurst, rms = 3 - recipe["dimension"], RMS_FRACTION * side
    surface = self_affine((nodes, nodes), SPACING, hurst, rms=rms, seed=seed, roll_off=roll_off)
    slope = slope_statistics(surface, SPACING)["rms_slope"].item()
    where = f"synthetic surface, seed {seed}, roll-off {roll_off}"
    states = load_steps(surface, space, loads * E_STAR * slope * side**2, {"rtol": rtol}, where)
    areas = [
        (state.area, float(corrected_area(state.in_contact, space.spacing))) for state in states
    ]
    raw, corrected = np.array(areas).T / side**2
    return {
        "rms_slope": slope,
        "area_share": raw,
        "kappa": raw / loads,
        "corrected_share": corrected,
        "corrected_kappa": corrected / loads,
    }
