"""Small shaded reliefs, written into the page itself."""

import base64
import warnings

import numpy as np
import xarray as xr

from ..core.png import png
from ..core.window import spacing_of, window_slices

#: Pixels of the longer side.
SIDE = 96
#: Where the light comes from, (x, y): from the upper left, as on maps.
_LIGHT = np.array([-1.0, 1.0]) / np.sqrt(2)


def relief_thumbnail(specimen: xr.Dataset) -> str:
    """The lower face of the window, lit from the upper left, as an address that holds the picture.

    Parameters
    ----------
    specimen : xr.Dataset
        From :func:`surface.specimen.make_specimen`.
    """
    rows, columns = window_slices(specimen)
    heights = specimen["lower"].values[rows, columns].astype(float)
    return png_address(shaded(reduced(heights, SIDE), spacing_of(specimen)[0]))


def reduced(heights: np.ndarray, side: int) -> np.ndarray:
    """Means over blocks, so that the longer side has ``side`` nodes at most; NaN where all are.

    Parameters
    ----------
    heights : (ny, nx) ndarray
    side : int
    """
    step = -(-max(heights.shape) // side)
    ny, nx = (n // step for n in heights.shape)
    blocks = heights[: ny * step, : nx * step].reshape(ny, step, nx, step)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # blocks without a measured cell
        return np.nanmean(blocks, axis=(1, 3))


def shaded(heights: np.ndarray, spacing: float) -> np.ndarray:
    """Grey levels of a relief, row 0 at the top as pictures have it; missing cells are white.

    Parameters
    ----------
    heights : (ny, nx) ndarray
        Row 0 in the South.
    spacing : float
        Any: slopes are drawn relative to their spread.
    """
    slopes = np.gradient(heights, spacing)
    towards = -(slopes[1] * _LIGHT[0] + slopes[0] * _LIGHT[1])
    known = np.isfinite(towards)
    spread = float(np.std(towards[known])) if known.any() else 0.0
    light = np.clip(0.55 + towards / (5 * spread), 0, 1) if spread else np.full(heights.shape, 0.55)
    return np.where(known, np.round(255 * light), 255).astype(np.uint8)[::-1]


def png_address(grey: np.ndarray) -> str:
    """A picture of 8-bit grey levels as a ``data:`` address."""
    return "data:image/png;base64," + base64.b64encode(png(grey, 9)).decode("ascii")
