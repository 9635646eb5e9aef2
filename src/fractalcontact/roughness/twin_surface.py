"""Twin surfaces: random surfaces with the spectrum, and if needed the heights, of a measured one.

They are Gaussian: filtered white noise. If skewness or kurtosis of the measured heights is larger
than chance gives a Gaussian surface of this spectrum, they are translation processes (Grigoriu,
J. Eng. Mech. 110 (1984) 610): each height of a Gaussian surface is replaced by the measured one of
its rank, and the covariance of that surface is chosen so that the result has the spectrum.
"""

from dataclasses import dataclass

import numpy as np
import scipy.fft
from scipy import special

from ..core.mean_plane import without_mean_plane
from ..core.text import short
from ..surface.synthesis import filtered_noise, grid_side
from .plane_spectrum import plane_spectrum

#: Least departure, standard deviations, of a moment from that of Gaussian heights beyond chance.
_BEYOND_CHANCE = 3.0
#: Largest excess kurtosis of the slopes of a surface that is like its twins, whose slopes have some
#: 0: steps and spikes, which no spectrum holds, raise it (21 of a granite face).
MAX_SLOPE_KURTOSIS = 3.0
#: Number of Hermite polynomials in the expansion of a distribution, and its normal deviates.
_POLYNOMIALS, _DEVIATES = 16, np.linspace(-6, 6, 2001)


@dataclass(frozen=True, eq=False)
class TwinSurface:
    """Random surface like a measured one, of (ny, nx) nodes.

    ``density`` is that of :func:`surface.synthesis.filtered_noise`, mm2; of a translation process
    that of the Gaussian surface of variance one. ``heights`` (n,) are the measured ones of a
    translation process, mm, ascending; empty of a Gaussian surface.
    """

    shape: tuple[int, int]
    density: np.ndarray
    heights: np.ndarray

    @property
    def gaussian(self) -> bool:
        """True if the twins are Gaussian."""
        return not self.heights.size

    def drawn(self, seed: int) -> np.ndarray:
        """Heights of a twin (ny, nx) about its mean plane, mm; not periodic."""
        z = filtered_noise(self.density, self.shape, seed)
        if not self.gaussian:
            z = _translated(z, self.heights)
        return without_mean_plane(z)


def twin_surface(
    heights: np.ndarray, spacing: tuple[float, float], shape: tuple[int, int]
) -> TwinSurface:
    """Random surface of ``shape`` nodes with the spectrum and distribution of a measured one.

    Heights (ny, nx) have no holes; they and the spacing (dy, dx) are in mm. ValueError as of
    :func:`roughness.plane_spectrum.plane_spectrum`.
    """
    spectrum, side = plane_spectrum(heights, spacing), grid_side(shape)
    along = scipy.fft.fftfreq(side, spacing[0]), scipy.fft.rfftfreq(side, spacing[1])
    waves = np.meshgrid(*along, indexing="ij")
    density = spectrum.at(*waves) / (spacing[0] * spacing[1])
    covariance = scipy.fft.irfft2(density, s=(side, side), workers=1)
    variance = float(covariance[0, 0])
    correlation = covariance / variance
    z = without_mean_plane(np.asarray(heights, float)).ravel()
    z /= z.std()
    if not _matters(z, correlation):
        return TwinSurface(shape, density, np.empty(0))
    ordered = np.sort(z)
    normal = scipy.fft.rfft2(_before_translation(correlation, ordered), workers=1).real
    normal = np.maximum(normal, 0)
    # Cutting negative parts off the density raises the variance above one.
    normal /= scipy.fft.irfft2(normal, s=(side, side), workers=1)[0, 0]
    return TwinSurface(shape, normal, np.sqrt(variance) * ordered)


def twin_doubt(heights: np.ndarray, spacing: tuple[float, float]) -> str:
    """Reason why extremes of the twins of a surface mean little, or "".

    First touch and dilatancy hang on the few highest nodes. Parameters and errors are those of
    :func:`twin_surface`.
    """
    z = without_mean_plane(np.asarray(heights, float))
    kurtoses = []
    for axis in (0, 1):
        slopes = np.diff(z, axis=axis)
        kurtoses.append(np.mean(slopes**4) / np.mean(slopes**2) ** 2 - 3)
    if max(kurtoses) > MAX_SLOPE_KURTOSIS:
        size = short(max(kurtoses))
        return f"no twin has its steps or spikes (excess kurtosis of the slopes {size})"
    spectrum = plane_spectrum(heights, spacing)
    if spectrum.longest > 1 + _BEYOND_CHANCE * spectrum.longest_error:
        return f"its longest waves have {short(spectrum.longest)} times the power of its twins"
    return ""


def _matters(z: np.ndarray, correlation: np.ndarray) -> bool:
    """True if skewness or kurtosis of heights of variance one is beyond chance.

    Variances of the mean cube and fourth Hermite polynomial of correlated normal deviates: 6 and 24
    times the mean of the correlation to the third and fourth power over all pairs.
    """
    pairs = [np.sum(correlation**k) / z.size for k in (3, 4)]
    moments = np.mean(z**3), np.mean(z**4) - 3
    errors = np.sqrt(np.maximum([6 * pairs[0], 24 * pairs[1]], 0))
    return bool((np.abs(moments) > _BEYOND_CHANCE * errors).any())


def _translated(normal: np.ndarray, ordered: np.ndarray) -> np.ndarray:
    """Measured heights of the ranks of normal deviates."""
    ranks = (np.arange(ordered.size) + 0.5) / ordered.size
    return np.interp(special.ndtr(normal), ranks, ordered)


def _before_translation(correlation: np.ndarray, ordered: np.ndarray) -> np.ndarray:
    """Correlation of normal deviates whose translation to heights gives this correlation.

    Mehler's formula: the heights' correlation is the sum of a_k^2 r^k / k! over the Hermite
    polynomials k = 1, 2, ...
    """
    weight = np.exp(-(_DEVIATES**2) / 2)
    heights = _translated(_DEVIATES, ordered)
    parts = []
    for k in range(1, _POLYNOMIALS + 1):
        of_k = special.eval_hermitenorm(k, _DEVIATES)
        parts.append(np.sum(weight * heights * of_k) ** 2 / special.factorial(k))
    r = np.linspace(-1, 1, 2001)
    after = np.sum([part * r**k for k, part in enumerate(parts, 1)], axis=0) / np.sum(parts)
    # For very skew heights the curve falls at first, and low correlations cannot be attained.
    after = np.maximum.accumulate(after)
    return np.interp(correlation, after, r)
