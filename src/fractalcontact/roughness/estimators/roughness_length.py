"""Roughness-length method: the mean square height in windows of side b grows as b^(2H)."""

import numpy as np

from roughcontact.kernel_cache import njit

from ..curves import BLOCKS, WINDOW_COVER, Curve, along_axes, in_blocks, lengths_in_cells
from ..estimator import Estimator
from ..known_bias import (
    Fit,
    hurst_of_mean_square,
    short_wave_fraction,
    square_about_line,
    square_about_plane,
)
from ..roll_off import about_line_fraction, about_plane_fraction


def roughness_length_curves(heights: np.ndarray, spacing: float) -> dict[str, Curve]:
    """Mean square height about the local mean plane (mm2) in windows of side b: grows as b^(2H).

    Malinverno, Geophys. Res. Lett. 17 (1990) 1953. Square windows tile the middle of the grid;
    along one axis they are pieces of profiles about their own line (detrended fluctuations: Peng et
    al., Phys. Rev. E 49 (1994) 1685). A window that is less than `WINDOW_COVER` measured is left
    out. The three degrees of freedom of a plane are taken off.
    """
    sides = lengths_in_cells(4, min(heights.shape))
    both = in_blocks(spacing, sides, heights, _add_windows)
    return along_axes(spacing, sides, heights, _add_profile_windows) | {"both": both}


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
    # Cells that cover most of a window span a plane: the determinant is above zero.
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
    # The sum is divided by n: the mean square of a random walk is then n/15 - 4/(15 n). Noise
    # would need n - 2.
    return max(zz - zx * zx / xx, 0.0) / n


def expected_hurst(fit: Fit, sampling: str) -> np.ndarray:
    """Mean H of surfaces whose curve has this slope.

    The mean square of missing waves lies wholly about a window's plane, so all of it is lost; of
    the surface's mean square only a part lies about that plane.
    """
    whole = fit.axis == "both"
    unit = square_about_plane() if whole else square_about_line()
    fraction = about_plane_fraction if whole else about_line_fraction
    left = fraction(fit.length / fit.roll_off, fit.shape)
    missing = short_wave_fraction(fit, sampling, 1 / (2 * unit))
    return hurst_of_mean_square(fit, left - missing)


ESTIMATOR = Estimator(
    place=30,
    curves=roughness_length_curves,
    slope_per_hurst=2,
    slope_at_zero=0,
    length="window side",
    measure="mean square height about the local plane",
    units="mm2",
    factor=2,
    spread=1.25,
    expected_hurst=expected_hurst,
)
