"""Fig. 10: real contact area against resolution, and the nominal pressure it implies for size."""

import numpy as np
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.subject import Subject
from ...core.text import force_label
from .. import kit

TITLE = "Fig. 10: real contact area over resolution, and eq. 6"
SUBJECT = "specimen"
NEEDS = ("specimens", "closure", "scaling", "statements")
ORDER = 160
SECTION = "size effect"

#: Number of loads in panel (a).
_MAX_LOADS = 5
#: Colours of the loads, which differ from those of the two estimates.
_LOAD_COLOURS = ("0.65", kit.COLOURS[4], "0.4", kit.COLOURS[3], kit.COLOURS[0])


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """A_r(s) with its power laws, and eq. 6 under the reference load."""
    subject = Subject.of(atlas, name)
    states, load = subject.states("scaling"), subject.reported.reference
    estimates = kit.estimates_of(states)
    figure = Figure(figsize=(kit.WIDTH, 3.9))
    axes = figure.subplots(1, 2)
    a = kit.Panel(axes[0], "a", r"contact area, $A_r \sim s^{2-\Delta_\sigma}$ [95 %]")
    _draw_areas(a, kit.prefractals(subject, "scaling"), estimates[0], load)
    force = subject.reported.force
    b = kit.Panel(axes[1], "b", f"eq. 6 extrapolated, $F$ = {force_label(force)}")
    _draw_pressures(b, states.isel(normal_force=load), estimates, load, np.sqrt(subject.area))
    kit.legends_below(figure, a.entries, b.entries)
    kit.headline(figure, subject.label, kit.place(subject.direction, subject.offset))
    state = states.isel(normal_force=load)
    apart = bool(state["disagree"]) if np.isfinite(state["difference_low"]) else None
    words = {one.key: one.at(load) for one in estimates}
    falls = kit.claim(atlas, name, "area_is_lacunar", numbers=False)
    text = kit.caption(__name__, force=force, falls=falls, apart=apart, **words)
    return kit.Drawing(figure, kit.table_of(a, b), text)


def _draw_areas(panel, states, by_area, reference):
    """Areas of some loads, raw and corrected, with the laws fitted; rows of every load."""
    axes, forces = panel.axes, states["normal_force"].values
    names = ("spacing", "nodes", "area", "area_corrected", "area_used", "fitted_area")
    panel.keep(states, *names)
    for n, i in enumerate(kit.spread_loads(len(forces), _MAX_LOADS, reference)):
        state = states.isel(normal_force=i)
        used = state.isel(resolution=state["area_used"].values)
        # Filled markers shrink from load to load: two low loads may touch on the same few nodes.
        style = {"color": _LOAD_COLOURS[n], "marker": kit.MARKERS[n], "linestyle": "none"}
        raw = {"mfc": "none", "mew": 0.6, "markersize": 4}
        hollow = axes.plot(state["spacing"], state["area"], **(style | raw))
        filled = axes.plot(used["spacing"], used["area_corrected"], **style, markersize=7.5 - n)
        drawn = filled if used.sizes["resolution"] else hollow
        drawn[0].set_label(f"{force_label(forces[i])}: {by_area.entry(i)}")
        weak = {} if by_area.determined[i] else kit.WEAK
        axes.plot(used["spacing"], used["fitted_area"], color=_LOAD_COLOURS[n], **weak)
    axes.set_yscale("log")
    kit.spacing_axis(axes, states["spacing"])
    axes.set_ylabel("real contact area $A_r$ (mm$^2$)")
    grey = {"color": "0.3", "marker": "o", "ms": 4}
    axes.plot([], [], **grey, label="filled: corrected for the edge, fitted")
    axes.plot([], [], **grey, mfc="none", mew=0.6, ls="none", label="hollow: raw, not fitted")
    axes.plot([], [], color="0.3", label=r"thin line: $\Delta_\sigma$ undetermined", **kit.WEAK)


def _draw_pressures(panel, state, estimates, load, side):
    """Eq. 6 by both estimates through the specimen, and the bands of their intervals."""
    axes = panel.axes
    panel.keep(state, "eq6_pressure", "eq6_sigma_star", specimen_b_mm=side)
    panel.keep(state, "delta_sigma_area", "delta_sigma_box")
    for one in estimates:
        line = state.sel(estimator=one.key)
        style = {"color": one.style["color"], "ls": one.style["linestyle"]}
        if not one.known[load]:
            style["ls"] = "none"  # nothing is drawn: no line in the legend either
        style |= {} if one.determined[load] else kit.WEAK
        label = f"{one.symbol}: {one.entry(load)}"
        axes.plot(line["eq6_side"], line["eq6_pressure"], **style, label=label)
    specimen = float(state["nominal_pressure"])
    axes.plot(side, specimen, "*k", ms=9, label=r"specimen: $\sigma_0 = F/A_0$")
    kit.size_axes(axes)
    # The bands are drawn last and do not widen the axes: some intervals span many decades.
    axes.set_ylim(axes.get_ylim())
    for one in estimates:
        band = state.sel(estimator=one.key)
        ends = [band[f"eq6_pressure_{end}"].values for end in ("low", "high")]
        if not np.isfinite(ends).any():
            continue
        colour, ls = one.style["color"], one.style["linestyle"]
        face, edge = to_rgba(colour, 0.2 if one.determined[load] else 0.1), to_rgba(colour, 0.5)
        # The edges distinguish two bands that overlap.
        axes.fill_between([], [], label=f"95 %, {one.symbol}", fc=face, ec=edge, lw=0.5, ls=ls)
        # Edges are drawn as lines, which matplotlib clips before it dashes them. The edges of
        # areas are dashed first, which never ends on one that reaches a thousand decades down.
        axes.fill_between(band["eq6_side"], *ends, fc=face, lw=0)
        for end in ends:
            axes.plot(band["eq6_side"], end, color=edge, lw=0.5, ls=ls)
