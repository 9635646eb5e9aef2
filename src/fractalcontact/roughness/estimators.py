"""The estimators of the Hurst exponent: what their curves grow as, and what is known of their bias.

The slope of a curve says H but for what is known beforehand: its bias
(:mod:`roughness.known_bias`), and how much less the parts of one surface differ than surfaces
do.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from .area_curves import cube_counting_curves, slit_island_curves, triangular_prism_curves
from .curves import (
    Curve,
    power_spectrum_curves,
    roughness_length_curves,
    second_difference_curves,
    variogram_curves,
)
from .known_bias import (
    POINTS,
    Fit,
    found_by_cubes,
    found_by_islands,
    found_by_power_spectrum,
    found_by_prisms,
    found_by_roughness_length,
    found_by_second_differences,
    found_by_variogram,
)
from .spectrum_model import BAND_LIMITED


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
    found: Callable[[Fit, str], np.ndarray]
    """What the slope of such a fit says on average at each of `known_bias.HURST_GRID`, if the nodes
    are `known_bias.POINTS` or those of a `spectrum_model.BAND_LIMITED` surface."""
    nodes: str = POINTS
    """What they are taken for. Errors of measurement make short lags too rough, as missing waves
    make them too smooth: of scans neither is taken off. Cubes and islands were tried on
    band-limited surfaces first."""


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
        found=found_by_variogram,
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
        found=found_by_second_differences,
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
        found=found_by_roughness_length,
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
        found=found_by_power_spectrum,
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
        found=found_by_prisms,
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
        found=found_by_cubes,
        nodes=BAND_LIMITED,
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
        found=found_by_islands,
        nodes=BAND_LIMITED,
    ),
}
