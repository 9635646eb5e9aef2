"""Two faces of one joint brought together: the rigid motion that makes their gap most even."""

from dataclasses import replace

import numpy as np
import xarray as xr

from ..surface.cleaning import find_outliers
from .face_match import ROTATIONS, averaged, best_match, for_comparison, match
from .surface_motion import Motion, Surface, grid_nodes

#: A match found further away must be better by this much than the nearest one.
_CLEARLY_BETTER = 0.05
#: Cells along the longer side of the finest grid the motion is sought on; finer scans are averaged.
_FINEST, _COARSEST = 512, 64
_FEWEST_CELLS = 64  # common to both faces, to tell a gap's spread
_MOST_STEPS, _MOST_HALVINGS = 50, 8
_SMALL_STEP = 1e-3  # of a cell: a step that moves no cell further ends the search


def find_motion(
    lower: xr.DataArray, upper: xr.DataArray, mode: str = "rigid"
) -> tuple[Motion, dict]:
    """Find the rigid motion of the upper face that minimises the spread of the gap.

    The start is the best match over all shifts (and rotations up to 12 degrees), or no motion at
    all if that leads to as good a match. From there Gauss-Newton steps, on grids of growing
    fineness, lower the standard deviation of the gap over the cells both faces have. Outliers are
    left out.

    Parameters
    ----------
    lower, upper : DataArray (y, x)
        Heights in mm of one spacing, anywhere in the plane.
    mode : {"rigid", "translation"}
        With rotation and tilt, or without.

    Returns
    -------
    motion : Motion
        About the centroid of the cells both faces have after it. Its height is free.
    found : dict
        ``match``: correlation of the faces without their longest waves; ``converged``.
    """
    faces = [face.where(~find_outliers(face.values)) for face in (lower, upper)]
    compared = for_comparison(*faces)
    factors = _factors(faces)
    coarse = [averaged(face, factors[0]) for face in faces]
    start, _ = best_match(*compared, ROTATIONS if mode == "rigid" else (0.0,))
    motion, converged = _refine(coarse, start, mode)
    if _have_common_cells(*coarse):
        nearer = _refine(coarse, Motion(), mode)
        # What repeats itself fits in many places.
        if match(*compared, nearer[0]) > match(*compared, motion) - _CLEARLY_BETTER:
            motion, converged = nearer
    for factor in factors[1:]:
        motion, converged = _refine([averaged(face, factor) for face in faces], motion, mode)
    return motion, {"match": match(*compared, motion), "converged": converged}


def _have_common_cells(lower, upper) -> bool:
    both = np.isfinite(lower.values) & np.isfinite(Surface(upper)(*grid_nodes(lower)))
    return both.sum() >= _FEWEST_CELLS


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
    """Lower the spread of the gap by damped Gauss-Newton steps; whether the last one was small."""
    lower, upper = faces
    x, y = grid_nodes(lower)
    surface = Surface(upper)
    small = _SMALL_STEP * min(lower.attrs["spacing_x"], lower.attrs["spacing_y"])
    gap, spread = _gap(lower, surface, motion, x, y)
    if not np.isfinite(spread):  # no shift brings enough cells together: there is no start
        return motion, False
    enough = np.isfinite(gap).sum() / 2  # nor may a better gap be bought by parting the faces
    for _ in range(_MOST_STEPS):
        both = np.isfinite(gap)
        # About the centroid shift and rotation hardly interact.
        motion = motion.about(x[both].mean(), y[both].mean())
        step = _gauss_newton_step(lower, gap, motion, x, y, mode)
        size = np.hypot(*step[:2]) + abs(step[2]) * np.hypot(np.ptp(x[both]), np.ptp(y[both])) / 2
        for halving in range(_MOST_HALVINGS):
            tried = _stepped(motion, step / 2**halving)
            new_gap, new_spread = _gap(lower, surface, tried, x, y)
            if new_spread < spread and np.isfinite(new_gap).sum() >= enough:
                break
        else:
            return motion, True  # no step in the direction of descent lowers it: the minimum
        motion, gap, spread = tried, new_gap, new_spread
        if size <= small:
            return motion, True
    return motion, False


def _gap(lower, surface, motion, x, y):
    gap = surface(*motion.back(x, y)) + motion.rise(x, y) - lower.values
    both = np.isfinite(gap)
    return gap, float(gap[both].std()) if both.any() else np.inf


def _gauss_newton_step(lower, gap, motion, x, y, mode) -> np.ndarray:
    """Change of (end x, end y, rotation, slope x, slope y) that levels the gap to first order."""
    spacing = lower.attrs["spacing_y"], lower.attrs["spacing_x"]
    # The mean of both faces' gradients: that of the upper one is its gap's plus the lower one's.
    slope_y, slope_x = np.gradient(lower.values + gap / 2, *spacing)
    dx, dy = x - motion.end[0], y - motion.end[1]
    columns = [-slope_x, -slope_y, slope_x * dy - slope_y * dx, dx, dy]
    if mode == "translation":
        columns = columns[:2]
    usable = np.isfinite(gap) & np.isfinite(slope_x) & np.isfinite(slope_y)
    terms = np.array([c[usable] for c in [*columns, np.ones_like(x)]])
    scale = np.sqrt(np.mean(terms**2, axis=1))
    scale[scale == 0] = 1.0
    terms /= scale[:, np.newaxis]
    # Sums, not a matrix product: the last bit must not depend on the number of cores.
    normal = np.einsum("ik,jk->ij", terms, terms)
    right = -np.einsum("ik,k->i", terms, gap[usable])
    solution = np.linalg.lstsq(normal, right, rcond=1e-12)[0] / scale
    return np.pad(solution[:-1], (0, 5 - len(columns)))


def _stepped(motion: Motion, step: np.ndarray) -> Motion:
    return replace(
        motion,
        end=(motion.end[0] + float(step[0]), motion.end[1] + float(step[1])),
        rotation=motion.rotation + float(step[2]),
        slope=(motion.slope[0] + float(step[3]), motion.slope[1] + float(step[4])),
    )
