"""The area slope kappa at light load on synthetic surfaces, where its right value is known to lie.

Theories put kappa of A_r/A_0 = kappa p / (E* h'_rms) between Persson's sqrt(8/pi) and Bush, Gibson
and Thomas' sqrt(2 pi) for a surface with many hills in the window. Whether the solver lands there
is a check of the whole chain; how much single surfaces scatter says what one scan can show.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from fractalcontact.core.datasets import titled
from fractalcontact.core.labels import cf_attrs
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
        Of the solves.

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
    nodes = recipe["nodes"]
    side = nodes * SPACING
    space = HalfSpace((nodes, nodes), (SPACING, SPACING), E_STAR)
    nominal = side**2
    fraction = np.full((2, len(SURFACES), len(seeds), len(loads)), np.nan)
    slope = np.full(fraction.shape[1:3], np.nan)
    roll_offs = (recipe["roll_off_share"] * side, None)
    for i, roll_off in enumerate(roll_offs):
        for j, seed in enumerate(seeds):
            surface = self_affine(
                (nodes, nodes),
                SPACING,
                3 - recipe["dimension"],
                rms=RMS_FRACTION * side,
                seed=seed,
                roll_off=roll_off,
            )
            slope[i, j] = slope_statistics(surface, SPACING)["rms_slope"]
            forces = loads * E_STAR * slope[i, j] * nominal
            where = f"synthetic surface, seed {seed}, roll-off {roll_off}"
            for k, state in enumerate(load_steps(surface, space, forces, {"rtol": rtol}, where)):
                corrected = corrected_area(state.in_contact, space.spacing)
                fraction[:, i, j, k] = state.area / nominal, corrected / nominal
    result = _labelled(fraction, slope, loads, seeds)
    result.attrs = {
        "nodes": nodes,
        "dimension": float(recipe["dimension"]),
        "roll_off_share": float(recipe["roll_off_share"]),
    } | theory.KAPPA_ATTRS
    return result.assign(theory.persson_line(loads.min(), loads.max()))


def _labelled(
    fraction: np.ndarray, slope: np.ndarray, loads: np.ndarray, seeds: list[int]
) -> xr.Dataset:
    """The dataset from the area fractions (raw and corrected) and slopes of all surfaces."""
    dims = ("surface", "seed", "reduced_pressure")
    result = xr.Dataset(
        {"rms_slope": (dims[:2], slope, cf_attrs("1", "rms slope h'_rms of the surface"))},
        coords={
            "surface": list(SURFACES),
            "seed": ("seed", seeds, cf_attrs("1", "seed of the surface")),
            "reduced_pressure": ("reduced_pressure", loads, cf_attrs("1", "p / (E* h'_rms)")),
        },
    )
    for prefix, fractions, words in (
        ("", fraction[0], AREA_SLOPE),
        ("corrected_", fraction[1], CORRECTED_AREA_SLOPE),
    ):
        name = f"{prefix}share" if prefix else "area_share"
        result[name] = (dims, fractions, cf_attrs("1", f"A_r/A_0 ({prefix.strip('_') or 'raw'})"))
        result[f"{prefix}kappa"] = (dims, fractions / loads, cf_attrs("1", words))
    return result
