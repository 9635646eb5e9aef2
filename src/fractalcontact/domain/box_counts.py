"""Box counts of a contact domain: minimal cover over grid origins, and mean over grid origins."""

import numpy as np

from ..core import arguments
from ..core.arguments import whole_number, whole_numbers
from ..core.kernel_cache import njit

#: Box sizes in each doubling.
SIZES_PER_OCTAVE = 4

#: Whole ratios by which a deterministic set may repeat itself; their powers are among the sizes.
RATIOS = (2, 3, 4, 5)

#: Compiled code counts nodes in four bytes.
_MOST_CELLS = 2**31 - 1

#: Boxes of no size cover more than this many times an oblong extent.
MOST_OVERHANG = 1.1


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
    best: dict[int, tuple[float, float, float]] = {}
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
    return float(np.prod([float(boxes_along(n, r)) * r / n for n in sides if n >= r]))


def boxes_along(n: int, sizes: float | np.ndarray) -> np.ndarray:
    """Boxes of each size that cover n cells; the small number keeps n / (n / k) at k."""
    return np.ceil(n / sizes - 1e-9)


def whole_sizes(largest: float) -> np.ndarray:
    """Whole box sides from 1 to a largest, `SIZES_PER_OCTAVE` in each doubling where there are."""
    return np.unique(np.round(geometric_sizes(1, largest)).astype(np.int64))


def geometric_sizes(smallest: float, largest: float) -> np.ndarray:
    """Lengths from a smallest to a largest, `SIZES_PER_OCTAVE` in each doubling.

    Parameters
    ----------
    smallest, largest : float
        Positive, in one unit.

    Returns
    -------
    (k,) float64
        The smallest alone if the largest is no longer.
    """
    octaves = np.log2(max(largest / smallest, 1))
    steps = np.arange(int(SIZES_PER_OCTAVE * octaves + 1e-9) + 1)
    return smallest * 2 ** (steps / SIZES_PER_OCTAVE)


def box_count(domain: np.ndarray, sizes: np.ndarray, *, max_shifts: int = 16) -> np.ndarray:
    """Minimal cover: fewest boxes of each size that meet a domain, over grid origins.

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
        If a size is below 1, or no number, or the domain is not a (y, x) grid.
    """
    sizes = _checked_sizes(sizes)
    max_shifts = whole_number(max_shifts, "max_shifts", least=1, most=_MOST_CELLS)
    nodes = nodes_below(domain)
    return np.array([_minimal_cover(nodes, size, max_shifts) for size in sizes], dtype=np.int64)


def nodes_below(domain: np.ndarray) -> np.ndarray:
    """Nodes below and left of each corner: four look-ups then tell how many are in a box.

    Parameters
    ----------
    domain : (ny, nx) bool array_like

    Returns
    -------
    (ny + 1, nx + 1) int32

    Raises
    ------
    ValueError
        If the domain is not a (y, x) grid.
    """
    domain = arguments.domain(domain, "a contact domain")
    if domain.size > _MOST_CELLS:
        raise ValueError(
            f"a contact domain of {domain.shape}: expected {_MOST_CELLS} cells at most"
        )
    return _summed(domain)


def _checked_sizes(sizes):
    """Sides of boxes in cells as (k,) float64.

    Raises
    ------
    ValueError
        If one is below 1, or no number.
    """
    sizes = arguments.real_array(sizes, "sizes of boxes").astype(float)
    if sizes.ndim != 1:
        raise ValueError(f"sizes of boxes {sizes.shape}: expected a list of numbers")
    if not (np.isfinite(sizes) & (sizes >= 1)).all():
        raise ValueError(f"a box is at least one cell wide, not {sizes.min()}")
    return sizes


@njit(cache=True)
def _summed(domain):
    """Sums of all cells below and left of each corner, in one pass."""
    ny, nx = domain.shape
    nodes = np.zeros((ny + 1, nx + 1), np.int32)
    for y in range(ny):
        row = 0
        for x in range(nx):
            row += domain[y, x]
            nodes[y + 1, x + 1] = nodes[y, x + 1] + row
    return nodes


@njit(cache=True)
def _edges(n, size, max_shifts):
    """First cell of each box along one axis, a row for each origin of the grid."""
    shifts = max(min(int(np.ceil(size)), max_shifts), 1)
    boxes = int(np.ceil(n / size)) + 2
    edges = np.empty((shifts, boxes), np.int64)
    for shift in range(shifts):
        for box in range(boxes):
            edge = -size * shift / shifts + size * box
            # The cell whose centre is the first beyond the edge; the small number keeps n/k * k
            # at n.
            edges[shift, box] = min(max(int(np.ceil(edge - 0.5 - 1e-9)), 0), n)
    return edges


@njit(cache=True)
def _minimal_cover(nodes, size, max_shifts):
    """N(r) over all pairs of origins along y and x."""
    edges_y = _edges(nodes.shape[0] - 1, size, max_shifts)
    edges_x = _edges(nodes.shape[1] - 1, size, max_shifts)
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


def mean_count(domain: np.ndarray, sizes: np.ndarray, *, blocks: int = 1) -> np.ndarray:
    """Mean number of boxes of each size that meet a domain, over all grid origins.

    The places where a gliding box meets the domain, divided by its area: nothing depends on where
    a grid happens to lie. The domain ends where it ends, and boxes hang over that by up to their
    own side, so that a filled square of side L counts (L + r - 1)^2 / r^2.

    Parameters
    ----------
    domain : (ny, nx) bool array_like
    sizes : (k,) int array_like
        Box sides in cells, at least 1.
    blocks : int
        The window is divided into ``blocks`` x ``blocks`` parts, and each place of the box belongs
        to the part that holds the box's middle.

    Returns
    -------
    (k, blocks, blocks) float64
        N(r) of the parts; their sum is that of the domain. Linear in cells for each size.

    Raises
    ------
    ValueError
        If a size is below 1, or not whole, or the domain is not a (y, x) grid.
    """
    sizes = whole_numbers(_checked_sizes(sizes), "sizes of boxes", least=1, most=_MOST_CELLS)
    blocks = whole_number(blocks, "blocks", least=1, most=_MOST_CELLS)
    nodes = nodes_below(domain)
    counts = [_places(nodes, int(size), blocks) / size**2 for size in sizes]
    return np.array(counts).reshape(sizes.size, blocks, blocks)


@njit(cache=True)
def _places(nodes, size, blocks):
    """Places of a gliding box that meets the domain, by the part that holds its middle."""
    ny, nx = nodes.shape[0] - 1, nodes.shape[1] - 1
    places = np.zeros((blocks, blocks), np.int64)
    for y in range(1 - size, ny):
        bottom, top = nodes[max(y, 0)], nodes[min(y + size, ny)]
        part_y = min(max((2 * y + size) * blocks // (2 * ny), 0), blocks - 1)
        for part_x in range(blocks):
            # First place whose middle is in this part; the outer parts take what hangs over.
            start = 1 - size if part_x == 0 else -((size * blocks - 2 * nx * part_x) // 2 // blocks)
            end = -((size * blocks - 2 * nx * (part_x + 1)) // 2 // blocks)
            end = nx if part_x == blocks - 1 else end
            # Boxes that hang over the left, lie inside, and hang over the right.
            inside = min(max(start, 0), end)
            over = max(min(end, nx - size + 1), inside)
            hit = 0
            for x in range(start, inside):
                right = min(x + size, nx)
                hit += top[right] != bottom[right]
            for x in range(inside, over):
                hit += top[x + size] - top[x] != bottom[x + size] - bottom[x]
            for x in range(over, end):
                hit += top[nx] - top[x] != bottom[nx] - bottom[x]
            places[part_y, part_x] += hit
    return places
