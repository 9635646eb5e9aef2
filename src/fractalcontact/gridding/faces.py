"""Labelled heights from measured numbers in mm; two faces on one grid."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from ..core.errors import InputError
from ..registration.pairs import MIRRORS, register
from ..registration.surface_motion import Motion
from .clouds import Cloud, grid_cloud, moved_cloud, place_cloud, prepare_clouds
from .density import far_from_points, points_per_cell
from .plausible import check_surface
from .points import Lattice, covering_lattice
from .ungridded import NOTE, UngriddedScan, warnings_of

#: Largest relative difference of the spacings of two matrices on one grid.
SAME_SPACING = 1e-6
#: Largest distance of the nodes of two lattices on one grid, as a fraction of a cell.
SAME_NODES = 0.01


def grid_one(scan: UngriddedScan) -> xr.DataArray:
    """One scan on its grid."""
    if scan.layout == "matrix":
        return _matrix_heights(scan)
    (cloud,) = prepare_clouds([scan])
    if _keeps_lattice(scan, cloud):
        return _placed_heights(scan, cloud)
    spacing = scan.grid or cloud.spacing
    return _interpolated_heights(scan, cloud, spacing)


def grid_pair(
    lower: UngriddedScan,
    upper: UngriddedScan,
    registration: str | None = None,
    mirror_upper: str | None = None,
) -> tuple[xr.DataArray, xr.DataArray]:
    """Two faces on one common grid, registered and cropped to their common area.

    ``registration`` is that of `pairs.register`, rigid by default. ``mirror_upper`` is the
    direction, x or y, that runs the other way in an upper face scanned on its back. Matrices of
    different spacings are refused.
    """
    assert (lower.layout == "matrix") == (upper.layout == "matrix")  # `read_faces` refused others
    where, registration = f"{lower.path} and {upper.path}", registration or "rigid"
    if mirror_upper is not None:
        upper = _turned_over(upper, mirror_upper)
    if lower.layout == "matrix":
        z_l, z_u = _matrix_heights(lower), _matrix_heights(upper)
        if reason := _differing_grid(z_l, z_u):
            raise InputError(f"{where}: {reason}; resample one of them")
        return register(z_l, z_u, registration, where, mirrored=mirror_upper)
    clouds = prepare_clouds([lower, upper])
    faces = list(zip((lower, upper), clouds, strict=True))
    if all(_keeps_lattice(scan, cloud) for scan, cloud in faces):
        z_l, z_u = (_placed_heights(scan, cloud) for scan, cloud in faces)
        if not _differing_grid(z_l, z_u):
            return register(z_l, z_u, registration, where, mirrored=mirror_upper)
    # One sidecar serves both faces, so `grid` is the same for both.
    spacing = lower.grid or max(cloud.spacing for cloud in clouds)

    def regrid(motions: Sequence[Motion]) -> xr.DataArray:
        return _interpolated_heights(upper, moved_cloud(clouds[1], motions), spacing)

    z_l, z_u = _interpolated_heights(lower, clouds[0], spacing), regrid([])
    return register(z_l, z_u, registration, where, mirrored=mirror_upper, regrid=regrid)


def _turned_over(scan: UngriddedScan, axis: str) -> UngriddedScan:
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


def _keeps_lattice(scan: UngriddedScan, cloud: Cloud) -> bool:
    """True if the points stay on the lattice they lie on: the user wants no other spacing."""
    lattice = cloud.lattice
    if lattice is None or scan.grid is None:
        return lattice is not None
    return np.allclose([lattice.dx, lattice.dy], scan.grid, rtol=SAME_SPACING, atol=0)


def _matrix_heights(scan: UngriddedScan) -> xr.DataArray:
    rows, columns = scan.values.shape
    assert scan.spacing is not None  # a matrix has one
    dx, dy = scan.spacing
    lattice = Lattice(dx / 2, dy / 2, dx, dy, columns, rows)
    return _label(scan.values, lattice, scan, "")


def _placed_heights(scan: UngriddedScan, cloud: Cloud) -> xr.DataArray:
    heights, gridding = place_cloud(cloud)
    return _label(heights, cloud.lattice, scan, gridding, cloud)


def _interpolated_heights(scan: UngriddedScan, cloud: Cloud, spacing: float) -> xr.DataArray:
    lattice = covering_lattice(cloud.points, spacing, str(scan.path))
    heights, gridding = grid_cloud(cloud, lattice)
    sparse = far_from_points(cloud.points, lattice, cloud.area_per_point)
    labelled = _label(heights, lattice, scan, gridding, cloud)
    return labelled.assign_coords(sparse=(("y", "x"), sparse & np.isfinite(heights)))


def _label(heights, lattice, scan: UngriddedScan, gridding: str, cloud=None) -> xr.DataArray:
    """Check the heights and give them coordinates, units and provenance."""
    words = check_surface(heights, (lattice.dx, lattice.dy), scan.path)
    notes = [f"{NOTE}{sentence}" for sentence in words]
    provenance = dict(scan.provenance)
    if cloud is not None:
        provenance |= cloud.attrs
        provenance["points_per_cell"] = points_per_cell(cloud.points, heights, lattice)
        notes = [*cloud.notes, *notes]
    provenance["notes"] = "; ".join(filter(None, (provenance["notes"], *notes)))
    provenance["warnings"] = "\n".join(filter(None, (provenance["warnings"], warnings_of(notes))))
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
            **provenance,
            "gridding": gridding,
            "missing_share": float(np.isnan(heights).mean()),
        },
    )


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
