"""Power spectra of surfaces with missing cells: those of profiles, and radially averaged."""

import numpy as np
import scipy.fft

from ..core.mean_plane import without_mean_plane
from ..surface.window import hole_free_square
from .curves import LENGTHS_PER_OCTAVE, Curve

#: Parts of a surface: strips of neighbouring profiles.
STRIPS = 8

#: Fewest points of a profile segment whose spectrum is taken.
SHORTEST_SEGMENT = 32

#: Fewest wavelengths in a segment: the taper smears orders over two neighbours to either side, and
#: detrending takes a part of the first ones.
FIRST_ORDER = 4


def profile_spectra(heights: np.ndarray, spacing: tuple[float, float]) -> dict[str, Curve]:
    """Mean two-sided spectra (mm3) of profiles along "x" and "y", against wavelength (mm).

    Welch's method: unbroken segments of one length, as long as a quarter of the complete ones
    allows, each detrended and tapered (Hann); the mean is averaged in bins of equal ratio. Its
    parts are strips of profiles. Heights that are independent at every node, of variance v, have
    the spectrum v times the spacing at every wavelength. Curves are empty where no unbroken segment
    is long enough. Heights and spacing (dy, dx) are in mm, heights NaN where missing.
    """
    segments = _unbroken_segments(heights)
    n = segments["x"][0].shape[1]
    if n == 0:
        nothing = Curve(np.empty(0), *np.empty((2, 0, STRIPS)))
        return {"x": nothing, "y": nothing}
    order = np.arange(FIRST_ORDER, n // 2)
    ratio = np.round(np.log2(order) * LENGTHS_PER_OCTAVE).astype(int)
    _, which = np.unique(ratio, return_inverse=True)
    members = np.bincount(which)
    mean_order = np.exp(np.bincount(which, np.log(order)) / members)

    # Hann's side lobes fall as q^-6, so that long waves do not leak into q^-(1 + 2H).
    taper = np.hanning(n + 1)[:-1]
    curves = {}
    for (axis, (profiles, strip)), pitch in zip(segments.items(), spacing[::-1], strict=True):
        power = np.abs(scipy.fft.rfft(_without_trend(profiles) * taper, axis=1)[:, order]) ** 2
        power *= pitch / np.sum(taper**2)
        total, weight = np.zeros((2, len(members), STRIPS))
        for part in range(STRIPS):
            of_part = strip == part
            total[:, part] = np.bincount(which, power[of_part].sum(axis=0)) / members
            weight[:, part] = np.count_nonzero(of_part)
        curves[axis] = Curve((n * pitch / mean_order)[::-1], total[::-1], weight[::-1])
    return curves


def _unbroken_segments(heights: np.ndarray) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Complete profile segments (segments, length) along each axis, and the strip each lies in.

    The length is the longest at which complete segments cover a quarter of the measured cells along
    each axis; there are none if that is below `SHORTEST_SEGMENT`.
    """
    measured = np.isfinite(heights)
    length = min(heights.shape)
    while length >= SHORTEST_SEGMENT:
        segments = {"x": _cut_segments(heights, length), "y": _cut_segments(heights.T, length)}
        if min(f.size for f, _ in segments.values()) >= 0.25 * measured.sum() > 0:
            return segments
        length = length * 7 // 8
    return {axis: (np.empty((0, 0)), np.empty(0, int)) for axis in "xy"}


def _cut_segments(profiles: np.ndarray, length: int) -> tuple[np.ndarray, np.ndarray]:
    """Complete segments of the rows, each starting where the one before ended, and their strips."""
    measured = np.isfinite(profiles)
    strip = np.arange(len(profiles)) * STRIPS // len(profiles)
    segments, strips = [np.empty((0, length))], [np.empty(0, int)]
    free_from = np.zeros(len(profiles), int)
    run = np.zeros(len(profiles), int)
    for end in range(1, profiles.shape[1] + 1):
        run = np.where(measured[:, end - 1], run + 1, 0)
        complete = (run >= length) & (end - free_from >= length)
        if complete.any():
            segments.append(profiles[complete, end - length : end])
            strips.append(strip[complete])
            free_from[complete] = end
    return np.concatenate(segments), np.concatenate(strips)


def _without_trend(profiles: np.ndarray) -> np.ndarray:
    """Rows, each less its own least-squares line."""
    x = np.arange(profiles.shape[1]) - (profiles.shape[1] - 1) / 2
    slope = profiles @ x / np.dot(x, x)
    return profiles - profiles.mean(axis=1, keepdims=True) - np.outer(slope, x)


def radial_spectrum(
    heights: np.ndarray, spacing: tuple[float, float]
) -> tuple[np.ndarray, np.ndarray]:
    """Radially averaged spectrum of the largest hole-free square, levelled and tapered (Hann).

    Wavelengths (k,), mm, ascending, and two-sided densities (k,), mm4: independent errors of
    variance v have v dx dy everywhere. Empty where the square has fewer than `SHORTEST_SEGMENT`
    cells along a side. Heights and spacing (dy, dx) are in mm, heights NaN where missing.
    """
    z = heights[hole_free_square(np.isfinite(heights), spacing)]
    if min(z.shape) < SHORTEST_SEGMENT:
        return np.empty(0), np.empty(0)
    taper = np.outer(*(np.hanning(n + 1)[:-1] for n in z.shape))
    power = np.abs(scipy.fft.fft2(without_mean_plane(z) * taper, workers=1)) ** 2
    power *= spacing[0] * spacing[1] / np.sum(taper**2)
    waves = [scipy.fft.fftfreq(n, d) for n, d in zip(z.shape, spacing, strict=True)]
    number = np.hypot(waves[0][:, np.newaxis], waves[1])
    longest = FIRST_ORDER / min(n * d for n, d in zip(z.shape, spacing, strict=True))
    seen = (number >= longest) & (number < 0.5 / max(spacing))  # a full circle of directions
    bins = np.round(np.log2(number[seen] / longest) * LENGTHS_PER_OCTAVE).astype(int)
    members = np.bincount(bins)
    held = members > 0
    density = np.bincount(bins, power[seen])[held] / members[held]
    mean_number = np.exp(np.bincount(bins, np.log(number[seen]))[held] / members[held])
    return (1 / mean_number)[::-1], density[::-1]
