"""Density of points: their distance, the area of one point, the largest circle that is no hole."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import Delaunay, cKDTree

from ..core.strips import blocks, strips
from .points import Lattice
from .triangles import circumradius, doubled_area, on_one_line

#: Number of points that stand for all in a median, which is then known to 1 %.
SAMPLE = 50_000
#: Patches in which triangles are examined, and neighbouring points of a patch. A cloud with fewer
#: points is examined as a whole.
PATCHES = 20
PATCH_POINTS = 3_000
#: Least radius of a circle without points in which nothing was measured, in radii of the usual
#: circle through three neighbours. The usual radius is 0.62 to 0.73 times the root of the area per
#: point, for lattices and random clouds alike, and half the distance of the lines where a scanner's
#: lines lie far apart; chance leaves a circle of the multiple once in 10^5 points.
HOLE_FACTOR = 3.0
#: Largest root of the area per point, in nearest distances, of points that do not lie at random,
#: along lines or in clumps: it is 1.0 to 1.1 on a lattice, 1.1 to 1.2 in clouds of scanners and 2.1
#: in a random cloud. Of other points a grid at the nearest distance would have many cells a point,
#: none of them measured.
UNEVEN = 1.5
#: Least distance of a far cell to all points, in sides of the square that a point, or the cell, has
#: to itself: on a regular lattice no cell is farther than 0.71 of that side.
FAR = 1.5


@dataclass(frozen=True)
class Density:
    """Density of the points of one cloud."""

    distance: float  # median distance to the nearest neighbour, mm
    area: float  # area per point where points are, mm2
    circle: float  # radius of the largest circle without points that is no hole, mm

    @property
    def uneven(self) -> bool:
        """True if the points lie at random, much closer along one direction, or in clumps."""
        return np.sqrt(self.area) > UNEVEN * self.distance

    @property
    def spacing(self) -> float:
        """Spacing that suits the points, mm."""
        return float(np.sqrt(self.area)) if self.uneven else self.distance


def plane_tree(points: np.ndarray) -> cKDTree:
    """Tree of the points' x, y; built the quick way, ten million take seconds."""
    return cKDTree(points[:, :2], balanced_tree=False, compact_nodes=False)


def sample_points(points: np.ndarray, size: int = SAMPLE) -> np.ndarray:
    """All points, or this many of them taken at random (the same ones every time)."""
    if len(points) <= size:
        return points
    return points[np.random.default_rng(0).choice(len(points), size, replace=False)]


def neighbour_distance(points: np.ndarray, tree: cKDTree) -> float:
    """Median distance in the plane from a point to its nearest neighbour, in mm."""
    distances, _ = tree.query(sample_points(points)[:, :2], k=2)
    return float(np.median(distances[:, 1]))


def measure_density(points: np.ndarray, tree: cKDTree) -> Density | None:
    """Density of points (n, 3), no two at one x, y, from all of them or from patches.

    ``tree`` holds these points; None if they lie on one line.
    """
    if on_one_line(points[:, :2]):
        return None
    if len(points) <= PATCHES * PATCH_POINTS:
        patches = [(points[:, :2], np.inf)]
    else:
        centres = sample_points(points, PATCHES)[:, :2]
        distances, neighbours = tree.query(centres, k=PATCH_POINTS)
        patches = [
            (points[near, :2] - centre, reach)
            for centre, near, reach in zip(centres, neighbours, distances[:, -1], strict=True)
        ]
    radii, areas = zip(*(_circles(xy, reach) for xy, reach in patches), strict=True)
    radii, areas = np.concatenate(radii), np.concatenate(areas)
    circle = HOLE_FACTOR * float(np.median(radii))
    # A triangulation of many points has two triangles a point.
    area = 2 * float(areas[radii <= circle].mean())
    return Density(neighbour_distance(points, tree), area, circle)


def _circles(xy: np.ndarray, reach: float) -> tuple[np.ndarray, np.ndarray]:
    """Circumradius and area of the triangles that points beyond ``reach`` cannot change.

    The circle of a Delaunay triangle holds no point; within ``reach`` of the origin all are known.
    """
    if on_one_line(xy):
        return np.empty(0), np.empty(0)
    xy = xy - (xy.mean(axis=0) if np.isinf(reach) else 0.0)
    simplices = Delaunay(xy).simplices
    radius = circumradius(xy, simplices)
    farthest = np.hypot(*xy[simplices].mean(axis=1).T) + 2 * radius
    settled = np.isfinite(radius) & (farthest <= reach)
    return radius[settled], doubled_area(xy, simplices)[settled] / 2


def points_per_cell(points: np.ndarray, heights: np.ndarray, lattice: Lattice) -> float:
    """Median number of points (n, 3) in a measured cell of heights (ny, nx), or NaN."""
    measured = np.isfinite(heights)
    n_measured = int(measured.sum())
    if n_measured == 0:
        return np.nan
    if heights.size <= 4 * len(points):
        held = np.zeros(heights.size, dtype=np.uint32)
        for part in blocks(len(points)):
            np.add.at(held, _cells_of(points[part], lattice), np.uint32(1))
        return float(np.median(held[measured.ravel()]))
    cells, counts = np.unique(_cells_of(points, lattice), return_counts=True)
    counts = np.sort(counts[measured.ravel()[cells]])
    empty = n_measured - len(counts)  # most cells may be empty, so `counts` does not list those
    middle = [(n_measured - 1) // 2 - empty, n_measured // 2 - empty]
    return float(np.mean([counts[i] if i >= 0 else 0 for i in middle]))


def _cells_of(points: np.ndarray, lattice: Lattice) -> np.ndarray:
    """Cell of each point, counted row by row; points outside the grid are left out."""
    columns = np.round((points[:, 0] - lattice.x0) / lattice.dx).astype(np.int64)
    rows = np.round((points[:, 1] - lattice.y0) / lattice.dy).astype(np.int64)
    inside = (columns >= 0) & (columns < lattice.nx) & (rows >= 0) & (rows < lattice.ny)
    return rows[inside] * lattice.nx + columns[inside]


def far_from_points(points: np.ndarray, lattice: Lattice, area: float) -> np.ndarray:
    """Cells (ny, nx) far from every point of a cloud, whose heights are interpolated.

    ``area`` is that per point where points are, mm2.
    """
    x = lattice.x0 + lattice.dx * np.arange(lattice.nx)
    y = lattice.y0 + lattice.dy * np.arange(lattice.ny)
    reach = FAR * np.sqrt(max(area, lattice.dx * lattice.dy))
    measured = np.isfinite(points[:, 2])
    tree = plane_tree(points if measured.all() else points[measured])
    far = np.empty((lattice.ny, lattice.nx), dtype=bool)
    for rows in strips(far.shape, 4):
        cells = np.stack(np.meshgrid(x, y[rows]), axis=-1)
        far[rows] = ~np.isfinite(tree.query(cells, distance_upper_bound=reach)[0])
    return far
