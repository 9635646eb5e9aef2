"""Box-counting dimension Delta_sigma of a contact domain: cut-offs, three estimators, intervals.

The counts are those of :mod:`domain.box_counts`.
"""

import itertools
from dataclasses import dataclass, replace

import numpy as np

from ..core.estimate import DIMENSION, IN_PLANE, Estimate, Scale
from ..core.fitting import MIN_POINTS, LineFit, fit_line
from ..core.limits import MIN_NODES
from ..core.ranges import in_cells, within
from ..core.slope_of_sums import BLOCKS, MIN_SCALES, wave_error
from .box_counts import RATIOS, box_count, box_sizes, cropped, mean_count, window_sizes
from .count_law import NO_TERMS, LawTerms
from .cut_offs import between_cut_offs
from .mean_law import (
    NO_MEANS,
    FittedLaw,
    MeanCounts,
    block_error,
    count_slope,
    is_crowded,
    law_of_means,
)
from .ordinary_dimension import OrdinaryDimension, dyadic_sizes, ordinary_dimension

#: The estimators of the dimension by their names in results.
ESTIMATORS = {
    "exact": "exact power law of the minimal cover",
    "mean": "count law fitted to the mean counts",
    "cover": "line through the minimal cover",
}

#: Why the contact domain of one node has no dimension.
ONE_NODE = "one node is in contact, and the contact within its cell is not known"

#: Why a dense domain has no dimension.
CROWDED = "nearly all boxes are occupied but the smallest: too few sizes are left for a dimension"

#: Why a dimension has no interval.
FEW_NODES = f"no interval: {{}} nodes in contact, {MIN_NODES} are needed"
ONE_PART = "no interval: nearly all nodes lie in one part of the domain"


@dataclass(frozen=True, kw_only=True)
class BoxDimension(Estimate):
    """A box-counting dimension with its interval, its range in mm and the counts behind it.

    Attributes
    ----------
    r, count : (k,) ndarray
        Sides of the boxes, mm, and the minimal cover there.
    used : (k,) bool ndarray
        Sides that the dimension rests on; for "mean" those within the range of the law.
    estimator : str
        One of :data:`ESTIMATORS`.
    misfit : float
        Root mean square of the counts about the fitted law, as a fraction of them.
    terms : LawTerms
        Terms of the law, mm, from which :func:`domain.count_law.law_count` draws its curve.
    means : MeanCounts
        Mean counts over grid origins.
    ordinary : OrdinaryDimension or None
        Ordinary box-counting dimension, :mod:`domain.ordinary_dimension`; None without counts.
    """

    r: np.ndarray
    count: np.ndarray
    used: np.ndarray
    estimator: str = ""
    misfit: float = float("nan")
    terms: LawTerms = NO_TERMS
    means: MeanCounts = NO_MEANS
    ordinary: OrdinaryDimension | None = None
    scale: Scale = DIMENSION

    def __repr__(self):
        if not self.known:
            return f"<BoxDimension: none ({self.reason})>"
        return (
            f"<BoxDimension {self.value:.4g} [{self.low:.4g}, {self.high:.4g}] from {self.n} "
            f"sizes, {self.over[0]:.4g} to {self.over[1]:.4g} mm, by {self.estimator}>"
        )

    @property
    def dimension(self) -> float:
        """The dimension, NaN where there is none."""
        return self.value


def box_dimension(
    domain: np.ndarray,
    spacing: float,
    *,
    fit_range: tuple[float, float] | None = None,
    sizes: np.ndarray | None = None,
    whole_cells: bool | None = None,
) -> BoxDimension:
    """Box-counting dimension Delta_sigma of a contact domain.

    Parameters
    ----------
    domain : (ny, nx) bool array_like
        Nodes in contact.
    spacing : float
        Distance of neighbouring nodes, mm.
    fit_range : (float, float), optional
        Smallest and largest box side of the fit, mm; by default all between the cut-offs.
    sizes : (k,) array_like, optional
        Box sides in cells, ascending, of the minimal cover; by default `box_sizes` of the domain's
        own extent. Give them where several domains are to share one axis.
    whole_cells : bool, optional
        Whether every cell is marked that holds some point of the set, as in a drawing, or those
        whose centre does, as in a solution at nodes. By default the counts decide, and take cells
        for centres unless they plainly are none.

    Returns
    -------
    BoxDimension
        `r_min` and `r_max` of the fit in mm and its `n` sizes; `reason` says why there is no
        dimension (NaN) or no interval.

    Notes
    -----
    A box size lies beyond a cut-off where all but `SATURATED` of the nodes are alone in their box,
    or of the boxes of the window occupied. Such sizes are left out, unless as much of the window
    touches (then all sizes give dimension 2) or a single node does (0). Fewer than `MIN_SCALES`
    sizes left, or different counts among them, give no dimension: a line through a staircase of two
    or three treads shows where their edges happen to be, and through a single tread it would claim
    0 without error.

    Three estimators, the first that can be had:

    - "exact": the minimal cover over grid origins where its counts lie on a line but for rounding,
      at all sizes or at the extent / ratio^k with one of `RATIOS`: squares, lines and self-similar
      sets.
    - "mean": the law of :mod:`domain.count_law` fitted to the mean counts over grid origins,
      from the resolution to `LARGEST_BOX` of the extent. All rough contact domains.
    - "cover": the line through the minimal cover, where the domain is too small for the law. Not
      where it is too dense: over the few sizes below occupied boxes the two estimators differ by
      more than a load changes either (contact of half a window: 1.60 where the law had 1.73).

    The interval is that of the value over its range: the t-interval by the jackknife, `BLOCKS` x
    `BLOCKS` parts of the domain or strips of `BLOCKS` parts left out one by one, whichever is
    wider, and what waves of the counts about their smooth bend may tilt, in quadrature. The counts
    belong to one set and are no independent points: the error of a regression alone is far too
    small. A bend of the counts is no error of the value but a finding: the local slopes of
    :mod:`domain.slope_curves` show it. Fewer than `MIN_NODES` nodes have a value and no interval.
    An exact value has the slopes of every run of sizes over half of the range or more instead. How
    often intervals hold the truth: docs/calibration.md.

    Known bias: percolation clusters of 512 and 1024 read 0.016 to 0.02 low in the mean. Sets marked
    by whole cells read up to 0.1 high where their waves hide that: state `whole_cells`. Levy dusts
    marked and stated so read high, where chance bends the counts as an outline would (indices of
    1.2 and 1.5) or few boxes are left (0.8): by 0.025, 0.02 and 0.04 in windows of 512, by 0.02,
    0.015 and 0.015 in windows of 2048; means of 120 to 400, uncertain by 0.007.

    One window cannot show whether chance struck it more densely than others: where
    parts fall on the same boxes, as those of flights or trails, the counts of size r differ by a
    random fraction of (r / L)^(2 - D), which is alike in all parts and nearly a power law. Such
    sets of 1.5 are in 93 % of intervals; of 1.7, or trails that have not filled their window, in
    fewer.

    Figures apart, as two squares: once boxes are larger than a figure or than the gap, the counts
    measure no outline any more. With more of it than `count_law.MAX_OUTLINE` allows they read
    1.3 to 1.9, as a strip of 5 x 1 does, and where the gap is wide their intervals end short of 2:
    local slopes show the bend. Without that limit they are exact, but cascades of 1.2 read 0.12
    high. The same holds for a set that is cut off so that copies of several sizes are left: a
    dust of 650 of its 729 cells reads 0.09 low, inside its interval.
    """
    domain = np.asarray(domain, dtype=bool)
    extent = cropped(domain)
    # A single node has no extent to divide: its boxes are those of the window.
    shape = extent.shape if extent.size > 1 else domain.shape
    fitting = sizes is None
    sizes = box_sizes(shape, min(domain.shape)) if sizes is None else np.asarray(sizes, dtype=float)
    limits = in_cells(fit_range, spacing)
    count, ordinary = _minimal_covers(domain, extent, sizes, limits)
    r = sizes * float(spacing)
    nodes = int(extent.sum())
    used, reason = _used_sizes(domain, nodes, sizes, count, limits)
    if reason:
        return replace(no_dimension(r, count, reason), ordinary=ordinary)
    cover = _Cover(sizes, r, count, used)
    ladder = _best_scales(cover, {max(extent.shape), max(domain.shape)})
    side = max(extent.shape) * float(spacing)
    # Sizes that fit a filled window count it exactly; others overhang it.
    if nodes == 1 or (fitting and nodes == domain.size) or _is_exact(cover, ladder):
        return replace(_exact(cover, ladder, side), ordinary=ordinary)
    law, means = law_of_means(extent, limits, whole_cells)
    if law is None and is_crowded(means, extent):
        return replace(no_dimension(r, count, CROWDED), ordinary=ordinary, means=means)
    dimension = _of_law(cover, law, spacing) if law else _of_line(cover, extent, side)
    return replace(_with_interval(dimension, nodes), ordinary=ordinary, means=means)


def _with_interval(dimension: BoxDimension, nodes: int) -> BoxDimension:
    """The dimension, without its interval and with the reason where it rests on too few nodes."""
    why = FEW_NODES.format(nodes) if nodes < MIN_NODES else ONE_PART
    if nodes >= MIN_NODES and np.isfinite(dimension.width):
        return dimension.in_plane()
    return replace(dimension, low=np.nan, high=np.nan, reason=why)


def _minimal_covers(domain, extent, sizes, limits) -> tuple[np.ndarray, OrdinaryDimension | None]:
    """Minimal cover at all sizes, and the ordinary dimension from the powers of two among them."""
    dyadic = dyadic_sizes(domain.shape)
    all_sizes, place = np.unique(np.concatenate([sizes, dyadic]), return_inverse=True)
    count = box_count(extent, all_sizes)[place]
    if not extent.any():
        return count[: sizes.size], None
    of_dyadic = count[sizes.size :]
    return count[: sizes.size], ordinary_dimension(extent, domain.shape, dyadic, of_dyadic, limits)


def dimension_of_domain(
    domain: np.ndarray,
    spacing: float,
    *,
    fit_range: tuple[float, float] | None = None,
    whole_cells: bool | None = False,
) -> BoxDimension:
    """Box-counting dimension of a contact domain, as every stage states it.

    One set of nodes in one window has one dimension in all stages: box sizes are those of the
    window, whole numbers of cells, so that every grid origin is tried. To box counting a single
    node is a point, of dimension 0 without error. The node stands for contact somewhere in
    a cell, and no count at this spacing can show whether that is a point, a line or the whole cell:
    a single node has no dimension.

    Parameters
    ----------
    domain : (ny, nx) bool array_like
        Nodes in contact, over the whole window.
    spacing : float
        Distance of neighbouring nodes, mm.
    fit_range, whole_cells
        As of :func:`box_dimension`; the nodes of a solution are centres of cells.
    """
    domain = np.asarray(domain, dtype=bool)
    sizes = window_sizes(domain.shape).astype(float)
    box = box_dimension(domain, spacing, fit_range=fit_range, sizes=sizes, whole_cells=whole_cells)
    return no_dimension(box.r, box.count, ONE_NODE) if np.sum(domain) == 1 else box


@dataclass(frozen=True)
class _Cover:
    """Boxes of the minimal cover at each size."""

    sizes: np.ndarray
    """Sides of the boxes (k,), cells."""
    r: np.ndarray
    """Sides of the boxes (k,), mm."""
    count: np.ndarray
    """Numbers of boxes (k,)."""
    used: np.ndarray
    """Sizes (k,) bool between the cut-offs and within the requested range."""


def _used_sizes(domain, nodes, sizes, count, limits) -> tuple[np.ndarray, str]:
    """Sizes at which the counts are not saturated, and why these are too few, or ""."""
    if nodes == 0:
        return np.ones(sizes.size, dtype=bool), "no node is in contact"
    used, alone, full = between_cut_offs(count, sizes, nodes, domain.shape)
    used &= within(sizes, *limits)
    if used.sum() < MIN_SCALES:
        return used, (
            f"{used.sum()} of {sizes.size} box sizes lie between the cut-offs, {MIN_SCALES} are "
            f"needed ({alone.sum()} with every node alone, {full.sum()} with every box occupied)"
        )
    distinct = np.unique(count[used]).size
    if nodes > 1 and distinct < MIN_SCALES:
        return used, f"{nodes} nodes give {distinct} different counts, {MIN_SCALES} are needed"
    return used, ""


# -- by the law of the mean counts -----------------------------------------------------------------


def _of_law(cover: _Cover, law: FittedLaw, spacing) -> BoxDimension:
    """The dimension by the law of the mean counts."""
    low, high = law.ends
    terms = law.terms
    return BoxDimension(
        value=law.law.dimension,
        low=low,
        high=high,
        n=law.sizes.size,
        over=(float(law.sizes[0] * spacing), float(law.sizes[-1] * spacing)),
        r=cover.r,
        count=cover.count,
        used=cover.used & within(cover.sizes, law.sizes[0], law.sizes[-1]),
        estimator="mean",
        misfit=law.law.misfit,
        terms=terms._replace(node_width=terms.node_width * spacing, extent=terms.extent * spacing),
    )


# -- by the minimal cover --------------------------------------------------------------------------


def _exact(cover: _Cover, ladder, extent) -> BoxDimension:
    """The exact power law, and an interval that spans the choice of range."""
    r, count, used = cover.r, cover.count, cover.used
    line = _line(r, count, used)
    parts = _slopes_of_parts(np.log(r[used]), np.log(count[used]))
    slopes = [line.slope.low, line.slope.high, *parts]
    line = _line(r, count, ladder)
    slopes += [line.slope.low, line.slope.high]
    dimension = _of_cover(cover, ladder, "exact", extent)
    low, high = np.clip([0.0 - max(slopes), 0.0 - min(slopes)], *IN_PLANE)
    return replace(dimension, low=float(low), high=float(high))


def _of_line(cover: _Cover, extent, side) -> BoxDimension:
    """The line through the minimal cover, with the jackknife of the mean counts at its sizes."""
    r, count, used = cover.r, cover.count, cover.used
    dimension = _of_cover(cover, used, "cover", side)
    whole = np.unique(np.round(cover.sizes[used])).astype(int)
    parts = mean_count(extent, whole, blocks=BLOCKS)
    error = block_error(parts, lambda left: count_slope(left, whole))
    line = _line(r, count, used)
    law = line.intercept.value + line.slope.value * np.log(r[used])
    half = np.hypot(error, wave_error(r[used], np.log(count[used]) - law))
    return replace(dimension, low=dimension.value - half, high=dimension.value + half)


def _of_cover(cover: _Cover, ladder, estimator, extent) -> BoxDimension:
    """The line through the minimal cover, without an interval."""
    r, count = cover.r, cover.count
    line = _line(r, count, ladder)
    slope, intercept = line.slope.value, line.intercept.value
    law = np.exp(intercept + slope * np.log(r[ladder]))
    return BoxDimension(
        value=0.0 - slope,  # a constant count gives 0, not -0
        n=line.n,
        over=(float(r[ladder].min()), float(r[ladder].max())),
        r=r,
        count=count,
        used=ladder,
        estimator=estimator,
        misfit=float(np.sqrt(np.mean((law / count[ladder] - 1) ** 2))),
        terms=LawTerms(float(np.exp(intercept + slope * np.log(extent))), 0.0, 0.0, 0.0, extent),
    )


def _line(r: np.ndarray, count: np.ndarray, used: np.ndarray) -> LineFit:
    """The line through log N against log r."""
    return fit_line(np.log(r[used]), np.log(count[used]))


def _best_scales(cover: _Cover, sides: set[int]) -> np.ndarray:
    """All usable scales, or those side / ratio^k where they, unlike all, lie exactly on a line."""
    if _is_exact(cover, cover.used):
        return cover.used
    for side, ratio in itertools.product(sorted(sides), RATIOS):
        power = np.log(side / cover.sizes) / np.log(ratio)
        ladder = cover.used & (np.abs(power - np.round(power)) < 1e-9)
        if ladder.sum() >= MIN_SCALES and _is_exact(cover, ladder):
            return ladder
    return cover.used


def _is_exact(cover: _Cover, used: np.ndarray) -> bool:
    """True if counts lie on a line but for rounding; False where they are all the same."""
    return _line(cover.sizes, cover.count, used).r2 > 1 - 1e-12


def _slopes_of_parts(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Slopes of all runs of neighbouring points that cover half of the range of x or more."""
    first, last = np.triu_indices(x.size, MIN_POINTS - 1)
    wide = x[last] - x[first] >= (x[-1] - x[0]) / 2
    place = np.arange(x.size)
    inside = (place >= first[wide, np.newaxis]) & (place <= last[wide, np.newaxis])
    dx, dy = (inside * (v - (inside @ v / inside.sum(axis=1))[:, np.newaxis]) for v in (x, y))
    return np.sum(dx * dy, axis=1) / np.sum(dx * dx, axis=1)


def no_dimension(r: np.ndarray, count: np.ndarray, reason: str) -> BoxDimension:
    """Box counts (k,) at sides r (k,) in mm without a dimension, and the reason."""
    return BoxDimension(r=r, count=count, used=np.zeros(r.size, dtype=bool), reason=reason)
