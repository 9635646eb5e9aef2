"""From measured numbers in mm to labelled heights; two faces onto one grid."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import xarray as xr

from ..errors import InputError
from . import points as cloud
from .pairs import MIRRORS, register
from .plausible import check_relief, check_spacing
from .raw import SMALLEST_SIDE

#: Two matrices are one grid when their spacings agree this well (relative).
SAME_SPACING = 1e-6
#: Two lattices are one grid when their nodes coincide within this fraction of a cell.
SAME_NODES = 0.01
ROUNDING = 1e-12  # relative: what interpolating a constant leaves


@dataclass(frozen=True)
class Measured:
    """A scan in mm, before it is on a grid.

    Attributes
    ----------
    path : Path
    layout : {"matrix", "points", "mesh"}
    values : ndarray
        Heights (ny, nx), first row at the smallest y; or points (n, 3).
    spacing : (float, float) or None
        dx, dy of a matrix.
    grid : float or None
        Spacing to grid points at, where the user gives it.
    provenance : dict
        Attributes for the result.
    """

    path: Path
    layout: str
    values: np.ndarray
    spacing: tuple[float, float] | None
    grid: float | None
    provenance: dict


def grid_one(scan: Measured) -> xr.DataArray:
    """Put one scan on its grid."""
    if scan.layout == "matrix":
        return _matrix_heights(scan)
    points = _usable_points(scan)
    lattice = _own_lattice(scan, points)
    if lattice is not None:
        return _placed_heights(scan, points, lattice)
    spacing = scan.grid or cloud.neighbour_distance(points)
    lattice = cloud.covering_lattice([points], spacing, str(scan.path))
    return _interpolated_heights(scan, points, lattice)


def grid_pair(
    lower: Measured, upper: Measured, registration="rigid", mirror_upper=None
) -> tuple[xr.DataArray, xr.DataArray]:
    """Put two faces on one common grid, registered, cropped to the area both cover.

    Parameters
    ----------
    lower, upper : Measured
    registration : {"rigid", "translation", "none"}
        See `pairs.register`.
    mirror_upper : {"x", "y"} or None
        The direction that runs the other way in an upper face scanned on its back.

    Raises
    ------
    InputError
        If one is a matrix and the other is not, two matrices have different spacings, or as
        `pairs.register`.
    """
    if (lower.layout == "matrix") != (upper.layout == "matrix"):
        raise InputError(
            f"{lower.path} is a {lower.layout} scan and {upper.path} is a {upper.layout} scan; "
            "export both faces in the same way"
        )
    where = f"{lower.path} and {upper.path}"
    if mirror_upper is not None:
        upper = _turned_over(upper, mirror_upper)
    if lower.layout == "matrix":
        z_l, z_u = _matrix_heights(lower), _matrix_heights(upper)
        if reason := _differing_grid(z_l, z_u):
            raise InputError(f"{where}: {reason}; resample one of them")
        return register(z_l, z_u, registration, where, mirrored=mirror_upper)
    points = [_usable_points(scan) for scan in (lower, upper)]
    lattices = [_own_lattice(s, p) for s, p in zip((lower, upper), points, strict=True)]
    if None not in lattices:
        z_l, z_u = (
            _placed_heights(*face) for face in zip((lower, upper), points, lattices, strict=True)
        )
        if not _differing_grid(z_l, z_u):
            return register(z_l, z_u, registration, where, mirrored=mirror_upper)
    # One sidecar serves both faces, so `grid` is the same for both.
    spacing = lower.grid or max(cloud.neighbour_distance(p) for p in points)

    def gridded(scan, points):
        lattice = cloud.covering_lattice([points], spacing, str(scan.path))
        return _interpolated_heights(scan, points, lattice)

    def regrid(motions):
        moved = points[1]
        for motion in motions:
            moved = motion.move_points(moved)
        return gridded(upper, moved)

    z_l, z_u = gridded(lower, points[0]), regrid([])
    return register(z_l, z_u, registration, where, mirrored=mirror_upper, regrid=regrid)


def _turned_over(scan: Measured, axis: str) -> Measured:
    """A face scanned on its back as it lies in the joint, about its own middle."""
    if scan.layout == "matrix":
        sign_x, sign_y, sign_z = MIRRORS[axis]
        values = sign_z * scan.values[::sign_y, ::sign_x]
    else:
        middle = (np.nanmin(scan.values, axis=0) + np.nanmax(scan.values, axis=0)) / 2
        values = middle + MIRRORS[axis] * (scan.values - middle)
    turned = f"turned over, {axis} and z run the other way"
    notes = "; ".join(note for note in (scan.provenance["notes"], turned) if note)
    return replace(scan, values=values, provenance=scan.provenance | {"notes": notes})


def _usable_points(scan: Measured) -> np.ndarray:
    points = cloud.merge_points(scan.values)
    if not np.isfinite(points[:, 2]).any():
        raise InputError(f"{scan.path}: all cells are missing: no point has a finite height")
    if np.isfinite(points[:, 2]).sum() < SMALLEST_SIDE**2:
        raise InputError(
            f"{scan.path}: only {len(points)} points; at least {SMALLEST_SIDE} x {SMALLEST_SIDE} "
            "are needed"
        )
    return points


def _own_lattice(scan: Measured, points: np.ndarray) -> cloud.Lattice | None:
    """The lattice the points lie on, unless the user wants another spacing."""
    lattice = cloud.find_lattice(points)
    wanted = scan.grid
    if lattice is None or wanted is None:
        return lattice
    same = np.allclose([lattice.dx, lattice.dy], wanted, rtol=SAME_SPACING, atol=0)
    return lattice if same else None


def _matrix_heights(scan: Measured) -> xr.DataArray:
    rows, columns = scan.values.shape
    dx, dy = scan.spacing
    lattice = cloud.Lattice(dx / 2, dy / 2, dx, dy, columns, rows)
    return _label(scan.values, lattice, scan, "")


def _placed_heights(scan, points, lattice) -> xr.DataArray:
    gridding = "the points lie on a regular grid; each is its node, nodes without one are missing"
    return _label(cloud.place_on_lattice(points, lattice), lattice, scan, gridding)


def _interpolated_heights(scan, points, lattice) -> xr.DataArray:
    points = points[np.isfinite(points[:, 2])]
    circle = cloud.largest_circle(points)
    gridding = (
        f"{len(points)} points interpolated linearly on their Delaunay triangles at a spacing of "
        f"{lattice.dx:.6g} mm; where a circle of {circle:.4g} mm holds no point, cells are missing"
    )
    heights = cloud.interpolate_points(points, lattice, circle, str(scan.path))
    return _label(heights, lattice, scan, gridding)


def _label(heights, lattice, scan: Measured, gridding: str) -> xr.DataArray:
    """Check the heights and give them coordinates, units and provenance."""
    _check_surface(heights, lattice, scan.path)
    x = lattice.x0 + lattice.dx * np.arange(lattice.nx)
    y = lattice.y0 + lattice.dy * np.arange(lattice.ny)
    return xr.DataArray(
        heights,
        dims=("y", "x"),
        coords={
            "y": ("y", y, {"units": "mm", "long_name": "distance North, cell centre"}),
            "x": ("x", x, {"units": "mm", "long_name": "distance East, cell centre"}),
        },
        name="height",
        attrs={
            "units": "mm",
            "long_name": "height",
            "spacing_x": lattice.dx,
            "spacing_y": lattice.dy,
            **scan.provenance,
            "gridding": gridding,
        },
    )


def _check_surface(heights: np.ndarray, lattice: cloud.Lattice, path: Path) -> None:
    """Refuse what cannot be the scan of a rough surface."""
    if min(heights.shape) < SMALLEST_SIDE:
        raise InputError(
            f"{path}: {heights.shape[0]} x {heights.shape[1]} cells are too few; at least "
            f"{SMALLEST_SIDE} x {SMALLEST_SIDE} are needed"
        )
    present = heights[np.isfinite(heights)]
    if present.size == 0:
        raise InputError(f"{path}: all cells are missing")
    if np.ptp(present) <= ROUNDING * np.abs(present).max():
        raise InputError(
            f"{path}: a constant surface: every height is {present[0]:g} mm, so this is no scan"
        )
    check_spacing((lattice.dx, lattice.dy), path)
    check_relief(present, max(lattice.dx * lattice.nx, lattice.dy * lattice.ny), path)


def _differing_grid(z_l: xr.DataArray, z_u: xr.DataArray) -> str | None:
    """Say why two gridded faces do not share one grid, or None if they do."""
    for axis in "xy":
        spacing_l, spacing_u = z_l.attrs[f"spacing_{axis}"], z_u.attrs[f"spacing_{axis}"]
        if abs(spacing_l - spacing_u) > SAME_SPACING * spacing_l:
            return f"spacings along {axis} differ: {spacing_l:.9g} and {spacing_u:.9g} mm"
        shift = float(z_u[axis][0] - z_l[axis][0]) / spacing_l
        if abs(shift - round(shift)) > SAME_NODES:
            return f"their cells are {shift - round(shift):.3f} of a cell apart along {axis}"
    return None
