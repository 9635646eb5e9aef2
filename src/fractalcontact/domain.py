"""The contact domain D: box counts, its dimension Delta_sigma, and its clusters."""

from dataclasses import dataclass

import numba
import numpy as np
import scipy.ndimage
import xarray as xr

from .fitting import fit_line

#: Box sizes whose grid overhangs the extent by more than this part are not used: N(r) there counts
#: boxes that are mostly outside, and lifts the curve by twice as much.
LARGEST_OVERHANG = 0.03

#: Neighbouring box sizes differ by at least this factor, so that no part of the axis has more
#: weight in the fit than another.
SMALLEST_STEP = 2**0.25

#: Fewest boxes along the extent: with one box nothing is counted.
FEWEST_BOXES = 2

#: A dimension needs this many scales that say something.
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


def box_sizes(n: int) -> np.ndarray:
    """Box sides in cells for an extent of `n` cells: geometric, and fitting the extent.

    From 1 up to n / `FEWEST_BOXES`; of the sizes that overhang the extent by no more than
    `LARGEST_OVERHANG`, each at least `SMALLEST_STEP` times the one before.

    Parameters
    ----------
    n : int
        Cells along the longer side of what is to be covered.

    Returns
    -------
    (k,) int64
        Ascending; ``[1]`` for an extent too short to divide.
    """
    candidates = np.arange(1, max(n // FEWEST_BOXES, 1) + 1)
    overhang = -(-n // candidates) * candidates / n - 1
    sizes = []
    for size in candidates[overhang <= LARGEST_OVERHANG]:
        if not sizes or size >= SMALLEST_STEP * sizes[-1]:
            sizes.append(size)
    return np.array(sizes)


def box_count(domain: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Fewest boxes of each size that cover a domain, over every origin of the grid of boxes.

    Parameters
    ----------
    domain : (ny, nx) bool array_like
        Nodes in contact.
    sizes : (k,) int array_like
        Box sides in cells, at least 1.

    Returns
    -------
    (k,) int64
        N(r), the least over all r x r shifts of the origin by whole cells. Time grows with the
        number of cells for each size, whatever the number of shifts.

    Raises
    ------
    ValueError
        If a size is below 1 or the domain is not a (y, x) grid.
    """
    domain = np.ascontiguousarray(domain, dtype=bool)
    sizes = np.asarray(sizes, dtype=np.int64)
    if domain.ndim != 2:
        raise ValueError(f"a contact domain is a (y, x) grid, not of shape {domain.shape}")
    if sizes.size and sizes.min() < 1:
        raise ValueError(f"box sizes are whole numbers of cells from 1, not {sizes.min()}")
    return np.array([_fewest_boxes(domain, size) for size in sizes], dtype=np.int64)


@numba.njit(cache=True)
def _fewest_boxes(domain, size):
    """N(r) over all origins, in one pass over the windows of `size` cells.

    The window that ends at cell (y, x) is a box of exactly one grid, the one whose origin is
    (y, x) modulo `size`: marking each occupied window in that grid's counter counts all size^2
    grids at once.
    """
    ny, nx = domain.shape
    grids = np.zeros((size, size), np.int64)
    nodes_above = np.zeros(nx, np.int64)  # nodes of each column within the rows of the window
    for y in range(ny + size - 1):
        if y < ny:
            for x in range(nx):
                nodes_above[x] += domain[y, x]
        if y >= size:
            for x in range(nx):
                nodes_above[x] -= domain[y - size, x]
        counter = grids[y % size]
        inside = 0
        column = 0
        for x in range(nx + size - 1):
            if x < nx:
                inside += nodes_above[x]
            if x >= size:
                inside -= nodes_above[x - size]
            if inside:
                counter[column] += 1
            column += 1
            if column == size:
                column = 0
    return grids.min()


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

    Parameters
    ----------
    domain : (ny, nx) bool array_like
        Nodes in contact.
    spacing : float
        In mm.
    fit_range : (float, float), optional
        Smallest and largest box side of the fit, mm; by default all that say something.
    sizes : (k,) int array_like, optional
        Box sides in cells; by default `box_sizes` of the domain's own extent. Give them where
        several domains are to share one axis.

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
    """
    domain = np.asarray(domain, dtype=bool)
    extent = _cropped(domain)
    if sizes is None:
        sizes = box_sizes(max(extent.shape))
    sizes = np.asarray(sizes, dtype=np.int64)
    count = box_count(extent, sizes)
    r = sizes * float(spacing)
    nodes = int(extent.sum())
    if nodes == 0:
        return _no_dimension(r, count, "no node is in contact")

    ny, nx = domain.shape
    alone = (count == nodes) & (sizes > 1)
    alone |= (sizes == 1) & alone.any()
    full = count == -(-ny // sizes) * -(-nx // sizes)
    if nodes == 1 or nodes == domain.size:
        used = np.ones(sizes.size, dtype=bool)
    else:
        used = ~alone & ~full & (count > 1)
    if fit_range is not None:
        tolerance = 1e-9 * spacing
        used &= (r >= fit_range[0] - tolerance) & (r <= fit_range[1] + tolerance)
    if used.sum() < FEWEST_SCALES:
        return _no_dimension(
            r,
            count,
            f"{used.sum()} of {sizes.size} scales say something, {FEWEST_SCALES} are needed "
            f"({alone.sum()} with every node alone, {full.sum()} with every box occupied)",
        )

    log_r, log_count = np.log(r[used]), np.log(count[used])
    line = fit_line(log_r, log_count)
    slopes = [line.slope_low, line.slope_high, *_slopes_of_parts(log_r, log_count)]
    return BoxDimension(
        dimension=-line.slope,
        low=-max(slopes),
        high=-min(slopes),
        r_min=float(r[used].min()),
        r_max=float(r[used].max()),
        n=line.n,
        r=r,
        count=count,
        used=used,
        reason="",
    )


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


def _no_dimension(r: np.ndarray, count: np.ndarray, reason: str) -> BoxDimension:
    nan = float("nan")
    return BoxDimension(nan, nan, nan, nan, nan, 0, r, count, np.zeros(r.size, dtype=bool), reason)


def clusters(domain: np.ndarray) -> xr.Dataset:
    """Number and size of the clusters of a contact domain (nodes joined by a side or a corner).

    Parameters
    ----------
    domain : (ny, nx) bool array_like

    Returns
    -------
    xarray.Dataset
        Scalars: `clusters`; `mean_size` in nodes; `largest_share`, the largest cluster's part of
        all nodes in contact. The last two are NaN for an empty domain.
    """
    labels, number = scipy.ndimage.label(domain, structure=np.ones((3, 3)))
    sizes = np.bincount(labels.ravel())[1:]
    total = sizes.sum()
    mean_size = total / number if number else np.nan
    largest_share = sizes.max() / total if number else np.nan
    return xr.Dataset(
        {
            "clusters": ((), number, {"units": "1", "long_name": "clusters of nodes in contact"}),
            "mean_size": ((), mean_size, {"units": "1", "long_name": "mean nodes in a cluster"}),
            "largest_share": (
                (),
                largest_share,
                {"units": "1", "long_name": "largest cluster's share of nodes in contact"},
            ),
        }
    )
