"""Fig. 13: size effect of a joint by eq. 6, for growing load."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.subject import Subject
from ...core.text import force_label
from .. import kit

TITLE = "Fig. 13: eq. 6 extrapolated to other sizes, load by load"
SUBJECT = "specimen"
NEEDS = ("specimens", "closure", "scaling", "statements")
ORDER = 200
SECTION = "size effect"

#: Number of loads drawn.
_MAX_LOADS = 6
#: The bars of the n-th load stand beyond the ends of its line by the n-th power of this factor.
_BESIDE = 1.04


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """Eq. 6 under several loads, one panel an estimator."""
    subject = Subject.of(atlas, name)
    states = subject.states("scaling")
    shown = kit.spread_loads(states.sizes["normal_force"], _MAX_LOADS)
    figure = Figure(figsize=(kit.WIDTH, 4.6))
    axes = figure.subplots(1, 2, sharex=True, sharey=True)
    panels, columns = [], []
    for one, which, place in zip(kit.estimates_of(states), "ab", axes, strict=True):
        rise = kit.verdict_words(atlas, name, kit.RISES[one.key], numbers=False)
        words = rf"$\Delta_\sigma$ by {one.symbol}; the paper's rise with $F$:"
        panel = kit.Panel(place, which, f"{words}\n{rise}")
        columns.append(_draw_lines(panel, states, one, shown, np.sqrt(subject.area)))
        panels.append(panel)
    kit.plain_decades(axes[0].xaxis)
    axes[1].set_ylabel("")
    # These remarks hold for both panels.
    columns[0].append(kit.heading("markers: the specimen, on which eq. 6 is fixed; lines: eq. 6"))
    columns[0].append(kit.heading("bars at the ends: 95 % interval; thin, no bar: undetermined"))
    kit.legends_below(figure, *columns, columnspacing=2)
    kit.headline(figure, subject.label, kit.place(subject.direction, subject.offset))
    rises = kit.rise_words(atlas, name)
    return kit.Drawing(figure, kit.table_of(*panels), kit.caption(__name__, rises=rises))


def _draw_lines(panel, states, one, shown, side):
    """Lines of one estimator, a colour a load, and the specimen; entries of a legend."""
    axes, own = panel.axes, states.sel(estimator=one.key)
    names = ("eq6_pressure", "eq6_sigma_star", f"delta_sigma_{one.key}")
    panel.keep(own.isel(normal_force=shown), *names, specimen_b_mm=side)
    handles = [kit.heading(rf"{one.symbol}: slope $-(2-\Delta_\sigma)$ [95 % interval]")]
    for n, i in enumerate(shown):
        if not one.known[i]:
            continue
        line = own.isel(normal_force=i)
        style: dict[str, Any] = {"color": kit.COLOURS[n]}
        faint = {} if one.determined[i] else kit.WEAK
        axes.plot(line["eq6_side"], line["eq6_pressure"], **style | faint)
        if one.determined[i]:
            ends = line.isel(eq6_side=[0, -1])
            # The bars stand beside each other so that none hides another.
            b = ends["eq6_side"] * np.array([1 / _BESIDE**n, _BESIDE**n])
            axes.vlines(b, ends["eq6_pressure_low"], ends["eq6_pressure_high"], lw=1, **style)
        point = style | {"marker": kit.MARKERS[n], "ms": 6, "mec": "white", "mew": 0.5}
        axes.plot(side, float(line["nominal_pressure"]), zorder=3, **point)
        slope = one[i].mapped(lambda delta: delta - 2).text()
        label = f"$F$ = {force_label(float(line['normal_force']))}: {slope}"
        handles.append(kit.mark(marker=kit.MARKERS[n], label=label, **style | faint))
    if len(handles) == 1:
        kit.say_empty(axes, "no $\\Delta_\\sigma$ at the loads drawn", ticks=False)
        handles = []
    kit.size_axes(axes)
    return handles
