"""Fig. 12: the contact domain and its dimension as the joint closes."""

import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import Estimate
from ...core.limits import MIN_NODES
from ...core.subject import Subject
from ...core.text import force_label
from ...core.window import window_sides
from .. import kit

TITLE = "Fig. 12: contact domains and their dimension under growing load"
SUBJECT = "specimen"
NEEDS = (
    "specimens",
    "contact",
    "closure",
    "domains",
    "scaling",
    "ensemble",
    "contact_maps",
    "statements",
)
ORDER = 190

#: Number of contact domains drawn.
_MAX_MAPS = 6
_LETTERS = "abcdefg"
_ABOVE_MAPS = (
    "force $F$ and real contact area $A_r/A_0$ of each domain (contact black,\n"
    "small nodes enlarged, single ones in rings; raw: not corrected for the perimeter)"
)
#: Factors of F at which the two estimates stand, so that neither hides the other.
_APART = {"area": 1 / 1.04, "box": 1.04}
#: Names of the estimates in the stage ``ensemble``.
_OF_ENSEMBLE = {"area": "delta_sigma_area", "box": "delta_sigma"}


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Contact domains under growing load, and Delta_sigma against F by both estimators."""
    subject, series = Subject.of(atlas, name), kit.measured_series(atlas)
    counts, sides = subject.states("domains"), window_sides(subject["specimens"])
    shown = kit.spread_loads(len(subject.forces), _MAX_MAPS)
    height = kit.WIDTH / _MAX_MAPS * sides[0] / sides[1] + 0.95
    figure = Figure(figsize=(kit.WIDTH, height + 3))
    top, bottom = figure.subfigures(2, 1, height_ratios=[height, 3])  # type: ignore[misc]  # an array
    maps = top.subplots(1, len(shown), squeeze=False, sharey=True)[0]
    _draw_maps(maps, subject, shown, sides)
    top.suptitle(_ABOVE_MAPS, fontsize=8)
    words = r"dimension $\Delta_\sigma$ of the contact domain"
    panel = kit.Panel(bottom.subplots(), _LETTERS[len(shown)], words)
    _draw_nulls(panel, counts)
    _draw_dimensions(panel, subject)
    kit.draw_over_force(panel.axes, series, subject.area)
    panel.axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1), borderaxespad=0)
    kit.headline(figure, subject.label, kit.place(subject.direction, subject.offset))
    table = kit.table_of(panel)
    if series:
        of_maps = kit.table_of_maps(series).rename(columns={"load_N": "normal_force_N"})
        table = pd.concat([table, of_maps.assign(panel=panel.which)], ignore_index=True)
    text = kit.caption(
        __name__,
        rises=subject["statements"].sel(statement=[*kit.RISES.values()])["numbers"].values.tolist(),
        verdicts=kit.rise_words(atlas, name),
        least=MIN_NODES,
        members=kit.members_of(subject),
        **kit.departures(counts),
        **kit.measured_range(series),
    )
    return kit.Drawing(figure, table, text)


def _draw_maps(maps, subject, shown, sides):
    """Domains at the finest resolution."""
    states = subject.states("closure")
    for axes, which, i in zip(maps, _LETTERS, shown, strict=False):
        domain = kit.contact_domain(subject, subject.reported.resolution, i)
        kit.draw_domain(axes, domain, sides, ticks=3)
        share = kit.area_label(states.isel(normal_force=i))
        kit.letter(axes, which, f"{force_label(subject.forces[i])}\n{share}")
        axes.label_outer()


def _draw_nulls(panel, counts):
    """Delta_sigma by box counting of the null models."""
    panel.keep(counts, "delta_sigma_random", "delta_sigma_cut")
    axes, forces = panel.axes, counts["normal_force"].values
    random, low, high = Estimate.read(counts, "delta_sigma_random").ends
    axes.fill_between(forces, low, high, color="0.8", lw=0, zorder=0)
    label = "as many random nodes (95 % band)"
    axes.plot(forces, random, color="0.5", lw=1, label=label)
    cut = {"color": kit.COLOURS[4], "lw": 1, "label": "as many nodes: bearing-area cut"}
    axes.plot(forces, counts["delta_sigma_cut"], "-.", **cut)


def _draw_dimensions(panel, subject):
    """Delta_sigma by both estimators against F, faint where it is undetermined."""
    axes, forces, states = panel.axes, subject.forces, subject.states("scaling")
    estimates = kit.estimates_of(states)
    kept = [name for one in estimates for name in (one.name, f"{one.name}_reason")]
    enough = subject.states("closure")["area_corrected_resolved"]
    corrected = states["area_corrected"].where(enough)
    panel.keep(states.assign(area_corrected=corrected), "area", "area_corrected", *kept)
    for one in estimates:
        kit.draw_band(panel, subject, _OF_ENSEMBLE[one.key], one.style["color"], one.symbol)
        places, bars = forces * _APART[one.key], {"capsize": 2, "elinewidth": 0.8, "alpha": 0.35}
        axes.errorbar(places, one.value, yerr=kit.reach(*one.ends), **one.style, **bars)
        sure, style = one.determined, one.style | {"linestyle": "none"}
        label = rf"$\Delta_\sigma$ by {one.symbol}"
        axes.plot(places[sure], one.value[sure], **style, label=label)
    axes.errorbar([], [], [], ls="none", color="0.4", capsize=2, label="bars: 95 % interval")
    kit.hollow_entry(axes, "faint: undetermined", marker="s", alpha=0.35)
    if not any(one.known.any() for one in estimates):
        kit.say_empty(axes, "\n".join(kit.wrapped(one.reason[0]) for one in estimates))
    axes.set_xscale("log")
    axes.set_xlim(forces.min() / 1.5, forces.max() * 1.5)
    axes.set_ylim(-0.05, 2.05)
    axes.set_xlabel("normal force $F$ (N)")
    axes.set_ylabel(r"dimension $\Delta_\sigma$ (1)")
