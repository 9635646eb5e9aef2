"""The resolution law of the contact area: Persson's theory, for every short cut-off."""

from collections.abc import Sequence
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from xarray import DataTree

from fractalcontact.core.limits import LIGHT_LOAD
from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import MARKERS, WIDTH, Drawing, colour_of
from fractalcontact.figures.kit.legends import entries, heading, legends_below
from fractalcontact.figures.kit.panel import rows
from fractalcontact.figures.kit.points import reach

TITLE = "Contact area over the resolution: is it set by the rms slope alone?"
SUBJECT = "study"
NEEDS = ("size_effect",)
KEY = "size_effect"
ORDER = 6

#: Variables of every state in the table.
_STATES = (
    *("corrected_share", "persson_share", "rms_slope", "of_hurst", "of_cut_off", "number"),
    *("resolved_pressure", "resolved_kappa"),
)
#: Factor between the places of points that would overlap.
_BESIDE = 1.05
#: Colour of published computations, which are no class of surfaces of this study.
_PUBLISHED = colour_of(3)


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Area slope of all cut-offs s against p / (E* h'_rms(s)), which would be one curve."""
    test = atlas["size_effect/surfaces"].to_dataset()
    fine = test.isel(surface=(test["of_arm"] == "R").values)
    table = rows(fine, *_STATES)
    light = table[table["resolved_pressure"] <= LIGHT_LOAD]["resolved_kappa"]
    figure = Figure(figsize=(WIDTH, 4.0))
    axes = figure.subplots()
    theories = _draw_theories(axes, test)
    classes = _draw_slopes(axes, table)
    axes.set_xscale("log")
    axes.set_xlabel(r"reduced pressure $p/(E^* h′_\mathrm{rms}(s))$ (1)")
    axes.set_ylabel(r"area slope $\kappa=(A_r/A_0)\,E^* h′_\mathrm{rms}(s)/p$ (1)")
    head = f"mean and range of {int(table['number'].max()) + 1} surfaces, side by side"
    legends_below(figure, theories, [heading(head), *classes])
    words = caption(
        __name__,
        light=(float(light.min()), float(light.max())),
        cut_off=float(table["of_cut_off"].min()),
        departure=float(np.nanmax(abs(test["area_delta"] - test["theory_delta"]))),
    )
    return Drawing(figure, table, words)


def _draw_slopes(axes: Axes, table: pd.DataFrame) -> list[Any]:
    """kappa over the load: mean of the surfaces, bars from the least to the most of them."""
    drawn: list[Any] = []
    hursts, cut_offs = (sorted(table[of].unique()) for of in ("of_hurst", "of_cut_off"))
    for (i, hurst), (j, cut_off) in product(enumerate(hursts), enumerate(cut_offs)):
        chosen = (table["of_hurst"] == hurst) & (table["of_cut_off"] == cut_off)
        kappa = table[chosen].groupby("resolved_pressure")["resolved_kappa"]
        kappa = kappa.agg(["mean", "min", "max"])
        places = kappa.index * _BESIDE ** (i - (len(hursts) - 1) / 2)
        style: dict[str, Any] = {
            "marker": MARKERS[j % len(MARKERS)],
            "ms": 3.5,
            "color": colour_of(i + 1 if i < 2 else i + 2),  # the published ones have the third
            "lw": 0.6,
        }
        style["label"] = f"$H$ = {hurst:g}, $s$ = {cut_off:g} nodes"
        bars = reach(kappa["mean"], kappa["min"], kappa["max"])
        drawn.append(axes.errorbar(places, kappa["mean"], bars, **style))
    return drawn


def _draw_theories(axes: Axes, test: xr.Dataset) -> list[Artist]:
    """Persson's curve, with g, and published computations."""
    p = test["theory_pressure"].values
    axes.plot(p, test["theory_kappa"], color="k", ls="-.", label="Persson's theory")
    label = "Persson, elastic energy times $g$ = 0.42 to 0.45"
    low, high = (test[f"weakened_kappa_{end}"] for end in ("low", "high"))
    axes.fill_between(p, low, high, color="0.85", lw=0, label=label)
    published, share = test["published_pressure"].values, test["published_share"].values
    kappa, scatter = share / published, test.attrs["published_scatter"]
    label = "published: periodic, $H$ = 0.8, with its scatter"
    style: dict[str, Any] = {"fmt": "D", "ms": 3.5, "mfc": "white", "color": _PUBLISHED, "lw": 0.8}
    bars = kappa * scatter / 2
    axes.errorbar(published, kappa * (1 - scatter / 2), bars, label=label, **style)
    axes.axvline(LIGHT_LOAD, color="0.5", lw=0.8, ls=":", label="end of light load")
    return entries(axes)
