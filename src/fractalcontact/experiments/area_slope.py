"""The area slope kappa at light load on made surfaces, where its right value is known to lie.

Theories put kappa of A_r/A_0 = kappa p / (E* h'_rms) between Persson's sqrt(8/pi) and Bush, Gibson
and Thomas' sqrt(2 pi) for a surface with many hills in the window. Whether the solver lands there
is a check of the whole chain; how much single surfaces scatter tells what one scan can say.
"""

import numpy as np
import xarray as xr

from ..core.intervals import mean_interval
from ..core.labels import cf_attrs
from ..elastic.halfspace import HalfSpace
from ..mechanics import theory
from ..mechanics.area import corrected_area
from ..mechanics.sweep import load_steps
from ..roughness.dimension import slope_statistics
from ..surface.synthesis import self_affine

#: Kinds of surface: with a roll-off many hills share the load, without it a few carry all.
SURFACES = ("with_roll_off", "without_roll_off")

#: Root mean square height as a part of the window's side. The elastic problem is linear in heights,
#: so that kappa does not depend on it.
RMS_PART = 0.01

#: kappa depends on F/E* alone, and on no length: both are units.
SPACING = 1.0  # mm
E_STAR = 1.0  # MPa


def area_slope(recipe, rtol=1e-6):
    """Area slopes of made surfaces, raw and corrected, with and without a roll-off.

    Parameters
    ----------
    recipe : mapping
        ``dimension`` Delta_g, ``nodes`` a side, ``seeds``, ``roll_off_share`` (roll-off length as
        a part of the side) and ``loads``, values of p / (E* h'_rms).
    rtol : float
        Of the solves.

    Returns
    -------
    xr.Dataset
        ``kappa`` and ``corrected_kappa`` over (surface, seed, load), where ``load`` is
        p / (E* h'_rms); ``area_share`` and ``corrected_share`` of the same; ``rms_slope``
        (surface, seed); ``mean_kappa`` and ``corrected_mean_kappa`` over the seeds, with ``_low``
        and ``_high`` (95 %, Student's t) and ``_deviation``, over (surface, load).

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
    share = np.full((2, len(SURFACES), len(seeds), len(loads)), np.nan)
    slope = np.full(share.shape[1:3], np.nan)
    roll_offs = (recipe["roll_off_share"] * side, None)
    for i, roll_off in enumerate(roll_offs):
        for j, seed in enumerate(seeds):
            surface = self_affine(
                (nodes, nodes),
                SPACING,
                3 - recipe["dimension"],
                rms=RMS_PART * side,
                seed=seed,
                roll_off=roll_off,
            )
            slope[i, j] = slope_statistics(surface, SPACING)["rms_slope"]
            forces = loads * E_STAR * slope[i, j] * nominal
            where = f"made surface, seed {seed}, roll-off {roll_off}"
            for k, state in enumerate(load_steps(surface, space, forces, {"rtol": rtol}, where)):
                corrected = corrected_area(state.in_contact, space.spacing)
                share[:, i, j, k] = state.area / nominal, corrected / nominal
    result = _labelled(share, slope, loads, seeds)
    result.attrs = {
        "nodes": nodes,
        "dimension": float(recipe["dimension"]),
        "roll_off_share": float(recipe["roll_off_share"]),
        "persson_kappa": float(theory.PERSSON_KAPPA),
        "bush_gibson_thomas_kappa": float(theory.BUSH_GIBSON_THOMAS_KAPPA),
        "computed_kappa": list(theory.COMPUTED_KAPPA),
    }
    return result


def _labelled(share, slope, loads, seeds):
    """The dataset from the shares (raw and corrected) and slopes of all surfaces."""
    dims = ("surface", "seed", "load")
    result = xr.Dataset(
        {"rms_slope": (dims[:2], slope, cf_attrs("1", "rms slope h'_rms of the surface"))},
        coords={
            "surface": list(SURFACES),
            "seed": ("seed", seeds, cf_attrs("1", "seed of the surface")),
            "load": ("load", loads, cf_attrs("1", "p / (E* h'_rms)")),
        },
    )
    ends = (
        ("", "mean over seeds of"),
        ("_low", "lower end of the 95 % interval of the mean of"),
        ("_high", "upper end of the 95 % interval of the mean of"),
    )
    for prefix, shares, words in (
        ("", share[0], "area slope kappa = (A_r/A_0) E* h'_rms / p"),
        ("corrected_", share[1], "area slope kappa, corrected area"),
    ):
        name = f"{prefix}share" if prefix else "area_share"
        result[name] = (dims, shares, cf_attrs("1", f"A_r/A_0 ({prefix.strip('_') or 'raw'})"))
        kappa = shares / loads
        result[f"{prefix}kappa"] = (dims, kappa, cf_attrs("1", words))
        means = mean_interval(kappa, axis=1)[:3]
        for (ending, of), values in zip(ends, means, strict=True):
            key = f"{prefix}mean_kappa{ending}"
            result[key] = (("surface", "load"), values, cf_attrs("1", f"{of} {words}"))
        result[f"{prefix}mean_kappa_deviation"] = result[f"{prefix}kappa"].std("seed", ddof=1)
        result[f"{prefix}mean_kappa_deviation"].attrs = cf_attrs(
            "1", f"standard deviation between seeds of {words}"
        )
    return result
