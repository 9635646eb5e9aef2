"""Two faces of one joint brought together: the rigid motion that makes their gap most even.

Most cells alone count: spikes, and places where one face has lost rock, do not keep the other cells
apart.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr

from ..surface.cleaning import find_outliers
from .face_match import ROTATIONS, averaged, best_match, for_comparison, match
from .surface_motion import Motion, Surface, grid_nodes

#: Least gain of a match farther away over the nearest one.
_CLEARLY_BETTER = 0.05
#: Cells along the longer side of the finest grid the motion is sought on; finer scans are averaged.
_FINEST, _COARSEST = 512, 64
_MIN_CELLS = 64  # common to both faces, to know a gap's spread
_MAX_STEPS, _MAX_HALVINGS = 50, 8
_SMALL_STEP = 1e-3  # of a cell: a step that moves no cell further ends the search
#: Distance of a gap from the centre of all gaps, in robust standard deviations, beyond which its
#: cell does not count. The biweight with it is 95 % as efficient as least squares where errors are
#: Gaussian (Beaton and Tukey, Technometrics 16 (1974) 147).
_BIWEIGHT = 4.685
_NORMAL = 1.4826  # standard deviation of a normal distribution / its median absolute deviation
#: Relative change of the limit at which it no longer follows the gap, and most times that it does.
_SAME_LIMIT, _MAX_LIMITS = 0.02, 4
_ROUNDING = 1e-9  # relative: gaps that differ by less are one


def find_motion(
    lower: xr.DataArray, upper: xr.DataArray, mode: str = "rigid"
) -> tuple[Motion, dict]:
    """Motion of the upper face that minimises the robust spread of the gap, and its record.

    The start is the best match over all shifts (and rotations up to 12 degrees), or no motion at
    all if that leads to as good a match. From there Gauss-Newton steps, on grids of growing
    fineness, lower the biweight spread of the gap over the cells both faces have. Outliers are left
    out.

    Heights are in mm, of one spacing, anywhere in the plane. ``mode`` is "rigid", with rotation and
    tilt, or "translation". The motion is about the centroid of the cells both faces have after it,
    and its height is free. The record has ``match``, the correlation of the faces without their
    longest waves, and ``converged``.
    """
    faces = [face.where(~find_outliers(face.values)) for face in (lower, upper)]
    compared = for_comparison(*faces)
    factors = _factors(faces)
    coarse = [averaged(face, factors[0]) for face in faces]
    start, _ = best_match(*compared, ROTATIONS if mode == "rigid" else (0.0,))
    motion, converged = _refine(coarse, start, mode)
    if _have_common_cells(*coarse):
        nearer = _refine(coarse, Motion(), mode)
        # A periodic surface fits in many places.
        if match(*compared, nearer[0]) > match(*compared, motion) - _CLEARLY_BETTER:
            motion, converged = nearer
    for factor in factors[1:]:
        motion, converged = _refine([averaged(face, factor) for face in faces], motion, mode)
    return motion, {"match": match(*compared, motion), "converged": converged}


def _have_common_cells(lower, upper) -> bool:
    both = np.isfinite(lower.values) & np.isfinite(Surface(upper)(*grid_nodes(lower)))
    return both.sum() >= _MIN_CELLS


def _factors(faces) -> list[int]:
    """Cells to average over, from coarse to fine."""
    longest = max(max(face.shape) for face in faces)
    shortest = min(min(face.shape) for face in faces)
    finest = -(-longest // _FINEST)
    coarsest = max(finest, min(longest // _COARSEST, shortest // 16))
    factors = [coarsest]
    while factors[-1] > finest:
        factors.append(max(finest, factors[-1] // 2))
    return factors


def _refine(faces: list[xr.DataArray], motion: Motion, mode: str) -> tuple[Motion, bool]:
    """Lower the spread of the gap, its limit following; whether the last search came to rest."""
    lower, upper = faces
    problem = _Problem(lower, Surface(upper), *grid_nodes(lower), mode)
    limit, converged = np.nan, False
    for _ in range(_MAX_LIMITS):
        gap = problem.gap(motion)
        new_limit = biweight_limit(gap)
        if new_limit == limit or abs(new_limit - limit) <= _SAME_LIMIT * new_limit < np.inf:
            break
        limit = new_limit
        motion, converged = _descend(problem, motion, limit)
    return motion, converged


class _Problem(NamedTuple):
    """Residuals and weights that a search for a motion uses."""

    lower: xr.DataArray
    surface: Surface
    x: np.ndarray
    y: np.ndarray
    mode: str

    def gap(self, motion: Motion) -> np.ndarray:
        """Gap (ny, nx) after a motion; NaN where either face is missing."""
        upper = self.surface(*motion.back(self.x, self.y)) + motion.rise(self.x, self.y)
        return upper - self.lower.values


def _descend(problem: _Problem, motion: Motion, limit: float) -> tuple[Motion, bool]:
    """Damped Gauss-Newton steps at one limit; whether the last one was small."""
    lower, x, y = problem.lower, problem.x, problem.y
    small = _SMALL_STEP * min(lower.attrs["spacing_x"], lower.attrs["spacing_y"])
    gap = problem.gap(motion)
    spread = biweight_spread(gap, limit)
    if not np.isfinite(spread):  # no shift brings enough cells together: there is no start
        return motion, False
    enough = np.isfinite(gap).sum() / 2  # no step may lower the gap by parting the faces
    for _ in range(_MAX_STEPS):
        both = np.isfinite(gap)
        # Shift and rotation about the centroid hardly interact.
        motion = motion.about(x[both].mean(), y[both].mean())
        step = _gauss_newton_step(lower, gap, motion, limit, problem.mode)
        size = np.hypot(*step[:2]) + abs(step[2]) * np.hypot(np.ptp(x[both]), np.ptp(y[both])) / 2
        for halving in range(_MAX_HALVINGS):
            tried = _stepped(motion, step / 2**halving)
            new_gap = problem.gap(tried)
            new_spread = biweight_spread(new_gap, limit)
            if new_spread < spread and np.isfinite(new_gap).sum() >= enough:
                break
        else:
            return motion, True  # no step of descent lowers the spread
        motion, gap, spread = tried, new_gap, new_spread
        if size <= small:
            return motion, True
    return motion, False


def biweight_limit(gap: np.ndarray) -> float:
    """Distance from the gap of most cells at which a cell does not count any more, mm.

    Infinite where most cells have one gap, or none is known.
    """
    gaps = gap[np.isfinite(gap)]
    if not gaps.size:
        return np.inf
    scale = _NORMAL * float(np.median(abs(gaps - np.median(gaps))))
    return _BIWEIGHT * scale if scale > _ROUNDING * np.abs(gaps).max() else np.inf


def biweight_spread(gap: np.ndarray, limit: float) -> float:
    """Spread of the gap, mm: the standard deviation where all cells lie well within the limit.

    It is the root of twice the mean biweight loss, limit^2/6 (1 - (1 - (r/limit)^2)^3) with r the
    distance from the biweight mean and the limit of :func:`biweight_limit`; infinite without any
    cell.
    """
    gaps = gap[np.isfinite(gap)]
    if not gaps.size:
        return np.inf
    if np.isinf(limit):
        return float(gaps.std())
    part = np.minimum(((gaps - _centre(gaps, limit)) / limit) ** 2, 1.0)
    return float(np.sqrt(limit**2 / 3 * np.mean(1 - (1 - part) ** 3)))


def _centre(gaps: np.ndarray, limit: float) -> float:
    """Biweight mean, by a few steps from the median."""
    centre = float(np.median(gaps))
    for _ in range(3):
        weights = _biweights(gaps - centre, limit)
        total = np.sum(weights)
        if not total > 0:  # all lie far from their median
            break
        centre = float(np.sum(weights * gaps) / total)
    return centre


def _biweights(distance: np.ndarray, limit: float) -> np.ndarray:
    if np.isinf(limit):
        return np.ones_like(distance)
    return np.maximum(1 - (distance / limit) ** 2, 0.0) ** 2


def _gauss_newton_step(lower, gap, motion, limit, mode) -> np.ndarray:
    """Change of (end x, end y, rotation, slope x, slope y) that levels the gap to first order."""
    usable, terms, weights = linearised(lower, gap, motion, limit, mode)
    scale = np.sqrt(np.mean(terms**2, axis=1))
    scale[scale == 0] = 1.0
    terms /= scale[:, np.newaxis]
    # Sums, not a matrix product: the last bit must not depend on the number of cores.
    weighted = weights * terms
    normal = np.einsum("ik,jk->ij", weighted, terms)
    right = -np.einsum("ik,k->i", weighted, gap[usable])
    solution = np.linalg.lstsq(normal, right, rcond=1e-12)[0] / scale
    return np.pad(solution[:-1], (0, len(PARAMETERS) + 1 - len(solution)))


#: Parameters that a motion changes; of "translation" the first two.
PARAMETERS = ("end_x", "end_y", "rotation", "slope_x", "slope_y")


def linearised(
    lower: xr.DataArray, gap: np.ndarray, motion: Motion, limit: float, mode: str
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """First-order change of the gap (ny, nx) with the motion, and the weight of each cell.

    Returned are the mask (ny, nx) of the n cells with a gap and a slope; the derivatives (k + 1, n)
    by each of the k :data:`PARAMETERS` that are free, and 1, of the height; and weights (n,) from 0
    to 1.
    """
    spacing = lower.attrs["spacing_y"], lower.attrs["spacing_x"]
    x, y = grid_nodes(lower)
    # Mean gradient of both faces; the upper one has that of the lower one plus that of the gap.
    slope_y, slope_x = np.gradient(lower.values + gap / 2, *spacing)
    dx, dy = x - motion.end[0], y - motion.end[1]
    columns = [-slope_x, -slope_y, slope_x * dy - slope_y * dx, dx, dy]
    if mode == "translation":
        columns = columns[:2]
    usable = np.isfinite(gap) & np.isfinite(slope_x) & np.isfinite(slope_y)
    terms = np.array([np.asarray(c)[usable] for c in (*columns, np.ones_like(x))])
    gaps = gap[usable]
    weights = _biweights(gaps - _centre(gaps, limit), limit)
    return usable, terms, weights


def _stepped(motion: Motion, step: np.ndarray) -> Motion:
    return replace(
        motion,
        end=(motion.end[0] + float(step[0]), motion.end[1] + float(step[1])),
        rotation=motion.rotation + float(step[2]),
        slope=(motion.slope[0] + float(step[3]), motion.slope[1] + float(step[4])),
    )
