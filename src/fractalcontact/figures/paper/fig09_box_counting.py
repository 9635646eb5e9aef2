"""Fig. 9: box counting on one contact domain."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.fitting import fit_line
from ...domain.box_dimension import local_slopes, spans
from ..kit.domains import Loading
from ..kit.drawing import COLOURS, WIDTH, Drawing, headline, label_short_span, letter
from ..kit.maps import draw_domain
from ..kit.verdicts import claim, sentences
from ..kit.words import force_label, interval, short

TITLE = "Fig. 9: box counting of a contact domain"
SUBJECT = "specimen"
NEEDS = ("specimens", "contact", "domains", "scaling", "statements")
ORDER = 140


def draw(atlas: DataTree, name: str) -> Drawing:
    """A contact domain, its box counts N(r) with the line fitted, and their local slopes."""
    loading = Loading.of(atlas, name)
    i = loading.map_load
    counts = loading.counts.isel(normal_force=i)
    table = _table(counts)
    figure = Figure(figsize=(WIDTH, 3.1))
    left, middle, right = figure.subplots(1, 3)
    draw_domain(left, loading.domain(loading.finest, i), loading.sides)
    letter(left, "a", "contact domain")
    _draw_counts(middle, table, loading.estimates[1], i)
    _draw_slopes(right, table, counts)
    # The marks of the counts are those of their slopes too: one legend.
    handles, _ = middle.get_legend_handles_labels()
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles))
    headline(figure, *loading.title, f"$F$ = {force_label(loading.forces[i])}")
    caption = sentences(
        _caption(loading, i, counts, table),
        claim(atlas, name, "one power law", "boxes_follow_one_law", numbers=False),
        claim(atlas, name, "fractal set", "domains_are_fractal", numbers=False),
    )
    return Drawing(figure, table, caption)


def _table(counts):
    """One row a box size, with the fitted N(r) and the local slope over a doubling."""
    kept = np.isfinite(counts["box_side"].values) & np.isfinite(counts["box_count"].values)
    r, n = counts["box_side"].values[kept], counts["box_count"].values[kept]
    used = counts["box_used"].values[kept]
    # Delta_sigma is that of the counts averaged over all origins; its line is drawn through these.
    delta = counts["delta_sigma"].item()
    level = np.mean(np.log(n[used]) + delta * np.log(r[used])) if used.any() else np.nan
    to_side, slope = np.full((2, r.size), np.nan)
    start, end = spans(r)
    to_side[start] = r[end]
    _, slope[start] = local_slopes(r, n)
    return pd.DataFrame(
        {
            "box_side_mm": r,
            "box_count": n,
            "used": used,
            "fitted_count": np.where(used, np.exp(level - delta * np.log(r)), np.nan),
            "slope_to_mm": to_side,
            "local_slope": slope,
        }
    )


def _draw_counts(axes, table, estimate, i):
    r, n, used = (table[key] for key in ("box_side_mm", "box_count", "used"))
    axes.loglog(r[~used], n[~used], "o", mfc="white", mec=COLOURS[0], label="not used")
    axes.loglog(r[used], n[used], "o", color=COLOURS[0], label="used")
    axes.loglog(r, table["fitted_count"], color=COLOURS[2], label=estimate.entry(i), zorder=1)
    # Guides go through the point that all lines share best: the largest box, where N is smallest.
    r_last, n_last = r.iloc[-1], n.iloc[-1]
    for slope, style in ((1, ":"), (2, "-.")):
        guide = n_last * (r / r_last) ** -slope
        axes.loglog(r, guide, style, color="0.6", lw=0.8, label=f"slope $-${slope}", zorder=0)
    axes.set_ylim(0.7, n.max() ** 1.1 * 2)
    axes.set(xlabel="box side $r$ (mm)", ylabel="occupied boxes $N(r)$ (1)")
    label_short_span(axes.xaxis)
    letter(axes, "b", "box counts")


def _draw_slopes(axes, table, counts):
    middle = np.sqrt(table["box_side_mm"] * table["slope_to_mm"])
    fitted = table["used"] & table["slope_to_mm"].isin(table["box_side_mm"][table["used"]])
    for mask, face in ((fitted, COLOURS[0]), (~fitted, "white")):
        axes.semilogx(middle[mask], table["local_slope"][mask], "o", mfc=face, mec=COLOURS[0])
    if not str(counts["reason"].item()):
        ends = [counts["fit_min"].item(), counts["fit_max"].item()]
        axes.plot(ends, [counts["delta_sigma"].item()] * 2, color=COLOURS[2])
        low, high = counts["delta_sigma_low"].item(), counts["delta_sigma_high"].item()
        axes.fill_between(ends, low, high, color=COLOURS[2], alpha=0.2, lw=0)
    for slope, style in ((1, ":"), (2, "-.")):
        axes.axhline(slope, color="0.6", ls=style, lw=0.8, zorder=0)
    axes.set_ylim(-0.1, max(2.2, 1.1 * table["local_slope"].max()))
    axes.set(xlabel="box side $r$ (mm)", ylabel=r"local slope $-$d log $N$ / d log $r$ (1)")
    label_short_span(axes.xaxis)
    letter(axes, "c", "local slopes")


def _caption(loading, i, counts, table):
    start = (
        f"{loading.opening('Fig. 9')} (a) Contact domain, F = {force_label(loading.forces[i])}; "
        "(b) box counts, "
    )
    reason = str(counts["reason"].item())
    if reason:
        return f"{start}no dimension: {reason}; (c) local slopes."
    return (
        f"{start}line fitted to the filled ones; (c) local slopes. Delta_sigma = "
        f"{loading.estimates[1].text(i)} (r = {short(counts['fit_min'])}–"
        f"{short(counts['fit_max'])} mm){_halves(table)}."
    )


def _halves(table):
    """Slopes of the smaller and of the larger boxes fitted, in words."""
    used = table[table["used"]]
    half = len(used) // 2
    parts = [
        fit_line(np.log(part["box_side_mm"]), np.log(part["box_count"]))
        for part in (used[:half], used[half:])
    ]
    if not all(np.isfinite(part.slope) for part in parts):
        return ""
    fine, coarse = (interval(-p.slope, -p.slope_high, -p.slope_low) for p in parts)
    return f"; smaller boxes give {fine}, larger {coarse} (regression alone)"
