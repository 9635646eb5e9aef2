"""Three exponents that one symbol carried: over the resolution, of the domain, over the side."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from xarray import DataTree

from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import WIDTH, Drawing, colour_of
from fractalcontact.figures.kit.legends import heading, legends_below, mark
from fractalcontact.figures.kit.panel import rows
from fractalcontact.figures.kit.titles import letter

from ...experiments.size_decision import NO_EFFECT, USUAL
from ._reduced_pressure import load_axis

TITLE = "Three exponents for which the paper has one symbol"
SUBJECT = "study"
NEEDS = ("size_effect",)
KEY = "size_effect"
ORDER = 4

#: Of each exponent: variable, what is taken from it, marker, words, and null models with their
#: lines and words.
_EXPONENTS: tuple[tuple[str, float, str, str, dict[str, tuple[str, str]]], ...] = (
    (
        "area_delta",
        2.0,
        "o",
        r"resolution $s$: $\Delta_\sigma-2$ by $A_r(s)$",
        {"theory_delta": ("--", "rms slopes alone, by Persson")},
    ),
    (
        "box_delta",
        2.0,
        "s",
        r"contact domain: $\Delta_\sigma-2$ by boxes",
        {"box_cut_delta": ("--", "bearing-area cut"), "random_delta": (":", "random nodes")},
    ),
    (
        "alpha",
        0.0,
        "D",
        r"side $b$: $\mathrm{d}\ln(A_r/A_0)/\mathrm{d}\ln b$",
        {"theory_alpha": ("--", "rms slopes alone, by Persson")},
    ),
)
#: Load at which the caption gives the three, p / (E* h'_rms).
_QUOTED = 0.01


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """The three exponents over the load beside their null models, one panel a Hurst exponent."""
    test = atlas["size_effect/surfaces"].to_dataset()
    arms = test["arm"].values
    test = test.sel(arm="S1" if "S1" in arms else arms[0])
    hursts = test["hurst"].values
    figure = Figure(figsize=(WIDTH, 4.2))
    panels = np.atleast_1d(figure.subplots(1, len(hursts), sharey=True))
    for which, axes, hurst in zip("abcdefgh", panels, hursts, strict=False):
        _draw_hurst(axes, test.sel(hurst=hurst))
        title = f"$H$ = {hurst:g}"
        if len(hursts) > 1:
            letter(axes, which, title)
        else:
            axes.set_title(title, loc="left")
    panels[0].set_ylabel("exponent (1)")
    legends_below(figure, *_legend())
    tables = [
        rows(test[[name, f"{name}_half_width"]], name, f"{name}_half_width", exponent=name).rename(
            columns=lambda column, name=name: str(column).replace(name, "value")
        )
        for first, *_, nulls in _EXPONENTS
        for name in (first, *nulls)
    ]
    return Drawing(figure, pd.concat(tables, ignore_index=True), caption(__name__, **_words(test)))


def _draw_hurst(axes: Axes, one: xr.Dataset) -> None:
    """Exponents of one class over the load."""
    load = one["reduced_pressure"].values
    axes.axhspan(-NO_EFFECT, NO_EFFECT, color="0.88", lw=0, zorder=0)
    limit = float(one["hurst"]) - 1
    axes.axhline(limit, color=colour_of(1), lw=0.8, ls="-.", zorder=1)
    for i, (name, less, marker, _, nulls) in enumerate(_EXPONENTS):
        style: dict[str, Any] = {"marker": marker, "color": colour_of(i + 1), "zorder": 3}
        half = one[f"{name}_half_width"].values
        axes.errorbar(load, one[name].values - less, yerr=half, **style)
        for null, (line, _) in nulls.items():
            axes.plot(load, one[null].values - less, ls=line, lw=1, color=colour_of(i + 1))
    load_axis(axes, load)
    axes.set_xlabel(r"reduced pressure $p/(E^* h'_\mathrm{rms})$ (1)")


def _legend() -> list[list[Artist]]:
    """Columns of the legend: one an exponent, with its null models."""
    columns: list[list[Artist]] = []
    for i, (_, _, marker, words, nulls) in enumerate(_EXPONENTS):
        colour = colour_of(i + 1)
        column: list[Artist] = [mark(color=colour, marker=marker, label=words)]
        column += [mark(color=colour, lw=1, ls=ls, label=of) for ls, of in nulls.values()]
        columns.append(column)
    limit = {"color": colour_of(1), "lw": 0.8, "ls": "-."}
    columns[0].append(mark(**limit, label=r"$H-1$, if cut-off $\ll$ roll-off"))
    columns[2].append(Patch(color="0.88", label=f"no size effect: within {NO_EFFECT:g} of 0"))
    columns[2].append(heading(f"bars: {100 * USUAL:.0f} % intervals"))
    return columns


def _words(test: xr.Dataset) -> dict[str, Any]:
    """Exponents at one load, of the lowest and the highest H."""
    one = test.sel(reduced_pressure=_QUOTED, method="nearest")
    exponents = {name: one[name].values - less for name, less, *_ in _EXPONENTS}
    classes = [
        (hurst, {name: values[i] for name, values in exponents.items()})
        for i, hurst in enumerate(test["hurst"].values.tolist())
    ]
    # The lowest and the highest H alone: a caption is short.
    ends = dict((classes[0], classes[-1]))
    return {"load": float(one["reduced_pressure"]), "classes": ends}
