"""Clouds and meshes made ready for a grid: turned level, repeats and overhangs counted."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..core.errors import InputError
from ..core.limits import SMALLEST_SIDE
from ..core.text import percent
from ..registration.surface_motion import Motion
from . import density as dense
from . import levelling, overhangs
from . import points as pts
from .triangles import interpolate_mesh, interpolate_points, places_across
from .ungridded import NOTE, UngriddedScan

_CUT_APART = (
    "save each face in a file of its own, two faces as NAME.lower and NAME.upper, as seen from "
    "above"
)
_OVERHANG_OF_POINTS = (
    "of the points lies beneath others; so few are kept",
    "of the points lies beneath others and is left out: an instrument above would not see it",
)

#: Largest fraction of points that lie above another point as repeats by chance.
_MANY_STACKED = 0.05


@dataclass(frozen=True)
class Mesh:
    """Vertices (n, 3) in mm and the triangles (m, 3) between them."""

    vertices: np.ndarray
    triangles: np.ndarray


@dataclass(frozen=True)
class Cloud:
    """Points of one scan, ready for a grid."""

    path: Path
    points: np.ndarray  # (n, 3) in mm, no two at one x, y; heights may be missing on a lattice
    lattice: pts.Lattice | None  # regular grid that all points lie on
    density: dense.Density | None  # None on a lattice
    mesh: Mesh | None
    attrs: dict  # of the result, on the points
    notes: tuple[str, ...]  # what was done, and what a user should know
    parted: float = 0.0  # share of the points of the file that lie on one of two faces

    @property
    def area_per_point(self) -> float:
        """Area per point where points are, mm2."""
        if self.density is not None:
            return self.density.area
        assert self.lattice is not None  # without a lattice there is a density
        return self.lattice.dx * self.lattice.dy

    @property
    def spacing(self) -> float:
        """Spacing that suits the cloud, mm."""
        if self.lattice is not None:
            return min(self.lattice.dx, self.lattice.dy)
        assert self.density is not None
        return self.density.spacing


def prepare_clouds(scans: Sequence[UngriddedScan]) -> list[Cloud]:
    """Clouds of one or two faces, ready for one grid.

    Points on a regular grid of x and y are one height to a node and stay as they are. Others are
    turned level if they lie steeply, faces together; then the points hidden under others are left
    out. Too few points, points on one line and those of two faces in one file are refused.
    """
    clouds = [_merge(scan) for scan in scans]
    if scans[0].level and any(cloud.lattice is None for cloud in clouds):
        clouds = _turn_level(clouds, scans)
    return [_look_beneath(cloud) for cloud in clouds]


def moved_cloud(cloud: Cloud, motions: Sequence[Motion]) -> Cloud:
    """A cloud after rigid motions, one after the other."""
    points, mesh = cloud.points, cloud.mesh
    for motion in motions:
        if mesh is not None:
            mesh = replace(mesh, vertices=motion.move_points(mesh.vertices, of=points))
        points = motion.move_points(points)
    return replace(cloud, points=points, mesh=mesh)


def grid_cloud(cloud: Cloud, lattice: pts.Lattice) -> tuple[np.ndarray, str]:
    """Heights (ny, nx) of a cloud on a grid, and the method of gridding in words."""
    where = str(cloud.path)
    area = cloud.area_per_point
    across = places_across(lattice, area)
    if cloud.mesh is not None:
        of = f"the mesh's own {len(cloud.mesh.triangles)} triangles, the top-most where several are"
        heights = interpolate_mesh(
            cloud.mesh.vertices, cloud.mesh.triangles, lattice, across, where
        )
        _refuse_several_faces(cloud.mesh, heights, lattice, where)
        holes = "where no triangle is, cells are missing"
    else:
        points = cloud.points[np.isfinite(cloud.points[:, 2])]
        density = cloud.density or _measure_density(points, cloud.path)
        of = f"{len(points)} points on their Delaunay triangles"
        heights = interpolate_points(points, lattice, density.circle, across, where)
        holes = f"where a circle of {density.circle:.4g} mm holds no point, cells are missing"
    means = ""
    if across > 1:
        means = f", averaged over {across} x {across} places in each cell"
    return heights, (
        f"linear interpolation of {of}{means}, at a spacing of {lattice.dx:.6g} mm; {holes}"
    )


def place_cloud(cloud: Cloud) -> tuple[np.ndarray, str]:
    """Heights of a cloud on the lattice its points lie on, and the method in words."""
    mesh, lattice = cloud.mesh, cloud.lattice
    assert lattice is not None  # the caller has checked it
    heights = pts.place_on_lattice(cloud.points, lattice)
    gridding = "the points lie on a regular grid; each is its node, "
    if mesh is None:
        return heights, gridding + "nodes without one are missing"
    between = interpolate_mesh(mesh.vertices, mesh.triangles, lattice, 1, str(cloud.path))
    _refuse_several_faces(mesh, between, lattice, str(cloud.path))
    heights = np.where(np.isfinite(heights), heights, between)
    return heights, gridding + "nodes without one lie on the mesh's triangles or are missing"


def _refuse_several_faces(mesh: Mesh, heights: np.ndarray, lattice: pts.Lattice, where: str):
    """Refuse a mesh of two faces above each other; of a closed body a note says what is read."""
    cell = lattice.dx * lattice.dy
    layers = overhangs.mean_layers(mesh.vertices, mesh.triangles, heights, cell)
    if layers >= overhangs.SEVERAL_FACES and not overhangs.is_closed(mesh.triangles):
        raise InputError(
            f"{where}: the mesh has {layers:.1f} heights at each x, y on average: two faces or "
            f"scans in one file, or a body; {_CUT_APART}"
        )


def _merge(scan: UngriddedScan) -> Cloud:
    """Count and join repeats, and look for a lattice."""
    points, repeats = pts.merge_points(scan.values)
    n_finite = int(np.isfinite(points[:, 2]).sum())
    if n_finite == 0:
        raise InputError(f"{scan.path}: all cells are missing: no point has a finite height")
    if n_finite < SMALLEST_SIDE**2:
        raise InputError(
            f"{scan.path}: only {n_finite} points; at least {SMALLEST_SIDE} x {SMALLEST_SIDE} are "
            "needed"
        )
    mesh = None
    if scan.triangles is not None:
        whole = np.isfinite(scan.values).all(axis=1)[scan.triangles].all(axis=1)
        mesh = Mesh(scan.values, scan.triangles[whole])
    lattice, parted = None, 0.0
    if mesh is None or repeats.stacked == 0:
        distance = dense.neighbour_distance(points, dense.plane_tree(points))
        lattice = pts.find_lattice(points, distance)
    if mesh is None and (repeats.stacked or lattice is None):
        every = np.unique(scan.values[_finite(scan.values)], axis=0)
        parted = overhangs.parted_share(every, dense.plane_tree(every))
    attrs: dict[str, float] = {"points": len(scan.values), "duplicated_points": repeats.duplicated}
    attrs |= {"stacked_points": repeats.stacked, "overhang_share": 0.0, "levelled_degrees": 0.0}
    notes = []
    if repeats.duplicated:
        notes.append(f"{repeats.duplicated} points are repeated; each counts once")
    if repeats.stacked:
        what = "averaged" if mesh is None else "upright parts of the mesh"
        note = f"{repeats.stacked} points lie above or below another point: {what}"
        if mesh is None and repeats.stacked > _MANY_STACKED * len(points):
            note = f"{NOTE}{note}; two faces or scans in one file? Cut them apart"
        notes.append(note)
    return Cloud(scan.path, points, lattice, None, mesh, attrs, tuple(notes), parted)


def _turn_level(clouds: list[Cloud], scans) -> list[Cloud]:
    """Turn clouds by one rotation if their common plane is steep."""
    present = [cloud.points[np.isfinite(cloud.points[:, 2])] for cloud in clouds]
    whole = [
        points if cloud.mesh is None else cloud.mesh.vertices[_finite(cloud.mesh.vertices)]
        for points, cloud in zip(present, clouds, strict=True)
    ]
    meshes = [cloud.mesh for cloud in clouds if cloud.mesh is not None]
    upward = sum(_mean_normal(mesh) for mesh in meshes) if meshes else None
    normal, centre = levelling.common_plane(whole, upward)
    if not levelling.is_steep(normal):
        return clouds
    return [_turned(cloud, scan, normal, centre) for cloud, scan in zip(clouds, scans, strict=True)]


def _turned(cloud: Cloud, scan, normal: np.ndarray, centre: np.ndarray) -> Cloud:
    """One cloud after the rotation; repeats are looked for in the new x and y."""
    values = levelling.turn_level(scan.values, normal, centre)
    degrees = levelling.tilt_degrees(normal)
    notes = [
        f"turned by {degrees:.3g} degrees about the horizontal line of its mean plane, to make "
        "that plane level; x, y and heights are those of the turned points"
    ]
    if degrees > levelling.UPRIGHT and cloud.mesh is None:
        notes.append("NOTE: it stood upright, so its points do not determine which side is up")
    if (missing := np.count_nonzero(~_finite(scan.values))) and cloud.mesh is None:
        notes.append(f"{missing} points without a height have no place after the turn")
    turned = _merge(replace(scan, values=values))
    attrs = turned.attrs | {"levelled_degrees": float(degrees)}
    # Turned points lie on a lattice by chance alone.
    return replace(turned, lattice=None, attrs=attrs, notes=(*notes, *turned.notes))


def _look_beneath(cloud: Cloud) -> Cloud:
    """Measure overhangs and density; two faces in one cloud are refused."""
    if cloud.parted >= overhangs.TWO_FACES:
        raise InputError(
            f"{cloud.path}: {percent(cloud.parted)} of the points lie on one of two faces whose "
            f"other is next to them: two faces or scans in one file, or a body; {_CUT_APART}"
        )
    if cloud.mesh is not None:
        cloud = _with_overhang_of_mesh(cloud, cloud.mesh)
    if cloud.lattice is not None:
        return cloud
    points = cloud.points[np.isfinite(cloud.points[:, 2])]
    tree = dense.plane_tree(points)
    if cloud.mesh is None:
        cloud = _with_layers(cloud, overhangs.layered_share(points, tree))
        share, hidden = overhangs.find_hidden(points, tree)
        cloud = _with_overhang(cloud, share, _OVERHANG_OF_POINTS[hidden is not None])
        if hidden is not None:
            points = points[~hidden]
            tree = dense.plane_tree(points)
    density = _measure_density(points, cloud.path, tree)
    notes = cloud.notes
    if density.uneven:
        notes += (
            f"the points lie unevenly: the nearest is {density.distance:.4g} mm away, but each "
            f"has {density.area:.4g} mm2 on average (random points, lines, clumps); the spacing "
            "is the root of this area, and much between the points is interpolated",
        )
    return replace(cloud, points=points, density=density, notes=notes)


def _with_layers(cloud: Cloud, share: float) -> Cloud:
    """The cloud with a note if it has several layers."""
    if share < overhangs.SEVERAL_LAYERS:
        return cloud
    note = (
        f"{NOTE}{percent(share)} of the points lie far above or below their neighbours in x and y: "
        "a closed body, or two faces or scans in one file; cut out one face, as seen from above"
    )
    return replace(cloud, notes=(*cloud.notes, note))


def _with_overhang(cloud: Cloud, share: float, what: str) -> Cloud:
    """The cloud with its share of overhangs, noted if there are any."""
    notes = cloud.notes
    if np.isnan(share):
        notes += ("its triangles are not wound alike, so that overhangs are not found",)
    elif share > 0:
        notes += (f"overhangs: {percent(share)} {what}",)
    return replace(cloud, attrs=cloud.attrs | {"overhang_share": share}, notes=notes)


def _with_overhang_of_mesh(cloud: Cloud, mesh: Mesh) -> Cloud:
    down, against = overhangs.downward_share(mesh.vertices, mesh.triangles)
    cloud = _with_overhang(cloud, against, "of the mesh faces down; its top-most part is used")
    if overhangs.is_closed(mesh.triangles):
        note = (
            f"{NOTE}the mesh is a closed body, such as a boulder, of which the top-most part was "
            "read up to its outline; cut out the face itself"
        )
        cloud = replace(cloud, notes=(*cloud.notes, note))
    if down <= 0.5:
        return cloud
    note = "most triangles are wound to face down; heights are taken to point up all the same"
    return replace(cloud, notes=(*cloud.notes, note))


def _measure_density(points: np.ndarray, path: Path, tree=None) -> dense.Density:
    density = dense.measure_density(points, tree or dense.plane_tree(points))
    if density is None:
        raise InputError(f"{path}: the points span no area (do they lie on one line?)")
    return density


def _mean_normal(mesh: Mesh) -> np.ndarray:
    return overhangs.triangle_normals(mesh.vertices, mesh.triangles).sum(axis=0)


def _finite(points: np.ndarray) -> np.ndarray:
    return np.isfinite(points).all(axis=1)
