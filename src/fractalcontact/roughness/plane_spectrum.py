"""Directional power spectrum of a rough surface, in bins of wave number and direction."""

from dataclasses import dataclass

import numpy as np
import scipy.fft
import scipy.ndimage

from ..core.mean_plane import without_mean_plane

#: Sectors of the half plane of directions, and rings of an octave of wave numbers.
SECTORS, RINGS_PER_OCTAVE = 12, 2
#: Weight, in waves, of the power law in a ring of long waves, and of the ring in its sectors: few
#: waves determine a density poorly, and a direction worse.
POOLED = 8
#: Fewest wavelengths in the surface: longer waves, which the taper mixes with the tilt, are
#: extrapolated.
FIRST_ORDER = 2
#: Number of waves of the tapered surface with the information of one independent wave.
_TAPERED = 2.25
#: Shortest wave of the fit of the power law, as a fraction of the longest, and least relative error
#: of a ring: no surface follows a power law more closely.
_FITTED, _MISFIT = 1 / 16, 0.1
#: Slopes that are tried, and roll-offs as fractions of the longest wave.
_SLOPES, _ROLL_OFFS = np.linspace(0, 4, 41), np.geomspace(1, 1 / 8, 13)
#: Deviance by which a roll-off must describe the rings better than a power law alone.
_EVIDENCE = 3.0


@dataclass(frozen=True, eq=False)
class PlaneSpectrum:
    """Two-sided power spectral density of a surface over wave number and direction.

    ``number`` (k,) are the wave numbers of the rings, 1/mm, ascending: inverse wavelengths.
    ``density`` (k, SECTORS) is in mm4, from direction x over y to -x: independent heights of
    variance v have v dx dy. ``slope`` is the exponent of the density of waves longer than those of
    the first ring. ``longest`` is the measured power of the two longest rings over that of the
    density, ``longest_error`` the standard deviation of 1 that so few waves have by chance.
    """

    number: np.ndarray
    density: np.ndarray
    slope: float
    longest: float = 1.0
    longest_error: float = 0.0

    def at(self, number_y: np.ndarray, number_x: np.ndarray) -> np.ndarray:
        """Density at wave numbers, mm4; zero for the mean height.

        Logarithms are interpolated between rings and sectors. Longer waves than those of the
        first ring follow the slope, shorter ones than those of the last have its value.
        """
        number = np.hypot(number_y, number_x)
        is_wave = number > 0
        log_q = np.log(np.where(is_wave, number, self.number[0]))
        rings, table = np.log(self.number), np.log(self.density)
        beyond = self.slope * np.minimum(log_q - rings[0], 0)
        place = np.interp(log_q, rings, np.arange(len(rings)))
        sector = (np.arctan2(number_y, number_x) / np.pi % 1) * SECTORS - 0.5
        around = np.concatenate([table[:, -1:], table, table[:, :1]], axis=1)
        log_c = scipy.ndimage.map_coordinates(
            around, np.array([place, sector + 1]), order=1, mode="nearest"
        )
        return np.where(is_wave, np.exp(log_c + beyond), 0.0)


def plane_spectrum(heights: np.ndarray, spacing: tuple[float, float]) -> PlaneSpectrum:
    """Directional spectrum of a surface without holes.

    Parameters
    ----------
    heights : (ny, nx) ndarray
        mm.
    spacing : (float, float)
        (dy, dx), mm.

    Raises
    ------
    ValueError
        If the surface is flat, or a side has fewer than eight nodes.

    Notes
    -----
    Periodogram of the differences along both axes under a Hann taper, divided by their gain:
    differences are whitened, so that neither the tilt nor long waves leak into shorter ones. It is
    averaged in rings of equal ratio and sectors. Rings of long waves, of which there are few, are
    pooled with the power law, with a roll-off if that is seen, which describes the longest three
    octaves best. The smearing by taper and rings is then corrected: the density is divided by the
    ratio of the periodogram expected of it to itself.
    """
    z = without_mean_plane(np.asarray(heights, float))
    if min(z.shape) < 8 or np.ptp(z) <= 1e-12 * np.abs(heights).max():
        raise ValueError("no spectrum: expected heights that vary, and eight nodes along each side")
    differences = np.diff(z, axis=0)[:, :-1] / spacing[0], np.diff(z, axis=1)[:-1] / spacing[1]
    shape = differences[0].shape
    taper = np.outer(*(np.hanning(n + 2)[1:-1] for n in shape))
    size = np.sum(taper**2) / (spacing[0] * spacing[1])
    power = sum(np.abs(scipy.fft.fft2((d - d.mean()) * taper, workers=1)) ** 2 for d in differences)
    bins = _Bins(shape, spacing)
    rings, table = bins.means(power / size)
    pooled, slope = _pooled(bins, rings)
    table = (bins.in_sector * table + POOLED * pooled[:, np.newaxis]) / (bins.in_sector + POOLED)
    spectrum = PlaneSpectrum(bins.number, np.maximum(table, 1e-15 * table.max()), slope)
    padded = _Waves([2 * n for n in shape], spacing)
    of_taper = scipy.fft.ifft2(np.abs(scipy.fft.fft2(taper, padded.shape, workers=1)) ** 2).real
    covariance = scipy.fft.ifft2(padded.gain * spectrum.at(*padded.numbers), workers=1).real
    expected = scipy.fft.fft2(covariance * of_taper, workers=1).real[::2, ::2]
    ratio = pooled / bins.means(expected / np.sum(taper**2))[0]
    waves = bins.in_ring[:2] / _TAPERED
    longest = float(np.average(rings[:2] / pooled[:2], weights=waves))
    density = spectrum.density * ratio[:, np.newaxis]
    return PlaneSpectrum(spectrum.number, density, slope, longest, float(waves.sum() ** -0.5))


def amplitude_error(heights: np.ndarray, spacing: tuple[float, float]) -> float:
    """Relative standard deviation of the root mean square height, over windows like this one.

    Parameters and errors are those of :func:`plane_spectrum`. The mean square of correlated
    Gaussian heights has the relative variance 2 <r^2>, r being the correlation, that of the
    spectrum, and <> the mean over all pairs of nodes.
    """
    waves = _Waves([2 * n for n in heights.shape], spacing)
    covariance = scipy.fft.ifft2(
        plane_spectrum(heights, spacing).at(*waves.numbers), workers=1
    ).real
    lags = [np.abs(scipy.fft.fftfreq(2 * n, 1 / (2 * n))) for n in heights.shape]
    pairs = np.outer(*((1 - lag / n) / n for lag, n in zip(lags, heights.shape, strict=True)))
    return float(np.sqrt(np.sum(pairs * (covariance / covariance[0, 0]) ** 2) / 2))


class _Waves:
    """Wave numbers (y, x) of a grid, 1/mm, and the gain of the differences along both axes."""

    def __init__(self, shape, spacing):
        self.shape = shape
        along = [scipy.fft.fftfreq(n, d) for n, d in zip(shape, spacing, strict=True)]
        self.numbers = np.meshgrid(*along, indexing="ij")
        steps = zip(self.numbers, spacing, strict=True)
        self.gain = sum((2 * np.sin(np.pi * number * d) / d) ** 2 for number, d in steps)


class _Bins:
    """Rings and sectors of the waves of a grid."""

    def __init__(self, shape, spacing):
        waves = _Waves(shape, spacing)
        number = np.hypot(*waves.numbers)
        longest = FIRST_ORDER / min(n * d for n, d in zip(shape, spacing, strict=True))
        self.used = number >= longest * (1 - 1e-9)
        self.gain = waves.gain[self.used]
        used = number[self.used]
        ring = np.round(np.log2(used / longest) * RINGS_PER_OCTAVE).astype(int)
        _, self.ring = np.unique(ring, return_inverse=True)
        angle = np.arctan2(*waves.numbers)[self.used] / np.pi % 1
        self.place = self.ring * SECTORS + np.minimum((angle * SECTORS).astype(int), SECTORS - 1)
        # A wave and its negative are one.
        self.in_ring = np.bincount(self.ring) / 2
        self.in_sector = np.bincount(self.place, minlength=len(self.in_ring) * SECTORS) / 2
        self.in_sector = self.in_sector.reshape(-1, SECTORS)
        self.number = np.exp(np.bincount(self.ring, np.log(used)) / self.in_ring / 2)

    def means(self, power):
        """Mean densities of rings and of their sectors (ring, sector), from power of differences.

        Zero in a bin without waves.
        """
        power = power[self.used] / self.gain
        ring = np.bincount(self.ring, power) / self.in_ring / 2
        total = np.bincount(self.place, power, self.in_sector.size).reshape(-1, SECTORS)
        return ring, total / np.maximum(2 * self.in_sector, 1)


def _pooled(bins, rings):
    """Rings, those of long waves pooled with a power law, and its slope to longer waves."""
    x = bins.number / bins.number[0]
    long = x <= 1 / _FITTED
    waves = bins.in_ring[long] / _TAPERED
    weights = 1 / (1 / waves + _MISFIT**2)
    starts = np.concatenate([[0.0], 1 / _ROLL_OFFS])[:, np.newaxis, np.newaxis]
    shapes = np.maximum(x[long], starts) ** -_SLOPES[:, np.newaxis]
    # The deviance of mean periodograms, which are gamma distributed, about the best multiple.
    ratio = rings[long] / shapes
    ratio /= np.average(ratio, axis=-1, weights=weights)[..., np.newaxis]
    deviance = -2 * np.sum(weights * np.log(np.maximum(ratio, 1e-300)), axis=-1)
    rolls_off = deviance[1:].min() < deviance[0].min() - _EVIDENCE
    deviance[0 if rolls_off else slice(1, None)] = np.inf
    best = np.unravel_index(deviance.argmin(), deviance.shape)
    law = shapes[best] * np.average(rings[long] / shapes[best], weights=weights)
    pooled = rings.copy()
    pooled[long] = (waves * rings[long] + POOLED * law) / (waves + POOLED)
    return pooled, 0.0 if rolls_off else -_SLOPES[best[1]]
