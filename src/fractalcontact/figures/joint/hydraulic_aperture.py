"""Hydraulic against mechanical aperture with the empirical laws, and transmissivity over load."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import Estimate, names_of
from ...core.subject import Subject
from ..kit.caption import caption
from ..kit.drawing import WIDTH, Drawing, colour_of
from ..kit.empty import say_empty
from ..kit.laboratory import draw_tests, test_words
from ..kit.legends import entries, legends_below
from ..kit.panel import Panel, table_of
from ..kit.sizes import plain_decades
from ..kit.titles import headline
from ..kit.words import NOMINAL_PRESSURE, place
from ._flow_ways import WAYS, open_states

TITLE = "Hydraulic aperture and transmissivity against load"
SUBJECT = "specimen"
NEEDS = ("specimens", "closure", "flow", "measured")
ORDER = 46
SECTION = "flow"

_LAWS: dict[str, tuple[str, dict[str, Any]]] = {
    "zimmerman_aperture": ("Zimmerman and Bodvarsson", {"color": colour_of(2), "ls": "--"}),
    "barton_aperture": ("Barton", {"color": colour_of(3), "ls": "-."}),
}
_BRANCHES = (("load", "loading", "-"), ("reload", "unloading and reloading", ":"))
#: Ends of the bars, points: both ways have the same abscissae.
_CAPS = {"along": 6.0, "across": 3.0}
_NO_FLOW = "no load has a path of open gap from side to side"


def draw(atlas: DataTree, name: str) -> Drawing:
    """Apertures and transmissivities at the reported offset."""
    subject = Subject.of(atlas, name)
    flow, closure = subject.states("flow"), subject.states("closure")
    states = flow.assign(mean_gap=closure["mean_gap"])
    figure = Figure(figsize=(WIDTH, 4.0))
    titles = ("hydraulic against mean aperture", "transmissivity against pressure")
    a, b = (Panel(*one) for one in zip(figure.subplots(1, 2), "ab", titles, strict=True))
    _draw_apertures(a, states)
    _draw_branches(b, flow)
    draw_tests(b, subject, "flow")
    legends_below(figure, entries(a.axes), entries(b.axes))
    headline(figure, subject.label, place(subject.direction, subject.offset))
    words = {"tests": test_words(subject, "flow"), **_words(subject, states)}
    return Drawing(figure, table_of(a, b), caption(__name__, **words))


def _draw_apertures(panel: Panel, states: xr.Dataset) -> None:
    kept = ("nominal_pressure", "critical_gap_along", "channel_fraction_along")
    for way, style in WAYS.items():
        panel.curve(
            open_states(states, f"hydraulic_aperture_{way}"),
            "mean_gap",
            f"hydraulic_aperture_{way}",
            keep=kept if way == "along" else (),
            label=f"cubic law, {way} ({states.attrs[f'flow_axis_{way}']})",
            ls="none",
            caps=_CAPS[way],
            **style,
        )
    if states[names_of("hydraulic_aperture_along")[1]].notnull().any():
        panel.axes.plot([], [], "|", color="0.4", ms=10, label="95 % interval, mean over windows")
    # Laws go on where no path is left: they are drawn beside what was computed.
    flows = sum(states[f"transmissivity_{way}"].fillna(0) for way in WAYS)
    beside = states.isel(normal_force=np.flatnonzero(flows > 0))
    for law, (words, style) in _LAWS.items():
        if beside[law].notnull().any():
            panel.curve(beside, "mean_gap", law, label=words, marker="none", **style)
    gaps = beside["mean_gap"].values
    if gaps.size:
        ends = [gaps.min(), gaps.max()]
        panel.axes.plot(ends, ends, color="0.6", lw=0.8, label="parallel plates")
    panel.axes.set(xscale="log", yscale="log", xlabel=r"mean gap $\langle g\rangle$ (mm)")
    panel.axes.set_ylabel("hydraulic aperture $h_h$ (mm)")
    for axis in (panel.axes.xaxis, panel.axes.yaxis):
        plain_decades(axis)


def _draw_branches(panel: Panel, flow: xr.Dataset) -> None:
    for way, style in WAYS.items():
        variable = f"branch_transmissivity_{way}"
        branches = open_states(flow, variable)
        load, reload = (branches[variable].sel(branch=one) for one in ("load", "reload"))
        # Where nothing yields, there is one curve.
        crushed = bool((reload.notnull() & (reload != load)).any())
        for branch, words, line in _BRANCHES[: 1 + crushed]:
            panel.curve(
                branches.sel(branch=branch),
                "nominal_pressure",
                variable,
                keep=("branch",),
                label=f"{words}, {way}",
                ls=line,
                **style,
            )
    if not (flow["transmissivity_along"] > 0).any():
        say_empty(panel.axes, _NO_FLOW)
    panel.axes.set(xscale="log", yscale="log", xlabel=f"{NOMINAL_PRESSURE} (MPa)")
    plain_decades(panel.axes.xaxis)
    panel.axes.set_ylabel("transmissivity $T = h_h^3/12$ (mm³)")


def _words(subject: Subject, states: xr.Dataset) -> dict[str, Any]:
    """Values of the caption."""
    at = states.isel(normal_force=subject.reported.reference)
    flow, ratio = float(at["transmissivity_along"]), float(at["hydraulic_ratio_along"])
    reload = at["branch_transmissivity_along"].sel(branch="reload")
    window = Estimate.read(at, "transmissivity_along")
    parts = {"grid": "grid_error", "closing": "separation_error"}
    return {
        "pressure": float(at["nominal_pressure"]),
        "transmissivity": flow,
        "aperture": float(at["hydraulic_aperture_along"]),
        "ratio": ratio,
        "flows": flow > 0,
        "window": [window.low, window.high],
        "reload": float(reload / flow) if flow > 0 else np.nan,
        "closed": float(states["first_closed_pressure_along"]),
        "opened": float(states["last_open_pressure_along"]),
        **{
            name: float(at[f"transmissivity_{part}_along"]) / flow if flow > 0 else np.nan
            for name, part in parts.items()
        },
    }
