"""Heights less their mean plane, to level a tilted scan."""

import numpy as np
from numpy.typing import ArrayLike


def without_mean_plane(heights: ArrayLike) -> np.ndarray:
    """Heights (ny, nx) less the least-squares plane through the cells that were measured.

    All NaN where the measured cells do not span a plane: fewer than three, or in one line.
    """
    heights = np.asarray(heights, float)
    measured = np.isfinite(heights)
    if measured.all() and min(heights.shape) > 1:
        return without_mean_planes(heights)
    if not measured.any():
        return np.full(heights.shape, np.nan)
    y, x = np.indices(heights.shape, dtype=float)
    y -= y[measured].mean()
    x -= x[measured].mean()
    mean = heights[measured].mean()
    # Sums and no matrix product, so that the last bit does not depend on the number of cores.
    dy, dx, dz = y[measured], x[measured], heights[measured] - mean
    yy, xx, xy = np.sum(dy * dy), np.sum(dx * dx), np.sum(dx * dy)
    determinant = yy * xx - xy**2
    if determinant <= 1e-12 * yy * xx or yy * xx == 0:
        return np.full(heights.shape, np.nan)
    zy, zx = np.sum(dz * dy), np.sum(dz * dx)
    slope_y = (zy * xx - zx * xy) / determinant
    slope_x = (zx * yy - zy * xy) / determinant
    return heights - mean - slope_y * y - slope_x * x


def mean_slopes(heights: ArrayLike) -> tuple[float, float]:
    """Slopes (y, x) of the least-squares plane through a complete grid, per cell.

    The grid has two cells or more along each side.
    """
    heights = np.asarray(heights, float)
    plane = heights - without_mean_planes(heights)
    return float(plane[1, 0] - plane[0, 0]), float(plane[0, 1] - plane[0, 0])


def without_mean_planes(heights: ArrayLike) -> np.ndarray:
    """Complete grids (..., ny, nx), each less its mean plane; two cells or more along each side."""
    heights = np.asarray(heights, float)
    ny, nx = heights.shape[-2:]
    y, x = np.arange(ny) - (ny - 1) / 2, np.arange(nx) - (nx - 1) / 2
    left = heights - heights.mean(axis=(-2, -1), keepdims=True)
    slope_y = np.sum(left.sum(axis=-1) * y, axis=-1) / (nx * np.sum(y * y))
    slope_x = np.sum(left.sum(axis=-2) * x, axis=-1) / (ny * np.sum(x * x))
    left -= slope_y[..., np.newaxis, np.newaxis] * y[:, np.newaxis]
    left -= slope_x[..., np.newaxis, np.newaxis] * x
    return left
