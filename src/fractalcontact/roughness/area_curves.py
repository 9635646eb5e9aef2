"""Curves that need an area: prisms, cubes and islands (see :mod:`roughness.curves`)."""

import numpy as np
from scipy import ndimage

from ..core.kernel_cache import njit
from .curves import (
    BLOCKS,
    LENGTHS_PER_OCTAVE,
    WINDOW_COVER,
    Curve,
    in_blocks,
    lengths_in_cells,
    ratio,
)

#: Prisms of side b start every b / PRISM_STEPS cells: closer ones tell nothing new.
PRISM_STEPS = 4

#: Shares of the surface below the levels whose islands are measured.
LEVELS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)


def triangular_prism_curves(heights: np.ndarray, spacing: float) -> dict[str, Curve]:
    """Area of triangular prisms of side b, for heights exaggerated without end: grows as b^(H-1).

    Clarke, Comput. Geosci. 12 (1986) 713. His area follows b^(2 - Delta_g) only on a surface that
    is steep at every length, and so depends on the unit of height: a gently rough surface gives 2
    whatever its H. In the limit of infinite exaggeration the area per unit of it is the mean slope
    of the facets, which has neither defect.
    """
    sides = lengths_in_cells(1, min(heights.shape) // 2)
    curve = in_blocks(spacing, sides, heights, _add_facet_slopes)
    return {"both": curve._replace(total=curve.total / spacing)}


@njit(cache=True)
def _add_facet_slopes(heights, side, total, weight):
    """Mean rise per cell of the four facets that meet at each prism's centre."""
    ny, nx = heights.shape
    step = max(side // PRISM_STEPS, 1)
    for i in range(0, ny - side, step):
        row = (2 * i + side) * BLOCKS // (2 * ny)
        for j in range(0, nx - side, step):
            a, b = heights[i, j], heights[i, j + side]
            d, c = heights[i + side, j], heights[i + side, j + side]
            # The centre is the mean of the corners, so opposite facets share their slope across.
            across_y, across_x = (d + c - a - b) / 2, (b + c - a - d) / 2
            rise = np.sqrt((b - a) ** 2 + across_y**2) + np.sqrt((c - d) ** 2 + across_y**2)
            rise += np.sqrt((d - a) ** 2 + across_x**2) + np.sqrt((c - b) ** 2 + across_x**2)
            if np.isfinite(rise):
                column = (2 * j + side) * BLOCKS // (2 * nx)
                total[row, column] += rise / (4 * side)
                weight[row, column] += 1


def cube_counting_curves(heights: np.ndarray, spacing: float) -> dict[str, Curve]:
    """Mean height range (mm) over square columns of side b (mm): grows as b^H.

    Counting cubes of side b that meet the surface gives b^-Delta_g only where it is steep at every
    length, and so depends on the unit of height. For heights exaggerated without end the number of
    cubes in a column is the range of heights in it over b: Dubuc et al., Proc. R. Soc. A 425 (1989)
    113. Neighbouring columns share their edges.
    """
    sides = lengths_in_cells(1, min(heights.shape) // 2)
    return {"both": in_blocks(spacing, sides, heights, _add_ranges)}


@njit(cache=True)
def _add_ranges(heights, side, total, weight):
    ny, nx = heights.shape
    for i in range((ny - 1) % side // 2, ny - side, side):
        row = (2 * i + side) * BLOCKS // (2 * ny)
        for j in range((nx - 1) % side // 2, nx - side, side):
            lowest, highest, n = np.inf, -np.inf, 0
            for p in range(i, i + side + 1):
                for q in range(j, j + side + 1):
                    height = heights[p, q]
                    if np.isfinite(height):
                        lowest, highest, n = min(lowest, height), max(highest, height), n + 1
            if n >= WINDOW_COVER * (side + 1) ** 2:
                column = (2 * j + side) * BLOCKS // (2 * nx)
                total[row, column] += highest - lowest
                weight[row, column] += 1


def slit_island_curves(heights: np.ndarray, spacing: float) -> dict[str, Curve]:
    """Perimeter of islands over the root of their area A, against that root (mm): A^((D - 1) / 2).

    Mandelbrot, Passoja & Paullay, Nature 308 (1984) 721: coasts of dimension D = Delta_g - 1.
    Islands and lakes of the `LEVELS`, connected along sides of cells; shores of what lies inside
    belong to the perimeter, and its area does not count. What meets the rim or a missing cell is
    left out.
    """
    edges = np.geomspace(1, min(heights.shape) / 2, _bins_to(min(heights.shape) / 2) + 1)
    bins = len(edges) - 1
    total, weight = np.zeros((2, bins, BLOCKS**2))
    known = np.isfinite(heights)
    levels = np.quantile(heights[known], LEVELS) if known.any() else []
    for level in levels:
        area, perimeter, block = _islands(heights, known, level)
        root = np.sqrt(area)
        which = np.digitize(root, edges) - 1
        inside = which < bins
        place = (which * BLOCKS**2 + block)[inside]
        compactness = (perimeter / root)[inside]
        total += np.bincount(place, compactness, total.size).reshape(total.shape)
        weight += np.bincount(place, minlength=total.size).reshape(total.shape)
    return {"both": Curve(np.sqrt(edges[1:] * edges[:-1]) * spacing, total, weight)}


def _bins_to(longest: float) -> int:
    return max(int(np.log2(longest) * LENGTHS_PER_OCTAVE), 0)


def _islands(heights, known, level):
    """Area, perimeter (cells) and block of every island and lake that ends within the surface."""
    above = known & (heights > level)
    islands, n_islands = ndimage.label(above)
    lakes, n_lakes = ndimage.label(known & ~above)
    lakes[lakes > 0] += n_islands
    # Number 0 is what was not measured, and a rim round the grid.
    label = np.pad(islands + lakes, 1)
    n = n_islands + n_lakes + 1
    perimeter, ends = np.zeros(n), np.ones(n, bool)
    for first, second in ((label[1:], label[:-1]), (label[:, 1:], label[:, :-1])):
        border = first != second
        first, second = first[border], second[border]
        perimeter += np.bincount(first, minlength=n) + np.bincount(second, minlength=n)
        ends[first[second == 0]] = ends[second[first == 0]] = False
    ends[0] = False
    inner = label[1:-1, 1:-1].ravel()
    area = np.bincount(inner, minlength=n)
    block = np.zeros(n, int)
    for places in np.indices(heights.shape):
        middle = ratio(np.bincount(inner, places.ravel(), n), area)
        side = places.max() + 1
        block = block * BLOCKS + np.where(area > 0, middle, 0).astype(int) * BLOCKS // side
    return area[ends], perimeter[ends], block[ends]
