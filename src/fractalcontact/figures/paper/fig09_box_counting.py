"""Fig. 9: box counting on one contact domain."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from xarray import DataTree

from ...core.estimate import DIMENSION, Estimate
from ...core.subject import Subject
from ...core.text import force_label
from ...core.window import window_sides
from .. import kit
from ._local_slopes import CUT, LAW, ORDINARY, RANDOM, band_of, draw_slopes

TITLE = "Fig. 9: box counting of a contact domain"
SUBJECT = "specimen"
NEEDS = ("specimens", "contact", "closure", "domains", "statements", "ensemble")
ORDER = 140

#: Variables of the rows of (b), by the dimension of their sides.
_COUNTS = {
    "scale": ("box_side", "box_count", "box_used", "ordinary_used", "ordinary_count"),
    "mean_scale": ("mean_side", "mean_count", "law_count"),
    "null_scale": ("null_side", "null_count_random", "null_count_cut"),
    "null_mean_scale": ("null_mean_side", "null_mean_count"),
}
#: Law of the counts in words.
_LAW = (
    "Count law in (b): the area $N r^2$ of the boxes,\nless that of a node's width and outline,\n"
)
_LAW += r"grows as $r^{2-\Delta_\sigma}$"
_SEEN: dict[str, Any] = {"zorder": 4, "linewidth": 1.4}


def draw(atlas: DataTree, name: str) -> kit.Drawing:
    """A contact domain, its box counts N(r) with both laws, and local slopes."""
    subject = Subject.of(atlas, name)
    reported, counts = subject.reported, subject.state("domains")
    law = Estimate.read(counts, "delta_sigma", scale=DIMENSION)
    slope = Estimate.read(counts, "delta_sigma_ordinary", scale=DIMENSION)
    ordinary = slope.text() if bool(counts["ordinary_determined"]) else slope.undetermined()
    figure = Figure(figsize=(kit.WIDTH, 3.7))
    axes = figure.subplots(1, 3)
    domain = kit.contact_domain(subject, reported.resolution, reported.reference)
    kit.draw_domain(axes[0], domain, window_sides(subject["specimens"]))
    kit.letter(axes[0], "a", "contact, small nodes enlarged")
    b, c = kit.Panel(axes[1], "b", "box counts"), kit.Panel(axes[2], "c", "local slopes")
    _draw_counts(b, counts, rf"count law: $\Delta_\sigma$ {law.text()}", ordinary)
    draw_slopes(c, counts)
    force = {"normal_force": reported.force}
    kit.draw_band(c, subject, "local_slope", kit.COLOURS[1], "(c)", "local_slope_side", **force)
    handles = [*kit.entries(axes[1]), kit.heading(_LAW)]
    handles.append(Patch(**band_of(LAW), label="(c) 95 % of the count law"))
    handles.append(Patch(**band_of(ORDINARY), label="(c) 95 % of the ordinary slope"))
    handles += kit.entries(axes[2])
    narrow = {"columnspacing": 1.2, "handlelength": 1.8}
    figure.legend(handles=handles, loc="outside lower center", ncols=3, **narrow)
    where = kit.place(subject.direction, subject.offset)
    kit.headline(figure, subject.label, where, f"$F$ = {force_label(reported.force)}")
    text = kit.caption(
        __name__,
        reason=str(counts["reason"].item()),
        law=law,
        sides=[float(counts[f"fit_{end}"]) for end in ("min", "max")],
        one_power=kit.verdict_words(atlas, name, "domains_are_fractal", numbers=False),
        ordinary=ordinary,
        fractal=kit.claim(atlas, name, "domains_are_fractal"),
    )
    return kit.Drawing(figure, kit.table_of(b, c), text)


def _draw_counts(panel, counts, law, ordinary):
    axes = panel.axes
    for names in _COUNTS.values():
        panel.keep(counts, *names)
    random, low, high = Estimate.read(counts, "null_count_random").ends
    sides, shown = counts["null_side"].values, np.isfinite(random)
    band = {"color": RANDOM, "lw": 1.5, "label": "random nodes: 95 %", "zorder": 0}
    axes.fill_between(sides[shown], low[shown].clip(min=0.5), high[shown], **band)
    cut = counts["null_count_cut"].values
    axes.loglog(sides[shown], cut[shown], **CUT, label="bearing-area cut: highest nodes")
    r, used = counts["box_side"].values, counts["ordinary_used"].values
    for some, face, words in ((used, ORDINARY, "fitted"), (~used, "white", "not fitted")):
        style = {"ms": 4, "mfc": face, "mec": ORDINARY, "label": f"boxes, fewest, {words}"}
        axes.loglog(r[some], counts["box_count"].values[some], "o", **style)
    if np.isfinite(counts["ordinary_count"]).any():
        style = _SEEN | ({} if bool(counts["ordinary_determined"]) else kit.WEAK)
        label = f"ordinary slope: {ordinary}"
        axes.loglog(r, counts["ordinary_count"], "--", color=ORDINARY, label=label, **style)
    # Small, thin crosses hide no line.
    crosses = {"ms": 3.5, "mew": 0.7, "alpha": 0.7, "label": "boxes, mean of origins"}
    axes.loglog(counts["mean_side"], counts["mean_count"], "x", color=LAW, **crosses)
    slopes = {"fmt": "D", "ms": 4, "lw": 0.8, "label": "(c) mean of origins, 95 %"}
    axes.errorbar([], [], yerr=[], color=LAW, **slopes)
    if np.isfinite(counts["law_count"]).any():
        style = _SEEN | ({} if bool(counts["determined"]) else kit.WEAK)
        axes.loglog(counts["mean_side"], counts["law_count"], color=LAW, label=law, **style)
    axes.set_ylim(0.7, float(counts["box_count"].max()) ** 1.1 * 2)
    axes.set(xlabel="box side $r$ (mm)", ylabel="occupied boxes $N(r)$ (1)")
