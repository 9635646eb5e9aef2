"""Local roughness: rms heights of sub-windows about their own planes, over their size (eq. 2)."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from ..core.datasets import labelled_dataset
from ..core.estimate import Estimate
from ..core.intervals import mean_interval
from ..core.mean_plane import without_mean_planes
from ..core.window import cell_side, faces, window_slices
from ..states.loading import JointLoading
from .division import split

#: Fewest cells per side of a sub-window whose sigma_z is measured.
MIN_CELLS_ROUGHNESS = 4


def local_roughness(windows: ArrayLike) -> np.ndarray:
    """sigma_z (n,), mm: rms height of each window (n, ny, nx) about its own mean plane.

    The three degrees of freedom of the plane are taken off, as the roughness-length estimator of
    :mod:`roughness.dimension` has it.
    """
    residuals = without_mean_planes(windows)
    ny, nx = residuals.shape[1:]
    return np.sqrt(np.sum(residuals**2, axis=(1, 2)) / (ny * nx - 3))


_SCALES = {
    "scale_side": ("scale", "mm", "side b of the sub-windows"),
    "scale_n": ("scale", "1", "sub-windows of that size"),
    "scale_cells": ("scale", "1", "cells of each"),
}


def roughness_by_size(loading: JointLoading) -> xr.Dataset:
    """sigma_z of the face and of the composite topography in sub-windows of many sizes, mm.

    Means with intervals over all sub-windows of a size: ``face_sigma_z`` (scale) of the lower face
    under the window, ``sigma_z_all`` (offset, scale) of the composite topography.
    """
    specimen = loading.specimen
    lower = faces(specimen)[0][window_slices(specimen)]
    parts = _octaves_and_halves(min(lower.shape) // MIN_CELLS_ROUGHNESS)
    composites = [loading.composite(n) for n in loading.cells]
    nodes = np.array([np.prod([n // p for n in lower.shape]) for p in parts])
    side = cell_side(specimen) * np.sqrt(nodes)
    result = labelled_dataset(
        _SCALES, {"scale_side": side, "scale_n": parts**2, "scale_cells": nodes}
    )
    face, composite = _mean_roughness([lower], parts)[0], _mean_roughness(composites, parts)
    words = "about the plane of a sub-window, mean"
    result.update(face.variables("face_sigma_z", "scale", "mm", f"rms of the lower face {words}"))
    words = f"rms of the composite topography {words}"
    result.update(composite.variables("sigma_z_all", ("offset", "scale"), "mm", words))
    return result


def _octaves_and_halves(most: int) -> np.ndarray:
    """1, 2, 3, 4, 6, 8, 12, 16 ... up to ``most``."""
    octaves = 2 ** np.arange(int(np.log2(max(most, 1))) + 1)
    parts = np.union1d(octaves, octaves[1:] * 3 // 2)
    return parts[parts <= max(most, 1)]


def _mean_roughness(topographies: Sequence[np.ndarray], parts: np.ndarray) -> Estimate:
    """Mean over the sub-windows of each size, (topographies, parts)."""
    means = (mean_interval(local_roughness(split(z, n))) for z in topographies for n in parts)
    return Estimate.stack(means, (len(topographies), len(parts)))
