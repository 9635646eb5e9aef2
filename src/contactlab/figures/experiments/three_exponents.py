"""Three exponents that one symbol carried: over the resolution, of the domain, over the side."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from xarray import DataTree

from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import WIDTH, Drawing, colour_of
from fractalcontact.figures.kit.legends import entries, heading, legends_below
from fractalcontact.figures.kit.panel import Panel, rows

from ...experiments.size_decision import NO_EFFECT, USUAL
from ._reduced_pressure import load_axis

TITLE = "Three exponents for which the paper has one symbol"
SUBJECT = "study"
NEEDS = ("size_effect",)
KEY = "size_effect"
ORDER = 4

#: Exponents: variable, number subtracted, marker, words, and words of the null models.
_EXPONENTS: tuple[tuple[str, float, str, str, dict[str, str]], ...] = (
    (
        *("area_delta", 2.0, "o", r"resolution $s$: $\Delta_\sigma-2$ by $A_r(s)$"),
        {"theory_delta": "rms slopes alone, by Persson"},
    ),
    (
        *("box_delta", 2.0, "s", r"contact domain: $\Delta_\sigma-2$ by boxes"),
        {"box_cut_delta": "bearing-area cut", "random_delta": "random nodes"},
    ),
    (
        *("alpha", 0.0, "D", r"side $b$: $\mathrm{d}\ln(A_r/A_0)/\mathrm{d}\ln b$"),
        {"theory_alpha": "rms slopes alone, by Persson"},
    ),
)
#: Lines of the null models.
_NULLS = ("--", ":")
#: Load at which the caption quotes the three exponents, p / (E* h'_rms).
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
        Panel(axes, which if len(hursts) > 1 else "", f"$H$ = {hurst:g}")
        _draw_hurst(axes, test.sel(hurst=hurst))
    panels[0].set_ylabel("exponent (1)")
    no_effect = Patch(color="0.88", label=f"no size effect: within {NO_EFFECT:g} of 0")
    bars = heading(f"bars: {100 * USUAL:.0f} % intervals")
    size, *others = (
        entries(panels[0])[part] for part in (slice(0, 3), slice(3, 6), slice(6, None))
    )
    legends_below(figure, size, *others[:-1], [*others[-1], no_effect, bars], columnspacing=3)
    tables = [
        rows(test[[name, f"{name}_half_width"]], name, f"{name}_half_width", exponent=name).rename(
            columns=lambda column, name=name: str(column).replace(name, "value")
        )
        for first, *_, nulls in _EXPONENTS
        for name in (first, *nulls)
    ]
    return Drawing(figure, pd.concat(tables, ignore_index=True), caption(__name__, **_words(test)))


def _draw_hurst(axes: Axes, one: xr.Dataset) -> None:
    """Exponents of one class over the load, each beside its null models."""
    load = one["reduced_pressure"].values
    axes.axhspan(-NO_EFFECT, NO_EFFECT, color="0.88", lw=0, zorder=0)
    for i, (name, less, marker, words, nulls) in enumerate(_EXPONENTS):
        style: dict[str, Any] = {"marker": marker, "color": colour_of(i + 1), "zorder": 3}
        axes.plot(load, one[name] - less, label=words, **style)
        axes.errorbar(load, one[name] - less, one[f"{name}_half_width"], fmt="none", **style)
        for line, (null, of) in zip(_NULLS, nulls.items(), strict=False):
            axes.plot(load, one[null] - less, ls=line, lw=1, color=colour_of(i + 1), label=of)
        if name == "area_delta":
            limit = r"$H-1$, if cut-off $\ll$ roll-off"
            at: dict[str, Any] = {"color": colour_of(i + 1), "lw": 0.8, "ls": "-."}
            axes.axhline(float(one["hurst"]) - 1, zorder=1, label=limit, **at)
    load_axis(axes, load)
    axes.set_xlabel(r"reduced pressure $p/(E^* h′_\mathrm{rms})$ (1)")


def _words(test: xr.Dataset) -> dict[str, Any]:
    """Exponents at one load, of the lowest and the highest H."""
    quoted = test.sel(reduced_pressure=_QUOTED, method="nearest")
    exponents = {name: quoted[name].values - less for name, less, *_ in _EXPONENTS}
    classes = [
        (hurst, {name: values[i] for name, values in exponents.items()})
        for i, hurst in enumerate(test["hurst"].values.tolist())
    ]
    # The caption has only the lowest and the highest H, to be short.
    ends = dict((classes[0], classes[-1]))
    return {"load": float(quoted["reduced_pressure"]), "classes": ends}
