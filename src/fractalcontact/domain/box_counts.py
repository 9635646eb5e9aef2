"""Box counts of a contact domain: minimal cover over grid origins, and mean over grid origins."""

from fractions import Fraction

import numpy as np

from roughcontact import arguments
from roughcontact.arguments import whole_number, whole_numbers
from roughcontact.kernel_cache import njit

#: Box sizes in each doubling.
SIZES_PER_OCTAVE = 4

#: Whole ratios by which a deterministic set may repeat itself; their powers are among the sizes.
RATIOS = (2, 3, 4, 5)

#: Compiled code counts nodes in four bytes.
_MAX_CELLS = 2**31 - 1

#: Largest q of box sides p / q cells that are tried at every grid origin.
_MAX_PARTS = 4
#: Smallest number of places along x that are counted in one loop, for SIMD.
_SPAN = 64

#: Largest area of the boxes of one size over that of an oblong extent.
MAX_OVERHANG = 1.1


def box_sizes(extent: int | tuple[int, int], largest: float | None = None) -> np.ndarray:
    """Box sides in cells whose grids fit an extent, about `SIZES_PER_OCTAVE` in each doubling.

    Each is a whole part of one of the sides: in every quarter of an octave the one whose boxes
    overhang the extent least, if that is within `MAX_OVERHANG`. In a square they divide it
    exactly, the powers of `RATIOS` among them. (Boxes of whole cells overhang most extents, and a
    filled square then seems to have a dimension other than 2.)

    Parameters
    ----------
    extent : int or (ny, nx)
        Cells along the sides of a window or a domain.
    largest : float, optional
        Largest box; by default the shorter side, beyond which a filled window seems a line.

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
        # Rounding makes sizes that all fit equal, so that the nearest to its place is taken.
        rank = round(_overhang(sides, r), 9), abs(place - round(place)), r
        best[round(place)] = min(best.get(round(place), rank), rank)
    powers = {sides[-1] / ratio**k for ratio in RATIOS for k in range(1, sides[-1].bit_length())}
    exact = {r for r in powers & parts if _overhang(sides, r) < 1 + 1e-9}
    fitting = {r for overhang, _, r in best.values() if overhang <= MAX_OVERHANG}
    return np.array(sorted({1.0} | exact | fitting))


def _overhang(sides: list[int], r: float) -> float:
    """Area of boxes of side r over that of the window; a side shorter than a box is left out."""
    return float(np.prod([float(boxes_along(n, r)) * r / n for n in sides if n >= r]))


def boxes_along(n: int, sizes: float | np.ndarray) -> np.ndarray:
    """Boxes of each size that cover n cells; the small number keeps n / (n / k) at k."""
    return np.ceil(n / sizes - 1e-9)


def window_sizes(shape: tuple[int, ...]) -> np.ndarray:
    """Whole box sides in cells for a window, to half of its shorter side: the axis of stages.

    Every grid origin is tried for whole sizes, and the powers of two are among them.
    """
    return whole_sizes(min(shape) / 2)


def whole_sizes(largest: float) -> np.ndarray:
    """Whole box sides from 1 to a largest, at most `SIZES_PER_OCTAVE` in each doubling."""
    return np.unique(np.round(geometric_sizes(1, largest)).astype(np.int64))


def geometric_sizes(smallest: float, largest: float) -> np.ndarray:
    """Lengths from a smallest to a largest of one unit, `SIZES_PER_OCTAVE` in each doubling.

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
        Evenly spaced origins along each axis for sizes of which not all origins can be tried.

    Returns
    -------
    (k,) int64
        N(r): the minimum over every grid origin for whole sizes and for halves, thirds and quarters
        of cells, else an upper bound of it. Linear in cells for each size.

    Raises
    ------
    ValueError
        If a size is below 1, or no number, or the domain is not a (y, x) grid.

    Notes
    -----
    The boxes of all r x r grids together are the places of one gliding box, each met once: every
    origin costs no more than one look at every place.
    """
    sizes = _checked_sizes(sizes)
    max_shifts = whole_number(max_shifts, "max_shifts", least=1, most=_MAX_CELLS)
    extent = cropped(_checked_domain(domain))
    counts = np.ones(sizes.size, np.int64)  # one box as large as the extent covers it
    smaller = sizes < max(extent.shape)
    whole = smaller & (sizes == np.round(sizes))
    counts[whole] = minimal_cover(extent, sizes[whole].astype(np.int64))
    nodes = _summed(extent) if (smaller & ~whole).any() else None
    for k in np.flatnonzero(smaller & ~whole):
        origins = _origins(sizes[k], max_shifts)
        counts[k] = _minimal_cover(nodes, sizes[k], origins)
    return counts if extent.any() else np.zeros(sizes.size, np.int64)


def _ratio(size: float) -> Fraction | None:
    """A box side as p / q with a small q, or None."""
    ratio = Fraction(size).limit_denominator(_MAX_PARTS)
    return ratio if abs(float(ratio) - size) < 1e-9 * size else None


def _origins(size: float, max_shifts: int) -> np.ndarray:
    """Origins of a grid of boxes along one axis, cells: one for each way to part the nodes."""
    ratio = _ratio(size)
    if ratio is None:
        shifts = max(min(int(np.ceil(size)), max_shifts), 1)
        return size * np.arange(shifts) / shifts
    # Nodes change boxes when an edge passes a centre: at 1/2 + multiples of 1/q of a cell.
    return 0.5 + (np.arange(ratio.numerator) + 0.5) / ratio.denominator


def cropped(domain: np.ndarray) -> np.ndarray:
    """Part of the grid that a domain spans; one empty cell for an empty domain."""
    if not domain.any():
        return np.zeros((1, 1), dtype=bool)
    rows, columns = (np.flatnonzero(domain.any(axis=axis)) for axis in (1, 0))
    return domain[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]


def minimal_cover(domain: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Minimal cover by boxes of whole sides (k,) in cells, over every grid origin: (k,) int64."""
    return _over_origins(np.ascontiguousarray(domain), sizes)


def _checked_domain(domain):
    """A contact domain as (ny, nx) bool; ValueError if it is no grid or too large to count."""
    domain = arguments.domain(domain, "a contact domain")
    if domain.size > _MAX_CELLS:
        raise ValueError(f"a contact domain of {domain.shape}: expected {_MAX_CELLS} cells at most")
    return domain


def _checked_sizes(sizes):
    """Sides of boxes in cells as (k,) float64; ValueError if one is below 1, or no number."""
    sizes = arguments.real_array(sizes, "sizes of boxes").astype(float)
    if sizes.ndim != 1:
        raise ValueError(f"sizes of boxes {sizes.shape}: expected a list of numbers")
    if not (np.isfinite(sizes) & (sizes >= 1)).all():
        raise ValueError(f"a box is at least one cell wide, not {sizes.min()}")
    return sizes


@njit(cache=True)
def _summed(domain):
    """Nodes below and left of each corner: four look-ups then give the number in a box."""
    ny, nx = domain.shape
    nodes = np.zeros((ny + 1, nx + 1), np.int32)
    for y in range(ny):
        row = 0
        for x in range(nx):
            row += domain[y, x]
            nodes[y + 1, x + 1] = nodes[y, x + 1] + row
    return nodes


@njit(cache=True)
def _over_origins(domain, sizes):
    """Minimal cover for each size.

    A box whose lowest cell is p meets the domain if its side is at least d(p): 1 at a node, else
    one more than the least d of the upper neighbours. The boxes of one grid have their lowest cells
    at equal places modulo r.
    """
    ny, nx = domain.shape
    reach = 1
    for size in sizes:
        reach = max(reach, size)
    # Places along x are counted modulo a multiple of r, so that small boxes too have long loops.
    spans = sizes * ((_SPAN + sizes - 1) // sizes)
    starts = np.zeros(sizes.size + 1, np.int64)
    starts[1:] = np.cumsum(sizes * spans)
    counts = np.zeros(starts[-1], np.int32)
    smallest = np.full(nx + reach, reach + 1, np.int32)  # place x stands at x + reach - 1
    for y in range(ny - 1 if sizes.size else -reach, -reach, -1):
        nearest = _next_row(domain, y, smallest, reach)
        if nearest > reach:
            continue
        for k in range(sizes.size):
            size, span, least = sizes[k], spans[k], np.int32(sizes[k])
            if nearest > size or y <= -size:
                continue
            row = counts[starts[k] + (y + size - 1) % size * span :][:span]
            for first in range(reach - size, nx + reach - 1, span):
                part = smallest[first : min(first + span, nx + reach - 1)]
                for i in range(part.size):
                    row[i] += part[i] <= least
    cover = np.empty(sizes.size, np.int64)
    for k in range(sizes.size):
        alike = counts[starts[k] : starts[k + 1]].reshape(sizes[k], -1, sizes[k])
        cover[k] = alike.sum(axis=1).min()
    return cover


@njit(cache=True)
def _next_row(domain, y, smallest, reach):
    """Smallest box sides of one row, from those of the row above in place; returns the least."""
    nx = domain.shape[1]
    least = reach + 1
    above = right = np.int32(reach + 1)
    for i in range(nx + reach - 2, -1, -1):
        x = i - reach + 1
        diagonal, above = above, smallest[i]
        right = min(min(above, diagonal), right) + 1
        if y >= 0 and x >= 0 and domain[y, x]:
            right = 1
        right = min(right, reach + 1)
        smallest[i] = right
        least = min(least, right)
    return least


@njit(cache=True)
def _edges(n, size, origins):
    """First cell of each box along one axis, a row for each origin of the grid."""
    boxes = int(np.ceil(n / size)) + 2
    edges = np.empty((origins.size, boxes), np.int64)
    for shift in range(origins.size):
        for box in range(boxes):
            edge = size * box - origins[shift] % size
            # The first cell whose centre lies beyond the edge; the small number keeps n/k * k at n.
            edges[shift, box] = min(max(int(np.ceil(edge - 0.5 - 1e-9)), 0), n)
    return edges


@njit(cache=True)
def _minimal_cover(nodes, size, origins):
    """N(r) over all pairs of origins along y and x."""
    edges_y = _edges(nodes.shape[0] - 1, size, origins)
    edges_x = _edges(nodes.shape[1] - 1, size, origins)
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

    The places where a gliding box meets the domain, divided by its area: nothing depends on the
    origin of a grid. The domain ends where it ends, and boxes hang over that by up to their
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
    sizes = whole_numbers(_checked_sizes(sizes), "sizes of boxes", least=1, most=_MAX_CELLS)
    blocks = whole_number(blocks, "blocks", least=1, most=_MAX_CELLS)
    domain = np.ascontiguousarray(_checked_domain(domain))
    return _places_of(domain, sizes, blocks) / (sizes**2)[:, np.newaxis, np.newaxis]


def _places_of(domain, sizes, blocks):
    """Places of gliding boxes that meet a domain, (k, blocks, blocks), sizes in any order."""
    ascending, place = np.unique(sizes, return_inverse=True)
    ny, nx = domain.shape
    packed = np.zeros((ny, 8 * -(-nx // 64)), np.uint8)
    packed[:, : -(-nx // 8)] = np.packbits(domain, axis=1, bitorder="little")
    return _places(packed.view("<u8").astype(np.uint64, copy=False), nx, ascending, blocks)[place]


@njit(cache=True)
def _places(packed, nx, sizes, blocks):
    """Places of gliding boxes that meet the domain, by the part that holds their middle.

    Each bit says whether the box whose lowest cell is there meets the domain: 64 places at a time.
    A box of side r is made of four of side r', whose lowest cells are r - r' apart.
    """
    ny = packed.shape[0]
    reach = sizes[-1] if sizes.size else 1
    # Boxes hang over both sides: words before cell 0 and zeros behind the last word hold them.
    before = (reach + 62) // 64
    rows, words = ny + reach - 1, before + packed.shape[1]
    meets = np.zeros((rows, words + reach // 64 + 2), np.uint64)
    meets[reach - 1 :, before:words] = packed
    places = np.zeros((sizes.size, blocks, blocks), np.int64)
    side = 1
    for k in range(sizes.size):
        size = sizes[k]
        while side < size:
            step = min(side, size - side)
            _widen(meets, words, reach - side, step)
            side += step
        for row in range(reach - size, rows):
            y = row - reach + 1
            part_y = min(max((2 * y + size) * blocks // (2 * ny), 0), blocks - 1)
            first = 64 * before + 1 - size
            for part_x in range(blocks):
                # One past the last place whose middle is in this part; outer boxes overhang.
                end = -((size * blocks - 2 * nx * (part_x + 1)) // 2 // blocks)
                end = 64 * before + (nx if part_x == blocks - 1 else end)
                places[k, part_y, part_x] += _ones(meets[row], first, end)
                first = end
    return places


@njit(cache=True)
def _widen(meets, words, first, step):
    """Make boxes wider by some cells, at most by their side; row ``first`` is the first not empty.

    Rows are written from below and read from above, so that no copy is needed.
    """
    whole, bits = step // 64, np.uint64(step % 64)
    row = np.empty(words, np.uint64)
    for y in range(first, meets.shape[0]):
        lower, upper = meets[y, whole : whole + words], meets[y, whole + 1 : whole + 1 + words]
        for i in range(words):
            # Two shifts to the left, because a single shift by 64 bits does nothing.
            row[i] = lower[i] >> bits | upper[i] << np.uint64(1) << (np.uint64(63) - bits)
        for i in range(words):
            meets[y, i] |= row[i]
    for y in range(first - step, meets.shape[0] - step):
        for i in range(words):
            meets[y, i] |= meets[y + step, i]


@njit(cache=True)
def _ones(row, first, end):
    """Number of bits that are set from ``first`` to before ``end``."""
    if end <= first:
        return 0
    last = (end - 1) >> 6
    n = 0
    for i in range(first >> 6, last + 1):
        word = row[i]
        if i == first >> 6:
            word = word >> np.uint64(first & 63) << np.uint64(first & 63)
        if i == last:
            word = word << np.uint64(63 - ((end - 1) & 63))
        n += _bits_of(word)
    return n


@njit(cache=True)
def _bits_of(word):
    """Number of bits set in a word of 64: sums of two, four and eight of them in parallel."""
    word -= (word >> np.uint64(1)) & np.uint64(0x5555555555555555)
    word = (word & np.uint64(0x3333333333333333)) + (
        (word >> np.uint64(2)) & np.uint64(0x3333333333333333)
    )
    word = (word + (word >> np.uint64(4))) & np.uint64(0x0F0F0F0F0F0F0F0F)
    return np.int64((word * np.uint64(0x0101010101010101)) >> np.uint64(56))
