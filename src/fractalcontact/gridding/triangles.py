"""Heights on a grid from triangles: Delaunay's of a cloud, tile by tile, or a mesh's own."""

import math

import numpy as np
from scipy.spatial import Delaunay, QhullError

from ..core.errors import InputError
from .points import MAX_CELLS, Lattice

#: Points triangulated at once: a few tens of thousands stay in the processor's cache.
TILE_POINTS = 25_000
#: Most places of a tile.
TILE_PLACES = 2_000_000
#: Most points of a tile, for which Qhull takes about 1 GB; more of them around one cell, or within
#: the largest circle, are no scan of a surface.
_MAX_IN_TILE = 1_000_000
#: Largest distance of points on one line from it, as a fraction of its length: the root of
#: rounding.
_LINE = 1e-7
#: Fewest points in a cell of a grid whose heights are averaged over cells; other grids are read at
#: the centres of cells.
MIN_TO_AVERAGE = 4
#: Most times that the triangles of a mesh cover the grid; no surface comes near it.
_MAX_LAYERS = 200


def interpolate_points(
    points: np.ndarray, lattice: Lattice, largest_circle: float, across: int, where: str
) -> np.ndarray:
    """Heights (ny, nx) by linear interpolation on the Delaunay triangles of points (n, 3).

    Triangles whose circumcircle, which holds no other point, has a radius above ``largest_circle``,
    R in mm, span holes or the outside (alpha shape: Edelsbrunner, Kirkpatrick & Seidel 1983); cells
    in them are missing. Each cell is the mean over ``across`` x ``across`` places in it (1: its
    centre). Points are finite, no two at the same x, y. Points on one line, or a million in one
    spot, are refused.

    Notes
    -----
    Qhull cannot triangulate ten million points in 4 GB, so tiles of the grid are done one by one,
    each with the points up to 2 R around it. The result is that of the whole cloud. A triangle
    that covers a place p and has a circumradius of at most R lies with its circle within 2 R of p.
    If it is one of the whole cloud, its corners are among the points of p's tile and its circle is
    empty of them: a triangle of the tile. If it is one of the tile, all points within 2 R of p are
    the tile's, so that its circle is empty of the whole cloud: a triangle of the whole. Only where
    four points lie on one circle are there two triangulations, and a tile may choose the other.
    """
    if on_one_line(points[:, :2]):
        raise InputError(f"{where}: the points span no area (do they lie on one line?)")
    heights = np.full((lattice.ny, lattice.nx), np.nan)
    most_cells = TILE_PLACES // across**2
    everything = (slice(0, lattice.ny), slice(0, lattice.nx))
    for rows, columns, near in _tiles(points, lattice, *everything, 2 * largest_circle, most_cells):
        if on_one_line(near[:, :2]):
            continue
        part = _part(lattice, rows, columns)
        if len(near) > _MAX_IN_TILE:
            raise InputError(
                f"{where}: {len(near)} points, more than {_MAX_IN_TILE}, lie around "
                f"x = {part.x0:.6g}, y = {part.y0:.6g} mm, "
                "far more densely than the others or than the grid; thin them out, or set a finer "
                "key 'grid'"
            )
        # Far from the origin, triangulation loses digits.
        xy = near[:, :2] - (part.x0, part.y0)
        try:
            triangles = Delaunay(xy).simplices
        except QhullError as error:
            raise InputError(
                f"{where}: the points near x = {part.x0:.6g}, y = {part.y0:.6g} mm cannot be "
                "triangulated (do they lie on one line?)"
            ) from error
        triangles = triangles[circumradius(xy, triangles) <= largest_circle]
        heights[rows, columns] = _envelope(near, triangles, part, across)
    return heights


def interpolate_mesh(
    vertices: np.ndarray, triangles: np.ndarray, lattice: Lattice, across: int, where: str
) -> np.ndarray:
    """Heights (ny, nx) of the mesh's own triangles, the top-most where several lie.

    ``triangles`` (m, 3) are rows of ``vertices`` (n, 3), in any sense of rotation; ``across`` as
    for `interpolate_points`. Cells without a triangle are NaN. Triangles that cover the grid
    absurdly often are refused.
    """
    corners = vertices[:, :2][triangles]
    extent = np.ptp(corners, axis=1) / (lattice.dx, lattice.dy)
    extent = np.minimum(extent, (lattice.nx, lattice.ny)) + 1
    if extent.prod(axis=1).sum() > _MAX_LAYERS * (lattice.nx * lattice.ny + len(triangles)):
        raise InputError(
            f"{where}: the triangles of the mesh cover its area more than {_MAX_LAYERS} times; "
            "export a surface, or a coarser mesh"
        )
    finest = math.isqrt(MAX_CELLS // (lattice.nx * lattice.ny))
    return _envelope(vertices, triangles, lattice, min(across, max(1, finest)))


def places_across(lattice: Lattice, area_per_point: float) -> int:
    """Places along each side of a cell over which heights are averaged.

    A cell's centre hears of three points only. Where a cell holds `MIN_TO_AVERAGE` points or
    more, what is finer than the grid would be aliased into it, so the surface is averaged over the
    cell, at about as many places as it holds points (the block mean of gridding).
    """
    per_cell = lattice.dx * lattice.dy / area_per_point
    if per_cell < MIN_TO_AVERAGE * (1 - 1e-6):
        return 1
    return math.ceil(math.sqrt(per_cell) - 1e-6)


def on_one_line(xy: np.ndarray) -> bool:
    """True if points (n, 2) span no area."""
    xy = xy - xy.mean(axis=0)
    narrow, wide = np.linalg.eigvalsh(xy.T @ xy)  # eigenvalues are squares of lengths
    return not (wide > 0 and math.sqrt(max(narrow, 0.0)) > _LINE * math.sqrt(wide))


def doubled_area(xy: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Twice the area of each triangle (m, 3) over points (n, 2), never negative."""
    a, b, c = (xy[triangles[:, corner]] for corner in range(3))
    return np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


def circumradius(xy: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """R = abc/(4 area) of each triangle; infinite where the corners lie on one line."""
    a, b, c = (xy[triangles[:, corner]] for corner in range(3))
    edges = [np.hypot(*(end - start).T) for start, end in ((a, b), (b, c), (c, a))]
    twice_area = doubled_area(xy, triangles)
    flat = np.full(len(a), np.inf)
    return np.divide(np.prod(edges, axis=0), 2 * twice_area, out=flat, where=twice_area > 0)


def _tiles(points, lattice: Lattice, rows: slice, columns: slice, margin: float, most_cells: int):
    """Halve the grid until few points lie within ``margin`` of each part; empty parts are left out.

    Yields rows and columns as slices, and the points (n, 3) near them.
    """
    part = _part(lattice, rows, columns)
    half_x, half_y = lattice.dx / 2, lattice.dy / 2  # places in a cell are not all at its centre
    width, height = part.dx * part.nx, part.dy * part.ny
    x, y = points[:, 0], points[:, 1]
    near = points[
        (x >= part.x0 - half_x - margin)
        & (x <= part.x0 - half_x + width + margin)
        & (y >= part.y0 - half_y - margin)
        & (y <= part.y0 - half_y + height + margin)
    ]
    if len(near) < 3:
        return
    along_x = part.nx > 1 and (width >= height or part.ny == 1)
    side, cells = (width, part.nx) if along_x else (height, part.ny)
    small = len(near) <= TILE_POINTS and part.nx * part.ny <= most_cells
    if small or cells == 1 or (side <= margin and part.nx * part.ny <= most_cells):
        yield rows, columns, near
        return
    whole = columns if along_x else rows
    middle = (whole.start + whole.stop) // 2
    for half in (slice(whole.start, middle), slice(middle, whole.stop)):
        parts = (rows, half) if along_x else (half, columns)
        yield from _tiles(near, lattice, *parts, margin, most_cells)


def _part(lattice: Lattice, rows: slice, columns: slice) -> Lattice:
    return Lattice(
        lattice.x0 + lattice.dx * columns.start,
        lattice.y0 + lattice.dy * rows.start,
        lattice.dx,
        lattice.dy,
        columns.stop - columns.start,
        rows.stop - rows.start,
    )


def _envelope(vertices, triangles, lattice: Lattice, across: int) -> np.ndarray:
    """Top-most heights of triangles at the nodes, or their means over the cells."""
    from .envelope import raise_to_triangles  # compiled: only gridding pays for it

    # In places of the finer grid, whose first ones lie (across - 1)/2 before the first node.
    before = (across - 1) / 2
    u = (vertices[:, 0] - lattice.x0) / lattice.dx * across + before
    v = (vertices[:, 1] - lattice.y0) / lattice.dy * across + before
    heights = np.full((lattice.ny * across, lattice.nx * across), np.nan)
    raise_to_triangles(heights, u, v, np.ascontiguousarray(vertices[:, 2]), triangles)
    if across == 1:
        return heights
    # A cell that is covered in part stays missing: its mean would be that of another place.
    return heights.reshape(lattice.ny, across, lattice.nx, across).mean(axis=(1, 3))
