"""The contact domain D: its box counts and its dimension Delta_sigma."""

import itertools
from dataclasses import dataclass

import numba
import numpy as np

from .fitting import LineFit, fit_line

#: Box sizes in each doubling.
SIZES_PER_OCTAVE = 4

#: Whole ratios by which a deterministic set may repeat itself; their powers are among the sizes.
RATIOS = (2, 3, 4, 5)

#: Boxes of no size cover more than this many times an oblong extent.
MOST_OVERHANG = 1.1

#: A dimension needs this many scales that say something, and as many different counts among them.
FEWEST_SCALES = 4


@dataclass(frozen=True)
class BoxDimension:
    """A box-counting dimension with its interval, its range and the counts behind it."""

    dimension: float
    low: float
    high: float
    r_min: float
    r_max: float
    n: int
    r: np.ndarray
    count: np.ndarray
    used: np.ndarray
    reason: str


def box_sizes(extent: int | tuple[int, int], largest: float | None = None) -> np.ndarray:
    """Box sides in cells whose grids fit an extent, about `SIZES_PER_OCTAVE` in each doubling.

    Each is a whole part of one of the sides: in every quarter of an octave the one whose boxes
    overhang the extent least, if that is within `MOST_OVERHANG`. In a square they divide it
    exactly, the powers of `RATIOS` among them. (Boxes of whole cells overhang most extents, and a
    filled square then seems to have a dimension other than 2.)

    Parameters
    ----------
    extent : int or (ny, nx)
        Cells along the sides of what is to be covered, a window or a domain.
    largest : float, optional
        No box is larger; by default the shorter side, beyond which a filled window seems a line.

    Returns
    -------
    (k,) float64
        Ascending, from 1; ``[1.]`` for an extent too short to divide.
    """
    sides = sorted({int(n) for n in np.broadcast_to(extent, 2)})
    largest = sides[0] if largest is None else largest
    parts = {n / k for n in sides for k in range(2, n // 2 + 1) if n / k <= largest}
    best = {}
    for r in sorted(parts):
        place = SIZES_PER_OCTAVE * np.log2(sides[-1] / r)
        # Rounded, so that of sizes that all fit the one nearest to its place is taken.
        rank = round(_overhang(sides, r), 9), abs(place - round(place)), r
        best[round(place)] = min(best.get(round(place), rank), rank)
    powers = {sides[-1] / ratio**k for ratio in RATIOS for k in range(1, sides[-1].bit_length())}
    exact = {r for r in powers & parts if _overhang(sides, r) < 1 + 1e-9}
    fitting = {r for overhang, _, r in best.values() if overhang <= MOST_OVERHANG}
    return np.array(sorted({1.0} | exact | fitting))


def _overhang(sides: list[int], r: float) -> float:
    """What boxes of side r cover over what there is; a side shorter than a box does not count."""
    return float(np.prod([_boxes_along(n, r) * r / n for n in sides if n >= r]))


def _boxes_along(n: int, sizes: np.ndarray) -> np.ndarray:
    """Boxes that cover n cells; the small number keeps n / (n / k) at k."""
    return np.ceil(n / sizes - 1e-9)


def box_count(domain: np.ndarray, sizes: np.ndarray, *, max_shifts: int = 16) -> np.ndarray:
    """Fewest boxes of each size that meet a domain, over origins of the grid of boxes.

    Parameters
    ----------
    domain : (ny, nx) bool array_like
        Nodes in contact. A node is in the box that holds its centre.
    sizes : (k,) array_like
        Box sides in cells, at least 1, not necessarily whole.
    max_shifts : int
        Origins tried along each axis, evenly spaced over a box; never more than cells in its side.

    Returns
    -------
    (k,) int64
        N(r). Time grows with the number of cells for each size, no more than that.

    Raises
    ------
    ValueError
        If a size is below 1 or the domain is not a (y, x) grid.
    """
    domain = np.asarray(domain, dtype=bool)
    sizes = np.asarray(sizes, dtype=float)
    if domain.ndim != 2:
        raise ValueError(f"a contact domain is a (y, x) grid, not of shape {domain.shape}")
    if sizes.size and sizes.min() < 1:
        raise ValueError(f"a box is at least one cell wide, not {sizes.min()}")
    # Nodes below and left of each corner: four look-ups then tell how many are in a box.
    nodes = np.zeros((domain.shape[0] + 1, domain.shape[1] + 1), np.int32)
    np.cumsum(np.cumsum(domain, axis=0, dtype=np.int32), axis=1, out=nodes[1:, 1:])
    return np.array(
        [
            _fewest_boxes(nodes, *(_edges(n, size, max_shifts) for n in domain.shape))
            for size in sizes
        ],
        dtype=np.int64,
    )


def _edges(n: int, size: float, max_shifts: int) -> np.ndarray:
    """First cell of each box along one axis, a row for each origin of the grid."""
    shifts = max(min(int(np.ceil(size)), max_shifts), 1)
    origins = -size * np.arange(shifts) / shifts
    boxes = int(np.ceil(n / size)) + 2
    edges = origins[:, np.newaxis] + size * np.arange(boxes)
    # The cell whose centre is the first beyond the edge; the small number keeps n/k * k at n.
    return np.clip(np.ceil(edges - 0.5 - 1e-9), 0, n).astype(np.int64)


@numba.njit(cache=True)
def _fewest_boxes(nodes, edges_y, edges_x):
    """N(r) over all pairs of origins: rows of edges along y and x."""
    fewest = nodes[-1, -1]  # no more boxes than nodes
    for ys in edges_y:
        for xs in edges_x:
            count = 0
            for i in range(ys.size - 1):
                bottom, top = nodes[ys[i]], nodes[ys[i + 1]]
                for j in range(xs.size - 1):
                    left, right = xs[j], xs[j + 1]
                    if top[right] - bottom[right] != top[left] - bottom[left]:
                        count += 1
                if count >= fewest:
                    break
            fewest = min(fewest, count)
    return fewest


def box_dimension(
    domain: np.ndarray,
    spacing: float,
    *,
    fit_range: tuple[float, float] | None = None,
    sizes: np.ndarray | None = None,
) -> BoxDimension:
    """Box-counting dimension Delta_sigma of a contact domain.

    A scale says nothing where every node is alone in its box (N(r) = N(s) beyond r = s) or where
    every box of the window is occupied; such scales are left out, unless the whole window touches
    (dimension 2) or a single node does (0), which is then what all scales say.

    N(r) is a whole number from 1 to the number of nodes. Sets of so few nodes that fewer than
    `FEWEST_SCALES` different counts are left have no dimension: a line through a staircase of two
    or three treads tells where their edges happen to be, and through a single tread it would claim
    0 without error.

    Parameters
    ----------
    domain : (ny, nx) bool array_like
        Nodes in contact.
    spacing : float
        In mm.
    fit_range : (float, float), optional
        Smallest and largest box side of the fit, mm; by default all that say something.
    sizes : (k,) array_like, optional
        Box sides in cells, ascending; by default `box_sizes` of the domain's own extent. Give them
        where several domains are to share one axis.

    Returns
    -------
    BoxDimension
        `dimension`, `low`, `high`; `r_min`, `r_max` of the fit in mm and its `n` scales; `r` (mm),
        `count` and `used` of all scales; `reason` why there is no dimension (NaN), else "".

    Notes
    -----
    The scales are counts of one and the same set, so the regression's t-interval alone is too
    narrow. The interval given spans it and the slopes fitted to every run of neighbouring scales
    that covers half of the range or more: how much the value depends on the range chosen.

    A set that repeats itself exactly in a fixed ratio has a staircase for N(r), on which only sizes
    in that ratio lie on one line. Where the counts at extent / ratio^k, one of `RATIOS`, are an
    exact geometric series, the value comes from them, and the interval still spans the slopes of
    all sizes. `n` and `used` tell. A rough contact domain has no such ratio and keeps all sizes.

    Known bias: boxes of a few cells have few origins to choose from, so that a Cantor dust drawn as
    all cells it passes through reads 0.06 to 0.17 high; leaving out sizes below 2 or 3 cells does
    not mend it, as fewer periods of the staircase are left. A dust that the window cuts off within
    a period is up to 0.08 off. A filled strip of 5 x 1 inside a larger window reads 0.05 low: to
    boxes wider than itself it is a line. The interval often does not reach the exact value there.
    """
    domain = np.asarray(domain, dtype=bool)
    extent = _cropped(domain)
    # A single node has no extent to divide: it is seen at the scales of the window.
    shape = extent.shape if extent.size > 1 else domain.shape
    sizes = box_sizes(shape, min(domain.shape)) if sizes is None else np.asarray(sizes, dtype=float)
    count = box_count(extent, sizes)
    r = sizes * float(spacing)
    nodes = int(extent.sum())
    if nodes == 0:
        return no_dimension(r, count, "no node is in contact")

    ny, nx = domain.shape
    alone = (count == nodes) & (sizes > 1)
    alone |= (sizes == 1) & alone.any()
    full = count == _boxes_along(ny, sizes) * _boxes_along(nx, sizes)
    if nodes == 1 or nodes == domain.size:
        used = np.ones(sizes.size, dtype=bool)
    else:
        used = ~alone & ~full & (count > 1)
    if fit_range is not None:
        tolerance = 1e-9 * spacing
        used &= (r >= fit_range[0] - tolerance) & (r <= fit_range[1] + tolerance)
    if used.sum() < FEWEST_SCALES:
        return no_dimension(
            r,
            count,
            f"{used.sum()} of {sizes.size} scales say something, {FEWEST_SCALES} are needed "
            f"({alone.sum()} with every node alone, {full.sum()} with every box occupied)",
        )

    distinct = np.unique(count[used]).size
    if nodes > 1 and distinct < FEWEST_SCALES:
        return no_dimension(
            r,
            count,
            f"{nodes} nodes give {distinct} different counts, {FEWEST_SCALES} are needed",
        )

    line = _line(r, count, used)
    parts = _slopes_of_parts(np.log(r[used]), np.log(count[used]))
    slopes = [line.slope_low, line.slope_high, *parts]
    used = _best_scales(sizes, {max(extent.shape), max(domain.shape)}, count, used)
    line = _line(r, count, used)
    slopes += [line.slope_low, line.slope_high]
    return BoxDimension(
        dimension=0.0 - line.slope,  # a constant count gives 0, not -0
        low=0.0 - max(slopes),
        high=0.0 - min(slopes),
        r_min=float(r[used].min()),
        r_max=float(r[used].max()),
        n=line.n,
        r=r,
        count=count,
        used=used,
        reason="",
    )


def _line(r: np.ndarray, count: np.ndarray, used: np.ndarray) -> LineFit:
    """The line through log N against log r."""
    return fit_line(np.log(r[used]), np.log(count[used]))


def _best_scales(
    sizes: np.ndarray, sides: set[int], count: np.ndarray, used: np.ndarray
) -> np.ndarray:
    """All usable scales, or those side / ratio^k where they, unlike all, lie exactly on a line."""
    if _is_exact(sizes, count, used):
        return used
    for side, ratio in itertools.product(sorted(sides), RATIOS):
        power = np.log(side / sizes) / np.log(ratio)
        ladder = used & (np.abs(power - np.round(power)) < 1e-9)
        if ladder.sum() >= FEWEST_SCALES and _is_exact(sizes, count, ladder):
            return ladder
    return used


def _is_exact(sizes: np.ndarray, count: np.ndarray, used: np.ndarray) -> bool:
    """Whether counts lie on a line but for rounding; False where they are all the same."""
    return _line(sizes, count, used).r2 > 1 - 1e-12


def _cropped(domain: np.ndarray) -> np.ndarray:
    """The part of the grid that the domain spans; one empty cell for an empty domain."""
    if not domain.any():
        return np.zeros((1, 1), dtype=bool)
    rows, columns = (np.flatnonzero(domain.any(axis=axis)) for axis in (1, 0))
    return domain[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]


def _slopes_of_parts(x: np.ndarray, y: np.ndarray) -> list[float]:
    """Slopes of all runs of neighbouring points that cover half of the range of x or more."""
    half = (x[-1] - x[0]) / 2
    return [
        fit_line(x[i:j], y[i:j]).slope
        for i in range(x.size)
        for j in range(i + 3, x.size + 1)
        if x[j - 1] - x[i] >= half
    ]


def no_dimension(r: np.ndarray, count: np.ndarray, reason: str) -> BoxDimension:
    """Box counts without a dimension, and why.

    Parameters
    ----------
    r, count : (k,) ndarray
        Box sides, mm, and N(r).
    reason : str
    """
    nan = float("nan")
    return BoxDimension(nan, nan, nan, nan, nan, 0, r, count, np.zeros(r.size, dtype=bool), reason)
