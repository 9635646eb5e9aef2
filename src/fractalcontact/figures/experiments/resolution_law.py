"""The resolution law of the contact area: Persson's theory, for every short cut-off."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from xarray import DataTree

from ...core.estimate import Estimate
from ...experiments.size_decision import PROBABILITY
from ...mechanics.theory import fudged_persson_area, persson_area
from ..kit.drawing import (
    MARKERS,
    WIDTH,
    Drawing,
    colour_of,
    entries,
    group,
    heading,
    legends_below,
    letter,
)
from ..kit.points import reach
from ..kit.words import SUPPLEMENTARY, number
from ._reduced_pressure import load_axis

TITLE = "Contact area over the resolution: is it set by the rms slope alone?"
SUBJECT = "study"
NEEDS = ("size_effect",)
KEY = "size_effect"
ORDER = 6

#: p / (E* h'_rms) up to which a load is called light.
LIGHT = 0.02
#: Factor between places of points that would lie over each other.
_BESIDE = 1.05
#: Colour of what others computed, which is no class of surfaces of this study.
_PUBLISHED = colour_of(3)


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """(a) area of all cut-offs against p / (E* h'_rms(s)); (b) exponents over the cut-off."""
    test = group(atlas, "size_effect", "surfaces")
    fine = test.isel(surface=(test["of_arm"] == "R").values)
    table = _table(fine)
    figure = Figure(figsize=(WIDTH, 4.4))
    left, right = figure.subplots(1, 2, width_ratios=(1.5, 1))
    _draw_theories(left, table, test)
    _draw_slopes(left, table)
    left.set_xscale("log")
    left.set_xlabel(r"reduced pressure $p/(E^* h'_\mathrm{rms}(s))$ (1)")
    left.set_ylabel(r"area slope $\kappa=(A_r/A_0)\,E^* h'_\mathrm{rms}(s)/p$ (1)")
    letter(left, "a", "area at every cut-off $s$")
    _draw_exponents(right, test)
    theories, classes = _entries(left, table)
    of_b = [
        heading(f"(b) side by side; bars:\n{100 * PROBABILITY:.0f} % intervals"),
        *entries(right),
    ]
    legends_below(figure, classes, theories, of_b)
    return Drawing(figure, table, _caption(test, table))


def _table(fine: xr.Dataset):
    """One row a surface of arm R and load."""
    names = ["corrected_share", "persson_share", "rms_slope", "of_hurst", "of_cut_off", "number"]
    table = fine[names].to_dataframe().reset_index()
    steepest = table.groupby(["of_hurst", "number"])["rms_slope"].transform("max")
    table["p_over_E_slope"] = table["reduced_pressure"] * steepest / table["rms_slope"]
    table["kappa"] = table["corrected_share"] / table["p_over_E_slope"]
    return table.rename(columns={"of_hurst": "hurst", "of_cut_off": "cut_off_nodes"}).drop(
        columns="surface"
    )


def _draw_slopes(axes: Axes, table: pd.DataFrame) -> None:
    """kappa over the load: mean of the surfaces, bars from the least to the most of them."""
    hursts, cut_offs = sorted(table["hurst"].unique()), sorted(table["cut_off_nodes"].unique())
    for i, hurst in enumerate(hursts):
        for j, cut_off in enumerate(cut_offs):
            chosen = (table["hurst"] == hurst) & (table["cut_off_nodes"] == cut_off)
            one = table[chosen].groupby("p_over_E_slope")["kappa"].agg(["mean", "min", "max"])
            axes.errorbar(
                one.index * _BESIDE ** (i - (len(hursts) - 1) / 2),
                one["mean"],
                yerr=reach(one["mean"], one["min"], one["max"]),
                marker=MARKERS[j % len(MARKERS)],
                ms=3.5,
                color=colour_of(_colour(i)),
                lw=0.6,
                label=f"$H$ = {hurst:g}, $s$ = {cut_off:g} nodes",
            )
    low, high = _light(table)
    if np.isfinite(low):
        axes.axvline(LIGHT, color="0.5", lw=0.8, ls=":")
        words = rf"$\leftarrow$ light load: $\kappa$ = {number(low)} to {number(high)}"
        axes.text(LIGHT, 0.18, f"{words} ", transform=axes.get_xaxis_transform(), ha="right")


def _colour(i: int) -> int:
    """Number of the colour of the i-th Hurst exponent: all but that of what others computed."""
    return i + 1 if i < 2 else i + 2


def _light(table: pd.DataFrame) -> tuple[float, float]:
    """Least and largest kappa of any surface at light load; NaN where no load is light."""
    kappa = table[table["p_over_E_slope"] <= LIGHT]["kappa"]
    return float(kappa.min()), float(kappa.max())


def _draw_theories(axes: Axes, table: pd.DataFrame, test: xr.Dataset) -> None:
    """Persson's curve, with g, and published computations."""
    p = np.geomspace(table["p_over_E_slope"].min(), table["p_over_E_slope"].max(), 60)
    axes.plot(p, persson_area(p, 1.0, 1.0) / p, color="k", ls="-.", label="Persson's theory")
    low, high = (fudged_persson_area(p, 1.0, 1.0, g) / p for g in (0.45, 0.42))
    label = "Persson, elastic energy\ntimes $g$ = 0.42 to 0.45"
    axes.fill_between(p, low, high, color="0.85", lw=0, label=label)
    published, share = test["published_pressure"].values, test["published_share"].values
    scatter = test.attrs["published_scatter"]
    axes.errorbar(
        published,
        share / published * (1 - scatter / 2),
        yerr=share / published * scatter / 2,
        fmt="D",
        ms=3.5,
        mfc="white",
        color=_PUBLISHED,
        lw=0.8,
        label="published: periodic, $H$ = 0.8,\nwith its scatter",
    )


def _entries(axes: Axes, table: pd.DataFrame) -> tuple[list, list]:
    """Legends of (a): surfaces of this study, and what they are compared with."""
    surfaces = int(table["number"].max()) + 1
    of_theory = [one for one in entries(axes) if not str(one.get_label()).startswith("$H$")]
    classes = [one for one in entries(axes) if str(one.get_label()).startswith("$H$")]
    head = heading(f"(a) mean and range of {surfaces}\nsurfaces, side by side")
    return [head, *classes], [heading("(a) compared with"), *of_theory]


def _draw_exponents(axes: Axes, test: xr.Dataset) -> None:
    """Delta_sigma by A_r(s) and from h'_rms alone, over load."""
    load = test["reduced_pressure"].values
    hursts = test["hurst"].values
    for i, hurst in enumerate(hursts):
        one = test.sel(hurst=hurst)
        error = reach(*Estimate.read(one, "area_delta").ends)
        beside = load * _BESIDE ** (2 * i - len(hursts) + 1)
        colour = colour_of(_colour(i))
        axes.errorbar(beside, one["area_delta"], yerr=error, fmt="o", color=colour)
        axes.plot(beside, one["theory_delta"], "_", color=colour, ms=14, mew=1.5)
        axes.axhline(1 + hurst, color=colour, lw=0.8, ls="--")
    load_axis(axes, load)
    axes.set_xlabel(r"$p/(E^* h'_\mathrm{rms})$, finest $s$ (1)")
    axes.set_ylabel(r"$\Delta_\sigma$ by the change of $A_r$ with $s$ (1)")
    axes.set_xmargin(0.12)
    letter(axes, "b", r"$\Delta_\sigma$ of the contact area")
    grey: dict[str, Any] = {"color": "0.3"}
    axes.add_line(Line2D([], [], marker="o", ls="none", label="from the areas $A_r(s)$", **grey))
    words = "from the slopes $h'_\\mathrm{rms}(s)$ alone"
    axes.add_line(Line2D([], [], marker="_", ms=14, mew=1.5, ls="none", label=words, **grey))
    axes.add_line(Line2D([], [], lw=0.8, ls="--", label="$1+H$", **grey))
    axes.text(
        0.97,
        0.03,
        f"largest difference {number(_departure(test))}",
        transform=axes.transAxes,
        ha="right",
    )


def _departure(test: xr.Dataset) -> float:
    """Largest difference of the two exponents of (b)."""
    return float(np.nanmax(abs(test["area_delta"] - test["theory_delta"])))


def _caption(test: xr.Dataset, table: pd.DataFrame) -> str:
    low, high = _light(table)
    words = (
        f"At light load kappa is {number(low)} to {number(high)} at every H and s; "
        if np.isfinite(low)
        else ""
    )
    return (
        f"{SUPPLEMENTARY} Real contact area of synthetic surfaces cut off at wavelengths s (a), at "
        f"least {table['cut_off_nodes'].min():g} nodes, which the grid resolves; its exponent (b). "
        f"{words}Delta_sigma from areas and from slopes alone differ by at most "
        f"{number(_departure(test))}."
    )
