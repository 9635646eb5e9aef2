"""Sub-grids: the same surface on finer grids, and its contact states there."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from roughcontact.contact.state import ContactState
from roughcontact.elastic.halfspace import HalfSpace

from .sweep import load_steps

#: Nodes around which the summit of the spline is looked for, and points per cell there. The spline
#: rises above its nodes by a few tenths of the difference between neighbours, so that a node much
#: lower than the highest ones has no summit beside it that matters.
SUMMIT_NODES, SUMMIT_POINTS = 64, 16


def subgrid(composite: ArrayLike, factor: int) -> np.ndarray:
    """Composite topography on cells ``factor`` times smaller: the cubic spline through its nodes.

    Nodes are centres of cells, so that n cells of s and 2 n cells of s/2 cover the same window, and
    the same nominal area, but have no centre in common; of odd factors each old centre is a new
    one. All are samples of one surface. Within half a cell of the window's edge the spline has no
    nodes beyond: it is continued evenly about the edge, which invents no summit there.
    """
    from scipy import ndimage

    heights = np.asarray(composite, float)
    if factor == 1:
        return heights
    return ndimage.zoom(heights, factor, order=3, mode="reflect", grid_mode=True)


def summit(composite: ArrayLike) -> float:
    """Largest height of the spline of :func:`subgrid`, mm."""
    from scipy import ndimage

    heights = np.asarray(composite, float)
    spline = ndimage.spline_filter(heights, order=3, mode="reflect")
    highest = np.argsort(heights, axis=None)[-SUMMIT_NODES:]
    around = np.linspace(-1, 1, 2 * SUMMIT_POINTS + 1)
    rows, columns = (
        np.clip(place[:, np.newaxis] + around, -0.5, n - 0.5)
        for place, n in zip(np.unravel_index(highest, heights.shape), heights.shape, strict=True)
    )
    points = np.broadcast_arrays(rows[:, :, np.newaxis], columns[:, np.newaxis, :])
    heights_around = ndimage.map_coordinates(
        spline, points, order=3, mode="reflect", prefilter=False
    )
    return float(max(heights_around.max(), heights.max()))


def subgrid_states(
    composite: np.ndarray,
    space: HalfSpace,
    factor: int,
    forces: ArrayLike,
    solving: Mapping[str, Any],
    where: str,
) -> Iterator[tuple[ContactState, float]]:
    """Contact states on cells ``factor`` times smaller, and the largest height on their grid, mm.

    Arguments as for :func:`states.sweep.load_steps`. The closure of a state counts from that
    height.
    """
    heights = subgrid(composite, factor)
    spacing = space.spacing[0] / factor, space.spacing[1] / factor
    kernel, boundary = space.kernel, space.boundary
    finer = HalfSpace(heights.shape, spacing, space.modulus, kernel=kernel, boundary=boundary)
    highest = float(heights.max())
    for state in load_steps(heights, finer, forces, solving, f"{where}, spacing / {factor}"):
        yield state, highest
