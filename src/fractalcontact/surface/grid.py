"""Spacing of the grid that a scan or a specimen lies on."""

import xarray as xr


def spacing_of(grid: xr.Dataset | xr.DataArray) -> tuple[float, float]:
    """Distances (dy, dx) of neighbouring nodes, mm.

    Parameters
    ----------
    grid : Dataset or DataArray
        A scan, a specimen, or anything else with the attributes ``spacing_y`` and ``spacing_x``.
    """
    return float(grid.attrs["spacing_y"]), float(grid.attrs["spacing_x"])
