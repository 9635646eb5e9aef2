"""Maps of scans and of contact domains, true to scale."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.image import AxesImage
from matplotlib.patches import Patch, Rectangle
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike
from scipy.ndimage import maximum_filter

from ...core.text import length_unit
from ...core.window import window_slices
from .drawing import COLOURS

#: Grey of cells that were not measured.
MISSING = "0.7"

#: White outline that makes a line or a word visible on light and on dark ground.
HALO = [withStroke(linewidth=2.5, foreground="white")]

#: A domain of fewer nodes gets rings if the map has more nodes along a side than the second number:
#: its nodes are too small to be seen in print.
FEW_NODES = 100
FINE_NODES = 100

_RING: dict[str, Any] = {"marker": "o", "ls": "none", "ms": 4, "mfc": "none", "mew": 0.7}
_RING["mec"] = COLOURS[3]

#: Minimum width of a node in contact, points, so that print shows it; and the largest fraction of
#: the map that may become black by it.
MIN_DOT, MAX_BLACK = 0.8, 0.3


def scan_extent(specimen: xr.Dataset) -> tuple[float, ...]:
    """Sides (y, x) of the whole scan, mm."""
    return tuple(specimen.sizes[axis] * specimen.attrs[f"spacing_{axis}"] for axis in "yx")


def window_outline(
    specimen: xr.Dataset, unit_mm: float, slid: tuple[float, float] = (0.0, 0.0), **style: Any
) -> Rectangle:
    """The window as a rectangle, in units of `unit_mm` mm from the corner of the scan.

    `slid` is the distance (y, x) that the window has slid, mm.
    """
    corner: list[float] = []
    sides: list[float] = []
    for cells, axis, moved in zip(window_slices(specimen), "yx", slid, strict=True):
        spacing = specimen.attrs[f"spacing_{axis}"]
        corner.append((cells.start * spacing + moved) / unit_mm)
        sides.append((cells.stop - cells.start) * spacing / unit_mm)
    return Rectangle(
        (corner[1], corner[0]), sides[1], sides[0], fill=False, path_effects=HALO, **style
    )


def draw_map(
    axes: Axes,
    image: np.ndarray,
    sides: Sequence[float],
    *,
    ticks: int = 5,
    interpolation: str = "nearest",
    **options: Any,
) -> AxesImage:
    """An image true to scale, with distances from its corner in the unit that suits them.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
    image : (ny, nx) or (ny, nx, 3) ndarray
        Values (NaN is drawn grey) or colours.
    sides : (float, float)
        (y, x) in mm.
    ticks : int
        Approximate number along each side.
    interpolation : str
        None by default, so that no missing cell is filled.
    **options
        Of ``imshow``.
    """
    name, size = length_unit(max(sides))
    extent = (0, sides[1] / size, 0, sides[0] / size)
    axes.set_facecolor(MISSING)
    drawn = axes.imshow(image, extent=extent, interpolation=interpolation, **options)
    for axis, letter, side in ((axes.xaxis, "x", sides[1]), (axes.yaxis, "y", sides[0])):
        # The short side of a strip gets fewer numbers, which would overlap.
        most = max(1, round(ticks * min(1.0, 1.5 * side / max(sides))))
        axis.set_major_locator(MaxNLocator(most, steps=[1, 2, 5, 10], min_n_ticks=min(most, 2)))
        axis.set_label_text(f"${letter}$ ({name})")
    return drawn


def draw_domain(
    axes: Axes,
    domain: np.ndarray,
    sides: Sequence[float],
    *,
    ticks: int = 5,
    times: int | None = None,
) -> None:
    """Contact domain (ny, nx) in black, with nodes enlarged for print and rings around the few.

    `sides` (y, x) of the window are in mm. `times` is the width of a drawn node in nodes, the same
    in maps that are compared with each other; by default it follows from the one map.
    """
    # A window has no missing cells, so that smoothing hides none; a node smaller than a pixel must
    # not vanish.
    grey: dict[str, Any] = {"cmap": "Greys", "vmin": 0, "vmax": 1, "interpolation": "auto"}
    if times is None:
        times = enlargement([domain], _node_points(axes, domain.shape, sides))
    draw_map(axes, enlarged(domain, times), sides, ticks=ticks, **grey)
    nodes = np.argwhere(domain)
    if len(nodes) < FEW_NODES and max(domain.shape) > FINE_NODES:
        y, x = node_position(nodes.T, domain.shape, sides)
        axes.plot(x, y, clip_on=False, **_RING)


def enlargement(domains: Sequence[np.ndarray], points: float, most: float = np.inf) -> int:
    """Enlargement of nodes in print, one for all domains of a window; 1 where they fill a map.

    With a number for each, finer domains would look fuller than coarser ones. `points` is the width
    of the smallest node in print, points; `most` is the largest enlargement.
    """
    wanted = int(min(np.ceil(MIN_DOT / points), most))
    for times in range(wanted, 1, -1):
        if all(enlarged(domain, times).mean() <= MAX_BLACK for domain in domains):
            return times
    return 1


def enlarged(domain: np.ndarray, times: int) -> np.ndarray:
    """Contact domain (ny, nx) with each node drawn as a square of ``times`` nodes per side."""
    return domain if times < 2 else maximum_filter(domain, times, mode="constant", cval=0)


def _node_points(axes, shape, sides):
    """Estimated width of a node in print, points, before the final layout."""
    box = axes.get_window_extent()
    scale = min(box.width / sides[1], box.height / sides[0])
    return 72 / axes.figure.dpi * scale * sides[0] / shape[0]


def node_position(node: ArrayLike, shape: Sequence[int], sides: Sequence[float]) -> list:
    """Centres (y, x) of nodes (row, column) on the map of a window, in the map's unit.

    `shape` is the number of nodes (y, x) and `sides` the length (y, x) of the window, mm.
    """
    _, size = length_unit(max(sides))
    return [
        (np.asarray(at) + 0.5) * side / n / size
        for at, n, side in zip(np.asarray(node), shape, sides, strict=True)
    ]


def missing_patch() -> Patch:
    """Entry of a legend for cells that were not measured."""
    return Patch(facecolor=MISSING, edgecolor="none", label="not measured")
