"""Rigid slide of a window along a line: largest height, spread, correlation of the faces.

A joint of a thousand cells is slid through hundreds of offsets in four directions. With arrays of
their own for every offset, that took longer than all else that is made of a specimen. The largest
height must look at every cell at every offset, and takes the spread along; the correlation of all
offsets at once comes from Fourier transforms along the slide and from sums of one line.
"""

from typing import NamedTuple

import numpy as np
import scipy.fft

from roughcontact.kernel_cache import njit

from ..core.mean_plane import without_mean_plane

#: Number of values in a block of rows, which are transformed together.
_BLOCK = 1 << 21
#: Smallest fraction of a face's variance that its mean plane leaves; less is rounding.
_LEFT = 1e-13


class Slide(NamedTuple):
    """Bounds at each place (n,) of the lower face under the window."""

    highest: np.ndarray
    """Largest h, mm."""
    spread: np.ndarray
    """Standard deviation of h, mm."""
    correlation: np.ndarray
    """Correlation of the two faces, each less its mean plane; NaN where one is a plane."""


def slide(lower: np.ndarray, upper: np.ndarray, corners: np.ndarray) -> Slide:
    """Slide of the whole lower face under a window, heights in mm.

    ``corners`` (n, 2) have the row and column of the lower face under the window's first cell, one
    of which is the same at all places; h is lower less upper. No height may be missing where the
    window comes to lie. Raises ValueError if neither rows nor columns are all the same.
    """
    sums = np.zeros((len(corners), 2))
    highest = np.full(len(corners), -np.inf)
    _composite_sums(lower, upper, corners, highest, sums)
    variance = np.maximum(sums[:, 1] - sums[:, 0] ** 2 / upper.size, 0.0) / upper.size
    return Slide(highest, np.sqrt(variance), _correlation(lower, upper, corners))


@njit(cache=True, fastmath={"reassoc", "nsz", "nnan"})
def _composite_sums(lower, upper, corners, highest, sums):
    """Largest h of each place, and its sum and sum of squares, less h of the first cell.

    Sums are formed row by row for all places: a row of the window then stays in the processor's
    cache, and rounding grows with a side and not with the area.
    """
    ny, nx = upper.shape
    for i in range(ny):
        above = upper[i]
        for k in range(len(corners)):
            top, left = corners[k]
            below = lower[top + i, left : left + nx]
            # Sums count from the first cell, so that heights above sea level cost no digits.
            first = lower[top, left] - upper[0, 0]
            largest, total, squares = highest[k], 0.0, 0.0
            for j in range(nx):
                h = below[j] - above[j]
                largest = h if h > largest else largest
            for j in range(nx):
                h = below[j] - above[j] - first
                total += h
                squares += h * h
            highest[k] = largest
            sums[k, 0] += total
            sums[k, 1] += squares


def _correlation(lower, upper, corners):
    """Correlation of the faces at each place (n,), each less its mean plane under the window."""
    (top, left), (last_top, last_left) = corners.min(axis=0), corners.max(axis=0)
    strip = lower[top : last_top + upper.shape[0], left : last_left + upper.shape[1]]
    under, places = without_mean_plane(upper), corners - (top, left)
    # Where only the row changes, arrays are transposed so that the slide is along the last axis;
    # y and x are exchanged below too.
    if last_left == left:
        strip, under, places = strip.T, under.T, places[:, ::-1]
    elif last_top != top:
        raise ValueError("places of a slide lie along a row or along a column")
    strip = strip - strip.mean()
    of_under, about_mean = np.sum(under**2), np.sum((upper - upper.mean()) ** 2)
    if of_under <= _LEFT * about_mean:  # the upper face is a plane, tilted or not
        return np.full(len(corners), np.nan)
    product, of_z, along_y, along_x = (sums[places[:, 1]] for sums in _sums(strip, under))
    # The sum of squares of the mean plane is that of rows plus that of columns: both are
    # orthogonal.
    my, mx = under.shape
    with np.errstate(divide="ignore", invalid="ignore"):  # one row, or one column
        planes = along_y**2 / (mx * np.sum(_middled(my) ** 2))
        planes += along_x**2 / (my * np.sum(_middled(mx) ** 2))
        norm = np.sqrt(np.where(of_z - planes > _LEFT * of_z, of_z - planes, np.nan))
        norm *= np.sqrt(of_under)
        return np.where(norm > 0, product / norm, np.nan)


def _sums(strip, under):
    """Sums over each place (lag,) of a window along a strip: of z times ``under``, of z squared
    about its mean, of z times row and times column, these from the middle.
    """
    my, mx = under.shape
    length = scipy.fft.next_fast_len(strip.shape[1], real=True)
    spectrum = np.zeros(length // 2 + 1, complex)
    rows = max(1, _BLOCK // length)
    for start in range(0, my, rows):
        block = slice(start, start + rows)
        of_under = scipy.fft.rfft(under[block], length)
        spectrum += np.sum(scipy.fft.rfft(strip[block], length) * of_under.conj(), axis=0)
    lags = strip.shape[1] - mx + 1
    product = scipy.fft.irfft(spectrum, length)[:lags]
    window = np.ones(mx)
    column, square = strip.sum(axis=0), np.einsum("ij,ij->j", strip, strip)
    total = np.correlate(column, window)
    of_z = np.maximum(np.correlate(square, window) - total**2 / under.size, 0.0)
    # einsum sums in one order; a matrix product would make the last bit depend on the number of
    # cores.
    along_y = np.correlate(np.einsum("i,ij->j", _middled(my), strip), window)
    return product, of_z, along_y, np.correlate(column, _middled(mx))


def _middled(cells):
    return np.arange(cells) - (cells - 1) / 2
