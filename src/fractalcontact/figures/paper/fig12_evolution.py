"""Fig. 12: the contact domain and its dimension as the joint closes."""

import re
import textwrap

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import Estimate
from ...core.limits import CORRECTED_NODES
from ..kit.domains import RISES, Loading, departures, rise_words
from ..kit.drawing import COLOURS, WIDTH, Drawing, entries, headline, letter
from ..kit.empty import say_empty
from ..kit.maps import ENLARGED, draw_domain, ring_entry
from ..kit.measured import draw_series, measured_series, table_of, threshold_words
from ..kit.points import reach
from ..kit.verdicts import sentences, verdict_words
from ..kit.words import force_label, opening, percent, wrapped

TITLE = "Fig. 12: contact domains and their dimension under growing load"
SUBJECT = "specimen"
NEEDS = ("specimens", "contact", "domains", "scaling", "contact_maps", "statements")
ORDER = 190

#: Contact domains drawn.
_MOST_MAPS = 6

#: Null models of box counting, in words.
NULLS = {"random": "random nodes (95 % band)", "cut": "bearing-area cut"}
#: The same in the legend: as many nodes as touch.
NULL_LABELS = {
    "random": "as many random nodes (95 % band)",
    "cut": "as many nodes: bearing-area cut",
}

#: Letters of a line of the legend.
_LEGEND = 34

#: Points of the letters above the maps.
_ABOVE_MAPS = 8
#: Points between the panel's title and its upper edge, where an axis stands.
_ABOVE = 30
#: The two estimates stand this factor of F apart, so that neither hides the other.
_APART = {"area": 1 / 1.04, "box": 1.04}


def draw(atlas: DataTree, name: str) -> Drawing:
    """Contact domains under growing load, and Delta_sigma against F by both estimators."""
    loading = Loading.of(atlas, name)
    shown = loading.spread_loads(_MOST_MAPS)
    aspect = loading.sides[0] / loading.sides[1]
    map_height = WIDTH / _MOST_MAPS * aspect + 0.95
    figure = Figure(figsize=(WIDTH, map_height + 3))
    top, bottom = figure.subfigures(2, 1, height_ratios=[map_height, 3])  # type: ignore[misc]  # an array
    maps = top.subplots(1, len(shown), squeeze=False, sharey=True)[0]
    nominal = np.prod(loading.sides)
    states = loading.scaling.sel(resolution=loading.finest)
    finest = states["area"].values
    corrected = np.where(states["nodes"] >= CORRECTED_NODES, states["area_corrected"], np.nan)
    larger, some_raw = False, False
    for axes, which, i in zip(maps, "abcdef", shown, strict=False):
        larger |= draw_domain(axes, loading.domain(loading.finest, i), loading.sides, ticks=3)
        known = np.isfinite(corrected[i])
        share = percent((corrected if known else finest)[i] / nominal) + ("" if known else " raw")
        some_raw |= not known
        letter(axes, which, f"{force_label(loading.forces[i])}\n{share}")
        axes.label_outer()
    raw = "; raw: not corrected for the perimeter" if some_raw else ""
    above = f"force $F$ and real contact area $A_r/A_0$ of each domain (contact black{raw})"
    top.suptitle(above, fontsize=_ABOVE_MAPS)
    axes = bottom.subplots()
    measured = measured_series(atlas)
    _draw_nulls(axes, loading)
    _draw_dimensions(axes, loading, _rises(atlas, name))
    _draw_measured(axes, measured, nominal)
    handles = entries(axes)
    ringed = [ring_entry(f"ring: one node ({which})") for which in [_ringed(maps)] if which]
    axes.legend(
        handles=[*handles, *ringed], loc="upper left", bbox_to_anchor=(1.01, 1), borderaxespad=0
    )
    letter(axes, "abcdefg"[len(shown)], r"dimension $\Delta_\sigma$ of the contact domain")
    _pressure_axis(axes, nominal)
    headline(figure, *loading.title)
    table = pd.concat([_table(loading, finest, corrected, nominal), *_measured_rows(measured)])
    rises = rise_words(atlas, name, loading)
    caption = f"{_caption(loading, rises)}{_measured_words(measured)}"
    caption = sentences(caption, ENLARGED if larger else "")
    return Drawing(figure, table.reset_index(drop=True), caption)


def _rises(atlas, name):
    """Verdict on the rise of Delta_sigma with the load, by estimator, in lines of a legend."""
    found = {}
    for key, statement in RISES.items():
        words = verdict_words(atlas, name, statement).replace(" a decade of F", " a decade")
        # An interval stays in one line.
        words = re.sub(r"(\[\S+) ", "\\1\N{NO-BREAK SPACE}", words)
        found[key] = textwrap.fill(f"rise with $F$: {words}", _LEGEND)
    return found


def _ringed(maps):
    """Letters of the maps whose nodes have rings, "a to d"; empty where none has."""
    letters = [which for axes, which in zip(maps, "abcdef", strict=False) if axes.lines]
    return " to ".join(dict.fromkeys((letters[0], letters[-1]))) if letters else ""


def _measured_rows(series):
    """Rows of the table for the maps: their own load and area, not those of the window."""
    if not series:
        return []
    table = table_of(series)
    table["estimator"] = "box counting, measured: " + table.pop("label").astype(str)
    return [table[[name for name in table if not name.startswith(("random", "verdict"))]]]


def _draw_measured(axes, series, nominal):
    """Measured domains at their nominal pressure: F is of this window, their area is another."""
    for each in series:
        pressure = each.pressure
        without = np.flatnonzero(~np.isfinite(pressure))
        label = f"measured: {each.legend}"
        if len(without) < len(pressure):
            draw_series(axes, each, pressure * nominal, label)
        for one in without:  # without a load it has no place along F
            value = float(each.maps[one]["delta_sigma"])
            name = f"{label}, no load" if one == without[0] else None
            axes.axhline(value, color=each.style["color"], ls="-.", lw=0.9, label=name)
    if series:
        axes.autoscale(axis="x")


def _pressure_axis(axes, nominal):
    """The nominal pressure above the force: where measured maps, whose area is another, stand."""
    above = axes.secondary_xaxis(
        "top", functions=(lambda force: force / nominal, lambda pressure: pressure * nominal)
    )
    above.set_xlabel(r"nominal pressure $\sigma_0 = F/A_0$ (MPa)")
    axes.set_title(axes.get_title(loc="left"), loc="left", pad=_ABOVE)


def _measured_words(series):
    """Range of Delta_sigma by box counting of the measured domains."""
    values = np.concatenate([each.values("delta_sigma") for each in series] or [[]]).astype(float)
    known = values[np.isfinite(values)]
    if not known.size:
        return f" Measured maps: {len(values)}, without a dimension." if len(values) else ""
    ends = dict.fromkeys(f"{end:.2f}" for end in (known.min(), known.max()))
    return f" Measured ({threshold_words(series)}): {' to '.join(ends)}."


def _table(loading, area, corrected, nominal):
    """One row a load and estimator."""
    return pd.concat(
        [
            pd.DataFrame(
                {
                    "load_N": loading.forces,
                    "nominal_pressure_MPa": loading.forces / nominal,
                    "offset_mm": loading.offset,
                    "area_mm2": area,
                    "corrected_area_mm2": corrected,
                    "estimator": estimate.label,
                    **estimate.columns("delta_sigma"),
                    "reason": estimate.reason,
                }
            )
            for estimate in loading.estimates
        ]
        + [_null_table(loading, area, nominal, null) for null in NULLS],
        ignore_index=True,
    )


def _null_table(loading, area, nominal, null):
    """One row a load of a null model of box counting."""
    name = f"delta_sigma_{null}"
    columns = (
        Estimate.read(loading.counts, name).columns("delta_sigma")
        if null == "random"
        else {"delta_sigma": loading.counts[name].values}
    )
    return pd.DataFrame(
        {
            "load_N": loading.forces,
            "nominal_pressure_MPa": loading.forces / nominal,
            "offset_mm": loading.offset,
            "area_mm2": area,
            "estimator": f"box counting, {NULLS[null]}",
            **columns,
            "reason": "",
        }
    )


def _draw_nulls(axes, loading):
    """Delta_sigma by box counting of the null models."""
    counts, forces = loading.counts, loading.forces
    low, high = (counts[f"delta_sigma_random_{end}"].values for end in ("low", "high"))
    axes.fill_between(forces, low, high, color="0.8", lw=0, zorder=0)
    axes.plot(forces, counts["delta_sigma_random"], color="0.5", lw=1, label=NULL_LABELS["random"])
    axes.plot(
        forces, counts["delta_sigma_cut"], "-.", color=COLOURS[4], lw=1, label=NULL_LABELS["cut"]
    )


def _draw_dimensions(axes, loading, rises):
    for estimate in loading.estimates:
        axes.errorbar(
            loading.forces * _APART[estimate.key],
            estimate.value,
            yerr=reach(estimate.value, estimate.low, estimate.high),
            **estimate.style,
            capsize=2,
            elinewidth=0.8,
            alpha=0.35,
        )
        sure = estimate.determined
        axes.plot(
            loading.forces[sure] * _APART[estimate.key],
            estimate.value[sure],
            **estimate.style | {"linestyle": "none"},
            label=f"$\\Delta_\\sigma$ by {estimate.symbol}\n{rises[estimate.key]}",
        )
    axes.errorbar([], [], [], ls="none", color="0.4", capsize=2, label="bars: 95 % interval")
    faint = "faint: undetermined, not in the rise"
    axes.plot([], [], "s", color="0.4", mfc="white", alpha=0.35, label=faint)
    if not any(np.isfinite(estimate.value).any() for estimate in loading.estimates):
        first = "\n".join(wrapped(estimate.reason[0]) for estimate in loading.estimates)
        say_empty(axes, first)
    axes.set_xscale("log")
    axes.set_xlim(loading.forces.min() / 1.5, loading.forces.max() * 1.5)
    axes.set_ylim(-0.05, 2.05)
    axes.set_xlabel("normal force $F$ (N)")
    axes.set_ylabel(r"dimension $\Delta_\sigma$ (1)")


def _caption(loading, rises):
    departing = departures(loading.counts)
    return (
        f"{opening('Fig. 12')} Contact domains with A_r/A_0, and Delta_sigma over load. The "
        f"paper's rise with F: {rises}. {departing}"
    )
