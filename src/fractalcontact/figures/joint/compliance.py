"""Correlation of the faces, and closure and compliance of the interface, against the offset."""

import textwrap

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.limits import LOOSELY, NEARLY, RESOLVED_NODES
from ...core.verdicts import UNDETERMINED
from ..kit.drawing import (
    MARKERS,
    WIDTH,
    Drawing,
    colour_of,
    dilatancy_loads,
    entries,
    finest_curves,
    group,
    heading,
    headline,
    legends_below,
    letter,
    offset_axis,
    settings_of,
)
from ..kit.empty import TOO_FULL, different_reasons, missing_lines, say_empty
from ..kit.points import draw_points, hollow_entry
from ..kit.sizes import draw_bars, plain_decades
from ..kit.verdicts import row_of, sentences, verdict_words
from ..kit.words import TOWARDS, force_label, opening, percent, place, pressure_label, short

TITLE = "Figs. 4 and 5: correlation of the faces, closure and compliance against the offset"
SUBJECT = "joint"
NEEDS = ("specimens", "joints", "closure", "statements")
ORDER = 70

#: What the paper says of the stages of sliding (:mod:`statements.judge`).
STAGES = {
    "compliance_rises_at_first": "rising as v^x",
    "curves_overlap": "the same",
    "compliance_rises_again": "rising again on average",
}

#: A bar this many times as high as its value leaves the frame.
_UNBOUNDED = 1e4
#: Letters of a line of the stages in the legend.
_LINE = 50


def draw(atlas: DataTree, name: str) -> Drawing:
    """Face correlation at every offset, closure and compliance at those whose contact was solved.

    Its data are the points of (a) ("correlation") and of (b) and (c) ("closure").
    """
    settings = settings_of(atlas, name)
    specimen = group(atlas, "specimens", name)
    joint = group(atlas, "joints", name)
    curves = finest_curves(atlas, name)
    direction = str(curves["direction"].values)
    shown = dilatancy_loads(curves["normal_force"].values, settings, specimen)
    closures = _closure_table(curves, shown)

    figure = Figure(figsize=(WIDTH, 7.3))
    correlation, closed, compliance = figure.subplots(
        3, 1, sharex=True, height_ratios=[1.1, 1, 1.2]
    )
    _draw_correlation(correlation, joint, direction)
    _draw_closures(closed, compliance, closures)
    _mark_offsets((closed, compliance), joint, direction)
    # The scale suits the offsets solved; the correlation is known at more.
    offset_axis(compliance, curves["offset"].values)
    if compliance.get_xscale() == "log":
        plain_decades(compliance.xaxis)
    for upper in (correlation, closed):
        upper.set_xlabel("")
    force = group(atlas, "statements", name).attrs["force"]
    ends = _ends_of_correlation(joint, direction)
    stages = _stages(atlas, name, ends, curves["offset"].values)
    columns = [entries(correlation), entries(compliance), *_judged(stages, force)]
    if np.isfinite(closures["interface_compliance_mm_per_MPa"]).any():
        _number_stages(compliance, stages)
        why = closures["stiffness_missing_because"]
        columns[-1] = columns[-1] + [heading(line) for line in missing_lines(why, "c")]
    legends_below(figure, *columns, columnspacing=1.5)
    headline(figure, settings["label"], place(direction))
    caption = sentences(
        _caption(direction, joint, brief=bool(stages)),
        _stage_words([text for text, *_ in stages], force),
    )
    table = pd.concat([_correlation_table(joint), closures], ignore_index=True)
    return Drawing(figure, table, caption)


def _stages(atlas, name, ends, offsets):
    """What the paper says of each stage with its verdict, the limits, and between which offsets."""
    length, uncorrelated = ends
    bounds = ((-np.inf, length), (length, uncorrelated), (uncorrelated, np.inf))
    whys = _limits(bool(((offsets > length) & (offsets < uncorrelated)).any()))
    found = []
    for (statement, words), (first, last) in zip(STAGES.items(), bounds, strict=True):
        row = row_of(atlas, "statements", name, statement)
        if row is not None:
            why = "" if str(row["verdict"].item()) == UNDETERMINED else whys.get(statement, "")
            found.append((f"{words}: {verdict_words(atlas, name, statement)}", why, first, last))
    return found


def _limits(between):
    """What decides about the later stages; whether offsets were solved in the second."""
    before = "2" if between else "end of 1"
    return {
        "curves_overlap": f"limit {percent(NEARLY)}, in part {percent(LOOSELY)}",
        "compliance_rises_again": f"mean of stage 3 over {before}, limit {percent(NEARLY, '+')}",
    }


def _judged(stages, force):
    """Column of a legend with the stages, in lines that fit; none without stages."""
    if not stages:
        return []
    words = [f"(c): the paper's stages, 1 judged at $F$ = {force_label(force)}"]
    for n, (text, why, *_) in enumerate(stages, 1):
        said = f"{n}: {text}; {why}" if why else f"{n}: {text}"
        lines = textwrap.wrap(said.replace(" %", "\u00a0%"), _LINE, subsequent_indent="    ")
        words += [line.replace("v^x", "$v^x$") for line in lines]
    return [[heading(line) for line in words]]


def _number_stages(axes, stages):
    """Numbers of the stages at the upper edge, between the offsets that bound them."""
    low, high = axes.get_ylim()
    axes.set_ylim(top=high * (high / low) ** 0.12)
    log = axes.get_xscale() != "linear"
    left, right = axes.dataLim.intervalx if log else axes.get_xlim()
    for n, (*_, first, last) in enumerate(stages, 1):
        first, last = (left if np.isneginf(first) else first), min(last, right)
        if np.isnan(last):  # it ends nowhere in the window
            last = right
        if np.isfinite(first) and 0 <= first < last:
            middle = np.sqrt(first * last) if log and first > 0 else (first + last) / 2
            axes.text(
                middle,
                0.97,
                f"{n}",
                transform=axes.get_xaxis_transform(),
                ha="center",
                va="top",
                fontweight="bold",
            )


def _closure_table(curves, shown):
    """Closure and compliance of the interface, load by load."""
    rows = [
        pd.DataFrame(
            {
                "curve": "closure",
                "direction": str(curves["direction"].values),
                "force_N": float(curves["normal_force"][j]),
                "offset_mm": curves["offset"].values,
                "nodes": curves["nodes"][:, j].values,
                "resolved": curves["resolved"][:, j].values,
                "interface_closure_mm": curves["interface_closure"][:, j].values,
                "common_seating_pressure_MPa": float(curves["common_seating_pressure"]),
                "closure_from_common_seat_mm": curves["closure_from_common_seat"][:, j].values,
                **_compliance(curves.isel(normal_force=j)),
            }
        )
        for j in shown
    ]
    return pd.concat(rows, ignore_index=True)


def _compliance(states):
    """Compliance of the interface, and how far the solver may have it off either way."""
    stiffness, error = (
        states[f"interface_stiffness{of}"].transpose("offset").values for of in ("", "_error")
    )
    name, unit = "interface_compliance", "mm_per_MPa"
    low, high = stiffness + error, stiffness - error
    return {
        "stiffness_missing_because": states["interface_stiffness_reason"].values.astype(str),
        f"{name}_{unit}": 1 / stiffness,
        f"{name}_low_{unit}": 1 / low,
        f"{name}_high_{unit}": np.divide(
            1.0, high, out=np.full(high.shape, np.inf), where=high > 0
        ),
    }


def _correlation_table(joint):
    rows = [
        pd.DataFrame(
            {
                "curve": "correlation",
                "direction": d,
                "offset_mm": joint["rigid_offset"].values,
                "face_correlation": joint["face_correlation"].sel(direction=d).values,
                "correlation_length_mm": float(joint["correlation_length"].sel(direction=d)),
                "uncorrelated_offset_mm": float(joint["uncorrelated_offset"].sel(direction=d)),
            }
        )
        for d in joint["direction"].values
    ]
    return pd.concat(rows, ignore_index=True)


def _draw_correlation(axes, joint, solved):
    """The direction solved in black, all others in grey."""
    v = joint["rigid_offset"].values
    others = [d for d in joint["direction"].values if d != solved]
    for n, direction in enumerate(others):
        words = ", ".join(TOWARDS.get(d, d) for d in others)
        rho = joint["face_correlation"].sel(direction=direction).values
        axes.plot(v, rho, color="0.7", lw=0.9, label=None if n else f"towards {words}")
    rho = joint["face_correlation"].sel(direction=solved).values
    axes.plot(v, rho, color="k", label=f"towards {TOWARDS.get(solved, solved)}, as in (b), (c)")
    limit = float(joint["correlation_limit"])
    if np.isfinite(limit):
        label = "by chance alone, 95 %"
        axes.axhspan(-limit, limit, color="0.9", zorder=0, lw=0, label=label)
    # The level and the offsets found from it are lines of one style, here and below.
    axes.axhline(np.exp(-1), color="0.4", lw=0.8, ls="--")
    length, uncorrelated = _ends_of_correlation(joint, solved)
    for at, style, label in (
        (length, "--", f"correlation 1/e: $v$ = {short(length)} mm"),
        (uncorrelated, ":", f"correlation lost: $v$ = {short(uncorrelated)} mm"),
    ):
        if np.isfinite(at):
            axes.axvline(at, color="0.4", lw=0.8, ls=style, label=label)
    if not np.isfinite(length):
        axes.plot([], [], color="0.4", lw=0.8, ls="--", label="correlation 1/e: not reached")
    axes.set_ylim(top=1.05)
    axes.set_ylabel("correlation of the faces (1)")
    letter(axes, "a", "correlation of the faces")


def _draw_closures(closed, compliance, table):
    """Closure from the common seat of all offsets, or else from first touch, and compliance."""
    pressure = table["common_seating_pressure_MPa"].iloc[0]
    seated = bool((table["closure_from_common_seat_mm"] > 0).any())
    column = "closure_from_common_seat_mm" if seated else "interface_closure_mm"
    some_few, heights, tops = False, [], []
    for n, (force, points) in enumerate(table.groupby("force_N")):
        style = {"color": colour_of(n + 1), "marker": MARKERS[n % len(MARKERS)]}
        v, resolved = points["offset_mm"], points["resolved"]
        some_few |= not resolved.all()
        compliances = points["interface_compliance_mm_per_MPa"]
        low, high = (points[f"interface_compliance_{end}_mm_per_MPa"] for end in ("low", "high"))
        tops += [*high[np.isfinite(high)]]
        # What is unbounded leaves the frame.
        high = high.clip(upper=_UNBOUNDED * compliances)
        draw_bars(compliance, v, compliances, low, high, style["color"])
        label = f"$F$ = {force_label(force)}"
        draw_points(compliance, v, compliances, resolved, ls="-", label=label, **style)
        if not seated or (points[column] > 0).any():
            draw_points(closed, v, points[column], resolved, ls="-", **style)
            heights += [*points[column].dropna()]
    if some_few:
        hollow_entry(compliance, f"hollow: fewer than {RESOLVED_NODES} nodes touch")
    if not np.isfinite(table["interface_compliance_mm_per_MPa"]).any():
        why = different_reasons(table["stiffness_missing_because"])
        say_empty(compliance, "\n".join(why) or TOO_FULL)
    if any(heights):
        closed.set_ylim(bottom=min(0, *heights))
    elif not heights:
        say_empty(closed, TOO_FULL)
    closed.set_ylabel(r"closure $w_\mathrm{int}$ (mm)")
    compliance.set_yscale("log")
    if len(tops):
        compliance.set_ylim(top=1.3 * max(tops))
    plain_decades(compliance.yaxis)
    compliance.set_ylabel(r"compliance $\mathrm{d}w_\mathrm{int}/\mathrm{d}\sigma_0$ (mm/MPa)")
    since = f"counted from {pressure_label(pressure)} on" if seated else "counted from first touch"
    letter(closed, "b", f"closure of the interface, {since}")
    high = table["interface_compliance_high_mm_per_MPa"] / table["interface_compliance_mm_per_MPa"]
    most = high.max() - 1
    bars = f" (bars: error of the solver alone, {_most_words(most)})" if most > 0.001 else ""
    letter(compliance, "c", f"compliance of the interface{bars}")


def _most_words(most):
    return f"up to {percent(most)}" if np.isfinite(most) else "unbounded where they leave the frame"


def _mark_offsets(panels, joint, direction):
    """Where the faces of the direction solved lose their correlation, as in the first panel."""
    for at, style in zip(_ends_of_correlation(joint, direction), ("--", ":"), strict=True):
        for axes in panels:
            if np.isfinite(at):
                axes.axvline(at, color="0.4", lw=0.8, ls=style)


def _ends_of_correlation(joint, direction):
    """Correlation length and uncorrelated offset, mm, towards a direction; NaN if not reached."""
    along = joint.sel(direction=direction)
    return float(along["correlation_length"]), float(along["uncorrelated_offset"])


def _caption(direction, joint, *, brief):
    """What is drawn; where the correlation falls, as the key says too, unless it is to be brief."""
    start = f"{opening('Figs. 4 and 5')} Correlation of the faces"
    if brief:
        return f"{start}, closure and compliance."
    known = np.isfinite(float(joint["correlation_limit"]))
    fall = _correlation_words(_ends_of_correlation(joint, direction), known)
    return f"{start} ({fall}), closure and compliance."


def _stage_words(stages, force):
    """What the paper says of the compliance as v grows, and the verdicts that were asked for."""
    if not stages:
        return ""
    first = f" (the first at {force_label(force)})"
    return f"The paper's compliance, by stages{first}: {'; '.join(stages)}."


def _correlation_words(ends, decidable):
    """Where the correlation of the faces has fallen to 1/e, and where it is lost."""
    length, uncorrelated = ends
    if not np.isfinite(length):
        return "nowhere down to 1/e"
    lost = (
        f"lost from {short(uncorrelated)} mm"
        if np.isfinite(uncorrelated)
        else "never lost"
        if decidable
        else "loss not seen"
    )
    return f"1/e at v = {short(length)} mm, {lost}"
