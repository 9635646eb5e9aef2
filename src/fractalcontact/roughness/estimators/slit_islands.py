"""Slit islands: the perimeter of islands over the root of their area A grows as A^((1 - H) / 2)."""

import numpy as np
from scipy import ndimage

from ..curves import BLOCKS, LENGTHS_PER_OCTAVE, Curve, ratio
from ..estimator import Estimator
from ..known_bias import POINTS, Fit, tabulated_mean
from ..spectrum_model import BAND_LIMITED

#: Fractions of the surface that lie below the levels of the islands.
LEVELS = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)

#: Ratio of lengths to lags of the fit range: there are too few islands at the long end.
FACTOR = 0.75

#: Mean H by the slope on the synthetic surfaces of `known_bias.SYNTHETIC_HURST`.
_MEAN_HURST = {
    BAND_LIMITED: (0.411, 0.520, 0.633, 0.747, 0.794, 0.835, 0.857),
    POINTS: (0.269, 0.456, 0.602, 0.731, 0.777, 0.827, 0.848),
}
#: Mean H by the slope over the short range, smoothed: the standard errors are 0.01 to 0.02.
_MEAN_HURST_SHORT = {
    BAND_LIMITED: (0.526, 0.608, 0.672, 0.733, 0.762, 0.795, 0.815),
    POINTS: (0.370, 0.508, 0.617, 0.698, 0.733, 0.768, 0.790),
}


def slit_island_curves(heights: np.ndarray, spacing: float) -> dict[str, Curve]:
    """Perimeter of islands over the root of their area A, against that root (mm): A^((D - 1) / 2).

    Mandelbrot, Passoja & Paullay, Nature 308 (1984) 721: coasts of dimension D = Delta_g - 1.
    Islands and lakes of the `LEVELS`, connected along sides of cells; the shores of lakes and
    islands inside belong to the perimeter, and their area does not count. Islands that meet the rim
    or a missing cell are left out.
    """
    edges = np.geomspace(1, min(heights.shape) / 2, _bins_to(min(heights.shape) / 2) + 1)
    bins = len(edges) - 1
    total, weight = np.zeros((2, bins, BLOCKS**2))
    measured = np.isfinite(heights)
    levels = np.quantile(heights[measured], LEVELS) if measured.any() else []
    for level in levels:
        area, perimeter, block = _islands(heights, measured, level)
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


def _islands(heights, measured, level):
    """Area, perimeter (cells) and block of every island and lake that ends within the surface."""
    above = measured & (heights > level)
    islands, n_islands = ndimage.label(above)
    lakes, n_lakes = ndimage.label(measured & ~above)
    lakes[lakes > 0] += n_islands
    # Number 0 marks missing cells and a rim round the grid.
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


def expected_hurst(fit: Fit, sampling: str) -> np.ndarray:
    """Mean H of surfaces whose curve has this slope.

    Small islands have no lakes yet, and a single coast is smoother than all coasts together.
    """
    means = _MEAN_HURST[sampling], _MEAN_HURST_SHORT[sampling]
    return tabulated_mean(fit, *means, factor=FACTOR, second_differences=0.5)


ESTIMATOR = Estimator(
    place=70,
    curves=slit_island_curves,
    slope_per_hurst=-1,
    slope_at_zero=1,
    length="root of the area",
    measure="perimeter over root of the area",
    units="1",
    factor=FACTOR,
    spread=1.0,
    expected_hurst=expected_hurst,
    nodes=BAND_LIMITED,  # its means are of surfaces made on the grid
)
