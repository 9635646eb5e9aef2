"""Small shaded reliefs, written into the page itself."""

import base64

import numpy as np
import xarray as xr
from matplotlib.colors import LightSource

from ..core.png import png
from ..core.window import spacing_of, window_slices

#: Pixels of the longer side.
SIDE = 96


def relief_thumbnail(specimen: xr.Dataset) -> str:
    """Lower face of a specimen's window, lit from the upper left, as an address of its picture."""
    heights = specimen["lower"][window_slices(specimen)].astype(float)
    step = -(-max(heights.shape) // SIDE)
    means = heights.coarsen(dict.fromkeys(heights.dims, step), boundary="trim").mean()
    grey = shaded(means.values[::-1], step * spacing_of(specimen)[0])
    return "data:image/png;base64," + base64.b64encode(png(grey, 9)).decode("ascii")


def shaded(heights: np.ndarray, spacing: float) -> np.ndarray:
    """Grey levels of a relief whose row 0 is in the North; missing cells are white."""
    filled = np.where(np.isfinite(heights), heights, np.nanmean(heights))
    light = LightSource(azdeg=315).hillshade(filled, dx=spacing, dy=spacing)
    return np.where(np.isfinite(heights), np.round(255 * light), 255).astype(np.uint8)
