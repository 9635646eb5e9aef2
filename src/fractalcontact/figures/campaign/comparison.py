"""Specimens and groups of them compared under one nominal pressure, each with its errors."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import Estimate
from ..kit.caption import caption
from ..kit.drawing import WIDTH, Drawing, colour_of
from ..kit.panel import rows
from ..kit.points import reach
from ..kit.titles import TITLE_SIZE, letter
from ..kit.words import pressure_label
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

TITLE = "Specimens and groups compared: surface, stiffness, contact, dilatancy and size effect"
SUBJECT = "study"
NEEDS = ("study_comparison",)
KEY = "comparison"
ORDER = 6

#: Specimens of a group up to which each has its own error bar.
MAX_BARS = 40
#: Half the width that the specimens of a group take, of the distance between groups; where the
#: mean stands.
HALF_WIDTH, MEAN_AT = 0.25, 0.38
#: Quantities whose ends the caption quotes.
_QUOTED = ("delta_g", "stiffness")
#: Letters of a line of a specimen's label along an axis.
_LETTERS = 24


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """A strip of specimens for each group, and the mean of the group with its interval."""
    comparison = atlas["study_comparison/study"].to_dataset()
    under = under_common_pressure(comparison)
    by_specimen = alone(comparison)
    figure = Figure(figsize=(WIDTH, 6.4 if by_specimen else 5.2))
    panels = figure.subplots(2, 3).ravel()
    for axes, name, which in zip(panels, AXES, "abcde", strict=False):
        if by_specimen:
            _draw_specimens(axes, name, under, specimen_labels(comparison, _LETTERS))
        else:
            _draw_strip(axes, name, under)
        quoted = by_specimen and name in _QUOTED
        ends = values_range(under[name].values) if quoted else ""
        letter(axes, which, "\n".join(filter(None, (TITLES[name], ends))))
    _draw_key(panels[-1], under, by_specimen=by_specimen)
    pressure = float(under["pressure"])
    figure.suptitle(rf"under $\sigma_0$ = {pressure_label(pressure)}", fontsize=TITLE_SIZE)
    table = rows(under, "group", *AXES)
    labels = comparison["label"].values
    words = caption(
        __name__,
        specimens=comparison.sizes["specimen"],
        groups=comparison.sizes["group_name"],
        alone=by_specimen,
        pressure=pressure,
        ends={name: least_and_largest(under[name].values, labels) for name in _QUOTED},
        means=means_of_groups(under, "delta_g"),
        most=MAX_NAMED,
    )
    return Drawing(figure, table, words)


def _draw_specimens(axes, name, under, labels):
    """A bar for each specimen, at its label."""
    found, low, high = Estimate.read(under, name).ends
    axes.errorbar(
        range(len(labels)), found, reach(found, low, high), fmt="o", lw=1, color=colour_of(1)
    )
    axes.set_xticks(range(len(labels)), labels, rotation=90, fontsize=6.5, linespacing=1)
    axes.set_xlim(-0.6, len(labels) - 0.4)
    axes.grid(axis="x", color="0.9", lw=0.6)
    settle_axis(axes, name, drawn=bool(np.isfinite(found).any()))


def _draw_strip(axes, name, under):
    labels = group_labels(under)
    for i, of_group in enumerate(under["group_name"].values):
        members = ((under["group"] == of_group) & under[name].notnull()).values
        found, low, high = Estimate.read(under, name)[members].ends
        place = i + HALF_WIDTH * _spread(members.sum())
        colour = colour_of(i + 1)
        if members.sum() <= MAX_BARS:
            bars = reach(found, low, high)
            axes.errorbar(place, found, bars, fmt="o", ms=2.5, lw=0.5, color=colour, alpha=0.7)
        else:
            axes.plot(
                place, found, "o", ms=1.5, color=colour, alpha=0.4, mec="none", rasterized=True
            )
        mean, low, high = (ends[i] for ends in Estimate.read(under, f"{name}_mean").ends)
        if np.isfinite(low):
            axes.errorbar(i + MEAN_AT, mean, reach(mean, low, high), fmt="D", color="k", capsize=3)
    axes.set_xticks(range(len(labels)), labels, rotation=20 if len(labels) > 2 else 0)
    axes.set_xlim(-0.6, len(labels) - 0.4)
    settle_axis(axes, name, drawn=bool(np.isfinite(under[name]).any()))


def _draw_key(axes, under, *, by_specimen):
    """Legend of the signs, in the last panel."""
    axes.set_axis_off()
    axes.set(xlim=(0, 1.4), ylim=(0, 1))
    if by_specimen:
        axes.errorbar([0.1], [0.7], [0.06], fmt="o", lw=1, color=colour_of(1))
        words = "a specimen with its 95 %\ninterval, where it is known;\nno point: no value there"
        axes.text(0.2, 0.7, words, va="center")
        return
    many = np.unique(under["group"].values, return_counts=True)[1].max() > MAX_BARS
    of_each = "one specimen" if many else "one specimen with its\n95 % interval"
    axes.errorbar([0.1], [0.7], [0 if many else 0.06], fmt="o", ms=2.5, lw=0.5, color=colour_of(1))
    axes.text(0.2, 0.7, of_each, va="center")
    axes.errorbar([0.1], [0.45], [0.06], fmt="D", color="k", capsize=3)
    axes.text(0.2, 0.45, "mean of the group, with the\n95 % interval of the mean", va="center")


def _spread(n):
    """Places of n points from -1 to 1, of one in the middle."""
    return np.linspace(-1, 1, n) if n > 1 else np.zeros(n)
