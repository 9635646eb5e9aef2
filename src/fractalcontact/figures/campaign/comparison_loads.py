"""Groups of specimens over their load: stiffness, contact, dilatancy and size effect."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from xarray import DataTree

from ...core.estimate import Estimate
from ..kit.caption import caption
from ..kit.drawing import LINES, MARKERS, WIDTH, Drawing, colour_of
from ..kit.legends import entries, heading, mark
from ..kit.panel import rows
from ..kit.points import reach
from ..kit.titles import letter
from ..kit.words import NOMINAL_PRESSURE, pressure_label
from ._groups import (
    AXES,
    MAX_NAMED,
    TITLES,
    alone,
    group_labels,
    least_and_largest,
    means_of_groups,
    settle_axis,
    specimen_labels,
    under_common_pressure,
    values_range,
)

TITLE = "Specimens and groups over the nominal pressure: stiffness, contact, dilatancy, size effect"
SUBJECT = "study"
NEEDS = ("study_comparison",)
KEY = "comparison"
ORDER = 7

#: What each specimen has under every load.
_UNDER_LOAD = tuple(AXES)[1:]
#: Specimens up to which each has its own line.
MAX_LINES = 40
#: Groups that are drawn; the others stand in the table.
MAX_GROUPS = 7
#: Letters of a line of a specimen's label in the legend.
_LETTERS = 42


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Mean of each group with its interval and the spread of its specimens."""
    comparison = atlas["study_comparison/study"].to_dataset()
    under = under_common_pressure(comparison)
    pressure = float(under["pressure"])
    figure = Figure(figsize=(WIDTH, 5.4))
    by_specimen = alone(comparison)
    panels = figure.subplots(2, 2, sharex=True)
    for axes, name, which in zip(panels.ravel(), _UNDER_LOAD, "abcd", strict=True):
        (_draw_alone if by_specimen else _draw_quantity)(axes, comparison, name)
        ends = ""
        if by_specimen and name == "stiffness":
            unit = f" MPa/mm at {pressure_label(pressure)}"
            ends = values_range(under["stiffness"].values, unit)
        letter(axes, which, f"{TITLES[name]}: {ends}" if ends else TITLES[name])
    for axes in panels[1]:
        axes.set_xlabel(f"{NOMINAL_PRESSURE} (MPa)")
    shown = [*entries(panels[0, 0]), *_marks(comparison, by_specimen=by_specimen)]
    figure.legend(handles=shown, loc="outside lower center", ncols=3)
    statistics = ("mean", "deviation", "error", "n")
    names = [f"{name}_{of}" for name in _UNDER_LOAD for of in statistics]
    words = caption(
        __name__,
        alone=by_specimen,
        pressure=pressure,
        ends=least_and_largest(under["stiffness"].values, comparison["label"].values),
        means=means_of_groups(under, "stiffness", "MPa/mm"),
        most=MAX_NAMED,
    )
    return Drawing(figure, rows(comparison, *names), words)


def _draw_alone(axes, comparison, name):
    """A line for each specimen, with its intervals."""
    axes.set_xscale("log")
    for i, label in enumerate(specimen_labels(comparison, _LETTERS)):
        one = comparison.isel(specimen=i)
        found, low, high = Estimate.read(one, name).ends
        bars = reach(found, low, high)
        # Present in every panel, so that one legend serves all.
        style = {"color": colour_of(i), "marker": MARKERS[i], "ls": LINES[i % len(LINES)]}
        pressure = one["nominal_pressure"].values
        axes.errorbar(pressure, found, bars, label=label, ms=3, lw=0.9, elinewidth=0.5, **style)
    drawn = bool(np.isfinite(comparison[name]).any())
    settle_axis(axes, name, drawn=drawn)
    _draw_no_effect(axes, name, drawn=drawn)


def _draw_no_effect(axes, name, *, drawn):
    """The line of no size effect."""
    if name == "size_exponent" and drawn:
        axes.axhline(0, color="0.4", lw=0.8, ls=(0, (1, 2)), zorder=0)


def _marks(comparison, *, by_specimen):
    """Other entries of the legend."""
    no_effect = mark(color="0.4", lw=0.8, ls=(0, (1, 2)), label="(d) no size effect: 0")
    if by_specimen:
        return [heading("bars: 95 % intervals"), no_effect]
    marks = [
        Patch(color="0.85", label="band: mean and one standard deviation"),
        heading("bars: 95 % interval of the mean"),
        no_effect,
    ]
    if comparison.sizes["specimen"] <= MAX_LINES:
        marks.append(mark(color="0.5", lw=0.4, label="thin: one specimen"))
    return marks


def _draw_quantity(axes, comparison, name):
    pressure = comparison["pressure"].values
    axes.set_xscale("log")
    if comparison.sizes["specimen"] <= MAX_LINES:
        _draw_specimens(axes, comparison, name)
    for i, label in enumerate(group_labels(comparison)[:MAX_GROUPS]):
        one, colour = comparison.isel(group_name=i), colour_of(i + 1)
        mean, deviation = one[f"{name}_mean"].values, one[f"{name}_deviation"].values
        members = one[f"{name}_n"].values
        n = int(members.max())
        # Of one specimen among several a mean would be its own line, and jump to it.
        mean = np.where(members >= min(n, 2), mean, np.nan)
        # Present in every panel, so that one legend serves all.
        words = f"mean of up to {n} specimens" if n > 1 else "one specimen"
        axes.plot(pressure, mean, "o-", color=colour, label=f"{label}: {words}")
        axes.fill_between(
            pressure, mean - deviation, mean + deviation, color=colour, alpha=0.15, lw=0
        )
        _, low, high = Estimate.read(one, f"{name}_mean").ends
        axes.errorbar(
            pressure, mean, reach(mean, low, high), fmt="none", ecolor=colour, capsize=2, lw=0.8
        )
    drawn = bool(np.isfinite(comparison[f"{name}_mean"]).any())
    settle_axis(axes, name, drawn=drawn)
    _draw_no_effect(axes, name, drawn=drawn)


def _draw_specimens(axes, comparison, name):
    groups = list(comparison["group_name"].values[:MAX_GROUPS])
    for one in comparison["specimen"].values:
        specimen = comparison.sel(specimen=one)
        if (of_group := str(specimen["group"].values)) in groups:
            colour = colour_of(groups.index(of_group) + 1)
            axes.plot(specimen["nominal_pressure"], specimen[name], color=colour, lw=0.4, alpha=0.5)
