"""What the figures of the size test share: loads, lines of eq. 6, axes."""

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from xarray import DataTree

from ...domain.box_dimension import is_determined
from ..kit.drawing import COLOURS, MARKERS, entries, group, label_short_span
from ..kit.words import place, pressure_label

#: How each estimate of Delta_sigma is drawn where eq. 6 takes it, and how it is named.
ESTIMATORS = {"area": ("-", "$A_r(s)$"), "box": ("--", "box counting")}
#: Loads shown over the side b.
MOST_LOADS = 3
#: Verdicts and their reasons: of the well-conditioned form, of eq. 6's own, and of both.
JUDGED = ("area_verdict", "area_reason", "slope_verdict", "slope_reason", "verdict", "reason")


def size_test_of(atlas: DataTree, name: str) -> xr.Dataset:
    """Size test of a specimen with what was predicted of its whole window."""
    laws = group(atlas, "windows", name)
    predicted = [of for of in laws if {"predictor", "dilatancy_load"} & set(laws[of].dims)]
    return group(atlas, "size_test", name).assign({of: laws[of] for of in predicted})


def place_of(test: xr.Dataset) -> str:
    """Where the contact is, in words."""
    return place(str(test["direction"].values), float(test["offset"]))


def first_loads(test: xr.Dataset, name: str) -> np.ndarray:
    """Indices of loads with a value: those of the study, or where it has none those beyond."""
    known = np.isfinite(test[name].values)
    of_study = known & ~test["beyond_study"].values.astype(bool)
    return np.flatnonzero(of_study if of_study.any() else known)


def pressure_words(test: xr.Dataset, i: int) -> str:
    """Nominal pressure of the i-th load."""
    return pressure_label(float(test["nominal_pressure"][i]))


def draw_predictions(axes: Axes, test: xr.Dataset) -> list[Artist]:
    """-(2 - Delta_sigma) over the load with intervals; legend entries."""
    pressure = test["nominal_pressure"].values
    for i, (estimator, (line, words)) in enumerate(ESTIMATORS.items()):
        one = test.sel(estimator=estimator)
        known = np.isfinite(one["predicted_slope"].values)
        value, low, high = (
            one[f"predicted_slope{end}"].values[known] for end in ("", "_low", "_high")
        )
        style: dict[str, Any] = {
            "color": COLOURS[i + 1],
            "ls": line,
            "marker": MARKERS[i + 1],
            "ms": 3,
        }
        axes.fill_between(pressure[known], low, high, color=style["color"], alpha=0.15, lw=0)
        axes.plot(pressure[known], value, label=f"eq. 6, $\\Delta_\\sigma$ by {words}", **style)
    return entries(axes)


def draw_measured(
    axes: Axes, test: xr.Dataset, name: str, chosen: np.ndarray, label: str, face: str = "k"
) -> None:
    """Measured exponents over the load with their intervals, faint where these are too wide.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    test : xr.Dataset
    name : str
        Of the exponent.
    chosen : (n_load,) bool ndarray
        Which loads.
    label : str
        For the legend, "" for none.
    face : str, optional
        Colour within the markers.
    """
    pressure = test["nominal_pressure"].values
    value, low, high = (test[f"{name}{end}"].values for end in ("", "_low", "_high"))
    sure = np.array([is_determined(*ends) for ends in zip(low, high, strict=True)])
    for which, alpha in ((chosen & sure, 1.0), (chosen & ~sure, 0.3)):
        axes.vlines(pressure[which], low[which], high[which], color="k", lw=0.8, alpha=alpha)
        axes.plot(pressure[which], value[which], "ko", mfc=face, ms=4, alpha=alpha)
    if label:
        faint = "; faint: undetermined" if (chosen & ~sure).any() else ""
        axes.plot([], [], "ko", mfc=face, ms=4, label=f"{label}{faint}")


def grey_beyond(axes: Axes, test: xr.Dataset) -> None:
    """Grey ground under the loads beyond the study's, along an axis of sigma_0."""
    pressure = test["nominal_pressure"].values
    beyond = pressure[test["beyond_study"].values.astype(bool)]
    if len(beyond):
        below = pressure[pressure < beyond[0]]
        first = np.sqrt(beyond[0] * below[-1]) if below.size else beyond[0] / 1.3
        style: dict[str, Any] = {"color": "0.93", "lw": 0, "zorder": 0}
        axes.axvspan(first, beyond[-1] * 1.3, label="beyond the study's loads", **style)


def load_axis(axes: Axes, test: xr.Dataset) -> None:
    """Axis of sigma_0 of the whole, loads beyond the study in grey."""
    pressure = test["nominal_pressure"].values
    grey_beyond(axes, test)
    axes.axhline(0, color="0.5", lw=0.6)
    axes.set_xscale("log")
    axes.set_xlim(pressure[0] / 1.3, pressure[-1] * 1.3)
    axes.set_ylim(-2.3, 0.8)
    axes.set_xlabel(r"$\sigma_0$ of the whole window (MPa)")
    label_short_span(axes.xaxis)


def load_columns(test: xr.Dataset, force: float) -> dict[str, float | bool]:
    """Columns that say which load is meant, the same in every table of the size test.

    Parameters
    ----------
    test : xr.Dataset
    force : float
        One of the loads of the test, N.

    Returns
    -------
    dict

    Raises
    ------
    KeyError
        If the test has no such load.
    """
    load = test[["nominal_pressure", "beyond_study"]]
    load = load.sel(normal_force=force, method="nearest", tolerance=1e-6 * force)
    return {
        "load_N": force,
        "nominal_pressure_MPa": float(load["nominal_pressure"]),
        "beyond_study": bool(load["beyond_study"]),
    }


def predicted_table(test: xr.Dataset, i: int, common: dict) -> pd.DataFrame:
    """What eq. 6 predicts under the i-th load by every estimate, and the verdicts on it."""
    return pd.DataFrame(
        {
            "quantity": "predicted_slope",
            **common,
            "estimator": test["estimator"].values,
            **{
                f"slope{end}": test[f"predicted_slope{end}"].values[:, i]
                for end in ("", "_low", "_high")
            },
            **{name: test[name].values[:, i] for name in JUDGED},
        }
    )
