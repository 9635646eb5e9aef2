"""Hydraulic against mechanical aperture with empirical laws; transmissivity over load, offset."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.directions import slides
from ...core.estimate import Estimate, names_of
from ...core.subject import Subject
from .. import kit

TITLE = "Hydraulic aperture and transmissivity"
SUBJECT = "specimen"
NEEDS = ("specimens", "closure", "flow", "measured")
ORDER = 46
JOINT_STUDY = True
SECTION = "flow"

#: Styles of the flow along and across; caps of bars differ because both have the same abscissae.
_WAYS: dict[str, dict[str, Any]] = {
    "along": {"color": kit.colour_of(0), "marker": "o", "caps": 6.0},
    "across": {"color": kit.colour_of(1), "marker": "s", "mfc": "none", "caps": 3.0},
}
_LAWS: dict[str, tuple[str, dict[str, Any]]] = {
    "zimmerman_aperture": ("Zimmerman and Bodvarsson", {"color": kit.colour_of(2), "ls": "--"}),
    "barton_aperture": ("Barton", {"color": kit.colour_of(3), "ls": "-."}),
}
_BRANCHES = (("load", "loading", "-"), ("reload", "unloading and reloading", ":"))
_TITLES = ("hydraulic aperture", "transmissivity", "$T$ (mm³), reference load")


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Apertures and transmissivities at the reported offset, and transmissivity at all offsets."""
    subject = Subject.of(atlas, name)
    flow, closure = subject.states("flow"), subject.states("closure")
    states = flow.assign(mean_gap=closure["mean_gap"])
    figure = Figure(figsize=(kit.WIDTH, 4.0))
    axes = figure.subplots(1, 3 if subject.direction != "none" else 2)
    a, b, *offsets = panels = kit.panels_of(axes, _TITLES)
    _draw_apertures(a, states)
    _draw_branches(b, flow)
    kit.draw_tests(b, subject, "flow")
    for c in offsets:
        flow = subject["flow"]
        _draw_ways(c, flow, "offset", "offset_transmissivity", "", "-", ["offset_mean_gap"])
        c.axes.set_yscale("log")
        kit.offset_axis(c.axes, flow["offset"].values)
    kit.legends_below(figure, a.entries, b.entries)
    kit.headline(figure, subject.label, kit.place(subject.direction, subject.offset))
    words = {"tests": kit.test_words(subject, "flow"), **_words(subject, states)}
    return kit.Drawing(figure, kit.table_of(*panels), kit.caption(__name__, **words))


def _draw_ways(
    panel: kit.Panel, data: xr.Dataset, x: str, name: str, label: str, ls: str, kept: Sequence[str]
) -> None:
    """Variable against x along and across the sliding; zeros are left out on logarithmic axes."""
    flows = False
    for way, style in _WAYS.items():
        variable = data[f"{name}_{way}"]
        shown = variable.where(variable > 0).assign_attrs(variable.attrs)
        panel.curve(
            data.assign({f"{name}_{way}": shown}),
            x,
            f"{name}_{way}",
            keep=kept if way == "along" else (),
            label=label and f"{label}, {way} ({data.attrs[f'flow_axis_{way}']})",
            ls=ls,
            **style,
        )
        flows |= bool(shown.notnull().any())
    if not flows:
        kit.say_empty(panel.axes, "no path of open gap\njoins both sides")


def _draw_apertures(panel: kit.Panel, states: xr.Dataset) -> None:
    kept = ("nominal_pressure", "critical_gap_along", "channel_fraction_along")
    _draw_ways(panel, states, "mean_gap", "hydraulic_aperture", "cubic law", "none", kept)
    if states[names_of("hydraulic_aperture_along")[1]].notnull().any():
        panel.axes.plot([], [], "|", color="0.4", ms=10, label="95 % interval, mean over windows")
    # Empirical laws have values where no path is open; they are drawn only beside computed ones.
    flows = sum(states[f"transmissivity_{way}"].fillna(0) for way in _WAYS)
    open_states = states.isel(normal_force=np.flatnonzero(flows > 0))
    for law, (words, style) in _LAWS.items():
        if open_states[law].notnull().any():
            panel.curve(open_states, "mean_gap", law, label=words, marker=".", **style)
    gaps = open_states["mean_gap"].values
    if gaps.size:
        ends = [gaps.min(), gaps.max()]
        panel.axes.plot(ends, ends, color="0.6", lw=0.8, label="parallel plates")
    panel.axes.set(xscale="log", yscale="log", xlabel=r"mean gap $\langle g\rangle$ (mm)")
    panel.axes.set_ylabel("hydraulic aperture $h_h$ (mm)")
    for axis in (panel.axes.xaxis, panel.axes.yaxis):
        kit.plain_decades(axis)


def _draw_branches(panel: kit.Panel, flow: xr.Dataset) -> None:
    x, name = "nominal_pressure", "branch_transmissivity"
    load, reload = (flow[f"{name}_along"].sel(branch=branch) for branch in ("load", "reload"))
    # Loading and reloading are one curve where nothing yields.
    crushed = bool(((reload > 0) & (reload != load)).any())
    for branch, words, line in _BRANCHES[: 1 + crushed]:
        _draw_ways(panel, flow.sel(branch=branch), x, name, words, line, ["branch"])
    panel.axes.set(xscale="log", yscale="log", xlabel=f"{kit.NOMINAL_PRESSURE} (MPa)")
    kit.plain_decades(panel.axes.xaxis)
    panel.axes.set_ylabel("transmissivity $T = h_h^3/12$ (mm³)")


def _words(subject: Subject, states: xr.Dataset) -> dict[str, Any]:
    """Values of the caption."""
    state = states.isel(normal_force=subject.reported.reference)
    window = Estimate.read(state, "transmissivity_along")
    # Ratios to the flow are missing where nothing flows.
    flow = float(window.value) if window.value > 0 else np.nan
    offsets = subject["flow"]["offset_transmissivity_along"]
    first, last = offsets.where(offsets > 0).values[[0, -1]]
    return {
        "pressure": float(state["nominal_pressure"]),
        "transmissivity": flow,
        "aperture": float(state["hydraulic_aperture_along"]),
        "ratio": float(state["hydraulic_ratio_along"]),
        "flows": flow > 0,
        "filled": np.isnan(window.value),
        "reason": str(state["flow_reason_along"].values),
        "wider": float(states["shifted_ratio"]),
        "window": [window.low, window.high],
        "reload": float(state["branch_transmissivity_along"].sel(branch="reload") / flow),
        "closed": float(states["first_closed_pressure_along"]),
        "opened": float(states["last_open_pressure_along"]),
        "grid": float(state["transmissivity_grid_error_along"]) / flow,
        "walls": int((offsets == 0).sum()),
        "offsets": offsets.size,
        "way": "the sliding" if slides(subject.settings["opposite"]) else "x",
        "slope": float(state["gap_slope"]),
        "first_offset": float(offsets["offset"][0]),
        "last_offset": float(offsets["offset"][-1]),
        "widening": float(last / first),
    }
