"""The estimators of the Hurst exponent: what their curves grow as, and what is known of their bias.

The slope of a curve says H but for three things that are known beforehand: what levelling takes
off, what a column of few nodes misses, and how much less the parts of one surface differ than
surfaces do.
"""

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np

from .area_curves import cube_counting_curves, slit_island_curves, triangular_prism_curves
from .curves import (
    Curve,
    power_spectrum_curves,
    ratio,
    roughness_length_curves,
    second_difference_curves,
    variogram_curves,
)

#: Exponents at which it is known what a biased estimator finds.
HURST_GRID = np.linspace(0.02, 0.98, 97)


class Estimator(NamedTuple):
    """One way of measuring H."""

    curves: Callable[[np.ndarray, float], dict[str, Curve]]
    """Takes heights and spacing in mm; gives curves by axis: "both", and "x", "y" where the measure
    can be taken along one axis alone."""
    slope_per_hurst: float
    slope_at_zero: float
    """d log(measure) / d log(length) = slope_at_zero + slope_per_hurst H."""
    length: str
    measure: str
    units: str
    factor: float
    """The fit range, stated as a lag, is this many times longer for the estimator's own length."""
    spread: float
    """How many times the jackknife's standard error the scatter between surfaces is. Parts of one
    surface share its long waves, and so are more alike than surfaces are. Mean over H from 0.3 to
    0.95 on made surfaces (50 of 256 x 256, 40 of 512 x 512)."""
    found: Callable[[np.ndarray], np.ndarray] | None = None
    """What the slope says on average at each of `HURST_GRID` when it is fitted at lengths given in
    parts of the surface's side; None where that is H itself."""


def slopes(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Least-squares slopes of the rows of y (rows, k) over x (k,), where y is finite."""
    known = np.isfinite(y)
    n = known.sum(axis=1)
    enough = n >= 2
    n = np.where(enough, n, 1)
    mean_x = np.sum(known * x, axis=1) / n
    dx = np.where(known, x - mean_x[:, np.newaxis], 0)
    product = np.sum(dx * np.where(known, y, 0), axis=1)
    return ratio(product, np.where(enough, np.sum(dx**2, axis=1), 0))


# -- what biased estimators find -------------------------------------------------------------------


@cache
def levelled_slope() -> np.ndarray:
    """Mean square slope (of one axis) that levelling takes off a surface, at `HURST_GRID`.

    For the mean square difference h^(2H) on a square of side 1. The slope of the least-squares
    plane is the integral of 12 (x - 1/2) z, whose mean square follows from the differences alone.
    """
    points, weights = np.polynomial.legendre.leggauss(64)
    u, w = (points + 1) / 2, weights / 2
    overlap_x = 12 * (1 - u) ** 3 - 36 * u**2 * (1 - u)
    distance = u[:, np.newaxis] ** 2 + u**2
    part = (w * overlap_x)[:, np.newaxis] * (w * (1 - u))
    return np.array([-2 * np.sum(part * distance**h) for h in HURST_GRID])


def _found_after_levelling(length: np.ndarray, plane: np.ndarray) -> np.ndarray:
    """Mean exponents found where the plane's part of the mean square is plane (h/b)^(2 - 2H)."""
    left = 1 - plane[:, np.newaxis] * length ** (2 - 2 * HURST_GRID[:, np.newaxis])
    return HURST_GRID + slopes(np.log(length), np.log(np.maximum(left, 1e-12))) / 2


def _found_by_variogram(length: np.ndarray) -> np.ndarray:
    return _found_after_levelling(length, levelled_slope())


def _found_by_prisms(length: np.ndarray) -> np.ndarray:
    """A facet's mean square rise is 1 + 2^(H-1) times the mean square difference, both axes'."""
    return _found_after_levelling(length, 2 * levelled_slope() / (1 + 2 ** (HURST_GRID - 1)))


def _found_by_cubes(length: np.ndarray) -> np.ndarray:
    """A column of few nodes misses peaks between them; levelling takes from the widest columns."""
    return _found_on_made_surfaces((0.407, 0.500, 0.611, 0.730, 0.786, 0.836, 0.858))


def _found_by_islands(length: np.ndarray) -> np.ndarray:
    """Small islands have no lakes yet, and each coast alone is smoother than all of them."""
    return _found_on_made_surfaces((0.411, 0.520, 0.633, 0.747, 0.794, 0.835, 0.857))


def _found_on_made_surfaces(found: tuple[float, ...]) -> np.ndarray:
    """Means over made surfaces, 50 of 256 x 256 and 40 of 512 x 512, fitted over the default range.

    They differ by up to 0.03 between the two sizes, and will by more for a very different range.
    """
    known = np.array([0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95])
    return extended(HURST_GRID, known, np.array(found))


def extended(x: np.ndarray, known: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Linear interpolation that goes straight on beyond both ends of the rising `known`."""
    interval = np.clip(np.searchsorted(known, x), 1, len(known) - 1)
    left, right = known[interval - 1], known[interval]
    part = (x - left) / (right - left)
    return values[interval - 1] + part * (values[interval] - values[interval - 1])


#: The estimators by name. The factor makes each look at about the same waves: a wave of length l
#: is seen by a lag of l/2, by a window of l, by second differences over 2 lags = l. Of
#: islands there are too few at the long end.
ESTIMATORS = {
    "variogram": Estimator(
        variogram_curves,
        slope_per_hurst=2,
        slope_at_zero=0,
        length="lag",
        measure="mean square difference",
        units="mm2",
        factor=1,
        spread=1.75,
        found=_found_by_variogram,
    ),
    "second_differences": Estimator(
        second_difference_curves,
        slope_per_hurst=2,
        slope_at_zero=0,
        length="lag",
        measure="mean square second difference",
        units="mm2",
        factor=1,
        spread=1.3,
    ),
    "roughness_length": Estimator(
        roughness_length_curves,
        slope_per_hurst=2,
        slope_at_zero=0,
        length="window side",
        measure="mean square height about the local plane",
        units="mm2",
        factor=2,
        spread=1.25,
    ),
    "power_spectrum": Estimator(
        power_spectrum_curves,
        slope_per_hurst=2,
        slope_at_zero=1,
        length="wavelength",
        measure="power spectral density of profiles",
        units="mm3",
        factor=2,
        spread=1.2,
    ),
    "triangular_prism": Estimator(
        triangular_prism_curves,
        slope_per_hurst=1,
        slope_at_zero=-1,
        length="prism side",
        measure="mean facet slope",
        units="1",
        factor=1,
        spread=2.0,
        found=_found_by_prisms,
    ),
    "cube_counting": Estimator(
        cube_counting_curves,
        slope_per_hurst=1,
        slope_at_zero=0,
        length="cube side",
        measure="mean height range over the column",
        units="mm",
        factor=1,
        spread=1.65,
        found=_found_by_cubes,
    ),
    "slit_islands": Estimator(
        slit_island_curves,
        slope_per_hurst=-1,
        slope_at_zero=1,
        length="root of the area",
        measure="perimeter over root of the area",
        units="1",
        factor=0.75,
        spread=1.0,
        found=_found_by_islands,
    ),
}
