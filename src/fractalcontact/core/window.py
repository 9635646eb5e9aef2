"""Window of a specimen, as its dataset states it: spacing, sides, area, place, faces."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from .directions import APERTURE, slides


def spacing_of(grid: xr.Dataset | xr.DataArray) -> tuple[float, float]:
    """Distances (dy, dx) of neighbouring nodes, mm.

    From the attributes ``spacing_y`` and ``spacing_x`` of a scan, a specimen or another grid.
    """
    return float(grid.attrs["spacing_y"]), float(grid.attrs["spacing_x"])


def faces(specimen: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Heights of the lower and upper face (ny, nx) in mm, NaN where missing.

    A face that was not scanned is the lower face itself ("match") or the plane z = 0
    ("flat"; for an aperture map, "aperture", the lower face is the negative of the map).
    """
    z_l = specimen["lower"].values.astype(np.float64)
    if specimen.attrs["opposite"] == "scanned":
        return z_l, specimen["upper"].values.astype(np.float64)
    if not slides(specimen.attrs["opposite"]):
        return z_l, np.zeros_like(z_l)
    return z_l, z_l


def face_words(specimen: xr.Dataset, face: str) -> str:
    """Face in words; the negative of an aperture map stands where others have the lower one."""
    is_face = specimen.attrs["opposite"] != APERTURE
    return f"{face} face" if is_face else "negative of the aperture"


def window_slices(specimen: xr.Dataset) -> tuple[slice, slice]:
    """Rows and columns of the window at zero offset."""
    y0, x0, ny, nx = (int(specimen.attrs[f"window_{key}"]) for key in ("y0", "x0", "ny", "nx"))
    return slice(y0, y0 + ny), slice(x0, x0 + nx)


def window_sides(specimen: xr.Dataset) -> tuple[float, float]:
    """Sides (y, x) of the window, mm."""
    cells = (specimen.attrs[f"window_n{axis}"] for axis in "yx")
    side_y, side_x = (n * s for n, s in zip(cells, spacing_of(specimen), strict=True))
    return side_y, side_x


def window_fraction(specimen: xr.Dataset, cells: Sequence[int] | None = None) -> float:
    """Fraction of the measured cells of a face that its window takes, or one of (ny, nx) cells."""
    ny, nx = cells or (specimen.attrs["window_ny"], specimen.attrs["window_nx"])
    return float(ny * nx / int(specimen["valid"].sum()))


def cell_side(specimen: xr.Dataset) -> float:
    """s, mm: side of the square as large as a cell, so that N nodes cover N s^2."""
    spacing_y, spacing_x = spacing_of(specimen)
    return float(np.sqrt(spacing_y * spacing_x))


def nominal_area(specimen: xr.Dataset) -> float:
    """A_0 of the window, mm2."""
    side_y, side_x = window_sides(specimen)
    return side_y * side_x
