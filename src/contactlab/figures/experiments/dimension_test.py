"""Both estimators of Delta_sigma on synthetic surfaces, over the load."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from fractalcontact.core.estimate import Estimate
from fractalcontact.figures.kit.axes import label_short_span
from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import COLOURS, MARKERS, WIDTH, Drawing
from fractalcontact.figures.kit.legends import heading, legends_below, mark
from fractalcontact.figures.kit.panel import rows
from fractalcontact.figures.kit.titles import headline, letter

TITLE = "Delta_sigma of synthetic surfaces over the load, by both estimators"
SUBJECT = "study"
NEEDS = ("dimension_test",)
KEY = "dimension_test"
ORDER = 30

#: How each estimator is drawn: colour, line, name.
_ESTIMATORS = {
    "delta_sigma_area": (COLOURS[1], "-", "by the areas $A_r(s)$"),
    "delta_sigma_box": (COLOURS[2], "--", "by box counting"),
    "delta_pairs": (COLOURS[3], ":", "by pairs (correlation dimension)"),
}

#: Ends of the axis, the lower one unless a mean lies below.
_LEAST = 0.6
_MOST = 2.05


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Delta_sigma against load by dimension, at the largest size.

    Its data have every size.
    """
    test = atlas["dimension_test/surfaces"].to_dataset()
    figure = Figure(figsize=(WIDTH, 3.6))
    panels = np.atleast_1d(figure.subplots(1, test.sizes["dimension"], sharey=True))
    for which, axes, dimension in zip("abcdefgh", panels, test["dimension"].values, strict=False):
        _draw_loads(axes, test.isel(size=-1), dimension, which)
    means = np.array([test[f"mean_{one}"].isel(size=-1).values for one in _ESTIMATORS])
    panels[0].set_ylim(min(_LEAST, np.nanmin(means, initial=_LEAST) - 0.1), _MOST)
    panels[0].set_ylabel(r"dimension of the contact domain $\Delta_\sigma$ (1)")
    legends_below(figure, *_legends(test))
    surfaces, size = test.sizes["seed"], test["size"].values[-1]
    headline(figure, f"means of {surfaces} surfaces of {size} nodes per side")
    names = [f"mean_{name}{of}" for name in _ESTIMATORS for of in ("", "_n")]
    table = rows(test, *names)
    return Drawing(figure, table, caption(__name__, **_words(test)))


def _draw_loads(axes, test, dimension, which):
    """Delta_sigma over the load, by estimator."""
    one = test.sel(dimension=dimension)
    load = one["reduced_pressure"].values
    for n, (name, (colour, line, _)) in enumerate(_ESTIMATORS.items()):
        mean, low, high = Estimate.read(one, f"mean_{name}").ends
        beside = load * 1.04 ** (n - 1)
        axes.plot(beside, mean, color=colour, ls=line, marker=MARKERS[n])
        axes.vlines(beside, low, high, color=colour, lw=0.8)
    axes.axhline(float(one["light_load_delta"]), color="0.3", lw=0.8, ls="-.")
    if np.isclose(dimension, test.attrs["paper_dimension"]):
        axes.axhline(test.attrs["paper_delta_sigma"], color=COLOURS[4], lw=1.2, ls="-")
    axes.set_xscale("log")
    label_short_span(axes.xaxis)
    axes.set_xlabel(r"reduced pressure $p/(E^* h'_\mathrm{rms})$ (1)")
    title = rf"$\Delta_g$ = {dimension:g}"
    if test.sizes["dimension"] > 1:
        letter(axes, which, title)
    else:
        axes.set_title(title, loc="left")


def _legends(test):
    lines = [
        mark(color=colour, ls=line, marker=MARKERS[n], label=words)
        for n, (colour, line, words) in enumerate(_ESTIMATORS.values())
    ]
    words = r"theory at light load: $1+H=4-\Delta_g$"
    theory = [
        heading("side by side; bars: 95 % intervals"),
        mark(color="0.3", lw=0.8, ls="-.", label=words),
    ]
    if np.isclose(test["dimension"].values, test.attrs["paper_dimension"]).any():
        words = f"the paper's {test.attrs['paper_delta_sigma']:g} at $\\Delta_g$ = 2.1"
        theory.append(mark(color=COLOURS[4], lw=1.2, label=words))
    return lines, theory


def _words(test):
    """The paper's value beside the results at its dimension and the largest size."""
    paper = test.attrs["paper_dimension"]
    words = {
        "surfaces": test.sizes["seed"],
        "paper_dimension": paper,
        "paper_value": test.attrs["paper_delta_sigma"],
        "means": {},
    }
    if np.isclose(test["dimension"].values, paper).any():
        one = test.sel(dimension=paper, method="nearest").isel(size=-1)
        names = zip(_ESTIMATORS, ("by A_r(s)", "by box counting", "by pairs"), strict=True)
        found = {by: one[f"mean_{name}"].values for name, by in names}
        known = {by: values[np.isfinite(values)].tolist() for by, values in found.items()}
        words["means"] = {by: values for by, values in known.items() if values}
    return words
