"""Correlation of the faces, and closure and compliance of the interface, against the offset."""

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.limits import RESOLVED_NODES
from ...core.subject import Subject
from ..kit.axes import offset_axis
from ..kit.caption import caption
from ..kit.drawing import WIDTH, Drawing
from ..kit.empty import TOO_FULL, different_reasons, missing_lines, say_empty
from ..kit.legends import entries, heading, legends_below
from ..kit.panel import Panel, table_of
from ..kit.points import hollow_entry
from ..kit.sizes import plain_decades
from ..kit.titles import headline
from ..kit.verdicts import row_of
from ..kit.words import force_label, percent, place, pressure_label
from ._face_correlation import draw_correlation
from ._sliding_stages import number_stages, stage_column, stages_of_sliding

TITLE = "Figs. 4 and 5: correlation of the faces, closure and compliance against the offset"
SUBJECT = "joint"
NEEDS = ("specimens", "joints", "closure", "statements")
ORDER = 70


def draw(atlas: DataTree, name: str) -> Drawing:
    """Face correlation at every offset; closure and compliance at those solved."""
    subject = Subject.of(atlas, name)
    curves = subject.curves().isel(normal_force=list(subject.reported.loads))
    joint = subject["joints"]
    solved = joint.sel(direction=subject.direction)
    ends = float(solved["correlation_length"]), float(solved["uncorrelated_offset"])
    force = subject["statements"].attrs["force"]
    stages = stages_of_sliding(atlas, name, ends)

    figure = Figure(figsize=(WIDTH, 7.3))
    axes = figure.subplots(3, 1, sharex=True, height_ratios=[1.1, 1, 1.2])
    titles = ("correlation of the faces", _seat(curves), _bars(curves))
    a, b, c = (Panel(*one) for one in zip(axes, "abc", titles, strict=True))
    draw_correlation(a, joint, subject.direction, ends)
    _draw_closures(b, c, curves)
    for at, style in zip(ends, ("--", ":"), strict=True):
        for panel in (b, c):
            if np.isfinite(at):
                panel.axes.axvline(at, color="0.4", lw=0.8, ls=style)
    # The scale suits the offsets solved; the correlation is known at more.
    offset_axis(c.axes, curves["offset"].values)
    if c.axes.get_xscale() == "log":
        plain_decades(c.axes.xaxis)
    columns: list[list[Artist]] = [entries(a.axes), entries(c.axes), *stage_column(stages, force)]
    if np.isfinite(curves["interface_compliance"]).any():
        number_stages(c.axes, stages)
        why = missing_lines(curves["interface_stiffness_reason"], "c")
        columns[-1] = columns[-1] + [heading(line) for line in why]
    legends_below(figure, *columns, columnspacing=1.5)
    headline(figure, subject.label, place(subject.direction))
    decidable = np.isfinite(float(joint["correlation_limit"]))
    first = row_of(atlas, "statements", name, "compliance_rises_at_first")
    rises = "" if first is None else str(first["verdict"].item())
    words = {
        "rises": rises,
        "ends": ends,
        "decidable": decidable,
        "end": float(joint["rigid_offset"][-1]),
        "stages": [text for text, *_ in stages],
    }
    return Drawing(figure, table_of(a, b, c), caption(__name__, force=force, **words))


def _seated(curves):
    """True if some closure lies above the seat that all offsets have in common."""
    return bool((curves["closure_from_common_seat"] > 0).any())


def _draw_closures(closed, compliance, curves):
    """Closure from the common seat of all offsets, or else from first touch, and compliance."""
    labels = [f"$F$ = {force_label(force)}" for force in curves["normal_force"].values]
    style = {"hue": "normal_force", "first": 1, "filled": "resolved", "ls": "-"}
    high = curves["interface_compliance_high"]
    kept = ("interface_stiffness_reason",)
    compliance.curves(curves, "offset", "interface_compliance", labels=labels, keep=kept, **style)
    closure = "closure_from_common_seat" if _seated(curves) else "interface_closure"
    kept = ("interface_closure", "closure_from_common_seat", "common_seating_pressure", "nodes")
    # Loads that seat the joint, or less, close it by nothing more.
    loaded = curves[closure].where((curves[closure] > 0).any("offset") | (not _seated(curves)))
    closed.curves(
        curves.assign({closure: loaded.assign_attrs(curves[closure].attrs)}),
        "offset",
        closure,
        keep=kept,
        **style,
    )
    if not curves["resolved"].all():
        hollow_entry(compliance.axes, f"hollow: fewer than {RESOLVED_NODES} nodes touch")
    if not np.isfinite(curves["interface_compliance"]).any():
        why = different_reasons(curves["interface_stiffness_reason"])
        say_empty(compliance.axes, "\n".join(why) or TOO_FULL)
    heights = loaded.values[np.isfinite(loaded.values)]
    if heights.any():
        closed.axes.set_ylim(bottom=min(0, *heights))
    elif not heights.size:
        say_empty(closed.axes, TOO_FULL)
    closed.axes.set_ylabel(r"closure $w_\mathrm{int}$ (mm)")
    compliance.axes.set_yscale("log")
    tops = high.values[np.isfinite(high.values)]
    if tops.size:
        compliance.axes.set_ylim(top=1.3 * tops.max())
    plain_decades(compliance.axes.yaxis)
    compliance.axes.set_ylabel(r"compliance $\mathrm{d}w_\mathrm{int}/\mathrm{d}\sigma_0$ (mm/MPa)")


def _seat(curves):
    """Title of the closures: from where they are counted."""
    seat = pressure_label(float(curves["common_seating_pressure"]))
    since = f"counted from {seat} on" if _seated(curves) else "counted from first touch"
    return f"closure of the interface, {since}"


def _bars(curves):
    """Title of the compliances, with the meaning of visible bars."""
    most = float((curves["interface_compliance_high"] / curves["interface_compliance"]).max()) - 1
    words = (
        f"up to {percent(most)}" if np.isfinite(most) else "unbounded where they leave the frame"
    )
    bars = f" (bars: error of the solver alone, {words})" if most > 0.001 else ""
    return f"compliance of the interface{bars}"
