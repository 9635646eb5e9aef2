"""Panels of the quality sheet about two faces: gap, overlap, load on suspicious cells."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import FigureBase

from ...core.limits import DECISIVE
from ..kit.drawing import COLOURS, spread
from ..kit.legends import mark
from ..kit.maps import draw_map, node_position, window_outline
from ..kit.panel import Panel
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


def draw_gap_heights(axes: Axes, quality: xr.Dataset) -> None:
    """Distribution of the gap; negative gaps are overlaps."""
    counts, edges = quality["gap_cells"].values, quality["gap_edge"].values
    unit, size = length_unit(np.ptp(edges))
    edges = edges / size
    axes.stairs(counts, edges, color=COLOURS[0], lw=1)
    below = edges <= 0
    if below.sum() > 1:
        axes.stairs(counts[: below.sum() - 1], edges[below], color=OVERLAP, fill=True)
    axes.axvline(0, color="0.4", lw=0.6)
    axes.set(xlabel=f"gap ({unit})", ylabel="cells (1)", yscale="log", ylim=(0.6, None))


def draw_load_share(panel: Panel, curves: xr.Dataset) -> None:
    """Fraction of the load on suspicious cells against the nominal pressure, by offset."""
    shown = curves.isel(offset=spread(curves.sizes["offset"], _OFFSETS))
    panel.curves(
        shown,
        "nominal_pressure",
        "suspect_load_share",
        hue="offset",
        labels=[f"{offset:.3g}" for offset in shown["offset"].values],
        marker="o",
        ls="-",
        ms=3,
        lw=0.9,
    )
    axes = panel.axes
    axes.axhline(DECISIVE, color="0.4", lw=0.7, ls="-.")
    axes.set(
        xlabel=r"nominal pressure $\sigma_0$ (MPa)",
        ylabel="load on suspicious cells (fraction)",
        xscale="log",
        ylim=(-0.04, 1.04),
    )
    axes.legend(title="$v$ (mm)", fontsize=6, title_fontsize=6, loc="best")


def pair_entries() -> list[Artist]:
    """Entries of the legend for the lower row."""
    return [mark(color="0.4", ls="-.", lw=0.7, label="half of the load")]
