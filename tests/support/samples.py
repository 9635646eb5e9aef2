"""Scans that tests make up."""

import numpy as np
import xarray as xr


def scan_of(z, spacing=0.5, x0=0.25, y0=0.25):
    """A scan as `read_scan` gives it."""
    z = np.asarray(z, dtype=float)
    return xr.DataArray(
        z,
        dims=("y", "x"),
        coords={
            "y": y0 + spacing * np.arange(z.shape[0]),
            "x": x0 + spacing * np.arange(z.shape[1]),
        },
        attrs={"spacing_x": spacing, "spacing_y": spacing, "source": "rock.npy"},
    )
