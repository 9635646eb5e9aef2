"""Triangular prisms: the mean slope of their facets of side b grows as b^(H - 1)."""

import numpy as np

from roughcontact.kernel_cache import njit

from ..curves import BLOCKS, Curve, in_blocks, lengths_in_cells
from ..estimator import Estimator
from ..known_bias import (
    HURST_GRID,
    Fit,
    hurst_of_mean_square,
    levelled_fraction,
    levelled_slope,
    short_wave_fraction,
)
from ..roll_off import rise_fraction

#: Starts of prisms per side: prisms of side b start every b / PRISM_STEPS cells, as closer ones add
#: nothing.
PRISM_STEPS = 4


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


def expected_hurst(fit: Fit, sampling: str) -> np.ndarray:
    """Mean H of surfaces whose curve has this slope.

    A facet's mean square rise is 1 + 2^(H - 1) times the mean square difference. Levelling takes
    both axes' part from it, and of noise it is 1 1/2 times the difference.
    """
    rise = 1 + 2 ** (HURST_GRID - 1)
    levelled = levelled_fraction(fit, 2 * levelled_slope() / rise)
    missing = short_wave_fraction(fit, sampling, 1.5 / rise)
    left = rise_fraction(fit.length / fit.roll_off, fit.shape)
    return hurst_of_mean_square(fit, left - levelled - missing)


ESTIMATOR = Estimator(
    place=50,
    curves=triangular_prism_curves,
    slope_per_hurst=1,
    slope_at_zero=-1,
    length="prism side",
    measure="mean facet slope",
    units="1",
    factor=1,
    spread=2.0,
    expected_hurst=expected_hurst,
)
