"""Points x, y, z onto a regular grid: exactly where they lie on one, else by interpolation."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import LinearNDInterpolator
from scipy.spatial import Delaunay, QhullError, cKDTree

from ..errors import InputError

#: Coordinates may stray this fraction of the pitch from a lattice (rounding in the export).
LATTICE_TOLERANCE = 0.1
#: Points rounded coarsely lie on a lattice too, but leave most of its nodes empty.
LATTICE_MIN_FILL = 0.2
#: Nothing was measured where a circle without points has a radius above this multiple of the usual
#: distance from a point to its sixth neighbour. That distance is 1.1 to 1.4 times the root of the
#: area per point, for lattices and random clouds alike; chance leaves such a circle once in 10^4.
HOLE_FACTOR = 1.5
_SIXTH = 6
#: Far above any profilometer; a stray point would otherwise ask for all memory.
MOST_CELLS = 200_000_000


@dataclass(frozen=True)
class Lattice:
    """A regular grid of nodes: origin, pitch and number along x and y."""

    x0: float
    y0: float
    dx: float
    dy: float
    nx: int
    ny: int


def merge_points(points: np.ndarray) -> np.ndarray:
    """Drop points without finite coordinates; average the heights at the same x, y.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Missing heights are NaN.

    Returns
    -------
    ndarray, shape (m, 3)
        m <= n; a height is NaN where none was measured at its x, y.
    """
    points = points[np.isfinite(points[:, :2]).all(axis=1)]
    if len(points) == 0:
        return points
    points = points[np.lexsort(points[:, :2].T)]
    starts = np.flatnonzero(np.r_[True, (np.diff(points[:, :2], axis=0) != 0).any(axis=1)])
    z = points[:, 2]
    measured = np.isfinite(z)
    counts = np.add.reduceat(measured.astype(float), starts)
    sums = np.add.reduceat(np.where(measured, z, 0.0), starts)
    heights = np.divide(sums, counts, out=np.full(len(starts), np.nan), where=counts > 0)
    return np.column_stack([points[starts, :2], heights])


def neighbour_distance(points: np.ndarray) -> float:
    """Median distance in the plane from a point to its nearest neighbour, in mm."""
    distances, _ = cKDTree(points[:, :2]).query(points[:, :2], k=2)
    return float(np.median(distances[:, 1]))


def largest_circle(points: np.ndarray) -> float:
    """Radius in mm of the largest circle without points that is no hole."""
    distances, _ = cKDTree(points[:, :2]).query(points[:, :2], k=[_SIXTH + 1])
    return HOLE_FACTOR * float(np.median(distances))


def find_lattice(points: np.ndarray) -> Lattice | None:
    """Find the regular grid that all points lie on, or None if they do not.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        No two at the same x, y.
    """
    tolerance = LATTICE_TOLERANCE * neighbour_distance(points)
    axes = [_find_levels(points[:, axis], tolerance) for axis in (0, 1)]
    if None in axes:
        return None
    (x0, dx, nx), (y0, dy, ny) = axes
    if len(points) < LATTICE_MIN_FILL * nx * ny:
        return None
    return Lattice(x0, y0, dx, dy, nx, ny)


def _find_levels(coordinate: np.ndarray, tolerance: float) -> tuple[float, float, int] | None:
    """Origin, pitch and number of equidistant levels the coordinates bunch at."""
    ordered = np.sort(coordinate)
    first = np.r_[0, np.flatnonzero(np.diff(ordered) > tolerance) + 1]
    last = np.r_[first[1:], len(ordered)] - 1
    if len(first) < 2 or np.any(ordered[last] - ordered[first] > 2 * tolerance):
        return None
    levels = (ordered[first] + ordered[last]) / 2
    pitch = float(np.median(np.diff(levels)))
    index = np.round((levels - levels[0]) / pitch)
    if np.any(np.diff(index) < 1):
        return None
    pitch, origin = np.polyfit(index, levels, 1)
    if np.abs(levels - origin - pitch * index).max() > tolerance:
        return None
    # The fit leaves 1 mm as 1.0000000000000002 mm.
    pitch = float(f"{pitch:.10g}")
    return round(origin / pitch, 9) * pitch, pitch, int(index[-1]) + 1


def place_on_lattice(points: np.ndarray, lattice: Lattice) -> np.ndarray:
    """Put each height on its node; nodes without a point are missing.

    Returns
    -------
    ndarray, shape (ny, nx)
    """
    columns = np.round((points[:, 0] - lattice.x0) / lattice.dx).astype(int)
    rows = np.round((points[:, 1] - lattice.y0) / lattice.dy).astype(int)
    heights = np.full((lattice.ny, lattice.nx), np.nan)
    heights[rows, columns] = points[:, 2]
    return heights


def covering_lattice(clouds: list[np.ndarray], spacing: float, where: str) -> Lattice:
    """Make the grid that covers the area common to all clouds.

    Nodes are whole multiples of the spacing, so that grids of the same spacing coincide.

    Raises
    ------
    InputError
        If the clouds do not overlap, or the grid would be absurdly large.
    """
    low = np.max([cloud[:, :2].min(axis=0) for cloud in clouds], axis=0)
    high = np.min([cloud[:, :2].max(axis=0) for cloud in clouds], axis=0)
    first = np.ceil(low / spacing - 1e-9)
    count = np.floor(high / spacing + 1e-9) - first + 1
    if np.any(count < 1):
        raise InputError(
            f"{where}: the points share no area of at least one grid spacing ({spacing:.4g} mm); "
            "two faces must be given in one coordinate frame, and key 'grid' must suit them"
        )
    if count.prod() > MOST_CELLS:
        raise InputError(
            f"{where}: a grid of {spacing:.4g} mm over {high[0] - low[0]:.4g} x "
            f"{high[1] - low[1]:.4g} mm has too many cells; remove stray points or set a coarser "
            "key 'grid'"
        )
    return Lattice(*map(float, first * spacing), spacing, spacing, int(count[0]), int(count[1]))


def interpolate_points(
    points: np.ndarray, lattice: Lattice, largest_circle: float, where: str
) -> np.ndarray:
    """Interpolate heights linearly on the Delaunay triangles of the points.

    Triangles whose circumcircle, which holds no other point, has a radius above ``largest_circle``
    (mm) span holes or the outside (alpha shape: Edelsbrunner, Kirkpatrick & Seidel 1983); cells in
    them are missing.

    Returns
    -------
    ndarray, shape (ny, nx)

    Raises
    ------
    InputError
        If the points lie on one line.
    """
    centre = points[:, :2].mean(axis=0)  # far from the origin, triangulation loses digits
    try:
        triangles = Delaunay(points[:, :2] - centre)
    except QhullError as error:
        raise InputError(f"{where}: the points span no area (do they lie on one line?)") from error
    x = lattice.x0 + lattice.dx * np.arange(lattice.nx) - centre[0]
    y = lattice.y0 + lattice.dy * np.arange(lattice.ny) - centre[1]
    nodes = np.stack(np.meshgrid(x, y), axis=-1)
    triangle = triangles.find_simplex(nodes)
    measured = (_circumradius(triangles) <= largest_circle)[triangle] & (triangle >= 0)
    heights = LinearNDInterpolator(triangles, points[:, 2])(nodes)
    return np.where(measured, heights, np.nan)


def _circumradius(triangles: Delaunay) -> np.ndarray:
    """R = abc/(4 area) of each triangle; infinite where the corners lie on one line."""
    a, b, c = np.moveaxis(triangles.points[triangles.simplices], 1, 0)
    edges = [np.hypot(*(end - start).T) for start, end in ((a, b), (b, c), (c, a))]
    twice_area = np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    flat = np.full(len(a), np.inf)
    return np.divide(np.prod(edges, axis=0), 2 * twice_area, out=flat, where=twice_area > 0)
