"""Cube counting: the mean height range over square columns of side b grows as b^H."""

import numpy as np

from roughcontact.kernel_cache import njit

from ..curves import BLOCKS, WINDOW_COVER, Curve, in_blocks, lengths_in_cells
from ..estimator import Estimator
from ..known_bias import POINTS, Fit, tabulated_mean
from ..spectrum_model import BAND_LIMITED

#: Ratio of the sides of columns to the lags of the fit range.
FACTOR = 1.0

#: Mean H by the slope on the synthetic surfaces of `known_bias.SYNTHETIC_HURST`.
_MEAN_HURST = {
    BAND_LIMITED: (0.407, 0.500, 0.611, 0.730, 0.786, 0.836, 0.858),
    POINTS: (0.311, 0.452, 0.587, 0.720, 0.781, 0.835, 0.859),
}
#: Mean H by the slope over the short range.
_MEAN_HURST_SHORT = {
    BAND_LIMITED: (0.501, 0.580, 0.674, 0.779, 0.830, 0.876, 0.896),
    POINTS: (0.395, 0.521, 0.642, 0.765, 0.824, 0.876, 0.899),
}


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


def expected_hurst(fit: Fit, sampling: str) -> np.ndarray:
    """Mean H of surfaces whose curve has this slope.

    A column of few nodes misses peaks between them; levelling takes from the widest columns.
    """
    means = _MEAN_HURST[sampling], _MEAN_HURST_SHORT[sampling]
    return tabulated_mean(fit, *means, factor=FACTOR, second_differences=1.5)


ESTIMATOR = Estimator(
    place=60,
    curves=cube_counting_curves,
    slope_per_hurst=1,
    slope_at_zero=0,
    length="cube side",
    measure="mean height range over the column",
    units="mm",
    factor=FACTOR,
    spread=1.65,
    expected_hurst=expected_hurst,
    nodes=BAND_LIMITED,  # its means are of surfaces made on the grid
)
