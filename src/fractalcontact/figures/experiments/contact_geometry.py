"""Geometry of the contact domain between the cut-offs, beside its null models."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from xarray import DataTree

from ...domain.box_dimension import WIDEST
from ..kit.drawing import WIDTH, Drawing, colour_of, entries, group, legends_below, letter
from ..kit.words import SUPPLEMENTARY, number
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


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Correlation dimension of contact and of its null models against load.

    A panel for each Hurst exponent of arm R and, below, for each construction of arm G.
    """
    test = group(atlas, "size_effect", "surfaces")
    hursts, constructions = test["hurst"].values, test["construction"].values
    rows = 2 if constructions.size else 1
    figure = Figure(figsize=(WIDTH, 0.9 + 2.5 * rows))
    parts = np.ravel(figure.subfigures(rows, 1, squeeze=False))
    letters = iter("abcdefghijkl")
    panels = np.atleast_1d(parts[0].subplots(1, len(hursts), sharey=True))
    for axes, hurst in zip(panels, hursts, strict=True):
        _draw_curves(axes, test.sel(hurst=hurst), _CURVES, colours=(1, 2))
        axes.axhline(1 + hurst, color="0.5", lw=0.8, ls=":", label="$1+H$")
        letter(axes, next(letters), f"$H$ = {hurst:g}")
    panels[0].set_ylabel("correlation dimension $D_2$ (1)")
    undetermined = Line2D([], [], color="0.4", marker="o", ls="none", mfc="white")
    undetermined.set_label(f"hollow: undetermined (interval wider than {WIDEST:g})")
    handles = [*entries(panels[0]), undetermined]
    if constructions.size:
        others = np.atleast_1d(parts[1].subplots(1, len(constructions), sharey=True))
        for axes, name in zip(others, constructions, strict=True):
            for i, hurst in enumerate(hursts):
                one = test.sel(construction=name, hurst=hurst)
                _draw_curves(axes, one, _OTHERS, colours=(i + 3, i + 3), of=f", $H$ = {hurst:g}")
            letter(axes, next(letters), str(name))
        others[0].set_ylabel("correlation dimension $D_2$ (1)")
        legends_below(parts[0], handles[:2], handles[2:])
        legends_below(parts[1], entries(others[0]))
    else:
        legends_below(figure, handles[:2], handles[2:])
    return Drawing(figure, _table(test), _caption(test))


def _draw_curves(axes, one, curves, *, colours, of="") -> None:
    """Dimension of the contact domain and of its cut, beside that of random nodes."""
    load = one["reduced_pressure"].values
    for (name, label, marker, line), colour in zip(curves, colours, strict=True):
        low, high = one[f"{name}_low"], one[f"{name}_high"]
        narrow = (high - low) <= WIDEST
        error = [(one[name] - low).where(narrow), (high - one[name]).where(narrow)]
        style = {"marker": marker, "ls": line, "color": colour_of(colour)}
        axes.errorbar(load, one[name], yerr=error, label=f"{label}{of}", **style)
        hollow = style | {"ls": "none", "mfc": "white", "zorder": 3}
        axes.plot(load, one[name].where(~narrow), **hollow)
    axes.axhline(2, color="k", lw=0.8, label="random nodes" if not of else None)
    load_axis(axes, load)
    axes.set_xlabel(r"$p/(E^* h'_\mathrm{rms})$ (1)")


def _table(test) -> pd.DataFrame:
    """One row a Hurst exponent, load and (of arm G) construction."""
    tables = []
    for curves in (_CURVES, _OTHERS):
        columns = [f"{name}{end}" for name, *_ in curves for end in ("", "_low", "_high")]
        tables.append(test[columns].to_dataframe().reset_index())
    return pd.concat(tables, ignore_index=True)


def _caption(test) -> str:
    arm = test.isel(surface=(test["of_arm"] == "R").values)
    count = int(arm["number"].max()) + 1
    low, high = (test[f"band_delta_{end}"] for end in ("low", "high"))
    known = ((high - low) <= WIDEST) & ((test["cut_delta_high"] - test["cut_delta_low"]) <= WIDEST)
    beyond = known & ((low > test["cut_delta_high"]) | (high < test["cut_delta_low"]))
    rising = test["band_delta"].isel(reduced_pressure=[0, -1]).diff("reduced_pressure")
    return (
        f"{SUPPLEMENTARY} Correlation dimension of contact domains between cut-off and roll-off, "
        f"{count} synthetic surfaces of each H. It differs from the bearing-area cut's beyond both "
        f"intervals at {int(beyond.sum())} of {known.size} states ({known.size - int(known.sum())} "
        f"undetermined, hollow), and rises with load by {number(float(rising.mean()))}."
    )
