"""The resolution law of the contact area: Persson's theory, for every short cut-off."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from xarray import DataTree

from ...mechanics.theory import fudged_persson_area, persson_area
from ..kit.drawing import MARKERS, WIDTH, Drawing, colour_of, group, letter
from ..kit.words import SUPPLEMENTARY, number
from ._reduced_pressure import load_axis

TITLE = "Contact area over the resolution: the law of the rms slope"
SUBJECT = "study"
NEEDS = ("size_effect",)
KEY = "size_effect"
ORDER = 6


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """(a) area of all cut-offs against p / (E* h'_rms(s)); (b) exponents over the cut-off."""
    test = group(atlas, "size_effect", "surfaces")
    fine = test.isel(surface=(test["of_arm"] == "R").values)
    table = _table(fine)
    figure = Figure(figsize=(WIDTH, 3.8))
    left, right = figure.subplots(1, 2, width_ratios=(1.5, 1))
    cut_offs = sorted(table["cut_off_nodes"].unique())
    for i, hurst in enumerate(sorted(table["hurst"].unique())):
        for j, cut_off in enumerate(cut_offs):
            chosen = (table["hurst"] == hurst) & (table["cut_off_nodes"] == cut_off)
            one = table[chosen].groupby("p_over_E_slope")["kappa"].mean()
            label = f"$H$ = {hurst:g}, cut-off {cut_off:g} nodes"
            style = {"marker": MARKERS[j % len(MARKERS)], "color": colour_of(i), "lw": 0.6}
            left.plot(one.index, one.values, label=label, ms=3.5, **style)
    _draw_theories(left, table, test)
    left.set_xscale("log")
    left.set_xlabel(r"reduced pressure $p/(E^* h'_\mathrm{rms}(s))$ (1)")
    left.set_ylabel(r"area slope $\kappa=(A_r/A_0)\,E^* h'_\mathrm{rms}(s)/p$ (1)")
    left.legend(fontsize=6.5, loc="lower left", bbox_to_anchor=(0, 0.06), labelspacing=0.3)
    letter(left, "a", f"cut-offs of {cut_offs[0]:g} to {cut_offs[-1]:g} nodes")
    _draw_exponents(right, test)
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


def _draw_theories(axes, table, test) -> None:
    """Persson's curve, with g, and published computations."""
    p = np.geomspace(table["p_over_E_slope"].min(), table["p_over_E_slope"].max(), 60)
    axes.plot(p, persson_area(p, 1.0, 1.0) / p, color="k", ls=":", label="Persson")
    low, high = (fudged_persson_area(p, 1.0, 1.0, g) / p for g in (0.45, 0.42))
    axes.fill_between(
        p,
        low,
        high,
        color="0.7",
        alpha=0.6,
        lw=0,
        label="Persson, elastic energy\nlessened ($g$ 0.42 to 0.45)",
    )
    published, share = test["published_pressure"].values, test["published_share"].values
    scatter = test.attrs["published_scatter"]
    axes.errorbar(
        published,
        share / published * (1 - scatter / 2),
        yerr=share / published * scatter / 2,
        fmt="k_",
        capsize=2,
        label="published, periodic, $H$ = 0.8",
    )


def _draw_exponents(axes, test) -> None:
    """Delta_sigma by A_r(s) and from h'_rms alone, over load."""
    load = test["reduced_pressure"].values
    for i, hurst in enumerate(test["hurst"].values):
        one = test.sel(hurst=hurst)
        error = [
            one["area_delta"] - one["area_delta_low"],
            one["area_delta_high"] - one["area_delta"],
        ]
        axes.errorbar(
            load,
            one["area_delta"],
            yerr=error,
            fmt="o",
            color=colour_of(i),
            label=f"$H$ = {hurst:g}",
        )
        axes.plot(load, one["theory_delta"], color=colour_of(i), ls=":")
        axes.axhline(1 + hurst, color=colour_of(i), lw=0.5, ls="--")
    load_axis(axes, load)
    axes.set_xlabel(r"load $p/(E^* h'_\mathrm{rms})$, finest (1)")
    axes.set_ylabel(r"$\Delta_\sigma$ by $A_r(s)$ (1)")
    letter(axes, "b", "dotted: Persson; dashed: $1+H$")


def _caption(test, table) -> str:
    departure = float(np.nanmax(abs(test["area_delta"] - test["theory_delta"])))
    light = table[table["p_over_E_slope"] < 0.02]["kappa"]
    words = (
        f"kappa at light load is {number(light.min())} to {number(light.max())}. "
        if len(light)
        else ""
    )
    count = int(test["number"].isel(surface=(test["of_arm"] == "R").values).max()) + 1
    return (
        f"{SUPPLEMENTARY} Contact area at every short cut-off over the pressure by the rms slope "
        f"there, {count} synthetic surfaces of each H. {words}Delta_sigma by A_r(s) differs from "
        f"that of h'_rms(s) alone by at most {number(departure)}."
    )
