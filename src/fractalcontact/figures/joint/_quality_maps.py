"""Maps of the quality sheet: missing and outlying cells, the gap of two faces."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import Normalize, to_rgb
from matplotlib.figure import FigureBase
from matplotlib.patches import Patch

from ...core.text import length_unit
from ...core.window import window_slices
from .. import kit

#: Maximum number of outliers or overlaps with rings, which make single cells visible.
FEW = 400
#: Colours and words of cells, by the variable of the stage ``specimens`` that marks them.
CELLS = {
    "filled": (kit.COLOURS[1], "filled"),
    "spike": (kit.COLOURS[0], "lone spike"),
    "outlier": (kit.COLOURS[2], "outlier"),
}
OVERLAP, _PRESENT = kit.COLOURS[2], "0.96"
#: Fraction of the cells left beyond the ends of the gap's colours.
_CLIPPED = 0.001


def draw_mask(
    axes: Axes, specimen: xr.Dataset, faces: Sequence[str], sides: Sequence[float]
) -> list[Artist]:
    """Mask of missing, filled and outlying cells, with the entries of its legend."""
    missing = np.isnan([specimen[face].values for face in faces]).any(axis=0)
    image = np.full((*missing.shape, 3), to_rgb(_PRESENT))
    image[missing] = to_rgb(kit.MISSING)
    marks: list[Artist] = [Patch(facecolor=_PRESENT, edgecolor="0.6", lw=0.5, label="measured")]
    marks += [Patch(facecolor=kit.MISSING, label="not measured")] if missing.any() else []
    for name, (colour, words) in CELLS.items():
        if name in specimen and specimen[name].any():
            image[specimen[name].values] = to_rgb(colour)
            marks.append(Patch(facecolor=colour, label=words))
    kit.draw_map(axes, image, sides)
    if "outlier" in specimen:
        _ring(axes, specimen["outlier"].values, sides)
    _, size = length_unit(max(sides))
    axes.add_patch(kit.window_outline(specimen, size, lw=1))
    line: dict[str, Any] = {"color": "0.4", "lw": 0.7, "ls": (0, (6, 2, 1, 2))}
    y, x = kit.node_position(middle(specimen), missing.shape, sides)
    axes.axhline(y, **line)
    axes.axvline(x, **line)
    return [*marks, kit.mark(label="where profiles run", **line)]


def middle(specimen: xr.Dataset) -> tuple[int, ...]:
    """Row and column through the middle of the window."""
    return tuple((cells.start + cells.stop) // 2 for cells in window_slices(specimen))


def draw_gap(
    figure: FigureBase, axes: Axes, specimen: xr.Dataset, sides: Sequence[float]
) -> list[Artist]:
    """Map of the gap, its overlapping cells ringed; the entries of a legend."""
    gap = (specimen["upper"] - specimen["lower"]).values
    widest = np.nanquantile(abs(gap), 1 - _CLIPPED) or 1.0
    unit, size = length_unit(2 * widest)
    norm = Normalize(-widest / size, widest / size)  # white where the faces touch
    image = kit.draw_map(axes, gap / size, sides, cmap="RdBu", norm=norm)
    label = f"gap, negative where the faces overlap ({unit})"
    figure.colorbar(image, ax=axes, location="bottom", fraction=0.06, extend="both", label=label)
    _, mm = length_unit(max(sides))
    axes.add_patch(kit.window_outline(specimen, mm, lw=1))
    return _ring(axes, specimen["overlap"].values, sides, label="faces overlap")


def _ring(
    axes: Axes, cells: np.ndarray, sides: Sequence[float], label: str | None = None
) -> list[Artist]:
    """Rings around cells, if there are few."""
    if not 0 < cells.sum() <= FEW:
        return []
    y, x = kit.node_position(np.nonzero(cells), cells.shape, sides)
    ring: dict[str, Any] = {
        "ls": "none",
        "marker": "o",
        "ms": 4,
        "mfc": "none",
        "mec": OVERLAP,
        "mew": 0.7,
    }
    return list(axes.plot(x, y, label=label, **ring))
