"""Geometry of the contact domain between the cut-offs, beside its null models."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from xarray import DataTree

from ..kit.drawing import WIDTH, Drawing, colour_of, entries, group, legends_below, letter
from ..kit.words import number, supplementary

TITLE = "Dimension of the contact domain beside its null models"
SUBJECT = "study"
NEEDS = ("size_effect",)
KEY = "size_effect"
ORDER = 7

_CURVES = (
    ("band_delta", "elastic contact", "o", "-"),
    ("cut_delta", "bearing-area cut", "s", "--"),
)


def draw(atlas: DataTree, names: Sequence[str]) -> Drawing:
    """Correlation dimension between the cut-offs against load, a panel for each Hurst exponent."""
    test = group(atlas, "size_effect", "surfaces")
    hursts = test["hurst"].values
    figure = Figure(figsize=(WIDTH, 3.4))
    panels = np.atleast_1d(figure.subplots(1, len(hursts), sharey=True))
    load = test["reduced_pressure"].values
    for which, axes, hurst in zip("abcdefgh", panels, hursts, strict=False):
        one = test.sel(hurst=hurst)
        for i, (name, label, marker, line) in enumerate(_CURVES):
            low, high = one[f"{name}_low"], one[f"{name}_high"]
            error = [one[name] - low, high - one[name]]
            style = {"marker": marker, "ls": line, "color": colour_of(i + 1)}
            axes.errorbar(load, one[name], yerr=error, label=label, **style)
        axes.axhline(2, color="k", lw=0.8, label="random nodes")
        axes.axhline(1 + hurst, color="0.5", lw=0.8, ls=":", label="$1+H$")
        axes.set_xscale("log")
        axes.set_xlabel(r"$p/(E^* h'_\mathrm{rms})$")
        letter(axes, which, f"$H$ = {hurst:g}")
    panels[0].set_ylabel("correlation dimension $D_2$")
    legends_below(figure, entries(panels[0])[:2], entries(panels[0])[2:])
    columns = [f"{name}{end}" for name, *_ in _CURVES for end in ("", "_low", "_high")]
    table = test[columns].to_dataframe().reset_index()
    return Drawing(figure, table, _caption(test))


def _caption(test) -> str:
    apart = test["band_delta"] - test["cut_delta"]
    beyond = (test["band_delta_low"] > test["cut_delta_high"]) | (
        test["band_delta_high"] < test["cut_delta_low"]
    )
    rising = float((test["band_delta"].isel(reduced_pressure=-1) - test["band_delta"][:, 0]).mean())
    return (
        f"{supplementary('synthetic surfaces, arm R, finest cut-off')} Correlation dimension of "
        "the "
        "contact domain between cut-off and roll-off; bars: 99 % over surfaces. It differs from "
        "the "
        f"bearing-area cut's by {number(float(apart.min()))} to {number(float(apart.max()))}, "
        f"beyond both intervals at {int(beyond.sum())} of {beyond.size} states, and rises with "
        "load "
        f"by {number(rising)}: no dimension of its own."
    )
