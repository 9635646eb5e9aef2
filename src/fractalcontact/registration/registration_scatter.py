"""Motions of two registered faces that are statistically equivalent to the best one.

Blocks of the faces are drawn anew with replacement (bootstrap), and the fit is made again from
them: how far it then moves is how well the faces determine their registration.
"""

import json

import numpy as np
import xarray as xr

from .registration import PARAMETERS, biweight_limit, linearised
from .surface_motion import Motion

#: Draws, and blocks along the longer side: gaps farther apart than a block hardly depend on each
#: other, and from this number of blocks a standard deviation is known to about a sixth.
MOTIONS, BLOCKS = 20, 6
#: Fewest cells present of a block that counts.
_MIN_CELLS = 16
#: Fewest blocks to draw from.
_MIN_BLOCKS = 8


def scattered_motions(lower: xr.DataArray, upper: xr.DataArray) -> list[Motion]:
    """Further motions of the upper face that the faces do not distinguish from none.

    The faces are on one grid, from `registration.pairs.register`. There are `MOTIONS` of them,
    about the middle of the common area; none where the faces do not match, were given in one frame
    (``registration: none``), or have too few blocks.

    Each is one Gauss-Newton step from the motion found, in the sums of each draw of blocks, less
    that in the sums of all: the same draws each time (a fixed seed), so that results repeat.
    """
    record = json.loads(upper.attrs.get("registration", "{}"))
    if record.get("mode", "none") == "none" or "do not match" in record["note"]:
        return []
    gap = upper.values - lower.values
    rows, columns = np.nonzero(np.isfinite(gap))
    middle = (float(lower.x.values[columns].mean()), float(lower.y.values[rows].mean()))
    motion = Motion(middle, middle)
    usable, terms, weights = linearised(lower, gap, motion, biweight_limit(gap), record["mode"])
    normal, right = _block_sums(usable, terms, weights, gap[usable])
    if len(normal) < _MIN_BLOCKS:
        return []
    whole = _step(normal.sum(axis=0), right.sum(axis=0))
    rng = np.random.default_rng(0)
    motions = []
    for _ in range(MOTIONS):
        counts = np.bincount(rng.integers(len(normal), size=len(normal)), minlength=len(normal))
        step = _step(np.tensordot(counts, normal, 1), counts @ right) - whole
        motions.append(_about(middle, *np.pad(step, (0, len(PARAMETERS) - len(step)))))
    return motions


def _about(pivot: tuple[float, float], *changes: float) -> Motion:
    """Motion about a point, by the change of each of `PARAMETERS`."""
    x, y, rotation, *slope = map(float, changes)
    return Motion(pivot, (pivot[0] + x, pivot[1] + y), rotation, (slope[0], slope[1]))


def _block_sums(usable, terms, weights, gap) -> tuple[np.ndarray, np.ndarray]:
    """Normal matrices (block, k, k) and right-hand sides (block, k) of the blocks of cells."""
    side = -(-max(usable.shape) // BLOCKS)
    rows, columns = (cells // side for cells in np.nonzero(usable))
    block = rows * BLOCKS + columns
    normal, right = [], []
    for label in np.unique(block):
        cells = block == label
        if cells.sum() < _MIN_CELLS:
            continue
        weighted = weights[cells] * terms[:, cells]
        normal.append(np.einsum("ik,jk->ij", weighted, terms[:, cells]))
        right.append(-np.einsum("ik,k->i", weighted, gap[cells]))
    return np.array(normal), np.array(right)


def _step(normal: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solution of the normal equations, scaled; but for the height."""
    scale = np.sqrt(np.diag(normal))
    scale[scale == 0] = 1.0
    scaled = normal / np.outer(scale, scale)
    return (np.linalg.lstsq(scaled, right / scale, rcond=1e-12)[0] / scale)[:-1]


_TABLE = {
    "registration_shift_x": ("mm", "shift of the upper face towards East"),
    "registration_shift_y": ("mm", "shift of the upper face towards North"),
    "registration_rotation": ("degrees", "rotation of the upper face from East to North"),
    "registration_slope_x": ("1", "rise of the upper face towards East"),
    "registration_slope_y": ("1", "rise of the upper face towards North"),
}


def motion_variables(motions: list[Motion]) -> dict[str, tuple]:
    """Variables (registration_motion) of a specimen that hold further motions of its upper face.

    They are as ``Dataset.assign`` takes them, with the point that the face turns about as
    attributes ``pivot_x_mm`` and ``pivot_y_mm``.
    """
    values = [
        (*motion.shift, float(np.degrees(motion.rotation)), *motion.slope) for motion in motions
    ]
    columns = np.array(values).reshape(-1, len(_TABLE)).T
    pivot = motions[0].start if motions else (np.nan, np.nan)
    of = "of a registration as good as the one made, from that"
    return {
        name: (
            "registration_motion",
            column,
            {
                "units": units,
                "long_name": f"{words} {of}",
                "pivot_x_mm": pivot[0],
                "pivot_y_mm": pivot[1],
            },
        )
        for (name, (units, words)), column in zip(_TABLE.items(), columns, strict=True)
    }


def stored_motions(specimen: xr.Dataset) -> list[Motion]:
    """The motions that :func:`motion_variables` has stored in a specimen."""
    if "registration_shift_x" not in specimen:
        return []
    columns = [specimen[name].values for name in _TABLE]
    columns[2] = np.radians(columns[2])
    attrs = specimen["registration_shift_x"].attrs
    pivot = (float(attrs["pivot_x_mm"]), float(attrs["pivot_y_mm"]))
    return [_about(pivot, *changes) for changes in zip(*columns, strict=True)]
