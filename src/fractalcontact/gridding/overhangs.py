"""Parts of a surface that lie beneath other parts and cannot be heights over x and y."""

import numpy as np
from scipy.spatial import cKDTree

from .density import sample_points
from .triangles import doubled_area

#: Neighbours in the plane that are looked at. Where two layers overlap there are 18 of each, and
#: by chance those above leave half a circle free once in a thousand points.
_NEIGHBOURS = 36
#: Least steepness of the line from a point to another that lies above it.
_STEEPEST = np.tan(np.radians(80.0))
#: Least rise of a point above another, in lower quartiles of the height differences between nearest
#: neighbours: white noise alone reaches 16 of them once in a million pairs. The quartile is that of
#: one layer, even where two layers lie over each other everywhere.
_NOISE = 20.0
#: Fewest neighbours that make a layer, above a point or at its level; fewer are spikes.
_FEWEST = 6
#: Widest sector without points above, if points above lie on all sides. Points beyond a line, as at
#: a step or an upright wall, leave half a circle free.
_WIDEST_GAP = np.radians(170.0)
#: Fraction of hidden points below which they change no result: at the steps of a fracture some
#: points look hidden by chance.
FEW_HIDDEN = 0.005
_BLOCK = 100_000  # points whose neighbours are held at once
#: Largest fraction of edges that run the same way in two triangles of a mesh wound alike.
_WOUND_ALIKE = 1e-3
#: Most edges with a triangle on one side alone of a mesh that closes a body, over the root of the
#: number of triangles: the rim of a sheet has some three times the root.
_OPEN_EDGES = 0.2
#: Least height of a neighbour in the plane above or below a point that lies over another layer, in
#: distances to the point's nearest neighbour in space.
_OTHER_LAYER = 10.0
#: Least mean number of layers of a mesh with more than one face, if it is no closed body. Cells at
#: its rim, of which some are missing, and overhangs add some hundredths.
SEVERAL_FACES = 1.5
#: Least fraction of points over another layer in a cloud of several layers: by chance one point in
#: some thousand lies so.
SEVERAL_LAYERS = 0.1
#: Number of points around a place, and when a height parts them into two faces: the least fraction
#: of them on either side, the least distance of the sides in units of their scatter (white noise
#: parted at its mean has 2.6, even heights 3.5) and in spacings (steps of an instrument have less).
_AROUND, _EITHER, _CLEFT, _SPACINGS = 24, 0.25, 5.0, 0.5
#: Least fraction of the points of a cloud of two faces where a height parts the points around and
#: the nearest of them lies on the other side. At random half of the nearest points do; at a step
#: hardly one does.
TWO_FACES = 0.2


def find_hidden(points: np.ndarray, tree: cKDTree) -> tuple[float, np.ndarray | None]:
    """Share of the points that lie beneath others, and their mask; None if few (`FEW_HIDDEN`) do.

    A point is hidden if those of its nearest neighbours in the plane that are far above it (steeper
    than 80 degrees, and well beyond the noise) surround it, while others share its level: it is
    part of a layer under a roof. Steps, upright walls and single spikes hide nothing.

    Points (n, 3) are finite, no two at the same x, y; ``tree`` holds their x, y. The share is that
    of a sample; where it is small, the other points are not looked at.
    """
    sample = sample_points(points)
    _, nearest = tree.query(sample[:, :2], k=[2])  # the first is the point itself
    differences = np.abs(points[nearest[:, 0], 2] - sample[:, 2])
    noise = _NOISE * float(np.quantile(differences, 0.25))
    hidden = _hidden(sample, points, tree, noise)
    if hidden.mean() < FEW_HIDDEN:
        return float(hidden.mean()), None
    if len(sample) < len(points):
        hidden = _hidden(points, points, tree, noise)
    return float(hidden.mean()), hidden


def _hidden(some: np.ndarray, points: np.ndarray, tree: cKDTree, noise: float) -> np.ndarray:
    """Mask of points hidden by others of the cloud."""
    hidden = np.zeros(len(some), dtype=bool)
    k = min(_NEIGHBOURS + 1, len(points))
    for start in range(0, len(some), _BLOCK):
        block = some[start : start + _BLOCK]
        distances, neighbours = tree.query(block[:, :2], k=k)
        rise = points[neighbours, 2] - block[:, 2:]
        beyond = noise + _STEEPEST * distances
        above = rise > beyond
        fellows = (np.abs(rise) <= beyond).sum(axis=1) - 1  # itself is the nearest
        may_be = np.flatnonzero((above.sum(axis=1) >= _FEWEST) & (fellows >= _FEWEST))
        around = points[neighbours[may_be], :2] - block[may_be, None, :2]
        angles = np.where(above[may_be], np.arctan2(around[..., 1], around[..., 0]), np.nan)
        angles = np.sort(angles, axis=1)  # missing angles come last
        across_the_back = angles[:, 0] + 2 * np.pi - np.nanmax(angles, axis=1, initial=-np.pi)
        gap = np.fmax(np.nanmax(np.diff(angles), axis=1, initial=0), across_the_back)
        hidden[start + may_be] = gap < _WIDEST_GAP
    return hidden


def layered_share(points: np.ndarray, tree: cKDTree) -> float:
    """Share of the points whose neighbour in the plane belongs to another layer.

    It is a half in a closed body, or two faces in one file: no surface over x and y. Points (n, 3)
    are finite, no two at the same x, y; ``tree`` holds their x, y.
    """
    sample = sample_points(points)
    distances, neighbours = tree.query(sample[:, :2], k=min(_NEIGHBOURS + 1, len(points)))
    rise = np.abs(points[neighbours[:, 1:], 2] - sample[:, 2:])
    nearest = np.hypot(distances[:, 1:], rise).min(axis=1)
    return float((rise[:, 0] > _OTHER_LAYER * nearest).mean())


def parted_share(points: np.ndarray, tree: cKDTree) -> float:
    """Share of the points that lie on one of two faces, their neighbour in the plane on the other.

    Points (n, 3) are finite, and several may stand at the same x, y; ``tree`` holds their x, y.
    """
    sample = sample_points(points)
    k = min(_AROUND, len(points))
    distances, neighbours = tree.query(sample[:, :2], k=k)
    around = points[neighbours]
    around = around - around.mean(axis=1, keepdims=True)
    level = np.concatenate([around[..., :2], np.ones((*around.shape[:2], 1))], axis=2)
    plane = np.linalg.pinv(level) @ around[..., 2:]
    residual = around[..., 2] - (level @ plane)[..., 0]
    above = residual > 0
    of_above, of_below = above.mean(axis=1), (~above).mean(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        high = (residual * above).mean(axis=1) / of_above
        low = (residual * ~above).mean(axis=1) / of_below
        scatter = np.where(above, residual - high[:, None], residual - low[:, None]).std(axis=1)
    # A circle around the last neighbour holds them all, in either layer half of them.
    spacing = distances[:, -1] * np.sqrt(2 * np.pi / k)
    parted = (np.minimum(of_above, of_below) >= _EITHER) & (high - low > _CLEFT * scatter)
    parted &= (high - low > _SPACINGS * spacing) & (above[:, 0] != above[:, 1])
    return float(parted.mean())


def mean_layers(
    vertices: np.ndarray, triangles: np.ndarray, heights: np.ndarray, cell: float
) -> float:
    """Mean number of triangles above each other where a mesh is: 1 of a surface, 2 of two faces.

    ``heights`` (ny, nx) are those of the mesh on a grid with cells of ``cell`` mm2, NaN without
    triangle.
    """
    covered = np.count_nonzero(np.isfinite(heights)) * cell
    area = float(doubled_area(vertices[:, :2], triangles).sum()) / 2
    return area / covered if covered else np.nan


def is_closed(triangles: np.ndarray) -> bool:
    """True if a mesh (m, 3) is the skin of a body: each edge has a triangle on either side."""
    edges = np.sort(
        np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    )
    keys = np.sort(edges[:, 0].astype(np.int64) * (int(triangles.max()) + 1) + edges[:, 1])
    same = keys[1:] == keys[:-1]
    alone = ~(np.r_[False, same] | np.r_[same, False])
    return bool(np.count_nonzero(alone) <= _OPEN_EDGES * np.sqrt(len(triangles)))


def downward_share(vertices: np.ndarray, triangles: np.ndarray) -> tuple[float, float]:
    """Shares of the area of a level mesh that face down, and against most of it.

    The first share follows the sense in which triangles are wound. The second is the smaller of the
    shares up and down, which are overhangs; it is NaN if the triangles are not wound alike.
    """
    normal = triangle_normals(vertices, triangles)
    area = np.sqrt((normal**2).sum(axis=1))
    # Triangles that are upright to within rounding face neither way.
    down, up = (area[s * normal[:, 2] > 1e-6 * area].sum() for s in (-1, 1))
    if down + up == 0:
        return np.nan, np.nan
    against = min(down, up) / area.sum()
    if against > 0 and not _wound_alike(triangles):
        against = np.nan
    return float(down / (down + up)), float(against)


def triangle_normals(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Normal (m, 3) of each triangle, as long as twice its area."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    return np.cross(b - a, c - a)


def _wound_alike(triangles: np.ndarray) -> bool:
    """True if neighbouring triangles pass their common edge in opposite directions."""
    start, end = triangles.T.astype(np.int64), np.roll(triangles.T, -1, axis=0).astype(np.int64)
    edges = np.sort((start * (int(triangles.max()) + 1) + end).ravel())
    return bool(np.count_nonzero(edges[1:] == edges[:-1]) <= _WOUND_ALIKE * len(edges))
