"""Shaded relief of the faces of a specimen."""

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LightSource, Normalize, to_rgb
from matplotlib.figure import FigureBase
from matplotlib.patches import Rectangle
from scipy.ndimage import distance_transform_edt

from ...core.directions import APERTURE
from ...core.text import length_unit
from ...core.window import spacing_of
from .maps import MISSING, draw_map, window_outline

COLOUR_MAP = "cividis"
#: Fraction of the heights beyond each end of the colours, so that a spike does not take them all.
CLIPPED = 0.002
#: Rms slope to which heights are stretched for the light; the colours show them as they are.
LIT_SLOPE = 0.7


def draw_faces(
    figure: FigureBase,
    panels: Sequence[Axes],
    specimen: xr.Dataset,
    faces: Sequence[str],
    sides: Sequence[float],
) -> Rectangle:
    """Reliefs of the faces side by side with one scale of heights; the outline of the window.

    `specimen` is the stage ``specimens`` and `sides` (y, x) are those of the scan, mm.
    """
    heights = np.concatenate([specimen[face].values.ravel() for face in faces])
    low, high = np.nanquantile(heights, [CLIPPED, 1 - CLIPPED])
    _, size = length_unit(max(sides))
    unit_of_height = length_unit(high - low)
    of_map = specimen.attrs["opposite"] == APERTURE
    of_heights = "mean less aperture" if of_map else "height above the mean plane"
    norm = Normalize(low / unit_of_height[1], high / unit_of_height[1])
    for panel, face in zip(panels, faces, strict=True):
        image = shaded(specimen[face].values, spacing_of(specimen), low, high)
        draw_map(panel, image, sides)
        outline = window_outline(specimen, size, lw=1, label="window of the contact")
        panel.add_patch(outline)
    figure.colorbar(
        ScalarMappable(norm, COLOUR_MAP),
        ax=list(panels),
        location="bottom",
        fraction=0.05,
        aspect=40,
        extend="both",
        label=f"{of_heights} ({unit_of_height[0]})",
    )
    return outline


def shaded(
    heights: np.ndarray, spacing: tuple[float, float], low: float, high: float
) -> np.ndarray:
    """Colours (ny, nx, 3) of a lit relief; cells not measured (NaN) are grey.

    `heights`, the spacing (dy, dx) and the ends `low` and `high` of the colours are in mm.
    """
    measured = np.isfinite(heights)
    # Holes are filled so that the light sees no cliff; they are painted grey below.
    nearest = distance_transform_edt(~measured, return_distances=False, return_indices=True)
    whole = heights[tuple(nearest)]
    steepness = np.sqrt(np.mean(np.square(np.gradient(whole, *spacing))))
    stretch = LIT_SLOPE / steepness if steepness > 0 else 1.0
    colours = LightSource(azdeg=315, altdeg=45).shade(
        # Rows of the image run to the North, the light's to the South: the step in y is negative.
        whole,
        colormaps[COLOUR_MAP],
        vmin=low,
        vmax=high,
        vert_exag=stretch,
        dx=spacing[1],
        dy=-spacing[0],
        blend_mode="soft",
    )[..., :3]
    colours[~measured] = to_rgb(MISSING)
    return colours
