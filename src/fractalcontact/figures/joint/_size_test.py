"""Loads, lines of eq. 6 and axes shared by the figures of the size test."""

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from ...core.estimate import DIMENSION, Estimate
from ..kit.drawing import COLOURS, spread
from ..kit.legends import mark
from ..kit.panel import rows
from ..kit.sizes import draw_bars, size_axis
from ..kit.words import place, pressure_label

#: How each estimate of Delta_sigma is drawn where eq. 6 takes it, and how it is named.
ESTIMATORS = {"area": ("-", "$A_r(s)$"), "box": ("--", "box counting")}
#: Colour of each: measured points alone are black.
ESTIMATOR_COLOURS = {"area": COLOURS[1], "box": COLOURS[2]}
#: Loads shown over the side b, and the marker of each in both panels; "." are all others.
MAX_LOADS = 3
LOAD_MARKERS = ("o", "s", "^")
#: Verdicts and their reasons: of the well-conditioned form, of eq. 6's own, and of both.
JUDGED = ("area_verdict", "area_reason", "slope_verdict", "slope_reason", "verdict", "reason")


def place_of(test: xr.Dataset) -> str:
    """Place of the contact in words."""
    return place(str(test["direction"].values), float(test["offset"]))


def first_loads(test: xr.Dataset, name: str) -> np.ndarray:
    """Indices of loads with a value: of the study, or else those beyond it."""
    known = np.isfinite(test[name].values)
    of_study = known & ~test["beyond_study"].values.astype(bool)
    return np.flatnonzero(of_study if of_study.any() else known)


def shown_loads(test: xr.Dataset, name: str) -> np.ndarray:
    """Indices of the loads that are drawn over b: a few of :func:`first_loads`."""
    fitted = first_loads(test, name)
    return fitted[spread(len(fitted), MAX_LOADS)]


def draw_over_side(
    axes: Axes, test: xr.Dataset, name: str, exponent: str, loads: np.ndarray
) -> list[Line2D]:
    """Values over b under some loads, with the prediction of eq. 6 from the whole window.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    test : xr.Dataset
    name, exponent : str
        Of the values, drawn with bars where they have intervals, and of their exponent.
    loads : (n,) int ndarray
        From :func:`shown_loads`.

    Returns
    -------
    list of matplotlib.lines.Line2D
        Entries of a legend, one a load: the exponent with its interval.
    """
    b, values, handles = test["side"].values, test[name].values, []
    exponents = Estimate.read(test, exponent, scale=DIMENSION)
    for n, i in enumerate(loads):
        style: dict[str, Any] = {"color": "k", "marker": LOAD_MARKERS[n], "ls": "none"}
        axes.plot(b, values[i], **style)
        if f"{name}_low" in test:
            low, high = (test[f"{name}_{end}"].values[i] for end in ("low", "high"))
            draw_bars(axes, b, values[i], low, high, "k")
        known = b[np.isfinite(values[i])]
        for estimator, (line, _) in ESTIMATORS.items():
            slope = float(test["predicted_slope"].sel(estimator=estimator)[i])
            law = values[i, 0] * (known / known[0]) ** slope
            axes.plot(known, law, color=ESTIMATOR_COLOURS[estimator], ls=line, lw=0.8)
        pressure = pressure_label(float(test["nominal_pressure"][i]))
        handles.append(mark(label=f"at {pressure}: {exponents[i].text()}", **style))
    size_axis(axes, b, "parts")
    return handles


def grey_beyond(axes: Axes, test: xr.Dataset) -> None:
    """Grey ground under the loads beyond the study's, along an axis of sigma_0."""
    pressure = test["nominal_pressure"].values
    beyond = pressure[test["beyond_study"].values.astype(bool)]
    if len(beyond):
        below = pressure[pressure < beyond[0]]
        first = np.sqrt(beyond[0] * below[-1]) if below.size else beyond[0] / 1.3
        style: dict[str, Any] = {"color": "0.93", "lw": 0, "zorder": 0}
        axes.axvspan(first, beyond[-1] * 1.3, label="beyond the study's loads", **style)


def rows_of_loads(test: xr.Dataset, *names: str, **constants: Any) -> pd.DataFrame:
    """Rows of variables of the size test, each with its load and whether that is the study's."""
    return rows(test.transpose("normal_force", ...), *names, "beyond_study", **constants)


def rows_predicted(test: xr.Dataset) -> pd.DataFrame:
    """Predictions of eq. 6 under each load by every estimator, and the verdicts on them."""
    return rows_of_loads(test, "predicted_slope", *JUDGED, panel="b")
