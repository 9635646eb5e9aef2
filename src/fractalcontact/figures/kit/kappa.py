"""Area slopes kappa of the theories, shared by two figures."""

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from ...core.text import compact, number


def kappa_lines(axes: Axes, stage: xr.Dataset, colours: Mapping[str, str] | None = None) -> None:
    """Persson's and Bush, Gibson and Thomas' kappa over p / (E* h'_rms), and the literature's band.

    `stage` has ``line_pressure`` and ``persson_line`` with attributes ``persson_kappa``,
    ``bush_gibson_thomas_kappa`` and ``computed_kappa``; `colours` are those of ``bush`` and
    ``persson``.
    """
    colours = colours or {"bush": "0.2", "persson": "0.2"}
    pressure = stage["line_pressure"].values
    low, high = stage.attrs["computed_kappa"]
    bush = stage.attrs["bush_gibson_thomas_kappa"]
    label = rf"Bush, Gibson and Thomas: $\sqrt{{2\pi}}$ = {number(bush, 3)}"
    constant = np.full(pressure.shape, bush)
    axes.plot(pressure, constant, "--", color=colours["bush"], lw=1, label=label)
    label = f"computed values in the literature: {compact(low, 6)} to {compact(high, 6)}"
    axes.fill_between(pressure, low, high, color="0.85", lw=0, zorder=0, label=label)
    light = number(stage.attrs["persson_kappa"], 3)
    label = rf"Persson: $\sqrt{{8/\pi}}$ = {light} at light load"
    kappa = stage["persson_line"].values
    axes.plot(pressure, kappa, "-.", color=colours["persson"], lw=1, label=label)
    axes.set_xscale("log")
