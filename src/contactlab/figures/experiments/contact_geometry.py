"""Geometry of the contact domain between the cut-offs, beside its null models."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from xarray import DataTree

from fractalcontact.core.estimate import Estimate
from fractalcontact.core.text import number
from fractalcontact.figures.kit.caption import caption
from fractalcontact.figures.kit.drawing import WIDTH, Drawing, colour_of
from fractalcontact.figures.kit.legends import entries, heading, legends_below
from fractalcontact.figures.kit.panel import Panel, table_of
from fractalcontact.figures.kit.points import hollow_entry

from ...experiments.size_decision import PROBABILITY
from ._reduced_pressure import load_axis

TITLE = "Dimension of the contact domain beside its null models"
SUBJECT = "study"
NEEDS = ("size_effect",)
KEY = "size_effect"
ORDER = 7

#: Contact and its bearing-area cut: words, marker, line, factor of their places.
_STYLES = (("elastic contact", "o", "-", 1.04), ("bearing-area cut", "s", "--", 0.96))
#: Variables of the contact and of its cut on the self-affine surfaces, and on each construction.
_SELF_AFFINE, _CONSTRUCTED = ("band_delta", "cut_delta"), ("geometry_delta", "geometry_cut")


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
    panels = []
    for axes, hurst in zip(_row(parts[0], hursts.size), hursts, strict=True):
        panels.append(Panel(axes, next(letters), f"$H$ = {hurst:g}"))
        _draw_curves(panels[-1], test.sel(hurst=hurst), _SELF_AFFINE, colours=(1, 2))
        axes.axhline(2, color="k", lw=0.8, label="random nodes: 2")
        words = r"$\Delta_\sigma$ of the area: $1+H$"
        axes.axhline(1 + hurst, color="0.5", lw=0.8, ls=":", label=words)
    hollow_entry(panels[0].axes, "hollow: no interval")
    handles = entries(panels[0].axes)
    bars = f"{_count(test)} surfaces of each $H$, side by side; bars: {100 * PROBABILITY:.0f} %"
    legends_below(parts[0], handles[:2], [heading(f"{bars} intervals"), *handles[2:]])
    if constructions.size:
        for axes, name in zip(_row(parts[1], constructions.size), constructions, strict=True):
            panels.append(Panel(axes, next(letters), str(name)))
            for i, hurst in enumerate(hursts):
                states, of = test.sel(construction=name, hurst=hurst), f", $H$ = {hurst:g}"
                _draw_curves(panels[-1], states, _CONSTRUCTED, colours=(i + 3, i + 3), of=of)
            axes.axhline(2, color="k", lw=0.8)
        legends_below(parts[1], entries(axes))
    return Drawing(figure, table_of(*panels), caption(__name__, **_words(test)))


def _row(part: Any, count: int) -> np.ndarray:
    """Panels of a row, which share their ordinates."""
    axes = np.atleast_1d(part.subplots(1, count, sharey=True))
    axes[0].set_ylabel("correlation dimension $D_2$ (1)")
    return axes


def _count(test: xr.Dataset) -> int:
    """Surfaces of each H."""
    arm = test.isel(surface=(test["of_arm"] == "R").values)
    return int(arm["number"].max()) + 1


def _draw_curves(
    panel: Panel, states: xr.Dataset, names: Sequence[str], *, colours: Sequence[int], of: str = ""
) -> None:
    """Dimension of the contact domain and of its cut."""
    for name, colour, (label, marker, line, shift) in zip(names, colours, _STYLES, strict=True):
        style: dict[str, Any] = {"marker": marker, "ls": line, "color": colour_of(colour)}
        style |= {"unit": (shift, 1.0), "label": f"{label}{of}", "hollow": {"zorder": 3}}
        has_interval = np.isfinite(Estimate.read(states, name).width)
        shown = states.assign(known=("reduced_pressure", has_interval))
        panel.curve(shown, "reduced_pressure", name, filled="known", **style)
    load_axis(panel.axes, states["reduced_pressure"].values)
    panel.axes.set_xlabel(r"reduced pressure $p/(E^* h′_\mathrm{rms})$ (1)")


def _words(test: xr.Dataset) -> dict[str, Any]:
    """Number of states that differ from the cut; dimensions under the least and largest load."""
    determined = test["domain_determined"]
    ends = [test["band_delta"].isel(reduced_pressure=load).values for load in (0, -1)]
    return {
        "surfaces": _count(test),
        "beyond": int(test["domain_beyond_cut"].sum()),
        "states": determined.size,
        "undetermined": int((~determined).sum()),
        "spans": [
            dict.fromkeys(number(end) for end in (np.nanmin(values), np.nanmax(values)))
            for values in ends
        ],
    }
