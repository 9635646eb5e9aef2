"""Points x, y, z: repeated points, regular grids, the grid that covers them."""

from dataclasses import dataclass

import numpy as np

from ..core.errors import InputError
from ..core.strips import blocks

#: Largest distance of coordinates from a lattice, as a fraction of the pitch: rounding in the
#: export.
LATTICE_TOLERANCE = 0.1
#: Least fraction of a lattice's nodes with a point: points rounded coarsely lie on a lattice too,
#: but leave most of its nodes empty.
LATTICE_MIN_FILL = 0.2
#: Most cells of a grid, far above those of any profilometer; a stray point would otherwise ask for
#: all memory.
MAX_CELLS = 200_000_000
#: Most cells per point: a finer grid would only interpolate, and a small file would need gigabytes.
CELLS_PER_POINT = 1000
_FEW_CELLS = 10_000_000
#: Least rounding of coordinates in single precision that is worth a note, as a fraction of the
#: distance of the points.
COARSE_ROUNDING = 0.01


@dataclass(frozen=True)
class Lattice:
    """A regular grid of nodes: origin, pitch and number along x and y."""

    x0: float
    y0: float
    dx: float
    dy: float
    nx: int
    ny: int


@dataclass(frozen=True)
class Repeats:
    """Repeated points, whose x, y are those of another point: of the same height, or of another."""

    duplicated: int
    stacked: int


def merge_points(points: np.ndarray) -> tuple[np.ndarray, Repeats]:
    """Points (m, 3) with one height at each x, y, the mean of all there, and counts of the repeats.

    Points without finite x, y are dropped, and a point that is given twice counts once. A height is
    NaN where none was measured.
    """
    placed = np.isfinite(points[:, :2]).all(axis=1)
    if not placed.all():
        points = points[placed]
    del placed
    if len(points) == 0:
        return points, Repeats(0, 0)
    if _in_rows(points):  # as most instruments write them: no repeats, and nothing to sort
        return points, Repeats(0, 0)
    points = points[np.lexsort(points.T[[2, 0, 1]])]  # NaN heights come last at their x, y
    same_place = (points[1:, 0] == points[:-1, 0]) & (points[1:, 1] == points[:-1, 1])
    same_height = same_place & (points[1:, 2] == points[:-1, 2])
    other_height = same_place & ~same_height & np.isfinite(points[1:, 2])
    repeats = Repeats(int(same_height.sum()), int(other_height.sum()))
    if not same_place.any():
        return points, repeats
    first_of_height, first_of_place = (np.r_[True, ~same] for same in (same_height, same_place))
    points, first_of_place = points[first_of_height], first_of_place[first_of_height]
    starts = np.flatnonzero(first_of_place)
    z = points[:, 2]
    measured = np.isfinite(z)
    counts = np.add.reduceat(measured.astype(float), starts)
    sums = np.add.reduceat(np.where(measured, z, 0.0), starts)
    heights = np.divide(sums, counts, out=np.full(len(starts), np.nan), where=counts > 0)
    return np.column_stack([points[starts, :2], heights]), repeats


def _in_rows(points: np.ndarray) -> bool:
    """True if points already ascend in y and, at equal y, in x, no two at the same place."""
    for part in blocks(len(points) - 1):
        x, y = points[part.start : part.stop + 1, :2].T
        along_y = np.diff(y)
        if not ((along_y > 0) | ((along_y == 0) & (np.diff(x) > 0))).all():
            return False
    return True


def refuse_one_place(points: np.ndarray, path: object) -> None:
    """Refuse points (n, 3) that all stand at one x, y: rounded coordinates, nearly always."""
    low, high = (f.reduce(points[:, :2], axis=0) for f in (np.fmin, np.fmax))
    if len(points) > 1 and (low == high).all():
        raise InputError(
            f"{path}: all {len(points)} points stand on one place, x = {low[0]:.10g}, "
            f"y = {low[1]:.10g}: coordinates this far from 0 may have been rounded to single "
            "precision; export coordinates nearer to 0, or in double precision"
        )


def single_precision_note(points: np.ndarray) -> str:
    """Sentence on the rounding of x and y by single precision; "" if it is harmless.

    Points (n, 3) are those of the file: any factor of units would hide the rounding.
    """
    for part in blocks(len(points)):
        coordinates = points[part][np.isfinite(points[part]).all(axis=1), :2]
        with np.errstate(over="ignore"):
            if np.any(coordinates.astype(np.float32) != coordinates):
                return ""
    points = points[np.isfinite(points).all(axis=1)]
    if len(points) < 2:
        return ""
    rounding = float(np.spacing(np.float32(np.abs(points[:, :2]).max())))
    # Two largest of three sides: a cloud may stand upright.
    area = np.prod(np.sort(np.ptp(points, axis=0))[1:])
    distance = float(np.sqrt(area / len(points)))
    whole = np.all(points[:, :2] == np.round(points[:, :2]))
    # Points at a distance of 0 lie on one line, and are refused for that.
    if whole or distance == 0 or rounding <= COARSE_ROUNDING * distance:
        return ""
    return (
        f"x and y are in single precision, rounded to {rounding:.2g} of the file's unit, "
        f"{rounding / distance:.0%} of the distance of the points; export coordinates nearer to 0"
    )


def find_lattice(points: np.ndarray, distance: float) -> Lattice | None:
    """Regular grid that all points (n, 3) lie on, no two at one x, y; None if they do not.

    ``distance`` is the median one of nearest neighbours, mm.
    """
    tolerance = LATTICE_TOLERANCE * distance
    along_x, along_y = (_find_levels(points[:, axis], tolerance) for axis in (0, 1))
    if along_x is None or along_y is None:
        return None
    (x0, dx, nx), (y0, dy, ny) = along_x, along_y
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
    # Coordinates rounded coarsely have a median step that is not their mean one.
    even = np.linspace(levels[0], levels[-1], len(levels))
    if np.abs(levels - even).max() <= tolerance:
        index = np.arange(len(levels), dtype=float)
    else:
        index = np.round((levels - levels[0]) / float(np.median(np.diff(levels))))
    if np.any(np.diff(index) < 1):
        return None
    pitch, origin = np.polyfit(index, levels, 1)
    if np.abs(levels - origin - pitch * index).max() > tolerance:
        return None
    # The fit leaves 1 mm as 1.0000000000000002 mm.
    pitch = float(f"{pitch:.10g}")
    return round(origin / pitch, 9) * pitch, pitch, int(index[-1]) + 1


def place_on_lattice(points: np.ndarray, lattice: Lattice) -> np.ndarray:
    """Heights (ny, nx) on the nodes of a grid; nodes without a point are missing."""
    heights = np.full((lattice.ny, lattice.nx), np.nan)
    for part in blocks(len(points)):
        x, y, z = points[part].T
        columns = np.round((x - lattice.x0) / lattice.dx).astype(int)
        rows = np.round((y - lattice.y0) / lattice.dy).astype(int)
        heights[rows, columns] = z
    return heights


def covering_lattice(points: np.ndarray, spacing: float, where: str) -> Lattice:
    """Grid that covers a cloud; a grid without a node, or absurdly large, is refused.

    Nodes are whole multiples of the spacing, so that grids of the same spacing coincide.
    """
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    first = np.ceil(low / spacing - 1e-9)
    count = np.floor(high / spacing + 1e-9) - first + 1
    if np.any(count < 1):
        raise InputError(
            f"{where}: the points span no area of at least one grid spacing ({spacing:.4g} mm); "
            "set a finer key 'grid'"
        )
    most = min(MAX_CELLS, max(_FEW_CELLS, CELLS_PER_POINT * len(points)))
    if count.prod() > most:
        raise InputError(
            f"{where}: a grid of {spacing:.4g} mm over {high[0] - low[0]:.4g} x "
            f"{high[1] - low[1]:.4g} mm has {count.prod():.3g} cells, more than the {most:.3g} "
            f"allowed for {len(points)} points; remove stray points or set a coarser key 'grid'"
        )
    x0, y0 = map(float, first * spacing)
    return Lattice(x0, y0, spacing, spacing, int(count[0]), int(count[1]))
