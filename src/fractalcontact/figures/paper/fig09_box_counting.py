"""Fig. 9: box counting on one contact domain."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from xarray import DataTree

from ...core.determined import is_determined
from ...core.estimate import DIMENSION, Estimate, names_of
from ...core.ranges import within
from ...domain.count_law import LawTerms, law_count
from ..kit.domains import Loading
from ..kit.drawing import COLOURS, WEAK, WIDTH, Drawing, heading, headline, label_short_span, letter
from ..kit.maps import draw_domain
from ..kit.points import reach
from ..kit.verdicts import claim, sentences
from ..kit.words import force_label, opening, short

TITLE = "Fig. 9: box counting of a contact domain"
SUBJECT = "specimen"
NEEDS = ("specimens", "contact", "domains", "scaling", "statements")
ORDER = 140

#: Columns of the null models and the variables that they hold.
NULLS = {
    "random_count": "null_count_random",
    "random_count_low": "null_count_random_low",
    "random_count_high": "null_count_random_high",
    "cut_count": "null_count_cut",
}

#: Columns of the local slopes, their variables and the ends of their intervals.
SLOPES = {
    "slope_to_mm": "local_slope_side_max",
    **{name: name for name in names_of("local_slope")},
    **dict(zip(names_of("random_slope"), names_of("local_slope_random"), strict=True)),
    "cut_slope": "local_slope_cut",
}

#: Grey of random nodes; lines over markers, which would hide them; markers that hide no line.
_RANDOM = "0.7"
_SEEN: dict[str, Any] = {"zorder": 4, "linewidth": 1.4}
_CROSS = {"ms": 3.5, "mew": 0.7, "alpha": 0.7}
_SLOPE_LABEL = "(c) mean of origins, 95 %"


def draw(atlas: DataTree, name: str) -> Drawing:
    """A contact domain, its box counts N(r) with count law and ordinary slope, local slopes."""
    loading = Loading.of(atlas, name)
    i = loading.map_load
    counts = loading.counts.isel(normal_force=i)
    table = _table(counts)
    figure = Figure(figsize=(WIDTH, 3.7))
    left, middle, right = figure.subplots(1, 3)
    larger = draw_domain(left, loading.domain(loading.finest, i), loading.sides)
    letter(left, "a", "contact domain")
    _draw_counts(middle, table, counts)
    _draw_slopes(right, table, counts)
    if larger:
        left.set_title("nodes enlarged", loc="right", fontsize=7)
    handles, _ = middle.get_legend_handles_labels()
    if np.isfinite(table["law_count"]).any():
        handles.append(heading(_law_form(counts)))
    handles.append(Patch(**_band(COLOURS[2]), label="(c) 95 % of the count law"))
    handles.append(Patch(**_band(COLOURS[0]), label="(c) 95 % of the ordinary slope"))
    narrow = {"columnspacing": 1.2, "handlelength": 1.8}
    figure.legend(handles=handles, loc="outside lower center", ncols=3, **narrow)
    headline(figure, *loading.title, f"$F$ = {force_label(loading.forces[i])}")
    caption = sentences(
        _caption(loading, i, counts),
        claim(atlas, name, "boxes_follow_one_law", numbers=False),
        claim(atlas, name, "domains_are_fractal"),
    )
    return Drawing(figure, table, caption)


def _table(counts):
    """One row a box size: minimal cover and mean counts, their fits, null models, local slope."""
    kept = np.isfinite(counts["box_side"].values) & np.isfinite(counts["box_count"].values)
    r, n = counts["box_side"].values[kept], counts["box_count"].values[kept]
    ordinary = counts["ordinary_used"].values[kept]
    table = pd.DataFrame(
        {
            "box_side_mm": r,
            "box_count": n,
            "used": counts["box_used"].values[kept],
            "ordinary_used": ordinary,
        }
    )
    table["ordinary_count"] = np.nan
    if ordinary.any():
        slope = counts["delta_sigma_ordinary"].item()
        level = np.mean(np.log(n[ordinary]) + slope * np.log(r[ordinary]))
        line = within(r, *(counts[f"ordinary_fit_{end}"].item() for end in ("min", "max")))
        table.loc[line, "ordinary_count"] = np.exp(level) * r[line] ** -slope
    table["mean_count"] = _at(r, counts["mean_side"].values, counts["mean_count"].values)
    fitted = within(r, counts["fit_min"].item(), counts["fit_max"].item())
    terms = LawTerms(*(counts[f"law_{name}"].item() for name in LawTerms._fields))
    table["law_count"] = np.nan
    table.loc[fitted, "law_count"] = law_count(r[fitted], counts["delta_sigma"].item(), terms)
    for column, name in NULLS.items():
        table[column] = _at(r, counts["null_side"].values, counts[name].values)
    table["random_mean_count"] = _at(
        r, counts["null_mean_side"].values, counts["null_mean_count"].values
    )
    sides = counts["local_slope_side_min"].values
    for column, name in SLOPES.items():
        table[column] = _at(r, sides, counts[name].values)
    return table


def _at(r, side, count):
    """Counts at the sizes r, NaN at those that have none."""
    nearest = np.abs(np.subtract.outer(r, side))
    nearest[~np.isfinite(nearest)] = np.inf
    place = nearest.argmin(axis=1)
    return np.where(nearest[np.arange(r.size), place] < 1e-6 * r, count[place], np.nan)


def _draw_counts(axes, table, counts):
    r = table["box_side_mm"]
    null = table[np.isfinite(table["random_count"])]
    axes.fill_between(
        null["box_side_mm"],
        null["random_count_low"].clip(lower=0.5),
        null["random_count_high"],
        color=_RANDOM,
        lw=1.5,
        label="random nodes: 95 %",
        zorder=0,
    )
    axes.loglog(
        null["box_side_mm"],
        null["cut_count"],
        "-.",
        color=COLOURS[4],
        label="bearing-area cut: highest nodes",
    )
    for used, face in ((table["ordinary_used"], COLOURS[0]), (~table["ordinary_used"], "white")):
        words = "boxes, fewest" + (", fitted" if face != "white" else ", not fitted")
        axes.loglog(
            r[used], table["box_count"][used], "o", ms=4, mfc=face, mec=COLOURS[0], label=words
        )
    if np.isfinite(table["ordinary_count"]).any():
        weak = {} if bool(counts["ordinary_determined"]) else WEAK
        label = f"ordinary slope: {_ordinary(counts)}"
        axes.loglog(r, table["ordinary_count"], "--", color=COLOURS[0], label=label, **_SEEN | weak)
    label = "boxes, mean of origins"
    axes.loglog(r, table["mean_count"], "x", color=COLOURS[2], label=label, **_CROSS)
    axes.errorbar([], [], yerr=[], fmt="D", ms=4, color=COLOURS[2], lw=0.8, label=_SLOPE_LABEL)
    if np.isfinite(table["law_count"]).any():
        weak = {} if _law_determined(counts) else WEAK
        label = rf"count law: $\Delta_\sigma$ {_by_law(counts)}"
        axes.loglog(r, table["law_count"], color=COLOURS[2], label=label, **_SEEN | weak)
    axes.set_ylim(0.7, table["box_count"].max() ** 1.1 * 2)
    axes.set(xlabel="box side $r$ (mm)", ylabel="occupied boxes $N(r)$ (1)")
    label_short_span(axes.xaxis)
    letter(axes, "b", "box counts")


def _law_determined(counts):
    """Whether the count law has a dimension that is narrow enough to be one."""
    return is_determined(*(counts[f"delta_sigma_{end}"].item() for end in ("low", "high")))


def _draw_slopes(axes, table, counts):
    slopes = table[np.isfinite(table["local_slope"])]
    middle = np.sqrt(slopes["box_side_mm"] * slopes["slope_to_mm"])
    random, low, high = Estimate.read(slopes, "random_slope").ends
    axes.fill_between(middle, low, high, color=_RANDOM, lw=1.5, zorder=0)
    axes.plot(middle, random, color=_RANDOM, lw=1)
    axes.plot(middle, slopes["cut_slope"], "-.", color=COLOURS[4], lw=1)
    ends = Estimate.read(slopes, "local_slope").ends
    axes.errorbar(
        middle, slopes["local_slope"], yerr=reach(*ends), fmt="D", ms=4, color=COLOURS[2], lw=0.8
    )
    axes.set_xscale("log")
    for name, fit, colour, style, sure in (
        ("delta_sigma", "fit", COLOURS[2], "-", _law_determined(counts)),
        (
            "delta_sigma_ordinary",
            "ordinary_fit",
            COLOURS[0],
            "--",
            bool(counts["ordinary_determined"]),
        ),
    ):
        ends = [counts[f"{fit}_min"].item(), counts[f"{fit}_max"].item()]
        if np.isfinite(counts[name].item()):
            weak = {} if sure else WEAK
            axes.plot(ends, [counts[name].item()] * 2, color=colour, ls=style, **weak)
            low, high = (counts[f"{name}_{end}"].item() for end in ("low", "high"))
            axes.fill_between(ends, low, high, **_band(colour))
    axes.set_ylim(-0.1, 2.3)
    axes.set(xlabel="box side $r$ (mm)", ylabel=r"local slope $-$d log $N$ / d log $r$ (1)")
    label_short_span(axes.xaxis)
    ends = dict.fromkeys(f"{slope:.2f}" for slope in slopes["local_slope"].agg(["min", "max"]))
    letter(axes, "c", f"local slopes: {' to '.join(ends)}" if len(slopes) else "no local slopes")


def _band(colour):
    """How the interval of a fit is drawn in (c): that of the black one hides nothing grey."""
    if colour == COLOURS[0]:
        return {"fc": "none", "ec": colour, "ls": ":", "lw": 0.8}
    return {"fc": to_rgba(colour, 0.15), "ec": "none"}


def _caption(loading, i, counts):
    start = f"{opening('Fig. 9')} Box counts beside null models. "
    ordinary = _ordinary(counts)
    reason = str(counts["reason"].item())
    if reason:
        return f"{start}There is no dimension: {reason}; ordinary slope {ordinary}."
    return f"{start}Delta_sigma is {loading.estimates[1].at(i)}, the ordinary slope {ordinary}."


def _law_form(counts):
    """The count law as a formula: its curve in (b), its level in (c)."""
    terms = LawTerms(*(counts[f"law_{name}"].item() for name in LawTerms._fields))
    # An index within an exponent would be too small to read in print.
    power, exponent, node = "r^{-x}", r"\Delta_\sigma", ""
    if terms.node_width:
        node = f"; node width $c$ = {short(terms.node_width)} mm"
        power, exponent = "(r-c)^x/r^2", r"2-\Delta_\sigma"
    outline = r"\,[1+\ldots]" if terms.outline or terms.outline_square else ""
    return f"(b) $N \\sim {power}{outline}$, $x = {exponent}$\n(c) level{node}"


def _by_law(counts):
    """The dimension of the count law with its interval."""
    return Estimate.read(counts, "delta_sigma", scale=DIMENSION).text()


def _ordinary(counts):
    """The ordinary dimension with its interval, or that it is undetermined."""
    slope = Estimate.read(counts, "delta_sigma_ordinary", scale=DIMENSION)
    return slope.text() if bool(counts["ordinary_determined"]) else slope.undetermined()
