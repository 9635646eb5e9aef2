"""The resolution law of the contact area: Persson's theory, for every short cut-off."""

from collections.abc import Sequence
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from xarray import DataTree

from fractalcontact.core.estimate import Estimate
from fractalcontact.core.limits import LIGHT_LOAD
from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import MARKERS, WIDTH, Drawing, colour_of
from fractalcontact.figures.kit.legends import entries, heading, legends_below, mark
from fractalcontact.figures.kit.panel import rows
from fractalcontact.figures.kit.points import reach
from fractalcontact.figures.kit.titles import letter
from fractalcontact.figures.kit.words import number

from ...experiments.size_decision import PROBABILITY
from ._reduced_pressure import load_axis

TITLE = "Contact area over the resolution: is it set by the rms slope alone?"
SUBJECT = "study"
NEEDS = ("size_effect",)
KEY = "size_effect"
ORDER = 6

#: Of every state in the table.
_STATES = (
    *("corrected_share", "persson_share", "rms_slope", "of_hurst", "of_cut_off", "number"),
    *("resolved_pressure", "resolved_kappa"),
)
#: Factor between places of points that would lie over each other.
_BESIDE = 1.05
#: Colour of what others computed, which is no class of surfaces of this study.
_PUBLISHED = colour_of(3)


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """(a) area of all cut-offs against p / (E* h'_rms(s)); (b) exponents over the cut-off."""
    test = atlas["size_effect/surfaces"].to_dataset()
    fine = test.isel(surface=(test["of_arm"] == "R").values)
    table = rows(fine, *_STATES)
    light = table[table["resolved_pressure"] <= LIGHT_LOAD]["resolved_kappa"]
    ends = float(light.min()), float(light.max())
    departure = float(np.nanmax(abs(test["area_delta"] - test["theory_delta"])))
    figure = Figure(figsize=(WIDTH, 4.4))
    left, right = figure.subplots(1, 2, width_ratios=(1.5, 1))
    theories = _draw_theories(left, test)
    classes = _draw_slopes(left, table, ends)
    left.set_xscale("log")
    left.set_xlabel(r"reduced pressure $p/(E^* h'_\mathrm{rms}(s))$ (1)")
    left.set_ylabel(r"area slope $\kappa=(A_r/A_0)\,E^* h'_\mathrm{rms}(s)/p$ (1)")
    letter(left, "a", "area at every cut-off $s$")
    _draw_exponents(right, test, departure)
    surfaces = int(table["number"].max()) + 1
    of_b = heading(f"(b) side by side; bars:\n{100 * PROBABILITY:.0f} % intervals")
    legends_below(
        figure,
        [heading("(a) compared with"), *theories],
        [heading(f"(a) mean and range of {surfaces}\nsurfaces, side by side"), *classes],
        [of_b, *entries(right)],
    )
    cut_off = float(table["of_cut_off"].min())
    words = caption(__name__, light=ends, cut_off=cut_off, departure=departure)
    return Drawing(figure, table, words)


def _draw_slopes(axes: Axes, table: pd.DataFrame, light: tuple[float, float]) -> list:
    """kappa over the load: mean of the surfaces, bars from the least to the most of them."""
    drawn = []
    hursts, cut_offs = (sorted(table[of].unique()) for of in ("of_hurst", "of_cut_off"))
    for (i, hurst), (j, cut_off) in product(enumerate(hursts), enumerate(cut_offs)):
        chosen = (table["of_hurst"] == hurst) & (table["of_cut_off"] == cut_off)
        one = table[chosen].groupby("resolved_pressure")["resolved_kappa"]
        one = one.agg(["mean", "min", "max"])
        beside = one.index * _BESIDE ** (i - (len(hursts) - 1) / 2)
        style: dict[str, Any] = {
            "marker": MARKERS[j % len(MARKERS)],
            "ms": 3.5,
            "color": _colour(i),
            "lw": 0.6,
        }
        style["label"] = f"$H$ = {hurst:g}, $s$ = {cut_off:g} nodes"
        bars = reach(one["mean"], one["min"], one["max"])
        drawn.append(axes.errorbar(beside, one["mean"], bars, **style))
    if np.isfinite(light[0]):
        axes.axvline(LIGHT_LOAD, color="0.5", lw=0.8, ls=":")
        between = " to ".join(map(number, light))
        words = rf"$\leftarrow$ light load: $\kappa$ = {between} "
        axes.text(LIGHT_LOAD, 0.18, words, transform=axes.get_xaxis_transform(), ha="right")
    return drawn


def _colour(i: int) -> str:
    """Colour of the i-th Hurst exponent, different from that of the literature."""
    return colour_of(i + 1 if i < 2 else i + 2)


def _draw_theories(axes: Axes, test: xr.Dataset) -> list:
    """Persson's curve, with g, and published computations."""
    p = test["theory_pressure"].values
    axes.plot(p, test["theory_kappa"], color="k", ls="-.", label="Persson's theory")
    label = "Persson, elastic energy\ntimes $g$ = 0.42 to 0.45"
    low, high = (test[f"weakened_kappa_{end}"] for end in ("low", "high"))
    axes.fill_between(p, low, high, color="0.85", lw=0, label=label)
    published, share = test["published_pressure"].values, test["published_share"].values
    kappa, scatter = share / published, test.attrs["published_scatter"]
    label = "published: periodic, $H$ = 0.8,\nwith its scatter"
    style: dict[str, Any] = {"fmt": "D", "ms": 3.5, "mfc": "white", "color": _PUBLISHED, "lw": 0.8}
    bars = kappa * scatter / 2
    axes.errorbar(published, kappa * (1 - scatter / 2), bars, label=label, **style)
    return entries(axes)


def _draw_exponents(axes: Axes, test: xr.Dataset, departure: float) -> None:
    """Delta_sigma by A_r(s) and from h'_rms alone, over load."""
    load = test["reduced_pressure"].values
    hursts = test["hurst"].values
    for i, hurst in enumerate(hursts):
        one = test.sel(hurst=hurst)
        error = reach(*Estimate.read(one, "area_delta").ends)
        beside = load * _BESIDE ** (2 * i - len(hursts) + 1)
        colour = _colour(i)
        axes.errorbar(beside, one["area_delta"], yerr=error, fmt="o", color=colour)
        axes.plot(beside, one["theory_delta"], "_", color=colour, ms=14, mew=1.5)
        axes.axhline(1 + hurst, color=colour, lw=0.8, ls="--")
    load_axis(axes, load)
    axes.set_xlabel(r"$p/(E^* h'_\mathrm{rms})$, finest $s$ (1)")
    axes.set_ylabel(r"$\Delta_\sigma$ by the change of $A_r$ with $s$ (1)")
    axes.set_xmargin(0.12)
    letter(axes, "b", r"$\Delta_\sigma$ of the contact area")
    grey: dict[str, Any] = {"color": "0.3"}
    axes.add_line(mark(marker="o", ls="none", label="from the areas $A_r(s)$", **grey))
    words = "from the slopes $h'_\\mathrm{rms}(s)$ alone"
    axes.add_line(mark(marker="_", ms=14, mew=1.5, ls="none", label=words, **grey))
    axes.add_line(mark(lw=0.8, ls="--", label="$1+H$", **grey))
    words = f"largest difference {number(departure)}"
    axes.text(0.97, 0.03, words, transform=axes.transAxes, ha="right")
