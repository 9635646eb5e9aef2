"""Directional power spectrum of a rough surface, in bins of wave number and direction."""

from dataclasses import dataclass, replace

import numpy as np
import scipy.fft
import scipy.ndimage

from ..core.mean_plane import without_mean_plane

#: Sectors of the half plane of directions, and rings of an octave of wave numbers.
SECTORS, RINGS_PER_OCTAVE = 12, 2
#: Waves that a sector of a ring is pooled with, which have the mean of the ring: as long as few
#: waves are seen the spectrum is isotropic, and directional where many are.
POOLED = 8
#: Waves of which fewer fit into the surface are extrapolated: the taper and the mean plane leave
#: little of them.
FIRST_ORDER = 2
#: Rings (an octave) whose slope is continued to longer waves, and the limits of that slope.
_LOWEST, _SLOPES = RINGS_PER_OCTAVE + 1, (-4.0, 0.0)


@dataclass(frozen=True, eq=False)
class PlaneSpectrum:
    """Two-sided power spectral density of a surface over wave number and direction.

    Attributes
    ----------
    number : (k,) ndarray
        Wave numbers of the rings, 1/mm, ascending: inverse wavelengths.
    density : (k, SECTORS) ndarray
        mm4, from direction x over y to -x: independent heights of variance v have v dx dy.
    """

    number: np.ndarray
    density: np.ndarray

    def at(self, number_y: np.ndarray, number_x: np.ndarray) -> np.ndarray:
        """Density at wave numbers, mm4; zero for the mean height.

        Logarithms are interpolated between rings and sectors. Longer waves than those of the
        first ring follow its neighbours' slope, shorter ones than those of the last have its value.
        """
        number = np.hypot(number_y, number_x)
        known = number > 0
        log_q = np.log(np.where(known, number, self.number[0]))
        rings, table = np.log(self.number), np.log(self.density)
        mean = np.log(self.density.mean(axis=1))
        slope = np.polyfit(rings[:_LOWEST], mean[:_LOWEST], 1)[0] if len(rings) > 1 else 0.0
        beyond = np.clip(slope, *_SLOPES) * np.minimum(log_q - rings[0], 0)
        place = np.interp(log_q, rings, np.arange(len(rings)))
        sector = (np.arctan2(number_y, number_x) / np.pi % 1) * SECTORS - 0.5
        around = np.concatenate([table[:, -1:], table, table[:, :1]], axis=1)
        log_c = scipy.ndimage.map_coordinates(
            around, np.array([place, sector + 1]), order=1, mode="nearest"
        )
        return np.where(known, np.exp(log_c + beyond), 0.0)


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
    Periodogram of the levelled heights under a Hann taper, averaged in rings of equal ratio and
    sectors; of few waves in a sector the mean of the ring is part. What the taper smears is then
    corrected: the density is divided by the ratio of the periodogram expected of it, which is the
    transform of its autocovariance times that of the taper, to the one seen.
    """
    z = without_mean_plane(np.asarray(heights, float))
    if min(z.shape) < 8 or np.ptp(z) <= 1e-12 * np.abs(heights).max():
        raise ValueError("no spectrum: expected heights that vary, and eight nodes along each side")
    taper = np.outer(*(np.hanning(n + 2)[1:-1] for n in z.shape))
    bins = _Bins(z.shape, spacing)
    seen = bins.means(np.abs(scipy.fft.fft2(z * taper, workers=1)) ** 2)
    cell = spacing[0] * spacing[1]
    spectrum = PlaneSpectrum(bins.number, seen * cell / np.sum(taper**2))
    padded = [2 * n for n in z.shape]
    waves = _waves(padded, spacing)
    of_taper = scipy.fft.ifft2(np.abs(scipy.fft.fft2(taper, padded)) ** 2).real
    covariance = scipy.fft.ifft2(spectrum.at(*waves)).real / cell
    expected = scipy.fft.fft2(covariance * of_taper).real[::2, ::2]
    # Once: a second correction would magnify what chance does to the long waves.
    ratio = seen / np.maximum(bins.means(expected), np.finfo(float).tiny)
    return replace(spectrum, density=spectrum.density * ratio)


class _Bins:
    """Rings and sectors of the waves of a grid."""

    def __init__(self, shape, spacing):
        number_y, number_x = _waves(shape, spacing)
        number = np.hypot(number_y, number_x)
        longest = FIRST_ORDER / min(n * d for n, d in zip(shape, spacing, strict=True))
        self.used = number >= longest * (1 - 1e-9)
        used = number[self.used]
        ring = np.round(np.log2(used / longest) * RINGS_PER_OCTAVE).astype(int)
        _, self.ring = np.unique(ring, return_inverse=True)
        angle = np.arctan2(number_y, number_x)[self.used] / np.pi % 1
        self.place = self.ring * SECTORS + np.minimum((angle * SECTORS).astype(int), SECTORS - 1)
        self.of_ring = np.bincount(self.ring)
        self.number = np.exp(np.bincount(self.ring, np.log(used)) / self.of_ring)

    def means(self, power):
        """Means (ring, sector), pooled with that of the ring; never zero."""
        power = power[self.used]
        ring = (np.bincount(self.ring, power) / self.of_ring)[:, np.newaxis]
        size = len(self.of_ring) * SECTORS
        total, waves = (
            np.bincount(self.place, weights, size).reshape(-1, SECTORS)
            for weights in (power, np.ones_like(power))
        )
        # A wave and its negative are one.
        means = (total / 2 + POOLED * ring) / (waves / 2 + POOLED)
        return np.maximum(means, 1e-15 * means.max())


def _waves(shape, spacing):
    """Wave numbers (y, x) of a grid, 1/mm."""
    along = [scipy.fft.fftfreq(n, d) for n, d in zip(shape, spacing, strict=True)]
    number_y, number_x = np.meshgrid(*along, indexing="ij")
    return number_y, number_x
