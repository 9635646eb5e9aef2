"""Correlation of the faces, and closure and compliance of the interface, against the offset."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ..kit.drawing import (
    LINES,
    MARKERS,
    WIDTH,
    Drawing,
    colour_of,
    dilatancy_loads,
    entries,
    finest_curves,
    group,
    headline,
    legends_below,
    letter,
    offset_axis,
    settings_of,
)
from ..kit.empty import TOO_FULL, say_empty
from ..kit.sizes import draw_bars
from ..kit.verdicts import sentences, verdict_words
from ..kit.words import TOWARDS, force_label, opening, percent, place, pressure_label, short

TITLE = "Figs. 4 and 5: correlation of the faces, closure and compliance against the offset"
SUBJECT = "joint"
NEEDS = ("specimens", "joints", "closure", "statements")
ORDER = 70

#: What the paper says of the stages of sliding (:mod:`statements.judge`).
STAGES = {
    "compliance_rises_at_first": "rising at first",
    "curves_overlap": "then the same",
    "compliance_rises_again": "then rising again",
}


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

    figure = Figure(figsize=(WIDTH, 7.4))
    correlation, closed, compliance = figure.subplots(
        3, 1, sharex=True, height_ratios=[1.2, 1, 1.1]
    )
    _draw_correlation(correlation, joint)
    _draw_closures(closed, compliance, closures)
    _mark_offsets((closed, compliance), joint, direction)
    # The scale suits the offsets solved; the correlation is known at more.
    offset_axis(compliance, curves["offset"].values)
    for upper in (correlation, closed):
        upper.set_xlabel("")
    legends_below(figure, entries(correlation), entries(compliance))
    headline(figure, settings["label"])
    verdicts = {
        words: verdict_words(atlas, name, said, numbers=False) for said, words in STAGES.items()
    }
    force = group(atlas, "statements", name).attrs["force"]
    caption = sentences(
        _caption(direction, joint), _stage_words(verdicts, force), _last_words(closures, force)
    )
    table = pd.concat([_correlation_table(joint), closures], ignore_index=True)
    return Drawing(figure, table, caption)


def _common_seat(curves):
    """Place among the loads of the pressure from which closure is seated at every offset, or None.

    Closures are comparable from one pressure on: that at which enough nodes touch at all offsets.
    """
    seats = curves["seating_pressure"].values
    if not np.isfinite(seats).any():
        return None
    return int(np.argmin(abs(curves["nominal_pressure"].values - np.nanmax(seats))))


def _closure_table(curves, shown):
    """Closure and compliance of the interface, load by load."""
    seat = _common_seat(curves)
    at_seat = np.nan if seat is None else curves["interface_closure"].isel(normal_force=seat)
    pressure = np.nan if seat is None else float(curves["nominal_pressure"][seat])
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
                "seating_pressure_MPa": pressure,
                "seated_closure_mm": (curves["interface_closure"][:, j] - at_seat).values,
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


def _draw_correlation(axes, joint):
    for n, direction in enumerate(joint["direction"].values):
        points = joint.sel(direction=direction)
        uncorrelated = float(points["uncorrelated_offset"])
        reached = (
            f"uncorrelated from $v$ = {short(uncorrelated)} mm"
            if np.isfinite(uncorrelated)
            else "always correlated"
            if np.isfinite(joint["correlation_limit"])
            else "window too small to see it lost"
        )
        v, rho = joint["rigid_offset"].values, points["face_correlation"].values
        # The marks are for prints in grey; at every offset they would hide the line.
        every = np.unique(np.geomspace(1, max(len(v) - 1, 1), 8).astype(int) % len(v)).tolist()
        axes.plot(
            v,
            rho,
            color=colour_of(n),
            ls=LINES[n % 4],
            marker=MARKERS[n % len(MARKERS)],
            markevery=every,
            label=f"{TOWARDS.get(direction, direction)}: {reached}",
        )
        if np.isfinite(uncorrelated):
            axes.axvline(uncorrelated, color=colour_of(n), lw=0.8, ls=":")
    axes.axhline(np.exp(-1), color="0.4", lw=0.8, ls="--", label="1/e")
    limit = float(joint["correlation_limit"])
    if np.isfinite(limit):
        axes.axhspan(
            -limit, limit, color="0.88", zorder=0, lw=0, label="what chance alone explains, 95 %"
        )
    axes.set_ylim(top=1.05)
    axes.set_ylabel("correlation of the faces (1)")
    letter(axes, "a", "correlation of the faces (dotted: uncorrelated offset)")


def _draw_closures(closed, compliance, table):
    """Closure from the seating pressure and from first touch, and compliance, load by load."""
    pressure = table["seating_pressure_MPa"].iloc[0]
    for n, (force, points) in enumerate(table.groupby("force_N")):
        style = {"color": colour_of(n + 1), "marker": MARKERS[n % len(MARKERS)]}
        line = {"ls": LINES[n % 4], "label": f"$F$ = {force_label(force)}"}
        v, few = points["offset_mm"], ~points["resolved"]
        if (points["seated_closure_mm"] > 0).any():
            closed.plot(v, points["seated_closure_mm"], **style, ls=LINES[n % 4])
        closed.plot(v, points["interface_closure_mm"], **style, mfc="none", ms=3, lw=0.5)
        compliances = points["interface_compliance_mm_per_MPa"]
        compliance.plot(v, compliances, **style, **line)
        ends = (points[f"interface_compliance_{end}_mm_per_MPa"] for end in ("low", "high"))
        draw_bars(compliance, v, compliances, *ends, style["color"])
        hollow = points[few]
        compliance.plot(
            hollow["offset_mm"],
            hollow["interface_compliance_mm_per_MPa"],
            **style,
            mfc="white",
            ls="none",
        )
    if not np.isfinite(table["interface_compliance_mm_per_MPa"]).any():
        say_empty(compliance, TOO_FULL)
    closures = table["interface_closure_mm"].dropna()
    if (closures != 0).any():
        closed.set_ylim(bottom=min(0, closures.min()))
    elif closures.empty:
        say_empty(closed, TOO_FULL)
    closed.set_ylabel(r"closure $w_\mathrm{int}$ (mm)")
    compliance.set_yscale("log")
    compliance.set_ylabel(r"compliance $\mathrm{d}w_\mathrm{int}/\mathrm{d}\sigma_0$ (mm/MPa)")
    direction = place(table["direction"].iloc[0])
    seated = f"from {pressure_label(pressure)} on (hollow: from first touch)"
    if not np.isfinite(pressure):
        seated = "from first touch"
    letter(closed, "b", f"closure {seated}, {direction}")
    high = table["interface_compliance_high_mm_per_MPa"] / table["interface_compliance_mm_per_MPa"]
    most = high.max() - 1
    bars = f" (bars: the solver alone, up to {percent(most)})" if np.isfinite(most) else ""
    letter(compliance, "c", f"compliance of the interface, {direction}{bars}")


def _mark_offsets(panels, joint, direction):
    """Where the faces of the direction solved lose their correlation."""
    marks = _ends_of_correlation(joint, direction)
    for axes in panels:
        for at, style, label in zip(
            marks,
            ("--", ":"),
            ("correlation length (1/e)", "uncorrelated offset"),
            strict=True,
        ):
            if np.isfinite(at):
                axes.axvline(at, color="0.4", lw=0.8, ls=style, label=label)


def _ends_of_correlation(joint, direction):
    """Correlation length and uncorrelated offset, mm, towards a direction; NaN if not reached."""
    along = joint.sel(direction=direction)
    return float(along["correlation_length"]), float(along["uncorrelated_offset"])


def _caption(direction, joint):
    ends = _ends_of_correlation(joint, direction)
    return (
        f"{opening('Figs. 4 and 5')} Correlation of the faces, closure and compliance against v. "
        f"The correlation is "
        f"{_correlation_words(ends, np.isfinite(float(joint['correlation_limit'])))}."
    )


def _stage_words(verdicts, force):
    """What the paper says of the compliance as v grows, and the verdicts that were asked for."""
    said = ", ".join(f"{words} ({verdict})" for words, verdict in verdicts.items() if verdict)
    return f"The paper's compliance at {force_label(force)}: {said}." if said else ""


def _last_words(table, force):
    """Where the compliance is largest, and what the last offset has of that."""
    points = table[table["force_N"] == force].dropna(subset="interface_compliance_mm_per_MPa")
    if len(points) < 2:
        return ""
    v, values = (points[key].values for key in ("offset_mm", "interface_compliance_mm_per_MPa"))
    most = int(np.argmax(values))
    words = f"Compliance at {force_label(force)} is largest at v = {short(v[most])} mm"
    if most == len(v) - 1:
        return f"{words}, the last."
    return f"{words}, {percent(1 - values[-1] / values[most])} less at {short(v[-1])} mm."


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
        else "the window too small to see it lost"
    )
    return f"1/e at v = {short(length)} mm, {lost}"
