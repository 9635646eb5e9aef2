"""Fig. 13: what eq. 6 makes of the size of the joint, for growing load."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from xarray import DataTree

from ...core.estimate import DIMENSION, Estimate
from ..kit.domains import RISES, Loading, rise_words
from ..kit.drawing import (
    COLOURS,
    MARKERS,
    WEAK,
    WIDTH,
    Drawing,
    heading,
    headline,
    legends_below,
    letter,
)
from ..kit.empty import say_empty
from ..kit.sizes import plain_decades
from ..kit.verdicts import row_of, verdict_words
from ..kit.words import force_label, opening
from ._size_effect import draw_axes, size_effect

TITLE = "Fig. 13: eq. 6 extrapolated to other sizes, load by load"
SUBJECT = "specimen"
NEEDS = ("specimens", "contact", "domains", "scaling", "statements")
ORDER = 200
SECTION = "size effect"

#: Loads drawn.
_MOST_LOADS = 6
#: Bars of the n-th load stand the n-th power of this factor of b beyond the ends of its line.
_BESIDE = 1.04


def draw(atlas: DataTree, name: str) -> Drawing:
    """Eq. 6 under several loads, one panel an estimator."""
    loading = Loading.of(atlas, name)
    shown = loading.spread_loads(_MOST_LOADS)
    table = pd.concat([size_effect(loading, i) for i in shown], ignore_index=True)
    figure = Figure(figsize=(WIDTH, 4.6))
    panels = figure.subplots(1, 2, sharex=True, sharey=True)
    columns = []
    for axes, which, estimate in zip(panels, "ab", loading.estimates, strict=True):
        columns.append(_draw_lines(axes, loading, estimate, shown, table))
        draw_axes(axes)
        rises = verdict_words(atlas, name, RISES[estimate.key], numbers=False)
        words = rf"$\Delta_\sigma$ by {estimate.symbol}; the paper's rise with $F$:"
        found = "; ".join(filter(None, (rises, _numbers(atlas, name, estimate))))
        letter(axes, which, f"{words}\n{found}")
    plain_decades(panels[0].xaxis)
    panels[1].set_ylabel("")
    # Of both panels.
    columns[0].append(heading("markers: the specimen, on which eq. 6 is fixed; lines: eq. 6"))
    columns[0].append(heading("bars at the ends: 95 % interval; thin, no bar: undetermined"))
    legends_below(figure, *columns, columnspacing=2)
    headline(figure, *loading.title)
    return Drawing(figure, table, _caption(rise_words(atlas, name, loading, numbers=False)))


def _numbers(atlas, name, estimate):
    """The numbers that decide about the rise by one estimate; empty where it was not asked."""
    row = row_of(atlas, "statements", name, RISES[estimate.key])
    if row is None:
        return ""
    # As many nodes as touch: the legend of Fig. 12 has the room to say so.
    numbers = str(row["numbers"].item()).replace("as many random", "random")
    return numbers.replace(" of F", " of $F$")


def _draw_lines(axes, loading, estimate, shown, table):
    """Lines of one estimator, a colour a load, and the specimen; entries of a legend."""
    handles = [heading(rf"{estimate.symbol}: slope $-(2-\Delta_\sigma)$ [95 % interval]")]
    for n, i in enumerate(shown):
        if estimate.reason[i]:
            continue
        force = loading.forces[i]
        rows = table[(table["load_N"] == force) & (table["estimator"] == estimate.label)]
        style: dict[str, Any] = {"color": COLOURS[n]}
        faint = {} if estimate.determined[i] else WEAK
        axes.plot(rows["b_mm"], rows["sigma_0_MPa"], **style | faint)
        if estimate.determined[i]:
            ends = rows.iloc[[0, -1]]
            # Beside each other, lest one hides another.
            b = ends["b_mm"] * np.array([1 / _BESIDE**n, _BESIDE**n])
            axes.vlines(b, ends["sigma_0_low_MPa"], ends["sigma_0_high_MPa"], lw=1, **style)
        own = rows.iloc[0]
        point = style | {"marker": MARKERS[n], "ms": 6, "mec": "white", "mew": 0.5}
        axes.plot(own["specimen_b_mm"], own["specimen_sigma_0_MPa"], zorder=3, **point)
        slope = Estimate(*(d[i] for d in _slope(estimate)), scale=DIMENSION).text()
        label = f"$F$ = {force_label(force)}: {slope}"
        handles.append(Line2D([], [], marker=MARKERS[n], label=label, **style | faint))
    if len(handles) == 1:
        say_empty(axes, "no $\\Delta_\\sigma$ at the loads drawn", ticks=False)
        return []
    return handles


def _slope(estimate):
    """-(2 - Delta_sigma) and its interval, each (n_load,)."""
    return estimate.value - 2, estimate.low - 2, estimate.high - 2


def _caption(rises):
    return (
        f"{opening('Fig. 13')} Nominal pressure of joints of other sizes by eq. 6, extrapolated "
        f"from the specimen, not measured. The paper's rise of Delta_sigma: {rises}."
    )
