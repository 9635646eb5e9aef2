"""The size test of eq. 6 on parts of the window: at equal nominal pressure, and at equal sigma*."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import DIMENSION, EXPONENT, Estimate
from ...core.subject import Subject
from ...core.text import pressure_label
from .. import kit

TITLE = "Size test: parts of the window at equal pressure and at equal sigma*, beside eq. 6"
SUBJECT = "specimen"
NEEDS = ("size_test", "windows", "statements")
ORDER = 170

#: Number of loads shown over the side b.
MAX_LOADS = 3
#: Words and style of eq. 6 by each estimate of Delta_sigma; black is left to measured points.
ESTIMATORS: dict[str, tuple[str, dict[str, Any]]] = {
    "area": ("$A_r(s)$", {"color": kit.COLOURS[1], "ls": "-"}),
    "box": ("box counting", {"color": kit.COLOURS[2], "ls": "--"}),
}
_TITLES = (
    r"contact area at equal $\sigma_0$",
    "exponent of the area",
    r"exponent of $\sigma_0$ at equal $\sigma^*$",
)
_MEANS = ("area_fraction", "interface_compliance", "mean_gap", "side", "min_nodes", "central_load")
_OTHERS = ("compliance_exponent", "gap_exponent", "beyond_study")
_JUDGED = ("area_verdict", "area_reason", "slope_verdict", "slope_reason", "verdict", "reason")


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """A_r/A_0 over b at some sigma_0, and exponents over load; those of the gap in the data."""
    subject = Subject.of(atlas, name)
    test = subject["size_test"].transpose("normal_force", ...)
    figure = Figure(figsize=(kit.WIDTH, 3.7))
    axes = figure.subplots(1, 3)
    a, b, c = kit.panels_of(axes, _TITLES)
    loads = _draw_area(a, test)
    _draw_exponents(b, test, "area_exponent", test["normal_force"] == test["normal_force"])
    _draw_exponents(c, test, "slope", test["well_conditioned"].astype(bool))
    b.keep(test, "predicted_slope", *_JUDGED, "beyond_study")
    b.axes.set_ylabel("exponent over $b$ (1)")
    hollow = kit.mark(
        color="k", marker="o", ls="none", mfc="white", label="hollow: not judged, too uncertain"
    )
    kit.legends_below(figure, loads, [*b.entries, hollow], columnspacing=3)
    kit.headline(
        figure, subject.label, kit.place(str(test["direction"].values), float(test["offset"]))
    )
    words = kit.caption(
        __name__,
        claim=kit.claim(atlas, name, "size_effect_follows", why=test.attrs["verdict_reason"]),
        measured=bool(np.isfinite(test["area_exponent_low"]).any()),
        effect=bool(test["size_effect"].any()),
    )
    return kit.Drawing(figure, kit.table_of(a, b, c), words)


def _draw_area(panel: kit.Panel, test: xr.Dataset) -> list[Artist]:
    """A_r/A_0 over b under some loads with the lines of eq. 6; entries of a legend, one a load."""
    axes, b = panel.axes, test["side"].values
    panel.keep(test, *_MEANS, "beyond_study")
    axes.set_ylabel(r"real contact area $A_r/A_0$ (1)")
    kit.size_axis(axes, b, "parts")
    fitted = np.isfinite(test["area_exponent_low"].values)
    of_study = fitted & ~test["beyond_study"].values.astype(bool)
    loads = np.flatnonzero(of_study if of_study.any() else fitted)
    if not loads.size:
        kit.say_empty(axes, "no load at which two sizes\nhold enough nodes", ticks=False)
    handles: list[Artist] = [kit.heading("(a) exponent of $b$ [95 % interval]")]
    for n, i in enumerate(loads[kit.spread(loads.size, MAX_LOADS)]):
        one = test.isel(normal_force=i)
        means = Estimate.read(one, "area_fraction")
        style: dict[str, Any] = {"color": "k", "marker": kit.MARKERS[n], "ls": "none"}
        axes.plot(b, means.value, **style)
        kit.draw_bars(axes, b, *means.ends, "k")
        sides = b[means.known]
        for estimator, (_, line) in ESTIMATORS.items():
            slope = float(one["predicted_slope"].sel(estimator=estimator))
            axes.plot(sides, means.value[0] * (sides / sides[0]) ** slope, lw=0.8, **line)
        exponent = Estimate.read(one, "area_exponent", scale=DIMENSION).text()
        pressure = pressure_label(float(one["nominal_pressure"]))
        handles.append(kit.mark(label=f"{pressure}: {exponent}", **style))
        axes.set_yscale("log")
        kit.plain_decades(axes.yaxis)
    return handles


def _draw_exponents(panel: kit.Panel, test: xr.Dataset, name: str, sure: xr.DataArray) -> None:
    """A measured exponent over the load, beside -(2 - Delta_sigma) of eq. 6 by each estimator."""
    axes, pressure = panel.axes, test["nominal_pressure"].values
    measured = Estimate.read(test, name, scale=EXPONENT)
    determined = [measured[i].determined for i in range(pressure.size)]
    shown = test.assign(determined=sure & xr.DataArray(determined, dims="normal_force"))
    style: dict[str, Any] = {
        "color": "k",
        "marker": "o",
        "ls": "none",
        "label": "measured; bar: 95 %",
    }
    panel.curve(shown, "nominal_pressure", name, filled="determined", keep=_OTHERS, **style)
    for estimator, (words, line) in ESTIMATORS.items():
        value, low, high = Estimate.read(test.sel(estimator=estimator), "predicted_slope").ends
        axes.plot(pressure, value, label=rf"eq. 6, $\Delta_\sigma$ by {words}; band: 95 %", **line)
        axes.fill_between(pressure, low, high, color=line["color"], alpha=0.15, lw=0.8)
    grey_beyond(axes, test)
    axes.axhline(0, color="0.5", lw=0.6)
    axes.set(xscale="log", xlim=(pressure[0] / 1.3, pressure[-1] * 1.3), ylim=(-2.3, 0.8))
    axes.set_xlabel(r"$\sigma_0$ of the whole window (MPa)")


def grey_beyond(axes: Any, test: xr.Dataset) -> None:
    """Grey ground under the loads beyond the study's, along an axis of sigma_0."""
    beyond = test["nominal_pressure"].values[test["beyond_study"].values.astype(bool)]
    if beyond.size:
        style: dict[str, Any] = {"color": "0.93", "lw": 0, "zorder": 0}
        axes.axvspan(beyond[0] / 1.15, beyond[-1] * 1.3, label="beyond the study's loads", **style)
