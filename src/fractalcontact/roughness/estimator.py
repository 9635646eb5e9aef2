"""Declaration of an estimator of the Hurst exponent."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from .curves import Curve
from .known_bias import POINTS, Fit


class Estimator(NamedTuple):
    """An estimator of H: from the slope of a curve that grows as a power of a length."""

    place: int
    """Place among all estimators, each its own: results and figures come in this order."""
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
    """The fit range, stated as a lag, is this many times longer for the estimator's own length, so
    that all look at about the same waves: a wave of length l is seen by a lag of l/2, by a window
    of l, by second differences over 2 lags = l."""
    spread: float
    """How many times the jackknife's standard error the scatter between surfaces is. Parts of one
    surface share its long waves, and so are more alike than surfaces are. Mean over H from 0.3 to
    0.95 on synthetic surfaces (50 of 256 x 256, 40 of 512 x 512)."""
    expected_hurst: Callable[[Fit, str], np.ndarray]
    """H that the slope of such a fit gives on average at each of `known_bias.HURST_GRID`, if the
    nodes are `known_bias.POINTS` or those of a `spectrum_model.BAND_LIMITED` surface."""
    nodes: str = POINTS
    """What the nodes are taken for, `POINTS` or `BAND_LIMITED`.

    Errors of measurement make short lags too rough, as missing waves make them too smooth: of scans
    neither is taken off.
    """
