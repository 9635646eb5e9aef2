"""Panels of the quality sheet about two faces: gap, overlap, load on suspicious cells."""

from collections.abc import Sequence

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import FigureBase
from matplotlib.lines import Line2D

from ...core.limits import DECISIVE
from ..kit.drawing import COLOURS, colour_of
from ..kit.maps import draw_map, node_position, window_outline
from ..kit.words import length_unit

#: Fraction of the cells left beyond the ends of the gap's colours.
_CLIPPED = 0.001
#: Overlapping cells up to this many are ringed.
_FEW = 400
#: So many offsets get a line of their own.
_OFFSETS = 5
OVERLAP = COLOURS[2]


def draw_gap(
    figure: FigureBase, axes: Axes, specimen: xr.Dataset, sides: Sequence[float]
) -> list[Artist]:
    """Map of the gap, its overlapping cells ringed; the entries of a legend."""
    gap = (specimen["upper"] - specimen["lower"]).values
    widest = np.nanquantile(abs(gap), 1 - _CLIPPED) or 1.0
    unit, size = length_unit(2 * widest)
    norm = Normalize(-widest / size, widest / size)  # white where the faces touch
    image = draw_map(axes, gap / size, sides, cmap="RdBu", norm=norm)
    label = f"gap, negative where the faces overlap ({unit})"
    figure.colorbar(image, ax=axes, location="bottom", fraction=0.06, extend="both", label=label)
    _, mm = length_unit(max(sides))
    axes.add_patch(window_outline(specimen, mm, lw=1))
    overlap = specimen["overlap"].values
    if not 0 < overlap.sum() <= _FEW:
        return []
    y, x = node_position(np.nonzero(overlap), overlap.shape, sides)
    (rings,) = axes.plot(x, y, "o", ms=4, mfc="none", mec=OVERLAP, mew=0.7)
    rings.set_label("faces overlap")
    return [rings]


def draw_gap_heights(axes: Axes, specimen: xr.Dataset) -> None:
    """Distribution of the gap; what lies left of zero overlaps."""
    counts, edges = _gap_histogram(specimen)
    unit, size = length_unit(np.ptp(edges))
    edges = edges / size
    axes.stairs(counts, edges, color=COLOURS[0], lw=1)
    below = edges <= 0
    if below.sum() > 1:
        axes.stairs(counts[: below.sum() - 1], edges[below], color=OVERLAP, fill=True)
    axes.axvline(0, color="0.4", lw=0.6)
    axes.set(xlabel=f"gap ({unit})", ylabel="cells (1)", yscale="log", ylim=(0.6, None))


def _gap_histogram(specimen):
    """Cells in bins of the gap, and the edges of the bins, mm, one of them at zero."""
    gap = (specimen["upper"] - specimen["lower"]).values
    known = gap[np.isfinite(gap)]
    width = (np.ptp(known) or 1.0) / 60
    first, last = np.floor(known.min() / width), np.ceil(known.max() / width)
    edges = width * np.arange(first, max(last, first + 1) + 1)
    return np.histogram(known, edges)[0], edges


def draw_load_share(axes: Axes, curves: xr.Dataset) -> None:
    """Fraction of the load on suspicious cells against the nominal pressure, by offset."""
    finest = _finest(curves)
    for i, place in enumerate(_shown(finest)):
        at = finest.isel(offset=place)
        axes.semilogx(
            at["nominal_pressure"],
            at["suspect_load_share"],
            "o-",
            ms=3,
            lw=0.9,
            color=colour_of(i),
            label=f"{float(at['offset']):.3g}",
        )
    axes.axhline(DECISIVE, color="0.4", lw=0.7, ls="-.")
    axes.set(
        xlabel=r"nominal pressure $\sigma_0$ (MPa)",
        ylabel="load on suspicious cells (fraction)",
        ylim=(-0.04, 1.04),
    )
    axes.legend(title="$v$ (mm)", fontsize=6, title_fontsize=6, loc="best")


def _finest(curves):
    return curves.sel(resolution=curves["resolution"].min()).isel(direction=0)


def _shown(finest):
    """Offsets with a line of their own: the ends and some between."""
    count = finest.sizes["offset"]
    return sorted({round(i) for i in np.linspace(0, count - 1, min(count, _OFFSETS))})


def pair_entries() -> list[Artist]:
    """Entries of the legend for the lower row."""
    return [Line2D([], [], color="0.4", ls="-.", lw=0.7, label="half of the load")]


def pair_table(specimen: xr.Dataset, curves: xr.Dataset) -> list[pd.DataFrame]:
    """One row a bar of the gap's distribution, and a point of the load's fraction."""
    counts, edges = _gap_histogram(specimen)
    gaps = pd.DataFrame({"panel": "gap", "gap_mm": (edges[1:] + edges[:-1]) / 2, "cells": counts})
    finest = _finest(curves)
    shares = [
        pd.DataFrame(
            {
                "panel": "load share",
                "offset_mm": float(finest["offset"][place]),
                "nominal_pressure_mpa": finest["nominal_pressure"].values,
                "suspect_load_share": finest["suspect_load_share"].isel(offset=place).values,
            }
        )
        for place in _shown(finest)
    ]
    return [gaps, *shares]
