"""Exponents of the size test over the load: measured, and as eq. 6 has them."""

import textwrap
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes

from ...core.estimate import EXPONENT, Estimate
from ..kit.axes import label_short_span
from ..kit.legends import entries
from ._size_test import ESTIMATOR_COLOURS, ESTIMATORS, LOAD_MARKERS, grey_beyond

#: Entry of a legend below that of a line.
_BAND = "its 95 % interval"
#: Letters of a line of the legend.
_KEY_WIDTH = 44


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
    for estimator, (line, words) in ESTIMATORS.items():
        one = test.sel(estimator=estimator)
        known = np.isfinite(one["predicted_slope"].values)
        value, low, high = (ends[known] for ends in Estimate.read(one, "predicted_slope").ends)
        colour = ESTIMATOR_COLOURS[estimator]
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
            decides, predicted = one["decides"].values, one["predicted_slope"].values
            agrees, count = int(one["agreeing_loads"]), int(one["deciding_loads"])
            counted = f"conclusive, by {words}: eq. 6 agrees at {agrees or 'none'} of {count}"
            named = counted if count else None
            axes.plot(pressure[decides], predicted[decides], "D", color=colour, ms=5, label=named)
    if decided and not test["decides"].any():
        why = textwrap.fill(test.attrs["verdict_reason"], _KEY_WIDTH)
        axes.plot([], [], " ", label=why)


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
        sure = Estimate(value[i], low[i], high[i], scale=EXPONENT).determined
        faint |= not sure
        alpha = 1.0 if sure else 0.3
        at = np.flatnonzero(shown == i)
        marker = LOAD_MARKERS[at[0]] if len(at) else "."
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
    """Legend entries of exponents in two columns: measured ones, then all others."""
    every, points = entries(axes), ("measured", "faint", "hollow")
    measured = [one for one in every if str(one.get_label()).startswith(points)]
    return measured, [one for one in every if one not in measured]


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
