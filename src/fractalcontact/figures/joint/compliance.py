"""Correlation of the faces, and closure and compliance of the interface, against the offset."""

from itertools import pairwise
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.limits import RESOLVED_NODES
from ...core.subject import Subject
from ...core.text import compact, force_label, pressure_label
from .. import kit

TITLE = "Figs. 4 and 5: correlation of the faces, closure and compliance against the offset"
SUBJECT = "joint"
NEEDS = ("specimens", "joints", "closure", "statements")
ORDER = 70
JOINT_STUDY = True

#: Stages of sliding that the paper describes, by statement.
STAGES = {
    "compliance_rises_at_first": "compliance rises as v^x",
    "curves_overlap": "compliance stays the same",
    "compliance_rises_again": "compliance rises again",
}
#: Line styles of the offsets between the stages.
_ENDS = {"correlation 1/e": "--", "correlation lost": ":"}


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Face correlation at every offset; closure and compliance at those solved."""
    subject = Subject.of(atlas, name)
    curves = subject.curves().isel(normal_force=list(subject.reported.loads))
    joint = subject["joints"]
    solved = joint.sel(direction=subject.direction)
    ends = float(solved["correlation_length"]), float(solved["uncorrelated_offset"])
    seated = bool((curves["closure_from_common_seat"] > 0).any())
    seat = pressure_label(float(curves["common_seating_pressure"])) if seated else "first touch"

    figure = Figure(figsize=(kit.WIDTH, 7.3))
    axes = figure.subplots(3, 1, sharex=True, height_ratios=[1.1, 1, 1.2])
    titles = ["correlation of the faces", f"closure of the interface from {seat} on"]
    titles.append("compliance of the interface (bars: error of the solver)")
    a, b, c = kit.panels_of(axes, titles)
    _draw_correlation(a, joint, subject.direction)
    _draw_closures(b, curves, "closure_from_common_seat" if seated else "interface_closure")
    _draw_compliances(c, curves)
    for at, (words, style) in zip(ends, _ENDS.items(), strict=True):
        if np.isfinite(at):
            for panel in (a, b, c):
                label = f"{words}: $v$ = {compact(at)} mm" if panel is a else None
                panel.axes.axvline(at, color="0.4", lw=0.8, ls=style, label=label)
    # The scale suits the offsets solved; the correlation is known at further offsets.
    kit.offset_axis(c.axes, curves["offset"].values)
    if c.axes.get_xscale() == "log":
        kit.plain_decades(c.axes.xaxis)
    judged = [one for one in STAGES if kit.row_of(atlas, "statements", name, one) is not None]
    if judged:
        _number_stages(c.axes, ends)
    why = kit.missing_lines(curves["interface_stiffness_reason"], "c")
    kit.legends_below(figure, a.entries, [*c.entries, *map(kit.heading, why)])
    kit.headline(figure, subject.label, kit.place(subject.direction))
    values = {
        "rises": kit.verdict_words(atlas, name, "compliance_rises_at_first", numbers=False),
        "ends": ends,
        "end": float(joint["rigid_offset"][-1]),
        "stages": [f"{STAGES[one]}: {kit.verdict_words(atlas, name, one)}" for one in judged],
        "force": subject["statements"].attrs["force"],
    }
    return kit.Drawing(figure, kit.table_of(a, b, c), kit.caption(__name__, **values))


def _draw_correlation(panel: kit.Panel, joint: xr.Dataset, solved: str) -> None:
    """Correlation of the faces: the direction solved in black, all others in grey."""
    kept = ("correlation_length", "uncorrelated_offset")
    for direction in sorted(joint["direction"].values, key=lambda one: one == solved):
        words = "the direction of (b), (c)" if direction == solved else "other directions"
        labels = {entry.get_label() for entry in panel.entries}
        style: dict[str, Any] = {"color": "k" if direction == solved else "0.7", "ls": "-"}
        style["label"] = None if words in labels else words
        one = joint.sel(direction=direction)
        panel.curve(one, "rigid_offset", "face_correlation", keep=kept, **style)
    limit = float(joint["correlation_limit"])
    if np.isfinite(limit):
        panel.axes.axhspan(-limit, limit, color="0.9", zorder=0, lw=0, label="by chance, 95 %")
    reached = np.isfinite(joint["correlation_length"].sel(direction=solved))
    dashed: dict[str, Any] = {"color": "0.4", "lw": 0.8, "ls": _ENDS["correlation 1/e"]}
    panel.axes.axhline(np.exp(-1), label=None if reached else "1/e, not reached", **dashed)
    panel.axes.set(ylim=(None, 1.05), ylabel="correlation of the faces (1)", xlabel="")


def _draw_closures(panel: kit.Panel, curves: xr.Dataset, name: str) -> None:
    """Closure from the common seat of all offsets, or else from first touch."""
    kept = ("interface_closure", "closure_from_common_seat", "common_seating_pressure", "nodes")
    # Loads up to the seating load do not close the joint any further.
    loaded = curves[name].where((curves[name] > 0).any("offset")).assign_attrs(curves[name].attrs)
    style: dict[str, Any] = {"hue": "normal_force", "first": 1, "filled": "resolved", "ls": "-"}
    panel.curves(curves.assign({name: loaded}), "offset", name, keep=kept, **style)
    if not loaded.notnull().any():
        kit.say_empty(panel.axes, kit.TOO_FULL)
    panel.axes.set_ylim(bottom=min(0, float(loaded.fillna(0).min())))
    panel.axes.set_ylabel(r"closure $w_\mathrm{int}$ (mm)")


def _draw_compliances(panel: kit.Panel, curves: xr.Dataset) -> None:
    """Compliance under every load; bars without an end leave the frame."""
    axes, reasons = panel.axes, curves["interface_stiffness_reason"]
    labels = [f"$F$ = {force_label(force)}" for force in curves["normal_force"].values]
    style: dict[str, Any] = {"hue": "normal_force", "first": 1, "filled": "resolved", "ls": "-"}
    kept = ("interface_stiffness_reason",)
    panel.curves(curves, "offset", "interface_compliance", labels=labels, keep=kept, **style)
    if not curves["resolved"].all():
        kit.hollow_entry(axes, f"hollow: fewer than {RESOLVED_NODES} nodes touch")
    axes.set_yscale("log")
    if curves["interface_compliance"].notnull().any():
        axes.set_ylim(top=3 * float(curves["interface_compliance"].max()))
    else:
        kit.say_empty(axes, "\n".join(kit.different_reasons(reasons)) or kit.TOO_FULL)
    kit.plain_decades(axes.yaxis)
    axes.set_ylabel(r"compliance $\mathrm{d}w_\mathrm{int}/\mathrm{d}\sigma_0$ (mm/MPa)")


def _number_stages(axes: Axes, ends: tuple[float, float]) -> None:
    """Numbers of the stages at the upper edge, between the offsets that bound them."""
    log = axes.get_xscale() != "linear"
    low, high = axes.dataLim.intervalx if log else axes.get_xlim()
    bounds = [low, *(min(end, high) for end in ends if np.isfinite(end)), high]
    style: dict[str, Any] = {"ha": "center", "va": "top", "fontweight": "bold"}
    for n, (first, last) in enumerate(pairwise(bounds), 1):
        if 0 <= first < last:
            middle = np.sqrt(first * last) if log and first > 0 else (first + last) / 2
            axes.text(middle, 0.97, f"{n}", transform=axes.get_xaxis_transform(), **style)
