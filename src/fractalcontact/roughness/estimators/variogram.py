"""Variogram: the mean square height difference over a lag h grows as h^(2H)."""

import numpy as np

from ..curves import Curve, add_squares, along_axes, lengths_in_cells
from ..estimator import Estimator
from ..known_bias import (
    Fit,
    hurst_of_mean_square,
    levelled_fraction,
    levelled_slope,
    short_wave_fraction,
)
from ..roll_off import difference_fraction


def variogram_curves(
    heights: np.ndarray, spacing: float, lags: np.ndarray | None = None
) -> dict[str, Curve]:
    """Mean square height difference (mm2) over lags (mm): grows as h^(2H).

    Lags are stated in cells; by default they go up to half of the smaller side.
    """
    if lags is None:
        lags = lengths_in_cells(1, min(heights.shape) // 2)
    return along_axes(spacing, lags, heights, _add_differences)


def _add_differences(heights, lag, total, weight):
    add_squares(heights[:, lag:] - heights[:, :-lag], lag, total, weight)


def expected_hurst(fit: Fit, sampling: str) -> np.ndarray:
    """Mean H that the slope of such a fit gives, at each true H of `HURST_GRID`.

    Levelling, roll-off and missing short waves lower the curve.
    """
    left = difference_fraction(fit.length / fit.roll_off, fit.shape)
    levelled = levelled_fraction(fit, levelled_slope())
    return hurst_of_mean_square(fit, left - levelled - short_wave_fraction(fit, sampling, 1))


ESTIMATOR = Estimator(
    place=10,
    curves=variogram_curves,
    slope_per_hurst=2,
    slope_at_zero=0,
    length="lag",
    measure="mean square difference",
    units="mm2",
    factor=1,
    spread=1.75,
    expected_hurst=expected_hurst,
)
