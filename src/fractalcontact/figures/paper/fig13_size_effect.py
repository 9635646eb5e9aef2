"""Fig. 13: what eq. 6 makes of the size of the joint, for growing load."""

from typing import Any

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from xarray import DataTree

from ..kit.domains import Loading, rise_words
from ..kit.drawing import COLOURS, MARKERS, WEAK, WIDTH, Drawing, heading, headline, legends_below
from ..kit.words import force_label, interval, opening
from ._size_effect import draw_axes, size_effect

TITLE = "Fig. 13: eq. 6 extrapolated to other sizes, load by load"
SUBJECT = "specimen"
NEEDS = ("specimens", "contact", "domains", "scaling", "statements")
ORDER = 200
SECTION = "size effect"

#: Loads drawn.
_MOST_LOADS = 6


def draw(atlas: DataTree, name: str) -> Drawing:
    """Eq. 6 under several loads, by both estimators."""
    loading = Loading.of(atlas, name)
    shown = loading.spread_loads(_MOST_LOADS)
    table = pd.concat([size_effect(loading, i) for i in shown], ignore_index=True)
    figure = Figure(figsize=(WIDTH, 4.8))
    axes = figure.subplots()
    for n, (_, rows) in enumerate(table.groupby("load_N")):
        if rows["sigma_0_MPa"].isna().all():
            continue
        own = rows.iloc[0]
        point: dict[str, Any] = {
            "marker": MARKERS[n],
            "ms": 7,
            "mec": "white",
            "mew": 0.5,
            "zorder": 3,
        }
        axes.plot(own["specimen_b_mm"], own["specimen_sigma_0_MPa"], color=COLOURS[n], **point)
    lines = [_draw_lines(axes, loading, estimate, shown, table) for estimate in loading.estimates]
    legends_below(figure, *lines)
    draw_axes(axes)
    axes.set_title("lines: eq. 6 (thin: undetermined); markers: the specimen")
    headline(figure, *loading.title)
    return Drawing(figure, table, _caption(rise_words(atlas, name, loading, numbers=False)))


def _draw_lines(axes, loading, estimate, shown, table):
    """Lines of one estimator, a colour a load; entries of a legend."""
    line = estimate.style["linestyle"]
    handles = [heading(rf"{estimate.symbol}: slope $-(2-\Delta_\sigma)$, 95 % interval")]
    for n, i in enumerate(shown):
        if estimate.reason[i]:
            continue
        force = loading.forces[i]
        rows = table[(table["load_N"] == force) & (table["estimator"] == estimate.label)]
        style = {"color": COLOURS[n], "linestyle": line}
        style |= {} if estimate.determined[i] else WEAK
        axes.plot(rows["b_mm"], rows["sigma_0_MPa"], **style)
        slope = interval(*(d[i] for d in _slope(estimate)))
        label = f"{force_label(force)}: {slope}"
        handles.append(Line2D([], [], **style, marker=MARKERS[n], label=label))
    return handles


def _slope(estimate):
    """-(2 - Delta_sigma) and its interval, each (n_load,)."""
    return estimate.value - 2, estimate.low - 2, estimate.high - 2


def _caption(rises):
    return (
        f"{opening('Fig. 13')} Eq. 6 extrapolated from the specimen (solid by A_r(s), dashed by "
        f"box counting), not measured. The paper's rise of Delta_sigma: {rises}."
    )
