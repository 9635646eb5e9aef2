"""The two estimates of Delta_sigma compared: over the size, box by box, and as material yields."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from fractalcontact.core.estimate import Estimate
from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import LINES, MARKERS, WIDTH, Drawing, colour_of
from fractalcontact.figures.kit.legends import heading, legends_below, mark
from fractalcontact.figures.kit.panel import rows
from fractalcontact.figures.kit.titles import headline, letter
from fractalcontact.figures.kit.words import number

TITLE = "Do A_r(s) and box counting give one Delta_sigma: their difference on synthetic surfaces"
SUBJECT = "study"
NEEDS = ("dimension_test",)
KEY = "dimension_test"
ORDER = 31

#: Ends of the axis of differences: intervals of two surfaces would go far beyond.
_DIFFERENCES = (-0.35, 0.85)


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Difference over size, boxes per node over resolution, and both where the material yields."""
    test = atlas["dimension_test/surfaces"].to_dataset()
    capped = "capped_pressure" in test.dims
    figure = Figure(figsize=(WIDTH, 3.7))
    panels = figure.subplots(1, 2 + capped)
    _draw_difference(panels[0], test, "a")
    _draw_boxes(panels[1], test, "b")
    if capped:
        _draw_capped(panels[2], test, "c")
    legends_below(figure, *_legends(test))
    headline(figure, f"means of {test.sizes['seed']} surfaces")
    return Drawing(figure, _table(test), caption(__name__, **_words(test)))


def _shown(test):
    """Indices of the loads drawn."""
    return sorted({0, test.sizes["reduced_pressure"] - 1})


def _curves(test):
    """Each dimension and load drawn: its data, style, and place beside the others."""
    for i in range(test.sizes["dimension"]):
        for n, j in enumerate(_shown(test)):
            style = {"color": colour_of(i), "ls": LINES[n % len(LINES)], "marker": MARKERS[i]}
            yield test.isel(dimension=i, reduced_pressure=j), style, n + 2 * i - 2


def _draw_difference(axes, test, which):
    """Difference of the two over the size; a line style a load, a colour a dimension."""
    size = test["size"].values
    for one, style, place in _curves(test):
        mean, low, high = Estimate.read(one, "mean_difference").ends
        beside = size * 1.03**place
        axes.plot(beside, mean, **style)
        axes.vlines(beside, low, high, color=style["color"], lw=0.5)
    axes.axhline(0, color="0.5", lw=0.8, ls=LINES[2])
    _in_doublings(axes, size)
    axes.set_ylim(*_DIFFERENCES)
    axes.set_xlabel("nodes per side (1)")
    axes.set_ylabel(r"$\Delta_\sigma$: $A_r(s)$ less box counting (1)")
    letter(axes, which, "difference, 95 % intervals")


def _in_doublings(axes, places):
    """Axis along x in powers of two, with a number at each place."""
    axes.set_xscale("log", base=2)
    axes.set_xticks(places, [f"{n:g}" for n in places])
    axes.minorticks_off()


def _draw_boxes(axes, test, which):
    """Occupied boxes of the finest domain over nodes in contact, at the largest size."""
    largest = test.isel(size=-1)
    k = test["resolution"].values
    for one, style, _ in _curves(largest):
        axes.plot(k, one["mean_boxes_per_node"], **style)
    axes.axhline(1, color="0.5", lw=0.8, ls=LINES[2])
    _in_doublings(axes, k)
    axes.set_xlabel("resolution: every $k$-th node (1)")
    axes.set_ylabel("occupied boxes of $k$ nodes\nover nodes in contact at $k$ (1)")
    letter(axes, which, "boxes per node of contact")


def _draw_capped(axes, test, which):
    """Both estimators with a hardness, up to where the whole window yields."""
    part = test["capped_pressure"].values
    for i in range(test.sizes["dimension"]):
        one = test.isel(dimension=i)
        for name, face, line in (
            ("delta_sigma_area", colour_of(i), "-"),
            ("delta_sigma_box", "white", "--"),
        ):
            style = {"color": colour_of(i), "marker": MARKERS[i], "mfc": face, "lw": 0.8}
            axes.plot(part, one[f"capped_mean_{name}"].values, ls=line, **style)
    axes.set_ylim(0.8, 2.1)
    axes.set_xlabel("load over that of full yield\n$F/(H A_0)$ (1)")
    axes.set_ylabel(r"$\Delta_\sigma$ (1)")
    letter(axes, which, rf"yielding at $H$ = {test.attrs['hardness']:g} $E^* h'_\mathrm{{rms}}$")


def _legends(test):
    dimensions = [
        mark(color=colour_of(i), marker=MARKERS[i], label=rf"$\Delta_g$ = {g:g}")
        for i, g in enumerate(test["dimension"].values)
    ]
    loads = test["reduced_pressure"].values
    of_load = r"(a), (b) $p/(E^* h'_\mathrm{rms})$"
    lines = [
        mark(color="0.3", ls=LINES[n % len(LINES)], label=f"{of_load} = {loads[j]:g}")
        for n, j in enumerate(_shown(test))
    ]
    one_law = "(a), (b) if one law governed both"
    lines.append(mark(color="0.5", lw=0.8, ls=LINES[2], label=one_law))
    if "capped_pressure" not in test.dims:
        return dimensions, lines
    faces = (("0.3", "-", "(c) by $A_r(s)$"), ("white", "--", "(c) by box counting"))
    capped = [
        mark(color="0.3", lw=0.8, marker="o", mfc=face, ls=line, label=words)
        for face, line, words in faces
    ]
    return dimensions, lines, [*capped, heading("(b), (c) no intervals drawn")]


def _table(test):
    tables = [
        rows(test, "mean_difference", "mean_difference_n", branch="elastic"),
        rows(test, "mean_boxes_per_node", branch="boxes and pre-fractals"),
    ]
    if "capped_pressure" in test.dims:
        names = [f"capped_mean_{name}" for name in ("delta_sigma_area", "delta_sigma_box")]
        counts = [f"{name}_n" for name in names]
        tables.append(rows(test, *names, *counts, branch="with hardness"))
    return pd.concat(tables, ignore_index=True)


def _words(test):
    """Range of the difference, in how many intervals zero lies, where box counting tends."""
    difference = Estimate.read(test, "mean_difference")
    known = np.isfinite(difference.low)
    yielded = np.array([])
    if "capped_pressure" in test.dims:
        last = Estimate.read(test.isel(capped_pressure=-1), "capped_mean_delta_sigma_box")
        yielded = last.value[np.isfinite(last.low)]
    return {
        "difference": difference.value[known].tolist(),
        "agree": int(test["difference_agrees"].sum()),
        "yielded": dict.fromkeys(number(end) for end in (min(yielded), max(yielded)))
        if yielded.size
        else {},
    }
