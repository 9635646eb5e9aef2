"""Rigid slide of a window, compiled: largest height, spread and correlation of the faces.

A joint of a thousand cells is slid through hundreds of offsets in four directions. With arrays of
their own for every offset, that took longer than all else that is made of a specimen.
"""

from typing import NamedTuple

import numpy as np

from ..core.kernel_cache import njit
from ..core.mean_plane import without_mean_plane

#: Of what a face has about its mean, what its mean plane must leave to be more than rounding.
_LEFT = 1e-13


class Slide(NamedTuple):
    """What is known of each place (n,) of the lower face under the window."""

    highest: np.ndarray
    """Largest h, mm."""
    spread: np.ndarray
    """Standard deviation of h, mm."""
    correlation: np.ndarray
    """Of the two faces, each less its mean plane; NaN where one is a plane."""


def slide(lower: np.ndarray, upper: np.ndarray, corners: np.ndarray) -> Slide:
    """Slide the lower face under a window.

    Parameters
    ----------
    lower : (ny, nx) float64 ndarray
        Heights of the whole lower face, mm; none missing where the window comes to lie.
    upper : (my, mx) float64 ndarray
        Heights of the upper face in the window, mm.
    corners : (n, 2) int ndarray
        Row and column of the lower face under the window's first cell.

    Returns
    -------
    Slide
        Of h = lower - upper at each place.
    """
    my, mx = upper.shape
    under = without_mean_plane(upper)
    sums = np.empty((len(corners), 6))
    for row, (top, left) in zip(sums, corners, strict=True):
        _sums(lower[top : top + my, left : left + mx], upper, under, row)
    highest, of_h, of_z, product, along_y, along_x = sums.T
    # The plane's part of the sum of squares: rows are orthogonal to columns.
    y, x = np.arange(my) - (my - 1) / 2, np.arange(mx) - (mx - 1) / 2
    with np.errstate(divide="ignore", invalid="ignore"):  # one row, or one column
        above = of_z - along_y**2 / (mx * np.sum(y * y)) - along_x**2 / (my * np.sum(x * x))
        norm = np.sqrt(np.where(above > _LEFT * of_z, above, np.nan) * np.sum(under**2))
        correlation = np.where(norm > 0, product / norm, np.nan)
    return Slide(highest, np.sqrt(of_h / upper.size), correlation)


@njit(cache=True)
def _sums(lower, upper, under, row):
    """Largest h; sums of squares of h and of lower, z, about their means; of z times ``under``, row
    and column, these from the middle.
    """
    ny, nx = lower.shape
    middle_y, middle_x = (ny - 1) / 2, (nx - 1) / 2
    # From the first cell: a height over sea level must not cost digits.
    z0, h0 = lower[0, 0], lower[0, 0] - upper[0, 0]
    highest = h0
    total_h = total_hh = total_z = total_zz = total_zu = total_zy = total_zx = 0.0
    for i in range(ny):
        # Row by row, so that rounding grows with a side and not with the area.
        h_row = hh_row = z_row = zz_row = zu_row = zx_row = 0.0
        for j in range(nx):
            h = lower[i, j] - upper[i, j]
            highest = max(highest, h)
            h -= h0
            z = lower[i, j] - z0
            h_row += h
            hh_row += h * h
            z_row += z
            zz_row += z * z
            zu_row += z * under[i, j]
            zx_row += z * (j - middle_x)
        total_h += h_row
        total_hh += hh_row
        total_z += z_row
        total_zz += zz_row
        total_zu += zu_row
        total_zx += zx_row
        total_zy += z_row * (i - middle_y)
    cells = ny * nx
    row[0] = highest
    row[1] = max(total_hh - total_h * total_h / cells, 0.0)
    row[2] = max(total_zz - total_z * total_z / cells, 0.0)
    row[3] = total_zu
    row[4] = total_zy
    row[5] = total_zx
