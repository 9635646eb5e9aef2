"""Measures of the contact domain beside its box dimension: local slopes, lacunarity and D_q."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from xarray import DataTree

from ...core.estimate import DIMENSION, Estimate
from ..kit.drawing import (
    LINES,
    MARKERS,
    WIDTH,
    Drawing,
    colour_of,
    group,
    heading,
    headline,
    label_short_span,
    legends_below,
    letter,
    nearest_load,
    settings_of,
    spread,
)
from ..kit.words import force_label, opening, place, short

TITLE = "Is the contact domain fractal: local slopes, lacunarity, dimensions of the pressure"
SUBJECT = "specimen"
NEEDS = ("specimens", "domains", "domain_measures")
ORDER = 150

#: Loads drawn, the map load among them.
MOST_LOADS = 3

#: Dimensions of the contact domain, by what they are estimated from.
_DIMENSIONS = (("boxes", "delta_sigma"), ("pairs", "correlation_dimension"))
#: What curves are compared with, in greys that no load has.
_LINE: dict[str, Any] = {"color": "0.6", "ls": (0, (1, 1)), "lw": 1.2, "zorder": 0}
_PLANE: dict[str, Any] = {"color": "0.6", "ls": "-", "lw": 1.2, "zorder": 0}
_EVEN: dict[str, Any] = {"color": "0.6", "ls": (0, (6, 2)), "lw": 1.2, "zorder": 0}
#: Opacity of intervals.
_FAINT = 0.15


def draw(atlas: DataTree, name: str) -> Drawing:
    """Local slopes of the box counts, lacunarity and the spectrum D_q of the pressure.

    Its data are the points drawn, ``kind`` "slope", "lacunarity" or "spectrum".
    """
    settings = settings_of(atlas, name)
    measures = group(atlas, "domain_measures", name)
    forces = measures["normal_force"].values
    mapped = nearest_load(forces, settings["map_load"], group(atlas, "specimens", name))
    table = _table(measures, _shown(measures, mapped))

    figure = Figure(figsize=(WIDTH, 3.4))
    slopes, lacunarity, spectrum = figure.subplots(1, 3)
    _draw_slopes(slopes, table)
    _draw_lacunarity(lacunarity, table, forces[mapped])
    _draw_spectrum(spectrum, table, forces[mapped])
    handles, _ = lacunarity.get_legend_handles_labels()
    mapped_entries = _key(measures.isel(normal_force=mapped), table)
    legends_below(figure, handles, mapped_entries[:3], mapped_entries[3:])
    where = place(str(measures["direction"].item()), float(measures["offset"]))
    headline(figure, settings["label"], where)
    slopes = group(atlas, "domains", name).sel(normal_force=forces[mapped], method="nearest")
    caption = _caption(measures.isel(normal_force=mapped), slopes)
    return Drawing(figure, table, f"{opening('section 6')} {caption}")


def _shown(measures, mapped):
    """Indices of the loads drawn: with a domain that has a lacunarity, and the map load."""
    some = np.flatnonzero(np.isfinite(measures["lacunarity"]).any("gliding_side").values)
    chosen = some[spread(some.size, MOST_LOADS)] if some.size else some
    if mapped in some:
        chosen[np.argmin(np.abs(chosen - mapped))] = mapped
    return np.unique(chosen)


def _table(measures, shown):
    """One row a point drawn."""
    curves = {
        "slope": ("slope_side", "local_slope", False),
        "lacunarity": ("gliding_side", "lacunarity", True),
        "spectrum": ("order", "generalised_dimension", True),
    }
    x_names = {"slope": "box_side_mm", "lacunarity": "box_side_mm", "spectrum": "order_q"}
    rows = [pd.DataFrame({"kind": [], "force_N": [], "value": [], "low": [], "high": []})]
    for i in shown:
        state = measures.isel(normal_force=i)
        for kind, (axis, key, bounded) in curves.items():
            row = {
                "kind": kind,
                "force_N": float(state["normal_force"]),
                x_names[kind]: state[axis].values,
            }
            row["value"] = state[key].values
            if bounded:
                row |= {end: state[f"{key}_{end}"].values for end in ("low", "high")}
            rows.append(pd.DataFrame(row))
    table = pd.concat([row for row in rows if len(row)] or rows, ignore_index=True)
    return table[np.isfinite(table["value"])].reset_index(drop=True)


def _styles(table, kind):
    """Points of one kind under each load, with the load's style; the same in all panels."""
    for n, force in enumerate(sorted(table["force_N"].unique())):
        points = table[(table["kind"] == kind) & (table["force_N"] == force)]
        style = {"color": colour_of(n), "marker": MARKERS[n % len(MARKERS)], "ls": LINES[n % 4]}
        yield force, points, style


def _draw_slopes(axes, table):
    for _, points, style in _styles(table, "slope"):
        axes.semilogx(points["box_side_mm"], points["value"], ms=3, lw=0.8, **style)
    for slope, style in ((1, _LINE), (2, _PLANE)):
        axes.axhline(slope, **style)
    axes.set_ylim(-0.1, max(2.2, axes.get_ylim()[1]))
    axes.set(xlabel="box side $r$ (mm)", ylabel=r"local slope $-$d log $N$ / d log $r$ (1)")
    label_short_span(axes.xaxis)
    letter(axes, "a", "box counts: level if fractal")


def _draw_lacunarity(axes, table, mapped):
    for force, points, style in _styles(table, "lacunarity"):
        r = points["box_side_mm"]
        label = f"$F$ = {force_label(force)}"
        if not ((table["kind"] == "spectrum") & (table["force_N"] == force)).any():
            label += ": no $D_q$"
        axes.loglog(r, points["value"], ms=3, lw=0.8, label=label, **style)
        if force == mapped:
            low, high = points["low"].clip(lower=1), points["high"]
            axes.fill_between(r, low, high, color=style["color"], alpha=_FAINT, lw=0)
    axes.axhline(1, **_EVEN)
    most = table.loc[table["kind"] == "lacunarity", "value"].max()
    if np.isfinite(most):
        # Bands may be open upwards where one part of the window holds nearly all contact.
        axes.set_ylim(0.8, 3 * max(most, 1.5))
    axes.set(
        xlabel="side of the gliding box $r$ (mm)",
        ylabel=r"lacunarity $\langle M^2\rangle/\langle M\rangle^2$ (1)",
    )
    label_short_span(axes.xaxis)
    letter(axes, "b", "lacunarity: 1 if even")


def _draw_spectrum(axes, table, mapped):
    for force, points, style in _styles(table, "spectrum"):
        axes.plot(points["order_q"], points["value"], ms=3, lw=0.8, **style)
        if force == mapped:
            low, high = points["low"], points["high"]
            axes.fill_between(
                points["order_q"], low, high, color=style["color"], alpha=_FAINT, lw=0
            )
    axes.axhline(2, **_PLANE)
    axes.set(xlabel="order $q$ (1)", ylabel="dimension $D_q$ of the pressure (1)")
    letter(axes, "c", "pressure: level if monofractal")


def _key(state, table):
    """What is no curve of a load: grey lines, shaded intervals, and dimensions in words."""
    mapped = float(state["normal_force"])
    colours = {force: style["color"] for force, _, style in _styles(table, "lacunarity")}
    greys = ((_LINE, "(a) 1: as of a line"), (_PLANE, "(a), (c) 2: as of a filled plane"))
    entries = [Line2D([], [], label=label, **style) for style, label in greys]
    entries.append(Line2D([], [], label="(b) 1: evenly filled", **_EVEN))
    # In the colour drawn; without a domain there nothing is.
    shade = {"color": colours.get(mapped, "0.5"), "alpha": _FAINT, "lw": 0}
    entries.append(Patch(label=f"95 % interval, {force_label(mapped)} alone", **shade))
    return entries + [
        heading(rf"$\Delta_\sigma$ by {words}: {_interval(state, key)}")
        for words, key in _DIMENSIONS
        if np.isfinite(state[key])
    ]


def _caption(state, slopes):
    force = force_label(float(state["normal_force"]))
    words = (
        "Local slopes of box counts, gliding-box lacunarity and dimensions of the pressure at F = "
        f"{force}."
    )
    dimensions = [
        f"{_interval(state, key)} from {label}"
        for label, key in _DIMENSIONS
        if np.isfinite(state[key])
    ]
    if not dimensions:
        return f"{words} The domain is too small for a dimension."
    span = state["generalised_dimension"].sel(order=[0.0, 4.0]).values
    spectrum = ""
    if np.isfinite(span).all():
        low = Estimate.read(state.sel(order=0.0), "generalised_dimension").low
        high = Estimate.read(state.sel(order=4.0), "generalised_dimension").high
        apart = "separate" if high < low else "overlap"
        spectrum = f"; intervals of D_0 = {span[0]:.2f} and D_4 = {span[1]:.2f} {apart}"
    return f"{words} {_law(slopes)} Delta_sigma is {', '.join(dimensions)}{spectrum}."


def _interval(state, key):
    """A dimension with its interval."""
    return Estimate.read(state, key, scale=DIMENSION).text()


def _law(slopes):
    """Whether local slopes under the map load are those of one power law."""
    curve = slopes["local_slope"].values
    if not np.isfinite(curve).all() or curve.size < 2:
        return "Too few local slopes to test for one power law."
    first, last = (
        slopes[f"local_slope_side_{end}"].values[place] for end, place in (("min", 0), ("max", -1))
    )
    return (
        f"Slopes of one contact domain range from {curve.min():.2f} to {curve.max():.2f} for boxes "
        f"of {short(first)} to {short(last)} mm; a fractal's would all be equal."
    )
