"""Multifractal analysis of a domain or its pressure: gliding-box lacunarity and D_q.

A box glides over all its places inside the window. Boxes of one size then are a fair sample of
the pattern beyond the window too, and nothing depends on the origin of a grid of boxes.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from roughcontact.arguments import real_array, refuse_masked, whole_numbers
from roughcontact.kernel_cache import njit

from ..core.estimate import Estimate
from ..core.intervals import jackknife_error
from ..core.slope_of_sums import BLOCKS, slope_of_sums
from .box_counts import whole_sizes

#: Smallest and largest box of the fits: cells, and fraction of the window's shorter side.
SMALLEST_BOX = 4
LARGEST_BOX = 1 / 4

#: Places of a box along its own side: boxes at more places overlap so much that they add nothing.
PLACES = 16

#: Orders q of the generalised dimensions.
ORDERS = (-2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0)
#: Size of whole orders below which powers are computed one from the other.
_MAX_WHOLE = 64
#: Fewest nodes with a D_q: each is then a tenth of the mass. Gliding boxes meet nodes near a rim
#: less often: a single node in a corner would have 1.8, and the jackknife would not show it.
FEWEST = 10


@dataclass(frozen=True, kw_only=True)
class SizeCurve(Estimate):
    """Numbers (k,) at box sizes ``r`` (k,)."""

    r: np.ndarray


def gliding_moments(
    mass: np.ndarray, sizes: np.ndarray, orders: Sequence[float]
) -> tuple[np.ndarray, np.ndarray]:
    """Moments of the mass in gliding boxes inside the window, over parts of the window.

    ``mass`` (ny, nx) are nodes in contact, or their pressure; ValueError if it is negative or not
    finite. ``sizes`` (k,) are box sides in cells, none larger than the window, ``orders`` are q.

    Returns
    -------
    moments : (k, len(orders) + 1, BLOCKS**2) float64
        Sums of p^q over boxes that are not empty, p their fraction of the window's mass; last those
        of p ln p.
    places : (k, BLOCKS**2) int64
        Boxes, empty ones too, by the part of the window that holds their middle.
    """
    mass = _checked(mass)
    sizes = whole_numbers(sizes, "sizes of boxes", least=1, most=max(1, *mass.shape))
    q = real_array(orders, "orders q").astype(float).ravel()
    moments = np.zeros((sizes.size, q.size + 1, BLOCKS**2))
    places = np.zeros((sizes.size, BLOCKS**2), np.int64)
    total = mass.sum()
    if total > 0:
        fraction = mass / total
        rows, columns = np.nonzero(fraction)
        starts = np.searchsorted(rows, np.arange(mass.shape[0] + 1))
        filled = fraction[rows, columns], columns, starts
        for k, size in enumerate(sizes.astype(int)):
            lowest = [np.arange(0, n - size + 1, max(1, size // PLACES)) for n in mass.shape]
            parts = [
                (2 * start + size) * BLOCKS // (2 * n)
                for start, n in zip(lowest, mass.shape, strict=True)
            ]
            _glide(mass.shape[1], filled, size, *lowest, *parts, q, moments[k])
            places[k] = np.outer(*(np.bincount(part, minlength=BLOCKS) for part in parts)).ravel()
    return moments, places


def _checked(mass):
    """Masses as (ny, nx) float64, all non-negative."""
    refuse_masked(mass, "masses")
    mass = real_array(mass, "masses", "biuf").astype(float, copy=False)
    if mass.ndim != 2:
        raise ValueError(f"masses are a (y, x) grid, not of shape {mass.shape}")
    if not np.isfinite(mass).all() or (mass < 0).any():
        raise ValueError("masses must be finite and not negative")
    return np.ascontiguousarray(mass)


@njit(cache=True, fastmath={"reassoc", "contract"})
def _glide(nx, filled, size, lowest_y, lowest_x, parts_y, parts_x, orders, moments):
    """Add the moments of all boxes of one size, from the cells that are filled, row by row."""
    fraction, columns, starts = filled
    column = np.zeros(nx)
    before = np.zeros(nx + 1, np.int64)  # number of columns with mass before each column
    whole = orders.size > 0 and np.abs(orders).max() < _MAX_WHOLE
    whole = whole and (orders == np.floor(orders)).all()
    least, most = (int(orders.min()), int(orders.max())) if whole else (0, 0)
    powers = np.empty(most - least + 1)
    for y, part_y in zip(lowest_y, parts_y):  # noqa: B905  # numba knows no `strict`
        # Sums are formed anew: differences of running sums would leave a trace in empty boxes.
        column[:] = 0.0
        for i in range(starts[y], starts[y + size]):
            column[columns[i]] += fraction[i]
        for x in range(nx):
            before[x + 1] = before[x] + (column[x] > 0)
        for x, part_x in zip(lowest_x, parts_x):  # noqa: B905
            if before[x + size] > before[x]:
                p, part = column[x : x + size].sum(), part_y * BLOCKS + part_x
                log_p = np.log(p)
                moments[-1, part] += p * log_p
                if whole:  # each power is p times the previous one
                    power = p**least
                    for n in range(powers.size):
                        powers[n] = power
                        power *= p
                for j, q in enumerate(orders):
                    moments[j, part] += powers[int(q) - least] if whole else np.exp(q * log_p)


def fit_sizes(shape: tuple[int, int]) -> np.ndarray:
    """Box sides of the fits in a window of this shape, cells."""
    sizes = whole_sizes(LARGEST_BOX * min(shape))
    return sizes[sizes >= SMALLEST_BOX]


def lacunarity(mass: np.ndarray, spacing: float) -> SizeCurve:
    """Gliding-box lacunarity <M^2> / <M>^2 over box sizes (Allain & Cloitre 1991).

    1 where all boxes hold the same; a translation invariant fractal of dimension D in a window has
    a power law of slope D - 2. Box sides in mm go from one cell, ``spacing`` in mm, to half of the
    window; the interval is by the jackknife over parts of the window (on the logarithm). NaN in an
    empty window.
    """
    mass = _checked(mass)
    sizes = whole_sizes(min(mass.shape) / 2)
    moments, places = gliding_moments(mass, sizes, [1.0, 2.0])
    sums = np.concatenate([moments[:, :2], places[:, np.newaxis]], axis=1)
    value = _lacunarity(sums.sum(axis=2))
    left = [np.log(_lacunarity(sums.sum(axis=2) - sums[:, :, i])) for i in range(sums.shape[2])]
    error = np.array([jackknife_error(column) for column in np.transpose(left)])
    error[~np.isfinite(value)] = np.nan
    r = sizes * float(spacing)
    return SizeCurve(value, value * np.exp(-error), value * np.exp(error), r=r)


def _lacunarity(sums):
    """<M^2> / <M>^2 from sums of M, M^2 and 1; NaN where all boxes are empty."""
    mass, square, places = sums.T
    return np.where(mass > 0, square * places, np.nan) / np.where(mass > 0, mass, 1) ** 2


def generalised_dimensions(
    mass: np.ndarray, spacing: float, orders: tuple[float, ...] = ORDERS
) -> dict[float, Estimate]:
    """Generalised dimensions D_q of a mass, by the moments of gliding boxes.

    D_q (q - 1) is the slope of log Z_q against log r, Z_q = r^(2q - 2) <p^q> / <p>^q, the sum of
    p^q over the boxes of a grid in the mean over its origins; at q = 1 that of <p ln p> / <p>
    - ln <p>, and 2 more. D_0 belongs to the domain itself, D_1 to its entropy, D_2 to pairs; a mass
    spread evenly has 2 at all q, and D_q falls with q.

    Parameters
    ----------
    mass : (ny, nx) array_like
        Pressure, or nodes in contact; fewer than :data:`FEWEST` nodes have no D_q.
    spacing : float
        Side of a cell, mm, the unit of the fits' box sides.
    orders : sequence of float
        q. Negative ones weigh the emptiest boxes most: they show the fading of contact at the rims
        of its patches, and depend on the solver's tolerance.
    """
    mass = _checked(mass)
    sizes = fit_sizes(mass.shape)
    if sizes.size == 0 or np.count_nonzero(mass) < FEWEST:
        return dict.fromkeys(orders, Estimate())
    moments, places = gliding_moments(mass, sizes, [1.0, *orders])
    first, entropy = moments[:, 0], moments[:, -1]
    dimensions = {}
    for j, q in enumerate(orders):
        column = entropy if q == 1 else moments[:, 1 + j]
        sums = np.stack([first, column, places], axis=1)
        slope = slope_of_sums(sizes * float(spacing), sums, _normalised(q))
        dimensions[q] = _dimension(slope, q)
    return dimensions


def _normalised(q):
    """Statistic whose slope gives D_q, from sums of p, of p^q (or p ln p), and of 1."""

    def statistic(sums):
        first, moment, places = sums.T
        with np.errstate(divide="ignore", invalid="ignore"):
            mean = first / places
            if q == 1:
                return np.exp(moment / first - np.log(mean))
            return moment / places / mean**q

    return statistic


def _dimension(slope, q):
    """D_q from the slope of its statistic."""
    factor = 1.0 if q == 1 else 1 / (q - 1)
    return slope.mapped(lambda exponent: 2 + factor * exponent, falling=factor < 0)
