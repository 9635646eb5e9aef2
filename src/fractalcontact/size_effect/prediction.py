"""Prediction of the largest window from small ones, the reverse of the test of eq. 6."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from ..core.datasets import labelled_dataset
from ..core.estimate import Estimate
from ..core.fitting import fit_line
from ..core.intervals import mean_interval
from ..core.labels import cf_attrs
from ..core.ranges import within

#: Predictors of the whole window from smaller ones; the middle ones are eq. 6 with Delta_sigma by
#: each estimator.
PREDICTORS = ("power_law", "eq6_area", "eq6_box", "eq6_box_sizes", "no_size_effect")


def predict_whole(states: xr.Dataset, delta_sigma: xr.DataArray, min_nodes: int) -> xr.Dataset:
    """Closure and real area of the whole window, from smaller windows and as solved.

    ``states`` are those of :func:`size_effect.load_ladder.solve_sub_windows`, ``delta_sigma``
    (estimator, normal_force) is that of the whole window; a size is used where its windows hold
    ``min_nodes`` on the average. ``predicted_closure``, ``predicted_area`` (predictor,
    normal_force) with intervals, ``direct_closure``, ``direct_area`` (normal_force), and
    ``closure_error``, ``area_error`` (predictor, load) = predicted / direct - 1, at the finest
    resolution.

    The power law goes through the means of the smaller sizes at the same sigma_0. Eq. 6 says that
    the whole at sigma_0 has the sigma*, so the real pressure, of windows of side b' at sigma_0
    (b/b')^(2 - Delta); every smaller size gives one prediction and their geometric mean is taken.
    That they close as much then, too, is what "governing parameter" is taken to mean here; the
    paper does not say it. Without a size effect the whole is as its parts at the same sigma_0.
    """
    b, pressures = states["side"].values, states["ladder_pressure"].values
    loads = pressures[: states.sizes["normal_force"]]
    powers = [*(2 - delta_sigma.values), np.zeros(len(loads))]
    fraction, closure = _mean_curves(states, min_nodes)

    def at_equal_star(curves: np.ndarray, powers: np.ndarray) -> np.ndarray:
        """Curves over pressure of smaller sizes, each at the pressure eq. 6 has for it."""
        return np.array(
            [
                _on_curve(p * (b[0] / b[1:]) ** power, pressures, curves[1:])
                for p, power in zip(loads, powers, strict=True)
            ]
        )

    by_eq6 = {
        "closure": [at_equal_star(closure, power) for power in powers],
        # At equal sigma_n the fractions are in proportion to sigma_0.
        "area": [
            at_equal_star(fraction, power) / (b[0] / b[1:]) ** power[:, np.newaxis]
            for power in powers
        ],
    }
    result = xr.Dataset(coords={"predictor": list(PREDICTORS)})
    for name, curves, units, words in (
        ("closure", closure, "mm", "interface closure w_int"),
        ("area", fraction, "1", "real contact area A_r/A_0"),
    ):
        by_law = _power_law(b, curves[:, : len(loads)])
        predictions = [by_law, *(_mean(of_sizes) for of_sizes in by_eq6[name])]
        _add(result, name, predictions, curves[0, : len(loads)], "normal_force", units, words)
    return result


def _mean_curves(states: xr.Dataset, min_nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Mean A_r/A_0 and w_int (part, step) of the windows of each size, where nodes are enough."""
    b = states["side"].values
    nodes, closing = (
        mean.mean("window").transpose("part", "step").values
        for mean in (states["nodes"].isel(resolution=0), states["interface_closure"])
    )
    enough = within(nodes, min_nodes, np.inf)
    fraction = np.where(enough, nodes, np.nan)
    fraction = fraction * states["spacing"].values[0] ** 2 / b[:, np.newaxis] ** 2
    return fraction, np.where(enough & (closing > 0), closing, np.nan)


_STRENGTH = {
    "strength_share": ((), "1", "v/b at which strengths are compared"),
}


def predict_whole_strength(laws: xr.Dataset, delta_sigma: xr.DataArray) -> xr.Dataset:
    """Shear strength of the whole window at v/b as small windows predict it, and as solved, MPa.

    ``laws`` are those of :func:`size_effect.laws.joint_by_size` of a joint that slides,
    ``delta_sigma`` (estimator, normal_force) is that of the whole window. ``predicted_strength``
    and ``strength_error`` (predictor, dilatancy_load), ``direct_strength`` (dilatancy_load), and
    ``strength_share``, the v/b at which most sizes can be compared. NaN where the study states no
    basic friction angle. Eq. 6 with tau* = mu sigma* has the apparent strength at a given sigma_0
    fall as b^-(2 - Delta).
    """
    place = int(
        np.argmax(laws["slope_at_equal_v_over_b"].notnull().all("normal_force").sum("part").values)
    )
    chosen = laws.isel(share=place)
    strength = chosen["strength_at_equal_v_over_b"].transpose("part", "normal_force").values
    strength = np.where(strength > 0, strength, np.nan)
    b, forces = laws["side"].values, laws["normal_force"].values
    delta = delta_sigma.sel(normal_force=forces, method="nearest").values
    ratio = b[1:] / b[0]
    smaller = strength[1:].T
    predictions = [_power_law(b, strength)]
    for powers in [*(2 - delta), np.zeros(len(forces))]:
        predictions.append(_mean(smaller * ratio ** powers[:, np.newaxis]))
    dim = "dilatancy_load"
    result = labelled_dataset(
        _STRENGTH,
        {"strength_share": float(chosen["share"])},
        coords={
            "predictor": list(PREDICTORS),
            dim: (dim, forces, cf_attrs("N", "force on the whole window")),
        },
    )
    words = "shear strength at v/b"
    _add(result, "strength", predictions, strength[0], dim, "MPa", words)
    return result


def _power_law(b: np.ndarray, values: np.ndarray) -> Estimate:
    """Predictions (n,) for the first size by the line through the others."""
    logs = np.log(values[1:])
    lines = [fit_line(np.log(b[1:] / b[0]), column) for column in logs.T]
    return Estimate.stack(line.intercept for line in lines).mapped(np.exp)


def _mean(predictions: np.ndarray) -> Estimate:
    """Geometric mean (n,) over sizes of (n, size) predictions."""
    return mean_interval(np.log(predictions), axis=1).mapped(np.exp)


def _on_curve(targets: np.ndarray, pressures: np.ndarray, curves: np.ndarray) -> np.ndarray:
    """Each curve at its own pressure, by lines between the logarithms; NaN beyond its ends."""
    values = np.full(len(curves), np.nan)
    for i, (p, curve) in enumerate(zip(targets, curves, strict=True)):
        finite = np.isfinite(curve)
        if finite.any() and np.isfinite(p):
            x, y = np.log(pressures[finite]), np.log(curve[finite])
            values[i] = np.exp(np.interp(np.log(p), x, y, left=np.nan, right=np.nan))
    return values


def _add(
    result: xr.Dataset,
    name: str,
    predictions: Sequence[Estimate],
    direct: np.ndarray,
    dim: str,
    units: str,
    words: str,
) -> None:
    """Predictions (n,) of each predictor, the value solved and the errors, into ``result``."""
    predicted = Estimate.stack(predictions, (len(PREDICTORS), len(direct)))
    text = f"{words} of the whole window, predicted from smaller ones"
    result.update(predicted.variables(f"predicted_{name}", ("predictor", dim), units, text))
    text = f"{words} of the whole window, solved"
    result[f"direct_{name}"] = (dim, direct, cf_attrs(units, text))
    error = predicted.value / direct - 1
    text = f"predicted over solved {words}, less one"
    result[f"{name}_error"] = (("predictor", dim), error, cf_attrs("1", text))
