"""Power spectrum of profiles: its density at a wavelength l grows as l^(1 + 2H)."""

import numpy as np

from ..curves import Curve, of_both_axes
from ..estimator import Estimator
from ..known_bias import HURST_GRID, Fit, hurst_of_mean_square
from ..roll_off import SMOOTH
from ..spectra import profile_spectra
from ..spectrum_model import rolled_off, sampled


def power_spectrum_curves(heights: np.ndarray, spacing: float) -> dict[str, Curve]:
    """Mean profile spectrum C(q) (mm3) against wavelength (mm): grows as l^(1 + 2H)."""
    return of_both_axes(profile_spectra(heights, (spacing, spacing)))


def expected_hurst(fit: Fit, sampling: str) -> np.ndarray:
    """Mean H of surfaces whose curve has this slope.

    Profiles lack waves that are short across them, or have short waves along them folded back.
    Their spectrum goes as q_x^-(1 + 2H); the shortest wave is two cells long. Where the surface
    rolls off, profiles also lack waves that are long across them.
    """
    slope = 1 + 2 * HURST_GRID[:, np.newaxis]
    kept = sampled(sampling, slope, 2 / fit.length)
    if np.isfinite(fit.roll_off):
        kept = kept * _rolled_off(fit, slope)
    return hurst_of_mean_square(fit, kept)


def _rolled_off(fit: Fit, slope: np.ndarray) -> np.ndarray:
    """Fraction left of the spectrum of profiles; a smooth one is (q_x^2 + q_r^2)^(-1/2 - H)."""
    if fit.shape == SMOOTH:
        return (1 + (fit.length / fit.roll_off) ** 2) ** (-slope / 2)
    return rolled_off(slope, 2 / fit.roll_off, 2 / fit.length)


ESTIMATOR = Estimator(
    place=40,
    curves=power_spectrum_curves,
    slope_per_hurst=2,
    slope_at_zero=1,
    length="wavelength",
    measure="power spectral density of profiles",
    units="mm3",
    factor=2,
    spread=1.2,
    expected_hurst=expected_hurst,
)
