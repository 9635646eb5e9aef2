"""Fig. 13: what eq. 6 makes of the size of the joint, for growing load."""

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..kit.domains import Loading, disagreement, trend
from ..kit.drawing import COLOURS, MARKERS, WIDTH, Drawing, heading, headline, legends_below
from ..kit.words import force_label, interval, short
from ._size_effect import draw_axes, size_effect

#: Loads drawn.
_MOST_LOADS = 6


def draw(atlas, name):
    """Eq. 6 under several loads, by both estimators.

    Parameters
    ----------
    atlas : xr.DataTree
    name : str
        The specimen.

    Returns
    -------
    Drawing
    """
    loading = Loading.of(atlas, name)
    shown = loading.spread_loads(_MOST_LOADS)
    table = pd.concat([size_effect(loading, i) for i in shown], ignore_index=True)
    figure = Figure(figsize=(WIDTH, 4.8))
    axes = figure.subplots()
    for n, (_, rows) in enumerate(table.groupby("load_N")):
        own = rows.iloc[0]
        point = {"marker": MARKERS[n], "ms": 7, "mec": "white", "mew": 0.5, "zorder": 3}
        axes.plot(own["specimen_b_mm"], own["specimen_sigma_0_MPa"], color=COLOURS[n], **point)
    lines = [_draw_lines(axes, loading, estimate, shown, table) for estimate in loading.estimates]
    legends_below(figure, *lines)
    draw_axes(axes)
    axes.set_title("eq. 6 extrapolated to other sizes; markers: the specimen")
    headline(figure, *loading.title)
    return Drawing(figure, table, _caption(loading))


def _draw_lines(axes, loading, estimate, shown, table):
    """Lines of one estimator, a colour a load; entries of a legend."""
    line = estimate.style["linestyle"]
    handles = [heading(rf"{estimate.symbol}: slope $-(2-\Delta_\sigma)$, 95 % interval")]
    for n, i in enumerate(shown):
        force = loading.forces[i]
        rows = table[(table["load_N"] == force) & (table["estimator"] == estimate.label)]
        style = {"color": COLOURS[n], "linestyle": line}
        axes.plot(rows["b_mm"], rows["sigma_0_MPa"], **style)
        slope = "none" if estimate.reason[i] else interval(*(d[i] for d in _slope(estimate)))
        label = f"{force_label(force)}: {slope}"
        handles.append(Line2D([], [], **style, marker=MARKERS[n], label=label))
    return handles


def _slope(estimate):
    """-(2 - Delta_sigma) and its interval, each (n_load,)."""
    return estimate.value - 2, estimate.low - 2, estimate.high - 2


def _caption(loading):
    verdicts = "; ".join(
        f"by {estimate.label} "
        + trend(
            loading.forces,
            2 - estimate.value,
            2 - estimate.high,
            2 - estimate.low,
            rising=False,
        )
        for estimate in loading.estimates
    )
    return (
        f"{loading.opening('Fig. 13')} Extrapolation of eq. 6, not a measurement: nominal pressure "
        "that brings about the sigma* of each load on a joint of side b, with Delta_sigma and "
        f"sigma* from A_r(s) (solid) and from box counting (dashed), {loading.fit_ranges()}. "
        f"Markers are the pressures applied to the specimen (b = {short(loading.side)} mm), which "
        "eq. 6 meets only where H_D = b^Delta_sigma. The paper has the slope's magnitude "
        f"2 - Delta_sigma fall as F rises: {verdicts}. {disagreement(loading.scaling)}"
    )
