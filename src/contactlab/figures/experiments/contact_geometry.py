"""Geometry of the contact domain between the cut-offs, beside its null models."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from xarray import DataTree

from fractalcontact.core.estimate import Estimate
from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import WIDTH, Drawing, colour_of
from fractalcontact.figures.kit.legends import entries, heading, legends_below, mark
from fractalcontact.figures.kit.panel import rows
from fractalcontact.figures.kit.points import reach
from fractalcontact.figures.kit.titles import letter
from fractalcontact.figures.kit.words import number

from ...experiments.size_decision import PROBABILITY
from ._reduced_pressure import load_axis

TITLE = "Dimension of the contact domain beside its null models"
SUBJECT = "study"
NEEDS = ("size_effect",)
KEY = "size_effect"
ORDER = 7

_CURVES = (
    ("band_delta", "elastic contact", "o", "-"),
    ("cut_delta", "bearing-area cut", "s", "--"),
)
_OTHERS = (
    ("geometry_delta", "elastic contact", "o", "-"),
    ("geometry_cut", "bearing-area cut", "s", "--"),
)

#: Factors of the places of the two, which would hide each other.
_BESIDE = (0.96, 1.04)


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Correlation dimension of contact and of its null models against load.

    A panel for each Hurst exponent of arm R and, below, for each construction of arm G.
    """
    test = atlas["size_effect/surfaces"].to_dataset()
    hursts, constructions = test["hurst"].values, test["construction"].values
    lines = 2 if constructions.size else 1
    figure = Figure(figsize=(WIDTH, 0.9 + 2.5 * lines))
    parts = np.ravel(figure.subfigures(lines, 1, squeeze=False))
    letters = iter("abcdefghijkl")
    panels = np.atleast_1d(parts[0].subplots(1, len(hursts), sharey=True))
    for axes, hurst in zip(panels, hursts, strict=True):
        _draw_curves(axes, test.sel(hurst=hurst), _CURVES, colours=(1, 2))
        axes.axhline(
            1 + hurst, color="0.5", lw=0.8, ls=":", label=r"$\Delta_\sigma$ of the area: $1+H$"
        )
        letter(axes, next(letters), f"$H$ = {hurst:g}")
    panels[0].set_ylabel("correlation dimension $D_2$ (1)")
    undetermined = mark(color="0.4", marker="o", ls="none", mfc="white")
    undetermined.set_label("hollow: no interval")
    handles = [*entries(panels[0]), undetermined]
    if constructions.size:
        others = np.atleast_1d(parts[1].subplots(1, len(constructions), sharey=True))
        for axes, name in zip(others, constructions, strict=True):
            for i, hurst in enumerate(hursts):
                one = test.sel(construction=name, hurst=hurst)
                _draw_curves(axes, one, _OTHERS, colours=(i + 3, i + 3), of=f", $H$ = {hurst:g}")
            letter(axes, next(letters), str(name))
        others[0].set_ylabel("correlation dimension $D_2$ (1)")
        legends_below(parts[0], handles[:2], [_bars(test), *handles[2:]])
        legends_below(parts[1], entries(others[0]))
    else:
        legends_below(figure, handles[:2], [_bars(test), *handles[2:]])
    tables = [rows(test, *(name for name, *_ in curves)) for curves in (_CURVES, _OTHERS)]
    table = pd.concat(tables, ignore_index=True)
    return Drawing(figure, table, caption(__name__, **_words(test)))


def _bars(test) -> Line2D:
    """Legend of bars and places of points."""
    drawn = f"{_count(test)} surfaces of each $H$, side by side"
    return heading(f"{drawn}; bars: {100 * PROBABILITY:.0f} % intervals")


def _count(test) -> int:
    """Surfaces of each H."""
    arm = test.isel(surface=(test["of_arm"] == "R").values)
    return int(arm["number"].max()) + 1


def _draw_curves(axes, one, curves, *, colours, of="") -> None:
    """Dimension of the contact domain and of its cut, beside that of random nodes."""
    load = one["reduced_pressure"].values
    pairs = zip(curves, colours, strict=True)
    for beside, ((name, label, marker, line), colour) in zip(_BESIDE, pairs, strict=True):
        value, low, high = Estimate.read(one, name).ends
        known = np.isfinite(high - low)
        error = np.where(known, reach(value, low, high), np.nan)
        style = {"marker": marker, "ls": line, "color": colour_of(colour)}
        x = load * beside
        axes.errorbar(x, value, yerr=error, label=f"{label}{of}", **style)
        hollow = style | {"ls": "none", "mfc": "white", "zorder": 3}
        axes.plot(x, np.where(known, np.nan, value), **hollow)
    axes.axhline(2, color="k", lw=0.8, label="random nodes: 2" if not of else None)
    load_axis(axes, load)
    axes.set_xlabel(r"reduced pressure $p/(E^* h'_\mathrm{rms})$ (1)")


def _words(test) -> dict[str, Any]:
    """Number of states that differ from the cut; dimensions under the least and largest load."""
    known = test["domain_determined"]
    domain = test["band_delta"]
    ends = [domain.isel(reduced_pressure=load).values for load in (0, -1)]
    return {
        "surfaces": _count(test),
        "beyond": int(test["domain_beyond_cut"].sum()),
        "states": known.size,
        "undetermined": int((~known).sum()),
        "spans": [
            dict.fromkeys(number(end) for end in (np.nanmin(values), np.nanmax(values)))
            for values in ends
        ],
    }
