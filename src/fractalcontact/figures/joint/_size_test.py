"""What the figures of the size test share: loads, lines of eq. 6, axes."""

import textwrap
from collections import Counter
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes

from ...core.determined import is_determined
from ...core.estimate import Estimate
from ...core.verdicts import AGREES, FLATTER, NOT_TESTED, STEEPER
from ..kit.axes import label_short_span
from ..kit.drawing import COLOURS
from ..kit.legends import entries
from ..kit.panel import rows
from ..kit.words import place, pressure_label

#: How each estimate of Delta_sigma is drawn where eq. 6 takes it, and how it is named.
ESTIMATORS = {"area": ("-", "$A_r(s)$"), "box": ("--", "box counting")}
#: Colour of each: measured points alone are black.
_COLOURS = {"area": COLOURS[1], "box": COLOURS[2]}
#: Loads shown over the side b, and the marker of each in both panels; "." are all others.
MOST_LOADS = 3
_LOAD_MARKERS = ("o", "s", "^")
#: Entry of a legend below that of a line.
_BAND = "its 95 % interval"
#: Letters of a line of the legend.
_KEY_WIDTH = 44
#: Verdicts that decide.
DECIDED = (AGREES, FLATTER, STEEPER)
#: Verdicts and their reasons: of the well-conditioned form, of eq. 6's own, and of both.
JUDGED = ("area_verdict", "area_reason", "slope_verdict", "slope_reason", "verdict", "reason")


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


def load_marker(n: int) -> str:
    """Marker of the n-th load shown over b."""
    return _LOAD_MARKERS[n]


def draw_laws(axes: Axes, test: xr.Dataset, i: int, b: np.ndarray, start: float) -> None:
    """Eq. 6 under the i-th load by either estimate, from the whole window's value on."""
    for estimator, (line, _) in ESTIMATORS.items():
        slope = float(test["predicted_slope"].sel(estimator=estimator)[i])
        axes.plot(b, start * (b / b[0]) ** slope, color=_COLOURS[estimator], ls=line, lw=0.8)


def draw_predictions(axes: Axes, test: xr.Dataset, *, decided: bool = False) -> None:
    """-(2 - Delta_sigma) over the load with intervals.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    test : xr.Dataset
    decided : bool, optional
        Whether the loads are marked at which an estimate decides about eq. 6.
    """
    pressure = test["nominal_pressure"].values
    test = test.sel(estimator=list(ESTIMATORS))
    any_decides = False
    for estimator, (line, words) in ESTIMATORS.items():
        one = test.sel(estimator=estimator)
        known = np.isfinite(one["predicted_slope"].values)
        value, low, high = (ends[known] for ends in Estimate.read(one, "predicted_slope").ends)
        colour = _COLOURS[estimator]
        absent = "" if known.any() else " (not known here)"
        label = f"eq. 6, $\\Delta_\\sigma$ by {words}{absent}"
        # A single value is no line, and its interval no band.
        single = known.sum() == 1
        mark = "_" if single else None
        axes.plot(pressure[known], value, color=colour, ls=line, label=label, marker=mark)
        if single:
            axes.vlines(pressure[known], low, high, color=colour, lw=0.8, label=_BAND)
        elif (np.isfinite(low) & np.isfinite(high)).any():
            style: dict[str, Any] = {"color": colour, "alpha": 0.15, "lw": 0}
            axes.fill_between(pressure[known], low, high, label=_BAND, **style)
        if decided:
            decides = deciding(one)
            any_decides |= bool(decides.any())
            predicted = one["predicted_slope"].values
            counted = f"decides, by {words}: eq. 6 agrees at {_agreement(one)}"
            named = counted if decides.any() else None
            axes.plot(pressure[decides], predicted[decides], "D", color=colour, ms=5, label=named)
    if decided and not any_decides:
        axes.plot([], [], " ", label=textwrap.fill(verdict_reason(test), _KEY_WIDTH))


def _agreement(test):
    """At how many of the loads that decide eq. 6 agrees: "1 of 3"."""
    decides = deciding(test)
    agree = int((decides & (test["verdict"].values == AGREES)).sum())
    return f"{agree} of {int(decides.sum())}"


def deciding(test: xr.Dataset) -> np.ndarray:
    """Which of the study's loads decide about eq. 6, in the shape of ``verdict``."""
    decided = test["verdict"].isin(DECIDED).values
    return decided & ~test["beyond_study"].values.astype(bool)


def draw_measured(
    axes: Axes, test: xr.Dataset, name: str, shown: np.ndarray, open_at: np.ndarray | None = None
) -> None:
    """Measured exponents over the load with their intervals, faint where these are too wide.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    test : xr.Dataset
    name : str
        Of the exponent.
    shown : (n,) int ndarray
        Loads shown over b, which have markers of their own.
    open_at : (n_load,) bool ndarray, optional
        Which markers are hollow.
    """
    pressure = test["nominal_pressure"].values
    value, low, high = Estimate.read(test, name).ends
    faint = False
    for i in np.flatnonzero(np.isfinite(value)):
        sure = is_determined(low[i], high[i])
        faint |= not sure
        alpha = 1.0 if sure else 0.3
        at = np.flatnonzero(shown == i)
        marker = _LOAD_MARKERS[at[0]] if len(at) else "."
        face = "white" if open_at is not None and open_at[i] else "k"
        axes.vlines(pressure[i], low[i], high[i], color="k", lw=0.8, alpha=alpha)
        axes.plot(pressure[i], value[i], marker, color="k", mfc=face, ms=5, alpha=alpha)
    if np.isfinite(value).any():
        axes.plot([], [], "|", color="k", ms=8, mew=0.8, label="bars in (a), (b): 95 % intervals")
    if np.isfinite(value).sum() > len(shown):
        axes.plot([], [], ".", color="k", ms=5, label="measured, at other loads")
    if faint:
        axes.plot([], [], "o", color="k", ms=4, alpha=0.3, label="faint: undetermined")


def size_legends(axes: Axes) -> tuple[list[Artist], list[Artist]]:
    """Entries of a panel of exponents in two columns: what is measured, and all else."""
    every, points = entries(axes), ("measured", "faint", "hollow")
    measured = [one for one in every if str(one.get_label()).startswith(points)]
    return measured, [one for one in every if one not in measured]


def verdict_reason(test: xr.Dataset) -> str:
    """Why eq. 6 is judged as it is: loads that decide, or what kept them from it; or empty."""
    of_study = test.isel(normal_force=~test["beyond_study"].values.astype(bool))
    of_study = of_study.sel(estimator=list(ESTIMATORS))
    tested = of_study["reason"].values[of_study["verdict"].values != NOT_TESTED].astype(str)
    decides = deciding(of_study)
    if decides.any():
        found = []
        for estimator, (_, words) in ESTIMATORS.items():
            part = of_study.sel(estimator=estimator)
            by = f"by {words.replace('$', '')}"
            agrees = f"agrees at {_agreement(part)} deciding loads {by}"
            found.append(agrees if deciding(part).any() else f"no load decides {by}")
        return ", ".join(found)
    if not tested.size:
        beyond = np.isfinite(test["area_exponent"].values).any()
        return "what is drawn lies beyond the study's loads" if beyond else ""
    why = Counter(tested).most_common(1)[0][0]
    return f"no load decides about eq. 6, mostly as {why}"


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
    axes.set_xlabel(r"nominal pressure $\sigma_0$ of the whole window (MPa)")
    label_short_span(axes.xaxis)


def rows_of_loads(test: xr.Dataset, *names: str, **constants: Any) -> pd.DataFrame:
    """Rows of variables of the size test, each with its load and whether that is the study's."""
    return rows(test.transpose("normal_force", ...), *names, "beyond_study", **constants)


def rows_predicted(test: xr.Dataset) -> pd.DataFrame:
    """Predictions of eq. 6 under each load by every estimator, and the verdicts on them."""
    return rows_of_loads(test, "predicted_slope", *JUDGED, panel="b")
