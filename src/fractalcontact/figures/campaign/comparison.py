"""Specimens and groups of them compared under one nominal pressure, each with its errors."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import Estimate, names_of
from ...statements.comparison import ONCE, QUANTITIES
from ..kit.drawing import TITLE_SIZE, WIDTH, Drawing, colour_of, group, letter
from ..kit.points import reach
from ..kit.words import SUPPLEMENTARY, pressure_label
from ._groups import (
    TITLES,
    alone,
    common_pressure,
    group_labels,
    means_in_words,
    range_in_words,
    settle_axis,
    specimen_labels,
    values_range,
)

TITLE = "Specimens and groups compared: surface, stiffness, contact, dilatancy and size effect"
SUBJECT = "study"
NEEDS = ("study_comparison",)
KEY = "comparison"
ORDER = 6

#: Specimens of a group up to which each has its own error bar.
MOST_BARS = 40
#: Half the width that the specimens of a group take, of the distance between groups; where the
#: mean stands.
HALF_WIDTH, MEAN_AT = 0.25, 0.38
#: Quantities whose ends the caption quotes, and their units there.
_QUOTED = {"delta_g": "", "stiffness": " MPa/mm"}
#: Letters of a line of a specimen's label along an axis.
_LETTERS = 24


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """A strip of specimens for each group, and the mean of the group with its interval."""
    comparison = group(atlas, "study_comparison", "study")
    number = common_pressure(comparison)
    pressure = float(comparison["pressure"][number])
    at_load = comparison.isel(pressure=number)
    values = _values_at(comparison, pressure)
    by_specimen = alone(comparison)
    figure = Figure(figsize=(WIDTH, 6.4 if by_specimen else 5.2))
    panels = figure.subplots(2, 3).ravel()
    for axes, name, which in zip(panels, QUANTITIES, "abcde", strict=False):
        if by_specimen:
            _draw_specimens(axes, name, values, specimen_labels(comparison, _LETTERS))
        else:
            _draw_strip(axes, name, values, at_load)
        quoted = by_specimen and name in _QUOTED
        ends = values_range(values[_column(name)].values) if quoted else ""
        letter(axes, which, "\n".join(filter(None, (TITLES[name], ends))))
    _draw_key(panels[-1], values, by_specimen=by_specimen)
    figure.suptitle(rf"under $\sigma_0$ = {pressure_label(pressure)}", fontsize=TITLE_SIZE)
    return Drawing(figure, values, _caption(comparison, at_load, pressure, values))


def _values_at(comparison: xr.Dataset, pressure: float) -> pd.DataFrame:
    """Every specimen with its quantities under one pressure, NaN where it was not loaded so."""
    same = np.isclose(comparison["compared_pressure"].values, pressure, rtol=1e-9)

    def at_pressure(found):
        known = np.where(same, found, np.nan)
        return np.where(np.isfinite(known).any(axis=1), np.nansum(known, axis=1), np.nan)

    columns = {"specimen": comparison["specimen"].values, "group": comparison["group"].values}
    for name, (unit, _) in QUANTITIES.items():
        found = Estimate.read(comparison, name)
        columns |= (found if name in ONCE else found.mapped(at_pressure)).columns(name, unit)
    return pd.DataFrame(columns).assign(nominal_pressure_MPa=pressure)


def _column(name):
    return names_of(name, QUANTITIES[name][0])[0]


def _draw_specimens(axes, name, values, labels):
    """A bar for each specimen, at its label."""
    found, low, high = Estimate.read(values, name, unit=QUANTITIES[name][0]).ends
    axes.errorbar(
        range(len(labels)), found, reach(found, low, high), fmt="o", lw=1, color=colour_of(1)
    )
    axes.set_xticks(range(len(labels)), labels, rotation=90, fontsize=6.5, linespacing=1)
    axes.set_xlim(-0.6, len(labels) - 0.4)
    axes.grid(axis="x", color="0.9", lw=0.6)
    settle_axis(axes, name, drawn=bool(np.isfinite(found).any()))


def _draw_strip(axes, name, values, at_load):
    column = _column(name)
    labels = group_labels(at_load)
    for i, of_group in enumerate(at_load["group_name"].values):
        members = values[values["group"] == of_group].dropna(subset=column)
        found, low, high = Estimate.read(members, name, unit=QUANTITIES[name][0]).ends
        place = i + HALF_WIDTH * _spread(len(members))
        colour = colour_of(i + 1)
        if len(members) <= MOST_BARS:
            bars = reach(found, low, high)
            axes.errorbar(place, found, bars, fmt="o", ms=2.5, lw=0.5, color=colour, alpha=0.7)
        else:
            axes.plot(
                place, found, "o", ms=1.5, color=colour, alpha=0.4, mec="none", rasterized=True
            )
        mean, low, high = (ends[i] for ends in Estimate.read(at_load, f"{name}_mean").ends)
        if np.isfinite(low):
            axes.errorbar(i + MEAN_AT, mean, reach(mean, low, high), fmt="D", color="k", capsize=3)
    axes.set_xticks(range(len(labels)), labels, rotation=20 if len(labels) > 2 else 0)
    axes.set_xlim(-0.6, len(labels) - 0.4)
    settle_axis(axes, name, drawn=bool(np.isfinite(values[column]).any()))


def _draw_key(axes, values, *, by_specimen):
    """What the signs are, in the last panel."""
    axes.set_axis_off()
    axes.set(xlim=(0, 1.4), ylim=(0, 1))
    if by_specimen:
        axes.errorbar([0.1], [0.7], [0.06], fmt="o", lw=1, color=colour_of(1))
        words = "a specimen with its 95 %\ninterval, where it is known;\nno point: no value there"
        axes.text(0.2, 0.7, words, va="center")
        return
    many = values.groupby("group").size().max() > MOST_BARS
    of_each = "one specimen" if many else "one specimen with its\n95 % interval"
    axes.errorbar([0.1], [0.7], [0 if many else 0.06], fmt="o", ms=2.5, lw=0.5, color=colour_of(1))
    axes.text(0.2, 0.7, of_each, va="center")
    axes.errorbar([0.1], [0.45], [0.06], fmt="D", color="k", capsize=3)
    axes.text(0.2, 0.45, "mean of the group, with the\n95 % interval of the mean", va="center")


def _caption(comparison, at_load, pressure, values):
    n = len(values)
    if alone(comparison):
        labels = comparison["label"].values
        ends = {
            name: range_in_words(values[_column(name)].values, labels, unit)
            for name, unit in _QUOTED.items()
        }
        return (
            f"{SUPPLEMENTARY} {n} specimens under {pressure_label(pressure)}. Delta_g is "
            f"{ends['delta_g']}; the tangent stiffness {ends['stiffness']}."
        )
    return (
        f"{SUPPLEMENTARY} {n} specimens in {comparison.sizes['group_name']} groups, under "
        f"{pressure_label(pressure)}. "
        f"Mean Delta_g {means_in_words(comparison, 'delta_g', at_load)}."
    )


def _spread(n):
    """Places of n points from -1 to 1, of one in the middle."""
    return np.linspace(-1, 1, n) if n > 1 else np.zeros(n)
