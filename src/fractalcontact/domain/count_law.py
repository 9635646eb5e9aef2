"""Power law of the mean box counts: the set's resolution and its outline separated.

The places of a gliding box that meet a set of dimension D fill the area V(r) = r^2 N(r). For a set
drawn on a grid and cut off by an outline

    V = rho^(2-D) [a_0 + a_1 (rho / L) + a_2 (rho / L)^2],    rho = r - c,

with all a >= 0. Of the two corrections

- c is the width that a node stands for. A box of r cells spans r - 1 from the centre of its first
  cell to that of its last: of points sampled at centres (contact solved at nodes), c = 1. If every
  cell is marked that holds some point of the set, the whole box counts: c = 0.
- the bracket is the area of boxes that hang over the outline: Steiner's formula for a filled figure
  (D = 2, area, half perimeter in the mean, 1), which boxes of a tenth of its side would take for a
  set of 1.8; the outline of a set of dimension D is taken to have D - 1, and below D = 1 there is
  none. (As no factor is negative, a random bend taken for an outline would raise D: by 0.03 at
  D = 0.8.)

The thresholds below were chosen on carpets, dusts, percolation clusters and random cascades, where
D comes out within 0.02. On other sets, drawn as whole cells, that they were not chosen on
(Vicsek's, Sierpinski's triangle, dusts and carpets of ratios 4 and 5, upright and turned) the
median error is 0.03 and the largest 0.07, mostly upwards, where whole cells pass for centres.
A user who knows how a set was drawn may state it.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from roughcontact.arguments import real_array
from roughcontact.kernel_cache import njit

#: Values of D that are tried first, and offsets from the best of them that are tried next.
_COARSE = np.linspace(0, 2, 101)
_FINE = np.linspace(-0.02, 0.02, 41)

#: Largest count of an outline over that of the inside, at boxes as large as the extent.
#: (A filled square has 2, a square turned by 45 degrees 4.)
MAX_OUTLINE = 4.0

#: Least dimension of a set with an outline: a line of the plane misses sets of less.
MIN_WITH_OUTLINE = 1.0

#: Least ratio by which a further term of the outline must lower the misfit.
TERM_GAIN = 1.5

#: Least ratio of misfits by which the law of whole cells (c = 0) must fit better than that of
#: centres, and its largest misfit without an outline (log-periodic sets wave by 2 %) and with one.
WHOLE_GAIN = 1.6
WHOLE_MISFIT = 0.026
WHOLE_MISFIT_OUTLINE = 0.0015

#: Smallest box, cells, by which forms of the law are separated, and smallest box of the fit itself.
#: Small boxes show the width c that a node stands for: it is wanted for the form only.
SMALLEST_SEPARATING = 3
SMALLEST = 4

#: Area that a node can stand for: all of its cell, or its centre.
_WHOLE, _CENTRE = 0, 1


class LawTerms(NamedTuple):
    """Terms of a count law, all lengths in one unit, for its curve."""

    amplitude: float
    """Factor A: boxes as large as the extent."""
    outline: float
    """Factor b_1 of the outline."""
    outline_square: float
    """Factor b_2 of the square of the outline's term."""
    node_width: float
    """Width c that a node stands for."""
    extent: float
    """Extent L of the domain."""


NO_TERMS = LawTerms(*(np.nan,) * 5)


def law_count(r: ArrayLike, dimension: float, terms: LawTerms) -> np.ndarray:
    """Boxes of side r (k,) by a count law, r in the unit of the terms and larger than c.

    N(r) = A (rho/L)^(2 - D) (L/r)^2 [1 + b_1 rho/L + b_2 (rho/L)^2], rho = r - c: the law at the
    top of this module, with A = a_0 L^-D, b = a/a_0. Without outline and with c = 0 it is the
    line N = A (L/r)^D.
    """
    r = np.asarray(r, float)
    rho = (r - terms.node_width) / terms.extent
    bracket = 1 + terms.outline * rho + terms.outline_square * rho**2
    return terms.amplitude * rho ** (2 - dimension) * (terms.extent / r) ** 2 * bracket


@dataclass(frozen=True)
class Law:
    """A fitted law: D, misfit (relative, root mean square), c, number of terms of the outline."""

    dimension: float
    misfit: float
    c: int
    outline: int


def best_law(
    sizes: np.ndarray, count: np.ndarray, side: float, whole_cells: bool | None = None
) -> Law | None:
    """Law that mean box counts (k,) follow at box sides (k,) in cells; None where no such law fits.

    ``side`` is the extent L of the set, cells. Nodes are whole cells (c = 0) or centres (c = 1);
    unless ``whole_cells`` states it, they are taken for centres where counts do not plainly follow
    the law of whole cells. ValueError if there is not one count for each size.
    """
    sizes, count = _checked(sizes, count)
    stand_for = {None: (_WHOLE, _CENTRE), True: (_WHOLE,), False: (_CENTRE,)}[whole_cells]
    forms = [Law(np.nan, np.inf, c, outline) for c in stand_for for outline in range(3)]
    fits = [_fit(form, sizes, count, side) for form in forms]
    laws = {(law.c, law.outline): law for law in fits if law is not None}
    if not laws:
        return None
    law = _whole_cells(laws) if whole_cells is None else None
    law = law or _simplest([law for law in laws.values() if law.c == _CENTRE])
    law = law or _simplest(list(laws.values()))
    kept = sizes >= SMALLEST
    return _fit(law, sizes[kept], count[kept], side) or law


def _whole_cells(laws):
    """Law of cells marked whole, where that of centres is plainly worse; else None."""
    centres = {law.outline: law.misfit for law in laws.values() if law.c == _CENTRE}
    limits = ((2, WHOLE_MISFIT_OUTLINE), (1, WHOLE_MISFIT_OUTLINE), (0, WHOLE_MISFIT))
    for outline, most in limits:
        whole = laws.get((_WHOLE, outline))
        if whole is None or whole.misfit > min([most, *centres.values()]):
            continue
        rivals = [misfit for terms, misfit in centres.items() if terms <= outline]
        if min(rivals, default=np.inf) >= WHOLE_GAIN * whole.misfit:
            return whole
    return None


def _simplest(laws):
    """Law with the fewest terms that one more would not make much better."""
    best = None
    for law in laws:
        if best is None or law.misfit < best.misfit / TERM_GAIN:
            best = law
    return best


def law_dimension(law: Law, sizes: np.ndarray, count: np.ndarray, side: float) -> float:
    """Dimension of a law of the same form fitted to other counts; NaN without a fit."""
    sizes, count = _checked(sizes, count)
    fitted = _fit(law, sizes, count, side)
    return np.nan if fitted is None else fitted.dimension


def law_terms(law: Law, sizes: np.ndarray, count: np.ndarray, side: float) -> LawTerms:
    """Terms, in cells, of a law of :func:`best_law`, fitted to its sizes and counts."""
    sizes, count = _checked(sizes, count)
    rho = (sizes - law.c) / side
    powers = rho[:, np.newaxis] ** (2 - law.dimension + np.arange(law.outline + 1))
    # The relative misfit is least, as in the fit.
    columns = powers * ((side / sizes) ** 2 / count)[:, np.newaxis]
    a = np.linalg.lstsq(columns, np.ones(sizes.size), rcond=None)[0]
    outline = np.zeros(2)
    outline[: law.outline] = a[1:] / a[0]
    return LawTerms(float(a[0]), outline[0], outline[1], float(law.c), float(side))


def _checked(sizes, count):
    """Sizes and counts as (k,) float64."""
    sizes, count = (
        np.ascontiguousarray(real_array(values, name), float)
        for values, name in ((sizes, "sizes"), (count, "counts"))
    )
    if sizes.ndim != 1 or sizes.shape != count.shape:
        raise ValueError(f"sizes {sizes.shape} and counts {count.shape}: expected one for each")
    return sizes, count


def _fit(law, sizes, count, side):
    """Law of this form with the least misfit; None if its factors are not admissible."""
    if sizes.size <= law.outline + 2:
        return None
    centre = 0.0
    for grid in (_COARSE, _FINE):
        tried = np.clip(centre + grid, 0, 2)
        misfit = _misfits(sizes - law.c, count * sizes**2, side, law.outline + 1, tried)
        i = int(np.argmin(misfit))
        if np.isinf(misfit[i]):
            return None
        centre = float(tried[i])
    return replace(law, dimension=centre, misfit=float(misfit[i]))


#: Compilation that may take sums in any order, several terms at a time.
_summing = njit(cache=True, fastmath={"reassoc", "contract"})


@_summing
def _misfits(rho, areas, side, terms, dimensions):
    """Relative misfit at each D with least-squares factors a; infinite for invalid factors."""
    misfits = np.full(dimensions.size, np.inf)
    log_rho, log_areas = np.log(rho), np.log(areas)
    columns, normal, a = np.empty((terms, rho.size)), np.empty((terms, terms + 1)), np.empty(terms)
    for d in range(dimensions.size):
        columns[0] = np.exp((2 - dimensions[d]) * log_rho - log_areas)
        columns[0] /= columns[0].max()
        for i in range(1, terms):
            columns[i] = columns[i - 1] * (rho / side)
        _solve_normal(columns, normal, a)
        possible = a[0] > 0 and (terms == 1 or dimensions[d] >= MIN_WITH_OUTLINE)
        for i in range(1, terms):
            possible &= -1e-9 * a[0] <= a[i] <= MAX_OUTLINE * a[0]
        if possible:
            total = 0.0
            for k in range(rho.size):
                miss = -1.0
                for i in range(terms):
                    miss += columns[i, k] * a[i]
                total += miss**2
            misfits[d] = np.sqrt(total / rho.size)
    return misfits


@_summing
def _solve_normal(columns, normal, a):
    """Least-squares factors a of columns a = 1 by the normal equations; zeros if singular."""
    n = a.size
    a[:] = 0
    for i in range(n):
        for j in range(i, n):
            normal[i, j] = (columns[i] * columns[j]).sum()
        normal[i, n] = columns[i].sum()
    for i in range(n):
        # The diagonal is the square of each column's part independent of the columns before it;
        # without such a part the equations are singular.
        if not normal[i, i] > 0:
            return
        for row in range(i + 1, n):
            factor = normal[i, row] / normal[i, i]
            for j in range(row, n + 1):
                normal[row, j] -= factor * normal[i, j]
    for i in range(n - 1, -1, -1):
        a[i] = normal[i, n]
        for j in range(i + 1, n):
            a[i] -= normal[i, j] * a[j]
        a[i] /= normal[i, i]
