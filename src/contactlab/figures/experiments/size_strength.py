"""Size effect of the strength of sliding mated joints: at equal v, and at equal v/b."""

from collections.abc import Sequence
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from xarray import DataTree

from fractalcontact.core.estimate import Estimate
from fractalcontact.core.text import number
from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import MARKERS, WIDTH, Drawing, colour_of
from fractalcontact.figures.kit.legends import heading, legends_below, mark
from fractalcontact.figures.kit.panel import rows
from fractalcontact.figures.kit.points import reach
from fractalcontact.figures.kit.sizes import plain_decades
from fractalcontact.figures.kit.titles import letter

from ...experiments.size_decision import PROBABILITY

TITLE = "Size effect of the strength at equal displacement and at equal displacement over size"
SUBJECT = "study"
NEEDS = ("size_strength",)
KEY = "size_strength"
ORDER = 8

#: Law of contact whose points are filled; the other law caps the pressure.
ELASTIC = "elastic"


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Strength over v by side; its exponents over the side, beside those that v alone predicts."""
    test = atlas["size_strength/surfaces"].to_dataset()
    hursts = test["hurst"].values
    figure = Figure(figsize=(WIDTH, 7.4))
    panels = figure.subplots(2, len(hursts), sharey="row", squeeze=False)
    for i, hurst in enumerate(hursts):
        upper, lower = panels[:, i]
        _draw_strength(upper, test.sel(hurst=hurst))
        letter(upper, "abcdefgh"[i], rf"$H$ = {hurst:g}: strength")
        _draw_exponents(lower, test.sel(hurst=hurst))
        letter(lower, "abcdefgh"[i + len(hursts)], rf"$H$ = {hurst:g}: its exponent over the side")
    panels[0, 0].set_ylabel(r"strength $\tau/\sigma_0$ (1)")
    panels[1, 0].set_ylabel(r"$\mathrm{d}\ln(\tau/\sigma_0)/\mathrm{d}\ln b$ (1)")
    legends_below(figure, *_legends(test), columnspacing=3)
    return Drawing(figure, _table(test), caption(__name__, **_words(test)))


def _table(test: xr.Dataset) -> pd.DataFrame:
    """Strengths of every side and interval; exponents of all v, at equal v and at equal v/b."""
    test = test.transpose("hurst", "law", "reduced_pressure", ..., "side")
    at_fractions = ("scaled_strength_exponent", "predicted_exponent", "theory_exponent")
    tables = [
        rows(test, "strength", "theory_strength", "truncated_share", drawn="strength"),
        rows(test, "pooled_exponent", "pooled_exponent_verdict", drawn="all v"),
        rows(test, "strength_exponent", "strength_exponent_verdict", drawn="equal v"),
        rows(test, *at_fractions, "scaled_strength_exponent_verdict", drawn="equal v/b"),
    ]
    return pd.concat(tables, ignore_index=True)


def _draw(axes: Axes, x: Any, estimate: Estimate, law: str, **style: Any) -> None:
    """Points with bars: filled where contact is elastic, hollow where its pressure is capped."""
    face = style["color"] if law == ELASTIC else "white"
    axes.errorbar(x, estimate.value, reach(*estimate.ends), mfc=face, elinewidth=0.7, **style)


def _draw_strength(axes: Axes, test: xr.Dataset) -> None:
    """Strength over v at the lightest load; points at one v are shifted sideways."""
    test = test.isel(reduced_pressure=0)
    low, high = test["interval_low"].values, test["interval_high"].values
    middles = np.sqrt(np.maximum(low, high / 4) * high)
    sides = test.sizes["side"]
    for law, i in product(test["law"].values, range(sides)):
        shift = 1.06 ** (i - (sides - 1) / 2) * (1.0 if law == ELASTIC else 1.03)
        strength = Estimate.read(test.sel(law=law).isel(side=i), "strength")
        _draw(axes, middles * shift, strength, law, color=colour_of(i + 1), fmt=MARKERS[i])
    axes.plot(middles, test["theory_strength"].sel(law=ELASTIC), "-", color="0.6", lw=1, zorder=0)
    friction = np.tan(np.radians(test.attrs["basic_friction_angle"]))
    axes.axhline(friction, color="0.6", ls=":", lw=1, zorder=0)
    axes.set_xscale("log")
    plain_decades(axes.xaxis)
    axes.set_xlabel("shear displacement $v$, middle of its interval (nodes)")


def _draw_exponents(axes: Axes, test: xr.Dataset) -> None:
    """Exponents with their intervals, those at equal v to the left, at equal v/b to the right."""
    intervals, fractions = test.sizes["interval"], test.sizes["fraction"]
    places = np.arange(1 + intervals + fractions)
    axes.axhspan(-test.attrs["bound"], test.attrs["bound"], color="0.9", lw=0, zorder=0)
    groups = list(product(range(test.sizes["reduced_pressure"]), test["law"].values))
    for n, (load, law) in enumerate(groups):
        exponents = test.sel(law=law).isel(reduced_pressure=load)
        x = places + 0.7 * ((n + 0.5) / len(groups) - 0.5)
        names = ("pooled_exponent", "strength_exponent", "scaled_strength_exponent")
        parts = [np.atleast_2d(np.stack(Estimate.read(exponents, name).ends).T) for name in names]
        _draw(axes, x, Estimate(*np.concatenate(parts).T), law, color="k", fmt=MARKERS[load])
        scaled = x[1 + intervals :]
        axes.plot(scaled, exponents["predicted_exponent"], "_", color="k", ms=12, zorder=0)
        axes.plot(scaled, exponents["theory_exponent"], "x", color="0.6", ms=5, zorder=0)
    axes.axvline(intervals + 0.5, color="0.6", lw=0.8)
    of_v = zip(test["interval_low"].values, test["interval_high"].values, strict=True)
    of_b = zip(test["fraction_low"].values, test["fraction_high"].values, strict=True)
    labels = ["all $v$", *(f"{low:g} to {high:g}" for low, high in of_v)]
    labels += [f"1/{1 / low:.4g} to 1/{1 / high:.4g}" for low, high in of_b]
    axes.set_xticks(places, labels, fontsize=7, rotation=90)
    axes.set_xlabel("at equal $v$ (nodes)  |  at equal $v/b$ (1)")


def _legends(test: xr.Dataset) -> list[list[Artist]]:
    """Columns of the legend: sides of the strength, loads of the exponents, lines."""
    sides = [
        mark(color=colour_of(i + 1), marker=MARKERS[i], ls="none", label=f"{side:g}")
        for i, side in enumerate(test["side"].values)
    ]
    loads = [
        mark(color="k", marker=MARKERS[i], ls="none", label=f"{load:g}")
        for i, load in enumerate(test["reduced_pressure"].values)
    ]
    hollow = mark(color="0.3", marker="o", mfc="white", ls="none", label="hollow: capped pressure")
    lines = [
        mark(color="0.3", marker="_", ms=12, ls="none", label="as $v$ alone makes it"),
        mark(color="0.6", marker="x", ls="-", label="theory: height differences at $v$"),
        mark(color="0.6", ls=":", label=r"basic friction $\tan\varphi_b$"),
        Patch(color="0.9", label=f"no size effect: within {test.attrs['bound']:g}"),
        heading(f"side by side; bars: {100 * PROBABILITY:.0f} % intervals"),
    ]
    of_loads = heading(r"exponent: $p/(E^* h′_\mathrm{rms})$")
    return [[heading("strength: side $b$ (nodes)"), *sides], [of_loads, *loads, hollow], lines]


def _words(test: xr.Dataset) -> dict[str, Any]:
    """Ranges of the exponents, and how many classes have which verdict."""
    names = ("pooled_exponent", "scaled_strength_exponent", "beyond_exponent")
    pooled, scaled, beyond = (test[name].values[np.isfinite(test[name].values)] for name in names)
    texts, count = np.unique(test["overall"].values, return_counts=True)
    return {
        "pooled": _range(pooled),
        "scaled": _range(scaled),
        "beyond": float(abs(beyond).max()) if beyond.size else np.nan,
        "verdicts": dict(zip(texts.tolist(), count.tolist(), strict=True)),
    }


def _range(values: np.ndarray) -> list[str]:
    """Least and largest in words, once if they read alike; empty without any."""
    ends = [number(end, 3) for end in (values.min(), values.max())] if values.size else []
    return list(dict.fromkeys(ends))
