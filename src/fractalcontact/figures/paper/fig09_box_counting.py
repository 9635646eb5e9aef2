"""Fig. 9: box counting on one contact domain."""

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from xarray import DataTree

from ...core.estimate import DIMENSION, Estimate
from ...core.ranges import within
from ...domain.box_dimension import WIDEST, is_determined, local_slopes, spans
from ...domain.count_law import LawTerms, law_count
from ...statements.findings import LOOSELY, NEARLY
from ..kit.domains import Loading
from ..kit.drawing import COLOURS, WEAK, WIDTH, Drawing, heading, headline, label_short_span, letter
from ..kit.maps import draw_domain
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

#: Grey of random nodes; lines over markers, which would hide them; markers that hide no line.
_RANDOM = "0.7"
_SEEN: dict[str, Any] = {"zorder": 4, "linewidth": 1.4}
_CROSS = {"ms": 3.5, "mew": 0.7, "alpha": 0.7}


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
    why = _width_words(counts)
    wide = why.replace("interval of Delta_sigma", ":", 1)
    handles.append(Patch(**_band(COLOURS[2]), label=f"(c) 95 % of the count law{wide}"))
    handles.append(Patch(**_band(COLOURS[0]), label="(c) 95 % of the ordinary slope"))
    narrow = {"columnspacing": 1.2, "handlelength": 1.8}
    figure.legend(handles=handles, loc="outside lower center", ncols=3, **narrow)
    headline(figure, *loading.title, f"$F$ = {force_label(loading.forces[i])}")
    caption = sentences(
        _caption(loading, i, counts),
        claim(atlas, name, "one power law", "boxes_follow_one_law", numbers=not why, why=why),
        claim(atlas, name, "fractal set", "domains_are_fractal"),
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
    to_side, slope = np.full((2, r.size), np.nan)
    start, end = spans(r)
    to_side[start] = r[end]
    _, slope[start] = local_slopes(r, n)
    return table.assign(slope_to_mm=to_side, local_slope=slope)


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
        label="random nodes: (b) 95 %, (c) mean",
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
        words = "boxes, fewest" + (", fitted" if face != "white" else ", not fitted; (c) all")
        axes.loglog(
            r[used], table["box_count"][used], "o", ms=4, mfc=face, mec=COLOURS[0], label=words
        )
    if np.isfinite(table["ordinary_count"]).any():
        weak = {} if bool(counts["ordinary_determined"]) else WEAK
        label = f"ordinary slope: {_ordinary(counts)}"
        axes.loglog(r, table["ordinary_count"], "--", color=COLOURS[0], label=label, **_SEEN | weak)
    label = "boxes, mean of origins"
    axes.loglog(r, table["mean_count"], "x", color=COLOURS[2], label=label, **_CROSS)
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
    middle = np.sqrt(table["box_side_mm"] * table["slope_to_mm"])
    axes.semilogx(middle, table["local_slope"], "o", ms=4, mfc="white", mec=COLOURS[0])
    null = table[np.isfinite(table["random_count"])]
    for column, style in (
        ("random_count", {"color": _RANDOM, "ls": "-", "lw": 2}),
        ("cut_count", {"color": COLOURS[4], "ls": "-."}),
    ):
        if np.isfinite(null[column]).all() and len(null) > 1:
            axes.plot(*local_slopes(null["box_side_mm"], null[column]), **{"lw": 1} | style)
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
    axes.set_ylim(-0.1, max(2.2, 1.1 * table["local_slope"].max()))
    axes.set(xlabel="box side $r$ (mm)", ylabel=r"local slope $-$d log $N$ / d log $r$ (1)")
    label_short_span(axes.xaxis)
    slopes = table["local_slope"].dropna()
    ends = f": {slopes.min():.1f} to {slopes.max():.1f}" if len(slopes) > 1 else ""
    letter(axes, "c", f"local slopes{ends}")


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


def _width_words(counts):
    """How wide the interval of Delta_sigma is, and beside which limit: it decides on one law."""
    low, high = (counts[f"delta_sigma_{end}"].item() for end in ("low", "high"))
    if str(counts["reason"].item()) or not np.isfinite(high - low):
        return ""
    limits = (2 * NEARLY, 2 * LOOSELY, WIDEST)
    # The widest that is exceeded decides; else the narrowest, which is kept to.
    limit = max((one for one in limits if high - low > one), default=limits[0])
    return f"interval of Delta_sigma {high - low:.2g} wide, limit {limit:g}"


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
