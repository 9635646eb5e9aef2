"""The curves from which the Hurst exponent of a surface is read, each in parts.

An estimator measures a quantity that grows as a known power of a length on a self-affine surface.
Every measure here is a mean, kept as a sum and a weight for each of several parts of the surface,
so that leaving out one part after the other shows how well the mean is known. All work on surfaces
with missing cells and any outline: they use what is complete at each length.
"""

from typing import NamedTuple

import numpy as np
import scipy.fft

from ..core.arguments import field, whole_numbers
from ..core.kernel_cache import njit

#: Lengths measured in each doubling.
LENGTHS_PER_OCTAVE = 4

#: Parts of the surface: `BLOCKS` x `BLOCKS` blocks, or `STRIPS` strips of profiles for spectra.
BLOCKS = 4
STRIPS = 8

#: A window or box counts where at least this part of it was measured.
WINDOW_COVER = 0.9

#: A profile segment must hold this many points for a spectrum to be worth taking.
SHORTEST_SEGMENT = 32

#: Waves of which fewer fit into a segment are left out: the taper smears orders over two
#: neighbours to either side, and detrending takes a part of the first ones.
FIRST_ORDER = 4


class Curve(NamedTuple):
    """A measure over lengths, in parts of the surface."""

    length: np.ndarray
    """(k,), mm."""
    total: np.ndarray
    """(k, parts): sums of what is averaged."""
    weight: np.ndarray
    """(k, parts): how much was summed."""

    def measure(self) -> np.ndarray:
        """Mean over all parts (k,), NaN where nothing was measured."""
        return ratio(self.total.sum(axis=1), self.weight.sum(axis=1))

    def without_each_part(self) -> np.ndarray:
        """Means (parts, k) over all parts but one; parts that hold nothing are passed over."""
        held = self.weight.any(axis=0)
        total, weight = self.total[:, held], self.weight[:, held]
        left = weight.sum(axis=1, keepdims=True) - weight
        return ratio(total.sum(axis=1, keepdims=True) - total, left).T


def ratio(total: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Total over weight, NaN where there is no weight."""
    return np.divide(total, weight, out=np.full(np.shape(total), np.nan), where=weight > 0)


def _summed(curves: dict[str, Curve]) -> dict[str, Curve]:
    """The curves along x and y, and of both together."""
    x, y = curves["x"], curves["y"]
    return {"both": Curve(x.length, x.total + y.total, x.weight + y.weight), **curves}


def lengths_in_cells(first: int, last: int) -> np.ndarray:
    """Whole numbers of cells from `first` to `last`, about evenly spaced on a logarithmic axis."""
    if last < first:
        return np.empty(0, int)
    octaves = np.arange(np.floor(np.log2(last / first) * LENGTHS_PER_OCTAVE) + 1)
    return np.unique(np.round(first * 2 ** (octaves / LENGTHS_PER_OCTAVE)).astype(int))


def in_blocks(spacing: float, lengths: np.ndarray, heights: np.ndarray, add) -> Curve:
    """Curve over lengths in cells: ``add(heights, length, total, weight)`` fills the blocks.

    Raises
    ------
    ValueError
        If the heights are no (y, x) grid of real numbers, or a length is none from 1.
    """
    heights = field(heights, "heights")
    lengths = whole_numbers(lengths, "lengths", least=1, most=max(1, *heights.shape))
    total, weight = np.zeros((2, len(lengths), BLOCKS, BLOCKS))
    for k, length in enumerate(lengths):
        add(heights, length, total[k], weight[k])
    shape = len(lengths), BLOCKS**2
    return Curve(lengths * spacing, total.reshape(shape), weight.reshape(shape))


def _along_axes(spacing: float, lengths: np.ndarray, heights: np.ndarray, add) -> dict[str, Curve]:
    """Curves of a measure of rows: along x, along y, and both."""
    x = in_blocks(spacing, lengths, heights, add)
    y = in_blocks(spacing, lengths, np.ascontiguousarray(heights.T), add)
    turned = (len(lengths), BLOCKS, BLOCKS)
    total, weight = (a.reshape(turned).swapaxes(1, 2).reshape(x.total.shape) for a in y[1:])
    return _summed({"x": x, "y": Curve(x.length, total, weight)})


# -- differences -----------------------------------------------------------------------------------


def variogram_curves(heights: np.ndarray, spacing: float) -> dict[str, Curve]:
    """Mean square height difference (mm2) over lags (mm): grows as h^(2H)."""
    lags = lengths_in_cells(1, min(heights.shape) // 2)
    return _along_axes(spacing, lags, heights, _add_differences)


def second_difference_curves(heights: np.ndarray, spacing: float) -> dict[str, Curve]:
    """Mean square second difference (mm2) over lags (mm): grows as h^(2H).

    Blind to any plane, and free of the variogram's bias at high H (Kent & Wood, J. R. Stat. Soc. B
    59 (1997) 679).
    """
    lags = lengths_in_cells(1, min(heights.shape) // 4)
    return _along_axes(spacing, lags, heights, _add_second_differences)


@njit(cache=True)
def _add_differences(heights, lag, total, weight):
    ny, nx = heights.shape
    for i in range(ny):
        row = i * BLOCKS // ny
        for column in range(BLOCKS):
            squares, n = 0.0, 0
            for j in range(*_pairs_in_block(column, nx, lag)):
                d = heights[i, j + lag] - heights[i, j]
                if np.isfinite(d):
                    squares += d * d
                    n += 1
            total[row, column] += squares
            weight[row, column] += n


@njit(cache=True)
def _add_second_differences(heights, lag, total, weight):
    ny, nx = heights.shape
    for i in range(ny):
        row = i * BLOCKS // ny
        for column in range(BLOCKS):
            squares, n = 0.0, 0
            for j in range(*_pairs_in_block(column, nx, 2 * lag)):
                d = heights[i, j + 2 * lag] - 2 * heights[i, j + lag] + heights[i, j]
                if np.isfinite(d):
                    squares += d * d
                    n += 1
            total[row, column] += squares
            weight[row, column] += n


@njit(cache=True)
def _pairs_in_block(block, nx, length):
    """First start of a pair of cells `length` apart whose middle lies in the block, and the end."""
    first = (2 * nx * block // BLOCKS - length + 1) // 2
    last = (2 * nx * (block + 1) // BLOCKS - length + 1) // 2
    return max(first, 0), max(min(last, nx - length), 0)


# -- windows ---------------------------------------------------------------------------------------


def roughness_length_curves(heights: np.ndarray, spacing: float) -> dict[str, Curve]:
    """Mean square height about the local mean plane (mm2) in windows of side b: grows as b^(2H).

    Malinverno, Geophys. Res. Lett. 17 (1990) 1953. Square windows tile the middle of the grid;
    along one axis they are pieces of profiles about their own line (detrended fluctuations: Peng et
    al., Phys. Rev. E 49 (1994) 1685). A window that is less than `WINDOW_COVER` measured is left
    out. The three degrees of freedom of a plane are taken off.
    """
    sides = lengths_in_cells(4, min(heights.shape))
    both = in_blocks(spacing, sides, heights, _add_windows)
    return _along_axes(spacing, sides, heights, _add_profile_windows) | {"both": both}


@njit(cache=True)
def _add_windows(heights, side, total, weight):
    ny, nx = heights.shape
    for i in range(ny % side // 2, ny - side + 1, side):
        for j in range(nx % side // 2, nx - side + 1, side):
            square = _square_about_plane(heights[i : i + side, j : j + side])
            if np.isfinite(square):
                row, column = (
                    (2 * i + side) * BLOCKS // (2 * ny),
                    (2 * j + side) * BLOCKS // (2 * nx),
                )
                total[row, column] += square
                weight[row, column] += 1


@njit(cache=True)
def _square_about_plane(window):
    """Variance about the least-squares plane; NaN where too little was measured."""
    side = window.shape[0]
    n, y, x, z = 0, 0.0, 0.0, 0.0
    for i in range(side):
        for j in range(side):
            if np.isfinite(window[i, j]):
                n += 1
                y += i
                x += j
                z += window[i, j]
    if n < WINDOW_COVER * side**2:
        return np.nan
    y, x, z = y / n, x / n, z / n
    yy, xx, xy, zy, zx, zz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(side):
        for j in range(side):
            if np.isfinite(window[i, j]):
                dy, dx, dz = i - y, j - x, window[i, j] - z
                yy += dy * dy
                xx += dx * dx
                xy += dx * dy
                zy += dz * dy
                zx += dz * dx
                zz += dz * dz
    # Most of the window was measured, so that its cells span a plane.
    determinant = yy * xx - xy * xy
    slope_y, slope_x = (zy * xx - zx * xy) / determinant, (zx * yy - zy * xy) / determinant
    return max(zz - slope_y * zy - slope_x * zx, 0.0) / (n - 3)


@njit(cache=True)
def _add_profile_windows(heights, side, total, weight):
    ny, nx = heights.shape
    for i in range(ny):
        row = i * BLOCKS // ny
        for j in range(nx % side // 2, nx - side + 1, side):
            square = _square_about_line(heights[i, j : j + side])
            if np.isfinite(square):
                column = (2 * j + side) * BLOCKS // (2 * nx)
                total[row, column] += square
                weight[row, column] += 1


@njit(cache=True)
def _square_about_line(piece):
    """Variance about the least-squares line; NaN where too little was measured."""
    side = piece.shape[0]
    n, x, z = 0, 0.0, 0.0
    for j in range(side):
        if np.isfinite(piece[j]):
            n += 1
            x += j
            z += piece[j]
    if n < WINDOW_COVER * side:
        return np.nan
    x, z = x / n, z / n
    xx, zx, zz = 0.0, 0.0, 0.0
    for j in range(side):
        if np.isfinite(piece[j]):
            dx, dz = j - x, piece[j] - z
            xx += dx * dx
            zx += dz * dx
            zz += dz * dz
    # A random walk's is n/15 - 4/(15 n): so a sum over n, not over n - 2 as for noise.
    return max(zz - zx * zx / xx, 0.0) / n


# -- spectrum --------------------------------------------------------------------------------------


def power_spectrum_curves(heights: np.ndarray, spacing: float) -> dict[str, Curve]:
    """Mean profile spectrum C(q) (mm3) against wavelength (mm): grows as l^(1 + 2H)."""
    return _summed(profile_spectra(heights, (spacing, spacing)))


def profile_spectra(heights: np.ndarray, spacing: tuple[float, float]) -> dict[str, Curve]:
    """Mean two-sided spectra (mm3) of profiles along x and along y, against wavelength (mm).

    Welch's method: unbroken segments of one length, as long as a quarter of the complete ones
    allows, each detrended and tapered (Hann); the mean is averaged in bins of equal ratio. Its
    parts are strips of profiles. Heights that are independent at every node, of variance v, have
    the spectrum v times the spacing at every wavelength.

    Parameters
    ----------
    heights : (ny, nx) ndarray
        mm, NaN where missing.
    spacing : (float, float)
        (dy, dx), mm.

    Returns
    -------
    dict of str to Curve
        "x" and "y"; empty curves where no unbroken segment is long enough.
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

    # Hann's side lobes fall as q^-6: no leakage from the long waves into q^-(1 + 2H).
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
    known = np.isfinite(heights)
    length = min(heights.shape)
    while length >= SHORTEST_SEGMENT:
        found = {"x": _cut_segments(heights, length), "y": _cut_segments(heights.T, length)}
        if min(f.size for f, _ in found.values()) >= 0.25 * known.sum() > 0:
            return found
        length = length * 7 // 8
    return {axis: (np.empty((0, 0)), np.empty(0, int)) for axis in "xy"}


def _cut_segments(profiles: np.ndarray, length: int) -> tuple[np.ndarray, np.ndarray]:
    """Complete segments of the rows, each starting where the one before ended, and their strips."""
    known = np.isfinite(profiles)
    strip = np.arange(len(profiles)) * STRIPS // len(profiles)
    segments, strips = [np.empty((0, length))], [np.empty(0, int)]
    free_from = np.zeros(len(profiles), int)
    run = np.zeros(len(profiles), int)
    for end in range(1, profiles.shape[1] + 1):
        run = np.where(known[:, end - 1], run + 1, 0)
        complete = (run >= length) & (end - free_from >= length)
        if complete.any():
            segments.append(profiles[complete, end - length : end])
            strips.append(strip[complete])
            free_from[complete] = end
    return np.concatenate(segments), np.concatenate(strips)


def _without_trend(profiles: np.ndarray) -> np.ndarray:
    """Each row less its own least-squares line."""
    x = np.arange(profiles.shape[1]) - (profiles.shape[1] - 1) / 2
    slope = profiles @ x / np.dot(x, x)
    return profiles - profiles.mean(axis=1, keepdims=True) - np.outer(slope, x)
