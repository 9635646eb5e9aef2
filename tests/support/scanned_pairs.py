"""Two faces of one joint as two scans have them, the motion between them known."""

import numpy as np
import xarray as xr

from fractalcontact.registration.surface_motion import Motion, Surface, grid_nodes
from fractalcontact.surface.synthesis import self_affine

SPACING = 0.1
MARGIN = 48  # cells of rock around the lower face, that the upper face may have been moved over


def labelled(z, x0=0.0, y0=0.0, spacing=(SPACING, SPACING)):
    """Heights (y, x) as a scan, spacing (dx, dy)."""
    dx, dy = spacing
    y, x = y0 + dy * np.arange(z.shape[0]), x0 + dx * np.arange(z.shape[1])
    attrs = {"spacing_x": dx, "spacing_y": dy, "notes": ""}
    return xr.DataArray(z, dims=("y", "x"), coords={"y": y, "x": x}, attrs=attrs)


def motion(shift=(0.0, 0.0), degrees=0.0, slope=(0.0, 0.0), centre=(9.6, 9.6)):
    end = (centre[0] + shift[0], centre[1] + shift[1])
    return Motion(centre, end, np.radians(degrees), slope)


def joint(moved: Motion, hurst=0.7, cells=96, noise=0.0, seed=1, gap=0.5, spacing=(0.1, 0.1)):
    """A lower face, and the upper face as it lies before ``moved`` brings it to its place."""
    dx, dy = spacing
    whole = self_affine((cells + 2 * MARGIN,) * 2, dx, hurst, rms=1.0, seed=seed)
    rock = Surface(labelled(whole, spacing=spacing))
    empty = labelled(np.zeros((cells, cells)), MARGIN * dx, MARGIN * dy, spacing)
    x, y = grid_nodes(empty)
    rng = np.random.default_rng(seed)
    lower = empty.copy(data=rock(x, y) + noise * rng.normal(size=x.shape))
    x, y = moved.forth(x, y)
    upper = rock(x, y) - moved.rise(x, y) + gap + noise * rng.normal(size=x.shape)
    return lower, empty.copy(data=upper)
