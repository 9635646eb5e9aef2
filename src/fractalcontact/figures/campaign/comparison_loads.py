"""Groups of specimens over their load: stiffness, contact, dilatancy and size effect."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from xarray import DataTree

from ...statements.comparison import UNDER_LOAD
from ..kit.drawing import WIDTH, Drawing, colour_of, entries, group, letter
from ..kit.words import NOMINAL_PRESSURE, SUPPLEMENTARY, pressure_label
from ._groups import TITLES, common_pressure, group_labels, means_in_words, settle_axis

TITLE = "Groups of specimens over the nominal pressure"
SUBJECT = "study"
NEEDS = ("study_comparison",)
KEY = "comparison"
ORDER = 7

#: Specimens up to which each has its own line.
MOST_LINES = 40
#: Groups that are drawn; the others stand in the table.
MOST_GROUPS = 7


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Mean of each group with its interval and the spread of its specimens."""
    comparison = group(atlas, "study_comparison", "study")
    figure = Figure(figsize=(WIDTH, 5.4))
    panels = figure.subplots(2, 2, sharex=True)
    for axes, name, which in zip(panels.ravel(), UNDER_LOAD, "abcd", strict=True):
        _draw_quantity(axes, comparison, name)
        letter(axes, which, TITLES[name])
    for axes in panels[1]:
        axes.set_xlabel(f"{NOMINAL_PRESSURE} (MPa)")
    figure.legend(handles=entries(panels[0, 0]), loc="outside lower center", ncols=3)
    return Drawing(figure, _table(comparison), _caption(comparison))


def _draw_quantity(axes, comparison, name):
    pressure = comparison["pressure"].values
    axes.set_xscale("log")
    if comparison.sizes["specimen"] <= MOST_LINES:
        _draw_specimens(axes, comparison, name)
    for i, label in enumerate(group_labels(comparison)[:MOST_GROUPS]):
        one, colour = comparison.isel(group_name=i), colour_of(i + 1)
        mean, deviation = one[f"{name}_mean"].values, one[f"{name}_deviation"].values
        n = int(one[f"{name}_n"].max())
        # Present in every panel, so that one legend serves all.
        axes.plot(pressure, mean, "o-", color=colour, label=f"{label}: mean of {n} specimens")
        axes.fill_between(
            pressure, mean - deviation, mean + deviation, color=colour, alpha=0.15, lw=0
        )
        low, high = one[f"{name}_mean_low"].values, one[f"{name}_mean_high"].values
        bars = np.nan_to_num([mean - low, high - mean])
        axes.errorbar(pressure, mean, bars, fmt="none", ecolor=colour, capsize=2, lw=0.8)
    drawn = bool(np.isfinite(comparison[f"{name}_mean"]).any())
    settle_axis(axes, name, drawn=drawn)
    if name == "size_exponent" and drawn:
        axes.axhline(0, color="0.5", lw=0.6)


def _draw_specimens(axes, comparison, name):
    groups = list(comparison["group_name"].values[:MOST_GROUPS])
    for one in comparison["specimen"].values:
        specimen = comparison.sel(specimen=one)
        if (of_group := str(specimen["group"].values)) in groups:
            colour = colour_of(groups.index(of_group) + 1)
            axes.plot(specimen["nominal_pressure"], specimen[name], color=colour, lw=0.4, alpha=0.5)


def _table(comparison: xr.Dataset):
    """Statistics of every group under every pressure, with the specimens they are of."""
    names = [
        name for name in comparison.data_vars if comparison[name].dims == ("group_name", "pressure")
    ]
    table = comparison[names].to_dataframe().reset_index()
    units = {name: comparison[name].attrs["units"].replace("/", "_per_") for name in names}
    renamed = {name: f"{name}_{units[name]}" for name in names}
    return table.rename(columns={**renamed, "group_name": "group", "pressure": "pressure_MPa"})


def _caption(comparison):
    number = common_pressure(comparison)
    state = comparison.isel(pressure=number)
    drawn = "bars the 95 % interval of the mean, bands one standard deviation between specimens"
    means = means_in_words(comparison, "stiffness", state, "MPa/mm")
    where = pressure_label(float(comparison["pressure"][number]))
    return f"{SUPPLEMENTARY} Means of groups, {drawn}. Stiffness under {where}: {means}."
