"""Known bias of the slopes of the estimators' curves: their mean on surfaces of known exponent.

Four effects, known beforehand, make the slope of a curve differ from that of a power law:

- levelling takes a part of the long waves off along with the plane;
- a grid does not show waves shorter than two nodes. If they were taken out - by the spot of an
  instrument, by averaging, or because a surface was made on the grid - all nodes lack their
  roughness, which makes the short end of a curve too low (`BAND_LIMITED`). If single points of a
  finer surface were taken they are there in full, and look like longer waves in a spectrum
  (`POINTS`). Nothing in heights alone decides for sure which of the two they are;
- a surface that rolls off lacks long waves (:mod:`roughness.roll_off`);
- a column of few nodes misses peaks, and a small island has no lakes.

All of it belongs to an isotropic surface that is self-affine at all lengths, or up to its roll-off.
Levelling and missing waves follow from the mean square difference of such a surface alone, h^(2H)
below a roll-off; the rest was measured on synthetic surfaces. The bias of a single estimator
stands in its own file.
"""

from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
from scipy import special

from .curves import ratio
from .roll_off import HURST_GRID, SHARP, levelled_slope_fraction, second_difference_fraction
from .spectrum_model import ALIASED, BAND_LIMITED

#: Nodes as points of a finer surface, the sampling other than `BAND_LIMITED` (docstring of this
#: module).
POINTS = ALIASED

#: Exponents of the synthetic surfaces from which the bias of cubes and islands was measured: means
#: over 50 of 256 x 256 and 40 of 512 x 512, fitted over the default range; from a spectrum
#: (`synthesis.self_affine`), and points of fractional Brownian surfaces (Stein, J. Comput. Graph.
#: Stat. 11 (2002) 587). The means differ by up to 0.03 between the two sizes; a very different
#: range makes them differ more.
SYNTHETIC_HURST = np.array([0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95])
#: Lags (cells) in the middle of the default range, 4 to 32 on 256 x 256, and of the short range,
#: 8/3 to 8, over which 16 of the surfaces of 256 x 256 were measured, too.
DEFAULT_RANGE, SHORT_RANGE = 11.0, 5.0
#: Least rise of a mean exponent with the true one.
MIN_RISE = 0.3


class Fit(NamedTuple):
    """Fit of the slope of a curve: lengths, size of the surface, axis and spectrum."""

    length: np.ndarray
    """Lengths (k,), cells."""
    side: float
    """Side of a square as large as the surface, cells."""
    axis: str
    """Axis of the curve: "both", "x" or "y"."""
    roll_off: float = np.inf
    """Wavelength above which the spectrum is flat, cells; infinite without one."""
    shape: str = SHARP
    """Shape of the roll-off, of `roll_off.SHAPES`."""


def slopes(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Least-squares slopes of the rows of y (rows, k) over x (k,), where y is finite."""
    finite = np.isfinite(y)
    n = finite.sum(axis=1)
    enough = n >= 2
    n = np.where(enough, n, 1)
    mean_x = np.sum(finite * x, axis=1) / n
    dx = np.where(finite, x - mean_x[:, np.newaxis], 0)
    product = np.sum(dx * np.where(finite, y, 0), axis=1)
    return ratio(product, np.where(enough, np.sum(dx**2, axis=1), 0))


def extended(x: np.ndarray, known: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Linear interpolation, extrapolated beyond both ends of the rising `known`."""
    interval = np.clip(np.searchsorted(known, x), 1, len(known) - 1)
    left, right = known[interval - 1], known[interval]
    part = (x - left) / (right - left)
    return values[interval - 1] + part * (values[interval] - values[interval - 1])


# -- parts of a surface whose mean square difference is h^(2H), at `HURST_GRID` --------------------


@cache
def levelled_slope() -> np.ndarray:
    """Mean square slope (of one axis) that levelling takes off a square of side 1.

    The slope of the least-squares plane is the integral of 12 (x - 1/2) z, whose mean square
    follows from the differences alone.
    """
    return -_mean_over_pairs(lambda u, v: 12 * (1 - 3 * u + 2 * u**3) * (1 - v)) / 2


@cache
def square_about_plane() -> np.ndarray:
    """Mean square about the least-squares plane of a square of side 1.

    Half the mean square difference of all its pairs of points, less the plane's mean square.
    """
    pairs = _mean_over_pairs(lambda u, v: (1 - u) * (1 - v))
    return pairs / 2 - levelled_slope() / 6


@cache
def square_about_line() -> np.ndarray:
    """Mean square about its least-squares line of a profile of length 1: 1/15 for H = 1/2."""
    exponent = 2 * HURST_GRID
    pairs = 2 / ((exponent + 1) * (exponent + 2))
    slope = 36 / (exponent + 2) - 12 / (exponent + 1) - 24 / (exponent + 4)
    return pairs / 2 - slope / 12


def _mean_over_pairs(weight) -> np.ndarray:
    """4 times the integral of weight(u, v) (u^2 + v^2)^H over differences u, v from 0 to 1."""
    points, weights = np.polynomial.legendre.leggauss(64)
    u, w = (points + 1) / 2, weights / 2
    distance = u[:, np.newaxis] ** 2 + u**2
    part = np.outer(w, w) * weight(u[:, np.newaxis], u)
    return np.array([4 * np.sum(part * distance**h) for h in HURST_GRID])


@cache
def unresolved() -> np.ndarray:
    """Mean square difference due to all waves shorter than two nodes along an axis, node to node.

    Points of a grid show these waves as noise, which differs by the same at every lag. Integrals of
    C(q) = q^(-2 - 2H) outside the square of resolved waves, and of C(q) (1 - cos q_x) over all.
    """
    points, weights = np.polynomial.legendre.leggauss(16)
    h = HURST_GRID[:, np.newaxis]
    angle, w = np.pi / 8 * (points + 1), np.pi / 8 * weights
    outside = (
        4 / h * np.pi ** (-2 * h) * np.sum(w * np.cos(angle) ** (2 * h), axis=1, keepdims=True)
    )
    whole = np.pi * special.gamma(1 - h) / (4**h * h * special.gamma(1 + h))
    return (outside / whole)[:, 0]


# -- mean exponents by the slope -------------------------------------------------------------------


def levelled_fraction(fit: Fit, fraction: np.ndarray) -> np.ndarray:
    """Fraction of the power law that levelling took, (exponents, k): it grows as length^2.

    ``fraction`` (exponents,) is that of a length as long as the surface, without a roll-off.
    """
    at_side = fraction[:, np.newaxis] * levelled_slope_fraction(
        np.array([fit.side / fit.roll_off]), fit.shape
    )
    return at_side * (fit.length / fit.side) ** (2 - 2 * HURST_GRID[:, np.newaxis])


def short_wave_fraction(fit: Fit, sampling: str, fraction: float | np.ndarray) -> np.ndarray:
    """Fraction of the power law that missing short waves have, (exponents, k).

    0 but for a `BAND_LIMITED` surface. ``fraction`` is the mean square of noise over that of its
    differences, both in units of the surface's own: one number or (exponents,).
    """
    missing = fraction * unresolved() * (sampling == BAND_LIMITED)
    return missing[:, np.newaxis] * fit.length ** (-2 * HURST_GRID[:, np.newaxis])


def hurst_of_mean_square(fit: Fit, kept: np.ndarray) -> np.ndarray:
    """Mean exponents by the slope, from the fractions (exponents, k) of the power law kept."""
    return HURST_GRID + slopes(np.log(fit.length), np.log(np.maximum(kept, 1e-12))) / 2


def tabulated_mean(
    fit: Fit,
    of_default: Sequence[float],
    of_short: Sequence[float],
    *,
    factor: float,
    second_differences: float,
) -> np.ndarray:
    """Mean exponents by the slope of a measure tabulated from synthetic surfaces, (exponents,).

    ``of_default`` and ``of_short`` (7,) are mean results at `SYNTHETIC_HURST` over the default
    range, and over `SHORT_RANGE`; linear in between in the logarithm of the mean length, since
    short columns and small islands are the source of the bias. ``factor`` is the ratio of the
    estimator's lengths to lags, ``second_differences`` the ratio of the effects of a roll-off on
    the measure and on second differences at lags as long.
    """
    long, short = np.log(DEFAULT_RANGE), np.log(SHORT_RANGE)
    part = np.clip((long - np.mean(np.log(fit.length / factor))) / (long - short), 0, 1)
    mean = (1 - part) * np.array(of_default) + part * np.array(of_short)
    left = second_difference_fraction(fit.length / fit.roll_off, fit.shape)
    of_roll_off = hurst_of_mean_square(fit, left) - HURST_GRID
    result = extended(HURST_GRID, SYNTHETIC_HURST, mean) + second_differences * of_roll_off
    # Below a short roll-off the slope hardly depends on H: this bounds the amplification.
    line = MIN_RISE * HURST_GRID
    return np.maximum.accumulate(result - line) + line
