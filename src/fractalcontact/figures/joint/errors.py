"""Error of each published quantity against load, split by source."""

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.subject import Subject
from ..kit.axes import force_axis, label_short_span
from ..kit.caption import caption
from ..kit.drawing import LINES, MARKERS, WIDTH, Drawing, colour_of
from ..kit.legends import entries
from ..kit.panel import rows
from ..kit.sizes import plain_decades
from ..kit.titles import headline, letter
from ..kit.words import force_label, length_unit, place
from ._error_words import QUANTITIES, SOURCES, TOTALS, caption_values, totals_words

TITLE = "Error of each quantity by source"
SUBJECT = "specimen"
NEEDS = ("error_budget", "closure")
ORDER = 225

INTERPOLATED = "numerical, interpolated between loads"
#: What is smaller is drawn here: as a fraction of the value, and where errors are in the unit of
#: the quantity as one of the largest error drawn.
LEAST = 1e-4
#: Unit of errors that are fractions.
_FRACTION = "% of the value"


def draw(atlas: DataTree, name: str) -> Drawing:
    """Errors over the load at the map offset, one panel a quantity, one line a source."""
    subject = Subject.of(atlas, name)
    here = subject.state("error_budget")
    errors = _with_totals(subject["error_budget"])
    force = force_label(float(here["normal_force"]))
    figure = Figure(figsize=(WIDTH, 6.6))
    cut = False
    *panels, legend = figure.subplots(3, 2, sharex=True).ravel()
    for axes, which, (quantity, (title, _)) in zip(
        panels, "abcde", QUANTITIES.items(), strict=True
    ):
        size = force_axis(axes.xaxis, subject.forces)
        at_maps = {"color": "0.8", "lw": 3, "zorder": 0}
        label = f"load of the totals above the panels\n(of this surface, of its kind): {force}"
        axes.axvline(float(here["normal_force"]) / size, label=label, **at_maps)
        cut |= _draw_errors(axes, errors.sel(quantity=quantity), size)
        letter(axes, which, f"{title}: {totals_words(here.sel(quantity=quantity))}")
        axes.set(xscale="log", yscale="log")
        if which in "abc":
            axes.set_xlabel("")
        else:
            axes.tick_params(labelbottom=True)
    _scale_errors([axes for axes in panels if axes.get_ylabel().endswith(f"({_FRACTION})")])
    for axes in panels:
        plain_decades(axes.yaxis)
    label_short_span(panels[0].xaxis)
    figure.align_ylabels(panels)
    _draw_legend(legend, panels, cut=cut)
    headline(figure, subject.label, place(subject.direction, subject.offset))
    return Drawing(figure, _table(errors), caption(__name__, **caption_values(here)))


def _with_totals(budget):
    """Errors by source, the totals among the sources, those without any left out."""
    errors = budget[["error", "relative_error", "unit", "absolute", "numerical_from"]]
    totals = [
        budget[[name, f"relative_{name}"]]
        .rename({name: "error", f"relative_{name}": "relative_error"})
        .expand_dims(source=[name])
        for name in TOTALS
    ]
    named = xr.concat([errors, *totals], "source", data_vars="minimal").transpose(
        "quantity", "source", "normal_force"
    )
    error = named["error"].assign_attrs(units="1")  # each quantity has its own
    return named.assign(error=error, drawn=(error > 0).any("normal_force"))


def _table(errors):
    """Errors drawn, one row a quantity, source and load."""
    table = rows(errors, "error", "unit", "relative_error", "numerical_from", "drawn")
    return table[table["drawn"]].drop(columns="drawn").reset_index(drop=True)


def _draw_errors(axes, errors, size):
    """Errors of a quantity, clipped at the bottom; True if some were clipped.

    Fractions are drawn in per cent of the value, other errors in the unit of the quantity.
    """
    values, unit, scale, largest = errors["relative_error"], _FRACTION, 0.01, 1.0
    if errors["absolute"]:
        values, unit = errors["error"], str(errors["unit"].values)
        largest = float(values.max())
        unit, scale = length_unit(largest) if unit == "mm" else (unit, 1.0)
    least = LEAST * largest / scale
    axes.set_ylabel(f"error, 95 % ({unit})")
    heights = values.where(errors["drawn"]) / scale
    force = errors["normal_force"].values / size
    between = np.char.startswith(errors["numerical_from"].values.astype(str), "interpolated")

    def line(source, words, **style):
        if source not in errors["source"]:  # twins of a scan, where it has some
            return
        height = heights.sel(source=source).values
        known = np.isfinite(height)
        if known.any():
            clipped = np.maximum(height, least)
            axes.plot(force[known], clipped[known], label=words, **style)
            if source == "numerical":
                hollow = {"ls": "none", "mfc": "white", "zorder": 3, "label": INTERPOLATED}
                shown = known & between
                axes.plot(force[shown], clipped[shown], **style | hollow)

    for i, (source, words) in enumerate(SOURCES.items()):
        in_totals = source not in ("resolution", "model", "estimator")
        style = {"color": colour_of(i + 1) if in_totals else "0.55", "ms": 3.5, "lw": 0.9}
        style |= {"marker": MARKERS[(i + 1) % len(MARKERS)]}
        style |= {"ls": LINES[i % 3] if in_totals else ":"}
        line(source, words, **style)
    for source, (words, dashes) in TOTALS.items():
        line(source, words, color="black", lw=2.2, ls=dashes, zorder=1)
    return bool((heights <= least).any())


def _scale_errors(panels):
    """One scale for all errors that are fractions: they can be compared."""
    low, high = zip(*(axes.get_ylim() for axes in panels), strict=True)
    for axes in panels:
        axes.set_ylim(min(70 * LEAST, *low), max(high))


def _draw_legend(axes, panels, *, cut):
    """Every line of any panel, in the place of a panel."""
    axes.set_axis_off()
    found = {entry.get_label(): entry for panel in panels for entry in entries(panel)}
    of_maps = [label for label in found if str(label).startswith("load of")]
    order = [*SOURCES.values(), INTERPOLATED, *(words for words, _ in TOTALS.values()), *of_maps]
    axes.legend(
        handles=[found[words] for words in order if words in found],
        loc="center",
        title="lowest points of a panel: such errors and smaller ones" if cut else None,
        title_fontsize=7,
        handlelength=3.5,
    )
