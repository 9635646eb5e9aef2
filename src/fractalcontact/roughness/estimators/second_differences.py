"""Second differences: their mean square over a lag h grows as h^(2H)."""

import numpy as np

from roughcontact.kernel_cache import njit

from ..curves import BLOCKS, Curve, along_axes, lengths_in_cells, pairs_in_block
from ..estimator import Estimator
from ..known_bias import HURST_GRID, Fit, hurst_of_mean_square, short_wave_fraction
from ..roll_off import second_difference_fraction

#: Mean square second difference of independent errors over that of their differences, both in
#: units of the surface's own.
NOISE = 3 / (4 - 4**HURST_GRID)


def second_difference_curves(heights: np.ndarray, spacing: float) -> dict[str, Curve]:
    """Mean square second difference (mm2) over lags (mm): grows as h^(2H).

    Blind to any plane, and free of the variogram's bias at high H (Kent & Wood, J. R. Stat. Soc. B
    59 (1997) 679).
    """
    lags = lengths_in_cells(1, min(heights.shape) // 4)
    return along_axes(spacing, lags, heights, _add_second_differences)


@njit(cache=True)
def _add_second_differences(heights, lag, total, weight):
    """Add squares of second differences along x to the blocks that hold their middles.

    As :func:`roughness.curves.add_squares`, but without an array of the differences: that of a
    large scan does not fit the processor's cache.
    """
    ny, nx = heights.shape
    for i in range(ny):
        row = i * BLOCKS // ny
        for column in range(BLOCKS):
            squares, n = 0.0, 0
            for j in range(*pairs_in_block(column, nx, 2 * lag)):
                d = heights[i, j + 2 * lag] - 2 * heights[i, j + lag] + heights[i, j]
                if np.isfinite(d):
                    squares += d * d
                    n += 1
            total[row, column] += squares
            weight[row, column] += n


def expected_hurst(fit: Fit, sampling: str) -> np.ndarray:
    """Mean H of surfaces whose curve has this slope.

    Second differences of noise are 3 times its differences, those of the surface 4 - 4^H times.
    """
    left = second_difference_fraction(fit.length / fit.roll_off, fit.shape)
    return hurst_of_mean_square(fit, left - short_wave_fraction(fit, sampling, NOISE))


ESTIMATOR = Estimator(
    place=20,
    curves=second_difference_curves,
    slope_per_hurst=2,
    slope_at_zero=0,
    length="lag",
    measure="mean square second difference",
    units="mm2",
    factor=1,
    spread=1.3,
    expected_hurst=expected_hurst,
)
