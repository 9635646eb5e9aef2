"""Pictures of the table of specimens."""

import base64
import io

import numpy as np
import xarray as xr
from matplotlib.image import imread

from fractalcontact.pages.thumbnails import SIDE, relief_thumbnail, shaded


def test_relief_is_lit_from_the_upper_left_and_missing_cells_are_white():
    """A hill's slope towards it is brighter than the one away from it."""
    y, x = np.mgrid[1:-1:40j, -1:1:40j]
    hill = np.exp(-4 * (x**2 + y**2))
    hill[-3:, :3] = np.nan
    grey = shaded(hill, 0.05).astype(int)
    assert grey[:20, :20].mean() > grey[20:, 20:].mean() + 20
    assert (grey[-3:, :3] == 255).all()
    assert (shaded(np.zeros((8, 8)), 1.0) == shaded(np.ones((8, 8)), 1.0)).all()


def test_a_thumbnail_has_means_of_what_is_known_north_up():
    """A ridge in the South of a window of twice the pixels, with a missing cell."""
    lower = np.zeros((2 * SIDE, 2 * SIDE))
    lower[20:24] = 1.0
    lower[21, 7] = np.nan
    attrs = {"window_y0": 0, "window_x0": 0, "window_ny": 2 * SIDE, "window_nx": 2 * SIDE}
    attrs |= {"spacing_x": 0.1, "spacing_y": 0.1}
    start, _, data = relief_thumbnail(
        xr.Dataset({"lower": (("y", "x"), lower)}, attrs=attrs)
    ).partition(",")
    assert start == "data:image/png;base64"
    found = imread(io.BytesIO(base64.b64decode(data)), format="png")
    assert found.shape == (SIDE, SIDE)
    edges = np.flatnonzero(np.abs(found[:, 50] - np.median(found)) > 0.1)
    assert edges.size
    assert (edges > SIDE // 2).all()
