"""Apparent dips of the contact along the sliding, and their distribution over the force."""

import warnings

import numpy as np
import xarray as xr

from ..core.window import faces, window_slices
from .joint import DIRECTION_STEPS, direction_spacing, sliding_axis

#: Number of equal parts of the force; every state keeps the mean apparent dip of each part.
PARTS = 100
#: Steps in spacings over which slopes are taken; the second serves for the error of the grid.
STEPS = (1, 2)


def contact_dips(
    specimen: xr.Dataset, direction: str, cells: int, factor: int, step: int = 1
) -> np.ndarray:
    """Apparent dip of the contact along the sliding at each node (ny, nx), if it touches.

    Degrees, above 0 where the upper block has to climb; NaN where no slope is known. The offset is
    in cells of the scan; slopes are taken over ``step`` spacings of the resolution k, ``factor``.

    Where faces meet at a node, the plane between them is no steeper than the slopes of both on
    either side allow: it lies between the middle two of these four, and their mean is taken. So a
    tip on a flank has the dip of the flank, and exchanging the faces changes nothing.
    """
    axis, sign = sliding_axis(direction), sum(DIRECTION_STEPS[direction])
    distance = factor * step
    spacing = distance * direction_spacing(specimen, direction)
    slopes = []
    for heights, slid in zip(faces(specimen), (cells * sign, 0), strict=True):
        window = list(window_slices(specimen))
        window[axis] = slice(window[axis].start + slid, window[axis].stop + slid)
        across = np.moveaxis(heights, axis, 0)
        along, other = window[axis], window[1 - axis]
        nodes = np.arange(along.start, along.stop, factor)
        across = across[:, other.start : other.stop : factor]
        for way in (distance, -distance):
            rows, height = nodes + way, across[nodes]
            inside = (rows >= 0) & (rows < len(across))
            neighbour = np.full(height.shape, np.nan)
            neighbour[inside] = across[rows[inside]]
            slopes.append(np.moveaxis((neighbour - height) / np.copysign(spacing, way), 0, axis))
    return np.degrees(np.arctan(sign * _nanmedian(np.array(slopes))))


def _nanmedian(values: np.ndarray) -> np.ndarray:
    """Median over the first axis of four values, of those that are finite."""
    a, b, c, d = values
    middle = np.maximum(np.minimum(a, b), np.minimum(c, d))
    middle = (middle + np.minimum(np.maximum(a, b), np.maximum(c, d))) / 2
    missing = ~np.isfinite(middle)  # nodes beside a rim
    with warnings.catch_warnings(action="ignore"):  # nodes without any slope
        middle[missing] = np.nanmedian(values[:, missing], axis=0)
    return middle


def dips_by_force(pressure: np.ndarray, dips: np.ndarray) -> np.ndarray:
    """Mean apparent dip of each of :data:`PARTS` equal parts of the force, ascending, degrees.

    ``dips`` (ny, nx) are those of :func:`contact_dips`; nodes without one are left out. NaN where
    nothing presses.
    """
    pressing = (pressure > 0) & np.isfinite(dips)
    if not pressing.any():
        return np.full(PARTS, np.nan)
    order = np.argsort(dips[pressing], kind="stable")
    weight, dip = pressure[pressing][order], dips[pressing][order]
    carried = np.concatenate([[0.0], np.cumsum(weight)])
    integral = np.concatenate([[0.0], np.cumsum(weight * dip)])
    ends = np.linspace(0, carried[-1], PARTS + 1)
    return np.diff(np.interp(ends, carried, integral)) / (carried[-1] / PARTS)
