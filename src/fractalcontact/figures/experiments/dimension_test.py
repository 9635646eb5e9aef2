"""Both estimators of Delta_sigma on synthetic surfaces, by load and size."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from xarray import DataTree

from ..kit.drawing import (
    COLOURS,
    LINES,
    MARKERS,
    WIDTH,
    Drawing,
    colour_of,
    group,
    heading,
    label_short_span,
    legends_below,
    letter,
)
from ..kit.words import PAPER, number

TITLE = "Delta_sigma of synthetic surfaces by both estimators, over sizes and loads"
SUBJECT = "study"
NEEDS = ("dimension_test",)
KEY = "dimension_test"
ORDER = 30

#: How each estimator is drawn: colour, line, name.
_ESTIMATORS = {
    "delta_sigma_area": (COLOURS[1], "-", "$A_r(s)$"),
    "delta_sigma_box": (COLOURS[2], "--", "box counting"),
    "delta_pairs": (COLOURS[3], ":", "correlation dimension"),
}


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Delta_sigma against load by dimension and size, their difference, and the way to 2."""
    test = group(atlas, "dimension_test", "surfaces")
    capped = "capped_pressure" in test.dims
    n = test.sizes["dimension"]
    figure = Figure(figsize=(WIDTH, 6.4))
    above, below = figure.subfigures(2, 1, height_ratios=(1, 1.25))  # type: ignore[misc]  # an array
    panels = np.atleast_1d(above.subplots(1, n, sharey=True))
    for which, axes, dimension in zip("abcdefgh", panels, test["dimension"].values, strict=False):
        _draw_loads(axes, test, dimension, which)
    panels[0].set_ylabel(r"$\Delta_\sigma$ (1)")
    lower = np.atleast_1d(below.subplots(1, 2 + capped))
    letters = "abcdefghijkl"[n:]
    _draw_difference(lower[0], test, letters[0])
    _draw_boxes(lower[1], test, letters[1])
    if capped:
        _draw_capped(lower[2], test, letters[2])
    legends_below(below, *_legends(test))
    figure.suptitle("synthetic surfaces against a rigid plane, means over seeds", fontsize=9)
    return Drawing(figure, _table(test), _caption(test, letters))


def _draw_loads(axes, test, dimension, which):
    """Delta_sigma over the load, by estimator and size."""
    one = test.sel(dimension=dimension)
    load = one["reduced_pressure"].values
    for name, (colour, line, _) in _ESTIMATORS.items():
        for i in range(one.sizes["size"]):
            mean, low, high = (
                one[f"mean_{name}{end}"].isel(size=i).values for end in ("", "_low", "_high")
            )
            style = {"color": colour, "ls": line, "marker": MARKERS[i], "lw": 0.8}
            beside = load * 1.04 ** (i - (one.sizes["size"] - 1) / 2)
            axes.plot(beside, mean, **style, mfc=colour if name == "delta_sigma_area" else "white")
            axes.vlines(beside, low, high, color=colour, lw=0.6)
    axes.axhline(float(one["light_load_delta"]), color="0.3", lw=0.8, ls="-.")
    if np.isclose(dimension, test.attrs["paper_dimension"]):
        axes.axhline(test.attrs["paper_delta_sigma"], color=COLOURS[4], lw=0.8, ls="-")
    axes.set_xscale("log")
    axes.set_ylim(0.6, 2.05)
    label_short_span(axes.xaxis)
    axes.set_xlabel(r"$p/(E^* h'_\mathrm{rms})$ (1)")
    letter(axes, which, rf"$\Delta_g$ = {dimension:g}")


def _draw_difference(axes, test, which):
    """Difference of the two over the size; a line style a load, a colour a dimension."""
    size = test["size"].values
    for i in range(test.sizes["dimension"]):
        for j in range(test.sizes["reduced_pressure"]):
            one = test.isel(dimension=i, reduced_pressure=j)
            mean, low, high = (one[f"mean_difference{end}"].values for end in ("", "_low", "_high"))
            beside = size * 1.03 ** (j + 4 * i - 5)
            colour = colour_of(i)
            axes.plot(beside, mean, color=colour, ls=LINES[j % len(LINES)], marker=MARKERS[i])
            axes.vlines(beside, low, high, color=colour, lw=0.5)
    axes.axhline(0, color="0.5", lw=0.6)
    axes.set_xscale("log", base=2)
    axes.set_xticks(size, [f"{n:g}" for n in size])
    axes.minorticks_off()
    axes.set_ylim(-0.35, 0.85)
    axes.set_xlabel("nodes per side (1)")
    axes.set_ylabel(r"$\Delta_\sigma$: $A_r(s)$ less box counting (1)")
    letter(axes, which, "difference")


def _draw_boxes(axes, test, which):
    """Occupied boxes of the finest domain over nodes in contact, at the largest size."""
    largest = test.isel(size=-1)
    k = test["resolution"].values
    for i in range(test.sizes["dimension"]):
        for j in range(test.sizes["reduced_pressure"]):
            ratio = largest["boxes_per_node"].isel(dimension=i, reduced_pressure=j).mean("seed")
            style = {"color": colour_of(i), "ls": LINES[j % len(LINES)], "marker": MARKERS[i]}
            axes.plot(k, ratio, **style)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("resolution $k = s_k/s$ (1)")
    axes.set_ylabel("occupied boxes $ks$ / nodes at $k$ (1)")
    label_short_span(axes.xaxis)
    label_short_span(axes.yaxis)
    letter(axes, which, f"boxes and pre-fractals, {test['size'].values[-1]} nodes")


def _draw_capped(axes, test, which):
    """Both estimators with a hardness, up to where the whole window yields."""
    part = test["capped_pressure"].values
    for i in range(test.sizes["dimension"]):
        one = test.isel(dimension=i)
        for name, face in (("delta_sigma_area", colour_of(i)), ("delta_sigma_box", "white")):
            style = {"color": colour_of(i), "marker": MARKERS[i], "mfc": face, "lw": 0.8}
            line = _ESTIMATORS[name][1]
            axes.plot(part, one[f"capped_mean_{name}"].values, ls=line, **style)
    axes.axhline(2, color="0.5", lw=0.6)
    axes.set_ylim(0.8, 2.1)
    axes.set_xlabel("$F/(H A_0)$ (1)")
    axes.set_ylabel(r"$\Delta_\sigma$ (1)")
    letter(axes, which, rf"hardness {test.attrs['hardness']:g} $E^* h'_\mathrm{{rms}}$")
    axes.text(0.97, 0.05, "filled: $A_r(s)$\nopen: boxes", transform=axes.transAxes, ha="right")


def _legends(test):
    sizes = [heading(" ")] + [
        Line2D([], [], ls="none", marker=MARKERS[i], color="k", label=f"{n} nodes per side")
        for i, n in enumerate(test["size"].values)
    ]
    lines = [
        Line2D([], [], color=colour, ls=line, label=words)
        for colour, line, words in _ESTIMATORS.values()
    ]
    theory = Line2D([], [], color="0.3", lw=0.8, ls="-.", label=r"light load: $1+H$")
    paper = Line2D(
        [],
        [],
        color=COLOURS[4],
        lw=0.8,
        label=f"the paper's {test.attrs['paper_delta_sigma']:g}, $\\Delta_g$ = 2.1",
    )
    dimensions = [
        Line2D([], [], color=colour_of(i), marker=MARKERS[i], label=rf"$\Delta_g$ = {g:g}")
        for i, g in enumerate(test["dimension"].values)
    ]
    loads = [heading(" ")] + [
        Line2D([], [], color="k", ls=LINES[j % len(LINES)], label=rf"load {p:g}")
        for j, p in enumerate(test["reduced_pressure"].values)
    ]
    upper = [heading("upper row"), *lines, theory, paper]
    return upper, sizes, [heading("lower row"), *dimensions], loads


def _table(test):
    names = [f"mean_{name}{end}" for name in _ESTIMATORS for end in ("", "_low", "_high", "_n")]
    names += [f"mean_difference{end}" for end in ("", "_low", "_high", "_n")]
    free = test[names].to_dataframe().reset_index().assign(branch="elastic")
    free = free.rename(columns={"reduced_pressure": "p_over_E_slope"})
    tables = [free]
    ratio = test["boxes_per_node"].mean("seed").to_dataframe().reset_index()
    tables.append(
        ratio.rename(columns={"reduced_pressure": "p_over_E_slope"}).assign(
            branch="boxes and pre-fractals"
        )
    )
    if "capped_pressure" in test.dims:
        capped = test[[f"capped_{name}" for name in names]].to_dataframe().reset_index()
        capped.columns = [
            "F_over_H_A0" if column == "capped_pressure" else column.removeprefix("capped_")
            for column in capped.columns
        ]
        tables.append(capped.assign(branch="with hardness"))
    return pd.concat(tables, ignore_index=True)


# -- caption ---------------------------------------------------------------------------------------


def _caption(test, letters):
    return (
        f"After Figs. 8 and 9 of {PAPER}. Delta_sigma of {test.sizes['seed']} synthetic surfaces "
        "per case by A_r(s) and by box counting, means, 95 % intervals. "
        f"{_difference_words(test)} {_paper_words(test)}{_capped_words(test, letters)}"
    ).strip()


def _difference_words(test):
    """Whether the two estimates agree, at all sizes and loads."""
    mean = test["mean_difference"].values
    low, high = (test[f"mean_difference_{end}"].values for end in ("low", "high"))
    known = np.isfinite(low)
    if not known.any():
        return "Too few values to compare the two."
    agree = int(((low <= 0) & (high >= 0))[known].sum())
    return (
        f"Their difference is {number(mean[known].min())} to {number(mean[known].max())}; zero "
        f"lies in {agree} of {int(known.sum())} intervals, against eq. 5."
    )


def _paper_words(test):
    """The paper's Fig. 8 beside what is found at its dimension, at the largest size."""
    wanted = test.attrs["paper_dimension"]
    if not np.isclose(test["dimension"].values, wanted).any():
        return ""
    one = test.sel(dimension=wanted, method="nearest").isel(size=-1)
    ranges = []
    for name, words in (
        ("delta_sigma_area", "by A_r(s)"),
        ("delta_sigma_box", "by the count law"),
        ("delta_ordinary", "by ordinary boxes"),
    ):
        values = one[f"mean_{name}"].values
        known = values[np.isfinite(values)]
        if known.size:
            ranges.append(f"{number(known.min())} to {number(known.max())} {words}")
    return (
        f"The paper has {test.attrs['paper_delta_sigma']:g} at Delta_g = {wanted:g}, here "
        f"{', '.join(ranges)}. "
    )


def _capped_words(test, letters):
    """Where box counting tends as the material yields."""
    if "capped_pressure" not in test.dims:
        return ""
    last = test.isel(capped_pressure=-1)
    values = last["capped_mean_delta_sigma_box"].values
    known = values[np.isfinite(last["capped_mean_delta_sigma_box_low"].values)]
    if not known.size:
        return ""
    ends = " to ".join(dict.fromkeys((number(known.min()), number(known.max()))))
    return f"({letters[2]}) Where the material yields boxes reach {ends}."
