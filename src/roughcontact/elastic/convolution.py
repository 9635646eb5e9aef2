"""Zero-padded convolution of a real field with an even kernel, by Fourier transforms of its own.

Sixteen transforms run side by side, one in each lane of the processor's SIMD vectors (`simd`),
which libraries compiled for every processor do not use in full. Columns beyond the window are not
transformed along y. The kernel's spectrum is stored in the order in which the forward transform
leaves its result and the inverse takes it, so that nothing is sorted.
`tests/support/plain_twins.py` has the same with scipy.fft.

The transform along y comes first, of two real columns as one complex one. Their spectra, for half
the wave numbers, stand in blocks of sixteen wave numbers and are transformed along x, multiplied,
and transformed back. (Forward by decimation in frequency: Gentleman and Sande, AFIPS Proc. 29
(1966) 563; back by decimation in time: Cooley and Tukey, Math. Comp. 19 (1965) 297.)
"""

import numpy as np
from scipy import fft

from .. import threads
from ..kernel_cache import njit
from .simd import WIDTH, load, store, transpose

#: Length of a buffer's row: real, then imaginary parts of one index of all transforms.
ROW = 2 * WIDTH
#: Fewest cells for which a second thread saves time.
THREADED_CELLS = 150_000
#: Lines that `cosine_transform` transforms at once; all at once would double the memory.
LINES = 64


def cosine_transform(
    half: np.ndarray, axis: int, kind: int = 1, *, back: bool = False
) -> np.ndarray:
    """Cosine transform along an axis, in place, of even data given by their first half, (ny, nx).

    Kind 1 (DCT-I): even about the first and the last value. Kind 2 (DCT-II): even about places half
    a step outside them. ``back``: the inverse. The threads are the solver's own, since scipy's are
    shut down while the process forks, and a transform at that moment fails.
    """
    lines = half if axis == 1 else half.T
    of_lines = fft.idct if back else fft.dct

    def transform(start: int, stop: int) -> None:
        for first in range(start, stop, LINES):
            block = slice(first, min(first + LINES, stop))
            lines[block] = of_lines(lines[block], kind, axis=1, workers=1)

    threads.in_parts(transform, len(lines), smallest=LINES)
    return half


def fast_length(least: int) -> int:
    """Shortest length >= ``least`` and >= 2 without prime factors above 5."""
    length = max(least, 2)
    while _radices(length) is None:
        length += 1
    return length


def _radices(n):
    """Factors 4, 2, 3 and 5 of a length; None if it has others."""
    factors = []
    for radix in (4, 2, 3, 5):
        while n % radix == 0:
            factors.append(radix)
            n //= radix
    return factors if n == 1 else None


class Convolution:
    """Convolution with one kernel in one precision.

    Parameters
    ----------
    spectrum : (padded y // 2 + 1, padded x // 2 + 1) ndarray
        Transform of the kernel on its circle: real, as the kernel is even along both axes.
    shape : (int, int)
        Shape of the fields, (ny, nx).
    padded : (int, int)
        Lengths of the transforms, each a :func:`fast_length`.
    dtype : type
        float32 or float64.
    wrapped : bool
        Whether the lengths may be less than twice those of the fields. The kernel is then that of
        the circle, and the caller must make sure that it ends before it wraps round.
    """

    def __init__(
        self,
        spectrum: np.ndarray,
        shape: tuple[int, int],
        padded: tuple[int, int],
        dtype: type,
        *,
        wrapped: bool = False,
    ):
        if dtype not in (np.float32, np.float64):
            raise ValueError(f"dtype {dtype}: expected float32 or float64")
        for n, length in zip(shape, padded, strict=True):
            least = n if wrapped else 2 * n - 1
            if n < 1 or length < least or length != fast_length(length):
                raise ValueError(
                    f"padded {padded}: expected fast lengths, of {n} cells {least} or more"
                )
        half = padded[0] // 2 + 1, padded[1] // 2 + 1
        if np.shape(spectrum) != half:
            raise ValueError(f"spectrum {np.shape(spectrum)}: expected {half}")
        self._shape, self._dtype = tuple(shape), np.dtype(dtype)
        (radices_y, twiddles_y, frequency_y) = _plan(padded[0], dtype)
        (radices_x, twiddles_x, frequency_x) = _plan(padded[1], dtype)
        waves = padded[0] // 2 + 1
        self._blocks, self._waves = -(-shape[1] // ROW), -(-waves // WIDTH)
        factors = np.zeros((self._waves * WIDTH, spectrum.shape[1]), dtype)
        factors[:waves] = spectrum
        factors[:waves] /= padded[0] * padded[1]
        blocks = factors.reshape(self._waves, WIDTH, -1).transpose(0, 2, 1)
        mirrored = np.minimum(frequency_x, padded[1] - frequency_x)
        self._along_y = radices_y, twiddles_y, np.argsort(frequency_y)
        self._along_x = np.ascontiguousarray(blocks), mirrored, radices_x, twiddles_x

    def __call__(self, field: np.ndarray) -> np.ndarray:
        """Convolution of a field of this shape and precision."""
        field = np.ascontiguousarray(field)
        # Compiled code checks no bounds.
        if field.shape != self._shape or field.dtype != self._dtype:
            raise ValueError(
                f"field {field.shape} of {field.dtype}: expected {self._shape} of {self._dtype}"
            )
        result = np.empty_like(field)
        spectra = np.empty((self._waves, self._blocks * ROW * ROW), self._dtype)
        nx = self._shape[1]
        if field.size < THREADED_CELLS:  # in small windows the calls take as long as the work
            _convolve(field, spectra, result, self._along_y, self._along_x)
            return result
        threads.in_parts(
            lambda *part: _forward_along_y(*part, field, spectra, *self._along_y),
            self._blocks,
            smallest=1,
        )
        threads.in_parts(
            lambda *part: _multiply_along_x(*part, nx, spectra, *self._along_x),
            self._waves,
            smallest=1,
        )
        threads.in_parts(
            lambda *part: _back_along_y(*part, spectra, result, *self._along_y),
            self._blocks,
            smallest=1,
        )
        return result


def _plan(n, dtype):
    """Radices, twiddle factors (cos, -sin), and frequencies in the transform's output order."""
    radices = np.array(_radices(n), np.int64)
    frequency = np.zeros(1, np.int64)
    for radix in radices[::-1]:
        frequency = (np.arange(radix)[:, None] + radix * frequency).ravel()
    angle = 2 * np.pi * np.arange(n) / n
    return radices, np.stack([np.cos(angle), -np.sin(angle)], axis=1).astype(dtype), frequency


@njit(cache=True)
def _twiddled(re, im, twiddles, k):
    """Product of re + i im with twiddle factor k."""
    if k == 0:
        return re, im
    c, s = twiddles[k, 0], twiddles[k, 1]
    return c * re - s * im, c * im + s * re


@njit(cache=True)
def _take(x, row, real, imag, twiddles, k):
    """Real and imaginary parts of a row, times twiddle factor k."""
    return _twiddled(load(x, row * ROW + real), load(x, row * ROW + imag), twiddles, k)


@njit(cache=True)
def _put(x, row, real, imag, value):
    store(x, row * ROW + real, value[0])
    store(x, row * ROW + imag, value[1])


# Butterflies of one radix on radix * m rows from ``first`` on. Twiddle factors are multiples of
# ``before`` or ``after`` times a row's place (one of the two is 0). All rows are read before any
# is written.


@njit(cache=True)
def _pass2(x, first, m, before, after, twiddles, real, imag):
    for p in range(m):
        row, k, q = first + p, before * p, after * p
        ar, ai = _take(x, row, real, imag, twiddles, 0)
        br, bi = _take(x, row + m, real, imag, twiddles, k)
        second = _twiddled(ar - br, ai - bi, twiddles, q)
        _put(x, row, real, imag, (ar + br, ai + bi))
        _put(x, row + m, real, imag, second)


@njit(cache=True)
def _pass3(x, first, m, before, after, twiddles, real, imag):
    half, height = x.dtype.type(0.5), x.dtype.type(np.sqrt(0.75))
    for p in range(m):
        row, k, q = first + p, before * p, after * p
        ar, ai = _take(x, row, real, imag, twiddles, 0)
        br, bi = _take(x, row + m, real, imag, twiddles, k)
        cr, ci = _take(x, row + 2 * m, real, imag, twiddles, 2 * k)
        sr, si = br + cr, bi + ci
        dr, di = height * (br - cr), height * (bi - ci)
        er, ei = ar - half * sr, ai - half * si
        second = _twiddled(er + di, ei - dr, twiddles, q)
        third = _twiddled(er - di, ei + dr, twiddles, 2 * q)
        _put(x, row, real, imag, (ar + sr, ai + si))
        _put(x, row + m, real, imag, second)
        _put(x, row + 2 * m, real, imag, third)


@njit(cache=True)
def _pass4(x, first, m, before, after, twiddles, real, imag):
    for p in range(m):
        row, k, q = first + p, before * p, after * p
        ar, ai = _take(x, row, real, imag, twiddles, 0)
        br, bi = _take(x, row + m, real, imag, twiddles, k)
        cr, ci = _take(x, row + 2 * m, real, imag, twiddles, 2 * k)
        dr, di = _take(x, row + 3 * m, real, imag, twiddles, 3 * k)
        er, ei, fr, fi = ar + cr, ai + ci, br + dr, bi + di
        gr, gi, hr, hi = ar - cr, ai - ci, br - dr, bi - di
        second = _twiddled(gr + hi, gi - hr, twiddles, q)
        third = _twiddled(er - fr, ei - fi, twiddles, 2 * q)
        fourth = _twiddled(gr - hi, gi + hr, twiddles, 3 * q)
        _put(x, row, real, imag, (er + fr, ei + fi))
        _put(x, row + m, real, imag, second)
        _put(x, row + 2 * m, real, imag, third)
        _put(x, row + 3 * m, real, imag, fourth)


@njit(cache=True)
def _pass5(x, first, m, before, after, twiddles, real, imag):
    c1, s1 = x.dtype.type(np.cos(0.4 * np.pi)), x.dtype.type(np.sin(0.4 * np.pi))
    c2, s2 = x.dtype.type(np.cos(0.8 * np.pi)), x.dtype.type(np.sin(0.8 * np.pi))
    for p in range(m):
        row, k, q = first + p, before * p, after * p
        ar, ai = _take(x, row, real, imag, twiddles, 0)
        br, bi = _take(x, row + m, real, imag, twiddles, k)
        cr, ci = _take(x, row + 2 * m, real, imag, twiddles, 2 * k)
        dr, di = _take(x, row + 3 * m, real, imag, twiddles, 3 * k)
        er, ei = _take(x, row + 4 * m, real, imag, twiddles, 4 * k)
        fr, fi, gr, gi = br + er, bi + ei, cr + dr, ci + di
        br, bi, cr, ci = br - er, bi - ei, cr - dr, ci - di
        hr, hi = ar + c1 * fr + c2 * gr, ai + c1 * fi + c2 * gi
        er, ei = ar + c2 * fr + c1 * gr, ai + c2 * fi + c1 * gi
        ur, ui = s1 * br + s2 * cr, s1 * bi + s2 * ci
        vr, vi = s2 * br - s1 * cr, s2 * bi - s1 * ci
        second = _twiddled(hr + ui, hi - ur, twiddles, q)
        third = _twiddled(er + vi, ei - vr, twiddles, 2 * q)
        fourth = _twiddled(er - vi, ei + vr, twiddles, 3 * q)
        fifth = _twiddled(hr - ui, hi + ur, twiddles, 4 * q)
        _put(x, row, real, imag, (ar + fr + gr, ai + fi + gi))
        _put(x, row + m, real, imag, second)
        _put(x, row + 2 * m, real, imag, third)
        _put(x, row + 3 * m, real, imag, fourth)
        _put(x, row + 4 * m, real, imag, fifth)


@njit(cache=True)
def _transform(x, radices, twiddles, back):
    """Transform the rows of x in place, in the frequency order of the plan; or ``back``.

    The inverse times n is the forward transform with real and imaginary parts exchanged and the
    passes in reverse order.
    """
    n = twiddles.shape[0]
    real, imag = (WIDTH, 0) if back else (0, WIDTH)
    size = 1 if back else n
    for number in range(radices.size):
        radix = radices[radices.size - 1 - number] if back else radices[number]
        m = size if back else size // radix
        stride = n // (m * radix)
        before, after = (stride, 0) if back else (0, stride)
        for first in range(0, n, m * radix):
            if radix == 4:
                _pass4(x, first, m, before, after, twiddles, real, imag)
            elif radix == 2:
                _pass2(x, first, m, before, after, twiddles, real, imag)
            elif radix == 3:
                _pass3(x, first, m, before, after, twiddles, real, imag)
            else:
                _pass5(x, first, m, before, after, twiddles, real, imag)
        size = m * radix if back else m


@njit(cache=True, nogil=True)
def _forward_along_y(start, stop, field, spectra, radices, twiddles, place):
    """Spectra along y of some blocks of columns.

    The left half of a block is the real and the right half the imaginary part of the transformed
    data: the spectra a, b of the halves are the Hermitian and (over i) the anti-Hermitian part of
    the result.
    """
    ny, nx = field.shape
    n = twiddles.shape[0]
    numbers = field.reshape(-1)
    x = np.empty(n * ROW, field.dtype)
    tile = np.empty(2 * WIDTH * ROW, field.dtype)
    half = field.dtype.type(0.5)
    for block in range(start, stop):
        left = block * ROW
        if left + ROW <= nx:
            for y in range(ny):
                store(x, y * ROW, load(numbers, y * nx + left))
                store(x, y * ROW + WIDTH, load(numbers, y * nx + left + WIDTH))
        else:
            for y in range(ny):
                for lane in range(ROW):
                    x[y * ROW + lane] = field[y, left + lane] if left + lane < nx else 0
        x[ny * ROW :] = 0
        _transform(x, radices, twiddles, False)
        for waves in range(spectra.shape[0]):
            for lane in range(WIDTH):
                # Lanes beyond the last wave number repeat it.
                k = min(waves * WIDTH + lane, n // 2)
                row, opposite = place[k] * ROW, place[(n - k) % n] * ROW
                zr, zi = half * load(x, row), half * load(x, row + WIDTH)
                wr, wi = half * load(x, opposite), half * load(x, opposite + WIDTH)
                store(tile, lane * ROW, zr + wr)
                store(tile, lane * ROW + WIDTH, zi + wi)
                store(tile, (WIDTH + lane) * ROW, zi - wi)
                store(tile, (WIDTH + lane) * ROW + WIDTH, wr - zr)
            # From wave numbers in rows to wave numbers in lanes.
            for part in (0, 1):
                for side in (0, WIDTH):
                    corner = part * WIDTH * ROW + side
                    target = (left + side) * ROW + part * WIDTH
                    transpose(tile, corner, ROW, spectra[waves], target, ROW)


@njit(cache=True, nogil=True)
def _multiply_along_x(start, stop, nx, spectra, kernel, mirrored, radices, twiddles):
    """Convolution along x of some blocks of wave numbers along y, in place."""
    n = twiddles.shape[0]
    x = np.empty(n * ROW, spectra.dtype)
    for waves in range(start, stop):
        x[: nx * ROW] = spectra[waves, : nx * ROW]
        x[nx * ROW :] = 0
        _transform(x, radices, twiddles, False)
        factors = kernel[waves].reshape(-1)
        for k in range(n):
            factor = load(factors, mirrored[k] * WIDTH)
            store(x, k * ROW, factor * load(x, k * ROW))
            store(x, k * ROW + WIDTH, factor * load(x, k * ROW + WIDTH))
        _transform(x, radices, twiddles, True)
        spectra[waves, : nx * ROW] = x[: nx * ROW]


@njit(cache=True, nogil=True)
def _back_along_y(start, stop, spectra, field, radices, twiddles, place):
    """Inverse transform along y of some blocks of columns."""
    ny, nx = field.shape
    n = twiddles.shape[0]
    numbers = field.reshape(-1)
    x = np.empty(n * ROW, field.dtype)
    tile = np.empty(2 * WIDTH * ROW, field.dtype)
    for block in range(start, stop):
        left = block * ROW
        for waves in range(spectra.shape[0]):
            for part in (0, 1):
                for side in (0, WIDTH):
                    corner = part * WIDTH * ROW + side
                    source = (left + side) * ROW + part * WIDTH
                    transpose(spectra[waves], source, ROW, tile, corner, ROW)
            for lane in range(min(WIDTH, n // 2 + 1 - waves * WIDTH)):
                k = waves * WIDTH + lane
                row, opposite = place[k] * ROW, place[(n - k) % n] * ROW
                ar, br = load(tile, lane * ROW), load(tile, lane * ROW + WIDTH)
                ai = load(tile, (WIDTH + lane) * ROW)
                bi = load(tile, (WIDTH + lane) * ROW + WIDTH)
                store(x, opposite, ar + bi)
                store(x, opposite + WIDTH, br - ai)
                store(x, row, ar - bi)
                store(x, row + WIDTH, ai + br)
        _transform(x, radices, twiddles, True)
        if left + ROW <= nx:
            for y in range(ny):
                store(numbers, y * nx + left, load(x, y * ROW))
                store(numbers, y * nx + left + WIDTH, load(x, y * ROW + WIDTH))
        else:
            for y in range(ny):
                for lane in range(nx - left):
                    field[y, left + lane] = x[y * ROW + lane]


@njit(cache=True, nogil=True)
def _convolve(field, spectra, result, along_y, along_x):
    """All three passes on one thread."""
    blocks = spectra.shape[1] // (ROW * ROW)
    _forward_along_y(0, blocks, field, spectra, *along_y)
    _multiply_along_x(0, spectra.shape[0], field.shape[1], spectra, *along_x)
    _back_along_y(0, blocks, spectra, result, *along_y)
