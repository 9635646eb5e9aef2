"""Roll-off of a surface: its effect on each measure, and its detection.

A surface whose spectrum is flat above a wavelength lacks long waves. Mean squares then grow more
slowly than h^(2H), and do so long before that wavelength: the variogram loses a part that grows as
h^(2 - 2H), like the part that levelling takes. The spectrum of the model is C(q) = q^(-2 (1 + H))
above q_r = 2 pi / roll-off and C(q_r) below (Persson et al., J. Phys. Condens. Matter 17 (2005)
R1), or von Karman's (q^2 + q_r^2)^(-1 - H), which bends over an octave or two. All else follows
from it. Fractions are of the power law that the same surface has without a roll-off: functions
``..._fraction`` take (k,) ratios of a length to the roll-off, 0 without one, and a shape of
`SHAPES`, and return (exponents, k).
"""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from scipy import special

from ..core.estimate import Estimate
from ..core.intervals import t_quantile
from .curves import Curve, jackknife_standard_error
from .spectrum_model import ALIASED, BAND_LIMITED

#: Exponents at which the mean result of every estimator is tabulated.
HURST_GRID = np.linspace(0.02, 0.98, 97)

#: Lengths over the roll-off at which fractions are tabulated; shorter ones lack nearly nothing.
SHARES = np.geomspace(2.0**-12, 2.0**5, 137)

#: Shortest lag, cells, of the search for a roll-off: shorter ones show the grid more.
FIRST_LAG = 2
#: Shortest roll-off of the search, cells, and steps in each doubling.
SHORTEST, STEPS_PER_OCTAVE = 8, 6
#: Longest roll-off over the longest lag of the second differences (which see waves of twice that).
LONGEST_PER_LAG = 4.0
#: Spread of neighbouring parts of one surface, which share its long waves
#: (`estimator.Estimator.spread`), and least relative error of a mean.
SPREAD, MIN_ERROR = 1.3, 0.03
#: Least drop of chi-square from the best power law to a roll-off that is seen.
EVIDENCE = 20.0
#: Least rise of chi-square above the best of a roll-off that is excluded.
EXCLUDED = 4.0


#: Forms of the spectrum C(q) about q_r: flat below it, or (q^2 + q_r^2)^(-1 - H), von Karman's.
SHARP, SMOOTH = SHAPES = ("sharp", "smooth")


@dataclass(frozen=True)
class RollOff(Estimate):
    """Wavelength above which a spectrum is flat, in the unit of the curve.

    Infinite where none is seen; its lower end then is the shortest that is not excluded. ``shape``
    of `SHAPES` describes the curve best, ``others`` are shapes and wavelengths nearly as good.
    """

    shape: str = SHARP
    others: tuple[tuple[str, float], ...] = ()

    def scaled(self, factor: float) -> "RollOff":
        """This roll-off in another unit of length."""
        others = tuple((shape, factor * length) for shape, length in self.others)
        value, low, high = (factor * end for end in self.ends)
        return replace(self, value=value, low=low, high=high, others=others)

    def cases(self) -> tuple[tuple[str, float], ...]:
        """All shapes and wavelengths that an estimate must allow for, the best first."""
        own = tuple((self.shape, length) for length in self.ends)
        return tuple(dict.fromkeys((*own, *self.others)))


# -- fractions left by a roll-off, (exponents, lengths) --------------------------------------------


@cache
def _difference_table(shape: str) -> np.ndarray:
    """Fraction of the mean square difference (exponents, `SHARES`)."""
    return 1 - _quadratic_part(SHARES, shape) - _beyond_quadratic_table(shape)


def _quadratic_part(share: np.ndarray, shape: str) -> np.ndarray:
    """Part of the missing fraction that grows as h^2 / h^(2H): that of a random plane."""
    h = HURST_GRID[:, np.newaxis]
    half = np.pi * share
    if shape == SMOOTH:
        return half ** (2 - 2 * h) * special.gamma(1 + h) / special.gamma(2 - h)
    return half**2 * (2 * half) ** (-2 * h) * (1 / (2 - 2 * h) - 0.25) / _whole()


def _whole() -> np.ndarray:
    """Integral of q^(-1 - 2H) (1 - J0(q)) over all q, (exponents, 1)."""
    h = HURST_GRID[:, np.newaxis]
    return special.gamma(1 - h) / (2 ** (2 * h + 1) * h * special.gamma(1 + h))


@cache
def _beyond_quadratic_table(shape: str) -> np.ndarray:
    """Rest of the missing fraction (exponents, `SHARES`).

    h^(2H) belongs to the integral of q^(-1 - 2H) (1 - J0(q h)) over all q. Of it (q^(-2 - 2H) -
    q_r^(-2 - 2H)) q (1 - J0(q h)) below q_r is missing where the roll-off is sharp. A smooth one
    leaves the correlation 2^(1 - H) z^H K_H(z) / Gamma(H), z = q_r h (von Karman; Matern).
    """
    h = HURST_GRID[:, np.newaxis]
    z = 2 * np.pi * SHARES
    if shape == SMOOTH:
        uncorrelated = 1 - 2 ** (1 - h) * z**h * special.kv(h, z) / special.gamma(h)
        power = special.gamma(1 - h) / special.gamma(1 + h) * (z / 2) ** (2 * h)
        return 1 - uncorrelated / power - _quadratic_part(SHARES, SMOOTH)
    points, weights = np.polynomial.legendre.leggauss(256)
    u, w = (points + 1) / 2, weights / 2
    zu = z[:, np.newaxis] * u
    beyond = 1 - special.j0(zu) - zu**2 / 4
    beyond = np.where(zu < 0.05, -(zu**4) / 64 * (1 - zu**2 / 36), beyond)
    return (((u ** (-1 - 2 * h) - u) * w) @ beyond.T) * z ** (-2 * h) / _whole()


def _looked_up(table: np.ndarray, share: np.ndarray) -> np.ndarray:
    """Linear interpolation over the logarithm of the share; 1 without a roll-off."""
    place = np.log(np.maximum(share, SHARES[0]) / SHARES[0]) / np.log(SHARES[1] / SHARES[0])
    place = np.minimum(place, len(SHARES) - 1.001)
    before = place.astype(int)
    part = place - before
    fraction = (1 - part) * table[:, before] + part * table[:, before + 1]
    return np.where(share > 0, fraction, 1.0)


def difference_fraction(share: np.ndarray, shape: str = SHARP) -> np.ndarray:
    """Fraction left of the mean square difference D(h) at a lag h."""
    return _looked_up(_difference_table(shape), np.asarray(share, float))


def second_difference_fraction(share: np.ndarray, shape: str = SHARP) -> np.ndarray:
    """Fraction left of the mean square second difference 4 D(h) - D(2h)."""
    return _looked_up(_second_difference_table(shape), np.asarray(share, float))


@cache
def _second_difference_table(shape: str) -> np.ndarray:
    ratio = 4 ** HURST_GRID[:, np.newaxis]
    of_both = 4 * difference_fraction(SHARES, shape)
    of_both = of_both - ratio * difference_fraction(2 * SHARES, shape)
    return of_both / (4 - ratio)


def rise_fraction(share: np.ndarray, shape: str = SHARP) -> np.ndarray:
    """Fraction left of a prism facet's mean square rise D(b) + D(sqrt(2) b) / 2."""
    share = np.asarray(share, float)
    ratio = 2 ** (HURST_GRID[:, np.newaxis] - 1)
    across = difference_fraction(np.sqrt(2) * share, shape)
    return (difference_fraction(share, shape) + ratio * across) / (1 + ratio)


def levelled_slope_fraction(share: np.ndarray, shape: str = SHARP) -> np.ndarray:
    """Fraction left of the mean square slope of the plane of a square, by its side."""
    return _looked_up(_over_pairs("slope", shape), np.asarray(share, float))


def about_plane_fraction(share: np.ndarray, shape: str = SHARP) -> np.ndarray:
    """Fraction left of the mean square about the plane of a square, by its side."""
    return _looked_up(_over_pairs("plane", shape), np.asarray(share, float))


def about_line_fraction(share: np.ndarray, shape: str = SHARP) -> np.ndarray:
    """Fraction left of a profile's mean square about its line, by its length."""
    return _looked_up(_over_pairs("line", shape), np.asarray(share, float))


@cache
def _over_pairs(of: str, shape: str) -> np.ndarray:
    """Fractions of means over all pairs of points of a square, or of a profile.

    The slope of the least-squares plane is the integral of 12 (x - 1/2) z; the mean square about
    the plane half the mean square difference of all pairs, less the plane's own.
    """
    points, weights = np.polynomial.legendre.leggauss(32)
    u, w = (points + 1) / 2, weights / 2
    if of == "line":
        distance, pairs = u, 2 * w * (1 - u) / 2
        slope = -w * 12 * (1 - 3 * u + 2 * u**3)
        held = 1 / 12
    else:
        distance = np.hypot(u[:, np.newaxis], u).ravel()
        pairs = 4 * np.outer(w * (1 - u), w * (1 - u)).ravel() / 2
        slope = -4 * np.outer(w * 12 * (1 - 3 * u + 2 * u**3), w * (1 - u)).ravel() / 2
        held = 1 / 6
    weight = slope if of == "slope" else pairs - held * slope
    power = weight * distance ** (2 * HURST_GRID[:, np.newaxis])
    whole = np.sum(power, axis=1)
    left = np.empty((len(HURST_GRID), len(SHARES)))
    for column, share in enumerate(SHARES):
        if of == "slope" or share > 1:
            left[:, column] = (
                np.sum(power * difference_fraction(share * distance, shape), axis=1) / whole
            )
        else:  # heights about a plane do not depend on a missing plane
            rest = _looked_up(_beyond_quadratic_table(shape), share * distance)
            left[:, column] = 1 - np.sum(power * rest, axis=1) / whole
    return left


# -- detection -------------------------------------------------------------------------------------


def find_roll_off(curve: Curve, spacing: float, missing: np.ndarray) -> RollOff:
    """Roll-off, mm, of a surface by its second differences along both axes, lags in mm.

    ``missing`` (exponents,) is the mean square second difference of the waves that a band-limited
    surface lacks, over that of a lag of one cell, ``spacing`` the cell, mm.

    Second differences are blind to any plane, so that levelling takes nothing from them, and reach
    waves of half the side. Least squares of their logarithms, weighted by their jackknife errors,
    over all exponents and roll-offs and for both samplings of :mod:`roughness.known_bias`. A
    roll-off is seen where it lowers chi-square by `EVIDENCE`, and having none is excluded.
    Calibrated on synthetic surfaces without a roll-off: :mod:`experiments.delta_g`.
    """
    lag, measure = curve.length / spacing, curve.measure()
    without = curve.without_each_part()
    used = (lag >= FIRST_LAG) & (measure > 0) & (without > 0).all(axis=0)
    if used.sum() < 5 or len(without) < 2:
        return RollOff(np.inf, SHORTEST * spacing, np.inf)
    lag, logs = lag[used], np.log(np.vstack([measure, without])[:, used])
    error = np.hypot(SPREAD * jackknife_standard_error(logs[1:]), MIN_ERROR)
    steps = np.log2(LONGEST_PER_LAG * lag[-1] / SHORTEST) * STEPS_PER_OCTAVE
    tried = np.r_[SHORTEST * 2 ** (np.arange(max(steps, 0) + 1) / STEPS_PER_OCTAVE), np.inf]
    chi2 = np.stack([_chi_square(lag, logs, error, tried, missing, of) for of in SHAPES])
    shape = int(chi2[:, 0].min(axis=1).argmin())
    best = chi2[shape].argmin(axis=1)
    least = chi2[shape, 0, best[0]]
    scatter = max(1.0, least / max(len(lag) - 3, 1))
    limit = least + EXCLUDED * scatter
    if not (chi2[0, 0, -1] - least > EVIDENCE * scatter and (chi2[:, 0, -1] >= limit).all()):
        return _unseen(chi2[:, 0] < limit, spacing * tried)
    step = 2 ** (1 / STEPS_PER_OCTAVE)
    parts = np.log(np.minimum(tried[best[1:]], tried[-2]))
    half = t_quantile(len(parts) - 1) * SPREAD * float(jackknife_standard_error(parts))
    value = tried[best[0]] * step ** _lowest_between(chi2[shape, 0, best[0] - 1 : best[0] + 2])
    allowed = tried[chi2[shape, 0] < limit]
    low = min(allowed[0] / step, value * np.exp(-half))
    high = max(allowed[-1] * step, value * np.exp(half))
    others = tuple(
        (of, float(length))
        for of, row in zip(SHAPES, chi2, strict=True)
        if of != SHAPES[shape]
        for length in tried[row[0] < limit]
    )
    others = others[:: len(others) - 1 or 1]
    ends = float(value), float(low), float(high)
    return RollOff(*ends, shape=SHAPES[shape], others=others).scaled(spacing)


def _unseen(allowed: np.ndarray, tried: np.ndarray) -> RollOff:
    """Result without a roll-off: the shortest that is allowed of each shape (shapes, roll-offs
    tried).
    """
    shortest = tuple(
        (of, float(min(tried[np.argmax(row)], tried[-2])))
        for of, row in zip(SHAPES, allowed, strict=True)
    )
    return RollOff(np.inf, min(length for _, length in shortest), np.inf, others=shortest)


def _lowest_between(chi2: np.ndarray) -> float:
    """Steps from the middle of three values to the lowest point of their parabola, half at most."""
    if len(chi2) < 3 or not np.isfinite(chi2).all():
        return 0.0
    curvature = chi2[0] - 2 * chi2[1] + chi2[2]
    return float(np.clip((chi2[0] - chi2[2]) / (2 * curvature), -0.5, 0.5)) if curvature else 0.0


def _chi_square(lag, logs, error, tried, missing, shape) -> np.ndarray:
    """Least chi-square (rows of logs, roll-offs tried) over exponents and samplings."""
    exponent = 2 * HURST_GRID[:, np.newaxis]
    weight = error**-2 / np.sum(error**-2)
    best = np.full((len(logs), len(tried)), np.inf)
    for column, roll_off in enumerate(tried):
        left = second_difference_fraction(lag / roll_off, shape)
        for sampling in (ALIASED, BAND_LIMITED):
            lacking = missing[:, np.newaxis] * lag**-exponent * (sampling == BAND_LIMITED)
            model = exponent * np.log(lag) + np.log(np.maximum(left - lacking, 1e-12))
            model -= model @ weight[:, np.newaxis]
            scaled = model / error
            own = (logs - logs @ weight[:, np.newaxis]) / error
            product = own @ scaled.T
            square = np.sum(own**2, axis=1)[:, np.newaxis] + np.sum(scaled**2, axis=1)
            best[:, column] = np.minimum(best[:, column], (square - 2 * product).min(axis=1))
    return best
