"""The reverse of the test of eq. 6: what small windows predict for the largest."""

import numpy as np
import xarray as xr

from ..core.fitting import fit_line
from ..core.intervals import INTERVAL, mean_interval
from ..core.labels import cf_attrs

#: How the whole window is predicted from smaller ones; the middle ones are eq. 6 with Delta_sigma
#: by each estimator.
PREDICTORS = ("power_law", "eq6_area", "eq6_box", "eq6_box_sizes", "no_size_effect")


def predict_whole(pressed, delta_sigma, fewest_nodes):
    """Closure and real area of the whole window, from smaller windows and as solved.

    Parameters
    ----------
    pressed : xr.Dataset
        From :func:`size_effect.load_ladder.press_parts`.
    delta_sigma : xr.DataArray (estimator, load)
        Of the whole window.
    fewest_nodes : int
        A size is used where its windows hold so many nodes on the average.

    Returns
    -------
    xr.Dataset
        ``predicted_closure``, ``predicted_area`` (predictor, load) with intervals,
        ``direct_closure``, ``direct_area`` (load), and ``closure_error``, ``area_error``
        (predictor, load) = predicted / direct - 1. At the finest resolution.

    Notes
    -----
    The power law goes through the means of the smaller sizes at the same sigma_0. Eq. 6 says that
    the whole at sigma_0 has the sigma*, so the real pressure, of windows of side b' at
    sigma_0 (b/b')^(2 - Delta); every smaller size gives one prediction and their geometric mean is
    taken. That they close as much then, too, is what "governing parameter" is taken to mean here;
    the paper does not say it. Without a size effect the whole is as its parts at the same sigma_0.
    """
    b, pressures = pressed["side"].values, pressed["ladder_pressure"].values
    nodes = pressed["nodes"].isel(resolution=0).mean("window").transpose("part", "step").values
    enough = nodes >= fewest_nodes - 1e-9
    share = np.where(enough, nodes, np.nan)
    share = share * pressed["spacing"].values[0] ** 2 / b[:, np.newaxis] ** 2
    mean = pressed["interface_closure"].mean("window").transpose("part", "step").values
    closure = np.where(enough & (mean > 0), mean, np.nan)
    loads = pressures[: pressed.sizes["load"]]

    def at_equal_star(curves, powers):
        """Curves over pressure of smaller sizes, each at the pressure eq. 6 has for it."""
        return np.array(
            [
                _on_curve(p * (b[0] / b[1:]) ** power, pressures, curves[1:])
                for p, power in zip(loads, powers, strict=True)
            ]
        )

    result = xr.Dataset(coords={"predictor": list(PREDICTORS)})
    for name, curves, units, words in (
        ("closure", closure, "mm", "interface closure w_int"),
        ("area", share, "1", "real contact area A_r/A_0"),
    ):
        found = [_power_law(b, curves[:, : len(loads)])]
        for powers in [*(2 - delta_sigma.values), np.zeros(len(loads))]:
            if name == "area":
                # Equal sigma_n at other sigma_0: the shares differ as the sigma_0 do.
                factor = (b[0] / b[1:]) ** powers[:, np.newaxis]
                found.append(_mean(at_equal_star(curves, powers) / factor))
            else:
                found.append(_mean(at_equal_star(curves, powers)))
        _add(result, name, np.array(found), curves[0, : len(loads)], "load", units, words)
    return result


def predict_whole_strength(laws, delta_sigma):
    """Shear strength of the whole window at v/b as small windows predict it, and as solved.

    Parameters
    ----------
    laws : xr.Dataset
        From :func:`size_effect.laws.joint_by_size`, of a joint that slides.
    delta_sigma : xr.DataArray (estimator, load)
        Of the whole window.

    Returns
    -------
    xr.Dataset
        ``predicted_strength`` (predictor, dilatancy_load), ``direct_strength`` (dilatancy_load),
        ``strength_error``; ``strength_share``, the v/b at which most sizes can be compared;
        ``strength_held`` (dilatancy_load), the largest part of windows of any size whose angle was
        held there. NaN where the study states no basic friction angle.

    Notes
    -----
    Eq. 6 with tau* = mu sigma* has the apparent strength at a given sigma_0 fall as
    b^-(2 - Delta).
    """
    at = int(np.argmax(np.isfinite(laws["similar_slope"]).all("load").sum("part").values))
    chosen = laws.isel(share=at)
    strength = chosen["similar_strength"].transpose("part", "load").values
    strength = np.where(strength > 0, strength, np.nan)
    b, forces = laws["side"].values, laws["load"].values
    delta = delta_sigma.sel(load=forces, method="nearest").values
    ratio = b[1:] / b[0]
    smaller = strength[1:].T
    found = [_power_law(b, strength)]
    for powers in [*(2 - delta), np.zeros(len(forces))]:
        found.append(_mean(smaller * ratio ** powers[:, np.newaxis]))
    dim = "dilatancy_load"
    result = xr.Dataset(
        {
            "strength_share": (
                (),
                float(chosen["share"]),
                cf_attrs("1", "v/b at which strengths are compared"),
            ),
            "strength_held": (
                dim,
                chosen["similar_held"].max("part").values,
                cf_attrs("1", "largest part of windows of any size whose angle was held"),
            ),
        },
        coords={
            "predictor": list(PREDICTORS),
            dim: (dim, forces, cf_attrs("N", "force on the whole window")),
        },
    )
    _add(result, "strength", np.array(found), strength[0], dim, "MPa", "shear strength at v/b")
    return result


def _power_law(b, values):
    """(3, n) prediction for the first size, with its interval, by the line through the others."""
    logs = np.log(values[1:])
    lines = [fit_line(np.log(b[1:] / b[0]), column) for column in logs.T]
    fields = ("intercept", "intercept_low", "intercept_high")
    return np.exp([[getattr(line, field) for line in lines] for field in fields])


def _mean(predictions):
    """(3, n) geometric mean over sizes of (n, size) predictions, with its interval."""
    return np.exp(mean_interval(np.log(predictions), axis=1)[:3])


def _on_curve(at, pressures, curves):
    """Each curve at its own pressure, by lines between the logarithms; NaN beyond its ends."""
    found = np.full(len(curves), np.nan)
    for i, (p, curve) in enumerate(zip(at, curves, strict=True)):
        known = np.isfinite(curve)
        if known.any() and np.isfinite(p):
            x, y = np.log(pressures[known]), np.log(curve[known])
            found[i] = np.exp(np.interp(np.log(p), x, y, left=np.nan, right=np.nan))
    return found


def _add(result, name, found, direct, dim, units, words):
    """Predictions (predictor, 3, n), the value solved and the errors, into ``result``."""
    for i, (ending, more) in enumerate(INTERVAL.items()):
        text = f"{words} of the whole window, predicted from smaller ones{more}"
        result[f"predicted_{name}{ending}"] = (
            ("predictor", dim),
            found[:, i],
            cf_attrs(units, text),
        )
    text = f"{words} of the whole window, solved"
    result[f"direct_{name}"] = (dim, direct, cf_attrs(units, text))
    error = found[:, 0] / direct - 1
    text = f"predicted over solved {words}, less one"
    result[f"{name}_error"] = (("predictor", dim), error, cf_attrs("1", text))
