"""Coarse match of two faces: correlation and shift, the start of their registration."""

import itertools
from collections.abc import Sequence

import numpy as np
import scipy.fft
import xarray as xr
from scipy import ndimage

from ..core.mean_plane import without_mean_plane
from .surface_motion import Motion, Surface, correlation, grid_nodes

#: Cells along the longer side of the grid on which faces are compared.
CELLS = 128
#: Waves of more than about a third of the smaller face are removed before faces are compared: the
#: longest waves of a self-affine surface decide its correlation, and are so few that any two faces
#: agree somewhere.
_LONGEST_WAVE = 1 / 3
#: Smallest fraction of the smaller face that the other must cover.
_SMALLEST_OVERLAP = 0.4
#: Rotations tried; the search that follows finds those between.
ROTATIONS = np.radians(np.arange(-12, 13, 2))
LARGEST_ROTATION = 10  # degrees that are found reliably, for messages


def averaged(heights: xr.DataArray, factor: int) -> xr.DataArray:
    """Means of blocks of ``factor`` x ``factor`` cells, over those present."""
    if factor == 1:
        return heights
    coarse = heights.coarsen(x=factor, y=factor, boundary="trim").mean()
    steps = {key: factor * heights.attrs[key] for key in ("spacing_x", "spacing_y")}
    return coarse.assign_attrs(steps)


def for_comparison(lower: xr.DataArray, upper: xr.DataArray) -> tuple[xr.DataArray, xr.DataArray]:
    """Both faces averaged to a grid of about `CELLS`, levelled and without their longest waves."""
    factor = max(1, round(max(*lower.shape, *upper.shape) / CELLS))
    factor = min(factor, max(1, min(*lower.shape, *upper.shape) // 16))
    coarse = [averaged(face, factor) for face in (lower, upper)]
    side = min(min(face.sizes[a] * face.attrs[f"spacing_{a}"] for a in "xy") for face in coarse)
    # A Gaussian of this width halves waves of the length wanted.
    width = side * _LONGEST_WAVE * np.sqrt(2 * np.log(2)) / (2 * np.pi)
    first, second = (face.copy(data=_without_long_waves(face, width)) for face in coarse)
    return first, second


def _without_long_waves(face: xr.DataArray, width: float) -> np.ndarray:
    z = without_mean_plane(face.values)
    present = np.isfinite(z)
    sigma = [width / face.attrs[f"spacing_{axis}"] for axis in "yx"]
    weight = ndimage.gaussian_filter(present.astype(float), sigma, mode="constant")
    mean = ndimage.gaussian_filter(np.where(present, z, 0.0), sigma, mode="constant")
    return np.where(present, z - mean / np.maximum(weight, 1e-12), np.nan)


def match(lower: xr.DataArray, upper: xr.DataArray, motion: Motion) -> float:
    """Correlation of two faces prepared by `for_comparison`, the upper one moved."""
    return correlation(lower.values, Surface(upper)(*motion.back(*grid_nodes(lower))))


def best_match(
    lower: xr.DataArray, upper: xr.DataArray, rotations: Sequence[float] | np.ndarray = ROTATIONS
) -> tuple[Motion, float]:
    """Best match of the upper face over all shifts and some rotations, and its correlation.

    Both faces are those of `for_comparison`, of one spacing, anywhere in the plane; rotations are
    in radians. The motion is in whole cells and one of the rotations.

    Masked normalised cross-correlation: Padfield, IEEE Trans. Image Process. 21 (2012) 2706. Of all
    shifts the one with the largest r sqrt(n) is taken, n the number of cells in common.
    """
    centre = float(upper.x.mean()), float(upper.y.mean())
    spacing = np.array([lower.attrs["spacing_x"], lower.attrs["spacing_y"]])
    surface = Surface(upper)
    half = [np.ptp(upper[axis].values) / 2 for axis in "xy"]
    best = (-np.inf, Motion(), 0.0)
    for rotation in rotations:
        cos, sin = np.cos(rotation), abs(np.sin(rotation))
        reach = np.array([half[0] * cos + half[1] * sin, half[1] * cos + half[0] * sin])
        cells = np.ceil(reach / spacing - 1e-6).astype(int)
        x, y = (
            middle + step * np.arange(-n, n + 1)
            for middle, step, n in zip(centre, spacing, cells, strict=True)
        )
        turn = Motion(centre, centre, float(rotation))
        turned = surface(*turn.back(*np.meshgrid(x, y)))
        r, common = _masked_correlations(lower.values, turned)
        score = np.where(common > 0, r * np.sqrt(common), -np.inf)
        row, column = np.unravel_index(np.argmax(score), score.shape)
        if score[row, column] > best[0]:
            end = (
                centre[0] + float(lower.x[0]) - x[0] + (column - len(x) + 1) * spacing[0],
                centre[1] + float(lower.y[0]) - y[0] + (row - len(y) + 1) * spacing[1],
            )
            motion = Motion(centre, (float(end[0]), float(end[1])), float(rotation))
            best = (score[row, column], motion, float(r[row, column]))
    return best[1:]


def _masked_correlations(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pearson's r for every shift of b over a, and the cells in common (0 where too few).

    Entry [i, j] belongs to b moved so that its first cell lies on cell
    [i - (rows of b - 1), j - (columns of b - 1)] of a.
    """
    shape = [n + m - 1 for n, m in zip(a.shape, b.shape, strict=True)]
    fast = [scipy.fft.next_fast_len(n, real=True) for n in shape]

    def spectra(z: np.ndarray, flip: bool) -> list[np.ndarray]:
        present = np.isfinite(z)
        z = np.where(present, z / (np.nanstd(z) or 1.0), 0.0)  # the rounding of sums is then known
        fields = (present.astype(float), z, z * z)
        step = -1 if flip else 1
        return [scipy.fft.rfft2(field[::step, ::step], fast) for field in fields]

    (mask_a, sum_a, square_a), (mask_b, sum_b, square_b) = spectra(a, False), spectra(b, True)

    def correlate(f: np.ndarray, g: np.ndarray) -> np.ndarray:
        return scipy.fft.irfft2(f * g, fast)[: shape[0], : shape[1]]

    common = np.round(correlate(mask_a, mask_b))
    smaller = min(np.isfinite(a).sum(), np.isfinite(b).sum())
    common[common < _SMALLEST_OVERLAP * smaller] = 0
    n = np.maximum(common, 1)
    a_mean, b_mean = correlate(sum_a, mask_b) / n, correlate(mask_a, sum_b) / n
    covariance = correlate(sum_a, sum_b) / n - a_mean * b_mean
    a_variance = correlate(square_a, mask_b) / n - a_mean**2
    b_variance = correlate(mask_a, square_b) / n - b_mean**2
    product = np.maximum(a_variance, 0) * np.maximum(b_variance, 0)
    r = np.divide(covariance, np.sqrt(product), out=np.zeros(shape), where=product > 1e-6)
    return r, common


def mirror_images(lower: xr.DataArray, upper: xr.DataArray) -> dict:
    """Best correlation of mirror images of the upper face, by the signs of x, y and z.

    Both faces are those of `for_comparison`; the face itself, (1, 1, 1), is left out.
    """
    images = [signs for signs in itertools.product((1, -1), repeat=3) if signs != (1, 1, 1)]
    return {
        (x, y, z): best_match(lower, upper.copy(data=z * upper.values[::y, ::x]))[1]
        for x, y, z in images
    }
