"""Few specimens one by one, or means of groups: surface dimension, and contact over pressure."""

from collections.abc import Sequence
from textwrap import fill

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from xarray import DataTree

from ...core.estimate import Estimate
from ...core.labels import printable
from .. import kit

TITLE = "Specimens or groups compared: surface, stiffness, contact, dilatancy and size effect"
SUBJECT = "study"
NEEDS = ("study_comparison",)
KEY = "comparison"
ORDER = 6

#: Title and axis of each quantity. The first has one value per specimen, the others one per load.
_QUANTITIES = {
    "delta_g": ("surface", r"surface dimension $\Delta_g$ (1)"),
    "stiffness": ("stiffness", r"$\mathrm{d}\sigma_0/\mathrm{d}w_\mathrm{int}$ (MPa/mm)"),
    "delta_sigma": ("contact", r"$\Delta_\sigma$ by box counting (1)"),
    "dilatancy": ("dilatancy", r"elastic dilatancy $\delta$ (mm)"),
    "size_exponent": ("size effect", r"exponent of $A_r/A_0$ against $b$ (1)"),
}
#: Name of the group in a study that states none.
_UNGROUPED = "no group"
#: Maximum number of specimens or groups drawn, one per colour. The table has all of them.
_MOST = 7
#: Length of a line of the legend, letters.
_LETTERS = 28


def draw(atlas: DataTree, names: Sequence[str]) -> kit.Drawing:
    """Quantities of specimens, or means of groups with their spread, with intervals."""
    compared = atlas["study_comparison/study"].to_dataset()
    few = compared.sizes["specimen"] <= _MOST
    single = few and set(compared["group"].values) == {_UNGROUPED}
    of, along = ("", "specimen") if single else ("_mean", "group_name")
    labels = [str(label) for label in compared["group_name" if of else "label"].values]
    figure = Figure(figsize=(kit.WIDTH, 4.6))
    *panels, key = figure.subplots(2, 3).ravel()
    for axes, which, (name, (title, words)) in zip(
        panels, "abcde", _QUANTITIES.items(), strict=True
    ):
        kit.letter(axes, which, title)
        for n, label in enumerate(labels[:_MOST]):
            _draw_one(axes, compared.isel({along: n}), f"{name}{of}", label, n)
        if name != "delta_g":
            axes.set_xscale("log")
            axes.set_xlabel(f"{kit.NOMINAL_PRESSURE} (MPa)")
        axes.set_ylabel(words)
        if not np.isfinite(compared[f"{name}{of}"]).any():
            kit.say_empty(axes, "no specimen\nhas a value", ticks=False)
    surface, stiffness, contact, _, _ = panels
    surface.set_xticks([])
    stiffness.set_yscale("log", nonpositive="mask")
    contact.set_ylim(-0.05, 2.05)  # the interval of a mean of few goes far beyond
    key.set_axis_off()
    bars = (
        "bars: 95 % intervals"
        if single
        else "bars: 95 % interval of the mean\nband: one standard deviation"
    )
    key.legend(handles=kit.entries(surface), loc="center", title=bars, title_fontsize=7)
    return kit.Drawing(figure, _table(compared, of), _caption(compared, of, labels))


def _draw_one(axes, one, name, label, n):
    """A specimen; or the mean of a group in a band of one standard deviation."""
    value, low, high = Estimate.read(one, name).ends
    style = {
        "color": kit.colour_of(n),
        "marker": kit.MARKERS[n],
        "ls": kit.LINES[n % len(kit.LINES)],
    }
    group = name.endswith("_mean")
    x = n
    if one[name].dims:
        x = one["pressure" if group else "nominal_pressure"].values
        style |= {"ms": 3, "lw": 0.9, "elinewidth": 0.5}
    words = fill(printable(label, 2 * _LETTERS), _LETTERS).replace("$", r"\$")
    axes.errorbar(x, value, kit.reach(value, low, high), label=words, **style)
    if group:
        spread = one[name.replace("_mean", "_deviation")].values
        ends = np.atleast_1d(value - spread), np.atleast_1d(value + spread)
        across = np.atleast_1d(x) if one[name].dims else np.add(n, (-0.3, 0.3))
        axes.fill_between(across, *ends, color=style["color"], alpha=0.15, lw=0)


def _table(compared, of):
    """Specimens under every load, and means of the groups if these are drawn."""
    tables = [kit.rows(compared, "group", "nominal_pressure", *_QUANTITIES)]
    if of:
        means = (f"{name}_{one}" for name in _QUANTITIES for one in ("mean", "deviation", "n"))
        tables.append(kit.rows(compared, *means))
    return pd.concat(tables, ignore_index=True)


def _caption(compared, of, labels):
    """Least and largest Delta_g and stiffness, with the specimen or group that has each."""
    pressure = float(compared["common_pressure"])
    stiffness = compared["stiffness_at_common_pressure"]
    if of:
        stiffness = compared["stiffness_mean"].sel(pressure=pressure)
    values = {"surface": compared[f"delta_g{of}"].values, "stiffness": stiffness.values}
    return kit.caption(
        __name__,
        specimens=compared.sizes["specimen"],
        groups=len(labels) if of else 0,
        pressure=pressure,
        ends={name: _ends(limits, labels) for name, limits in values.items()},
    )


def _ends(values, labels):
    """Least and largest of the known values with their labels; one, or none, where that is all."""
    finite = np.flatnonzero(np.isfinite(values))
    ends = finite[[values[finite].argmin(), values[finite].argmax()]] if finite.size else ()
    return {printable(labels[i], 2 * _LETTERS): float(values[i]) for i in ends}
