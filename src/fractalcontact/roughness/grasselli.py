"""Grasselli's directional roughness of a face: its area by apparent dip.

The part of the area that faces the sliding with an apparent dip of theta* or more follows
A = A_0 (1 - theta*/theta*_max)^C (Grasselli, Wirth & Egger, Int. J. Rock Mech. Min. Sci. 39 (2002)
789); theta*_max / (C + 1) is its measure of roughness (Tatone & Grasselli, Rev. Sci. Instrum. 80
(2009) 125110).
"""

from typing import NamedTuple

import numpy as np

from ..core.directions import axis_and_sign

#: Bins of the apparent dip, degrees, over which the law is fitted.
_BIN = 2.0
#: Fewest triangles facing the sliding that give a law.
_MIN_TRIANGLES = 200


class Grasselli(NamedTuple):
    """theta*_max in degrees, C, A_0, and theta*_max / (C + 1) in degrees; NaN without a law."""

    theta_max: float = np.nan
    c: float = np.nan
    a_0: float = np.nan
    roughness: float = np.nan


def grasselli(heights: np.ndarray, spacing: tuple[float, float], direction: str) -> Grasselli:
    """Grasselli's parameters of a face (ny, nx), mm, for sliding of the upper block in a direction.

    The face is without its mean plane, NaN where missing, the spacing that of y and x, mm. Slopes
    that rise in the direction "E", "N", "W" or "S" face the sliding.

    Two triangles a cell, of both diagonals half a weight each, so that no diagonal is preferred.
    Areas are those of the triangles themselves. C is fitted by least squares to the cumulative area
    over bins of 2 degrees, as the authors' program does.
    """
    dips, areas = (np.concatenate(halves) for halves in _triangles(heights, spacing, direction))
    facing = dips >= 0
    total = areas.sum()
    if np.count_nonzero(dips > 0) < _MIN_TRIANGLES:
        return Grasselli()
    dip, area = dips[facing], areas[facing]
    theta_max, a_0 = float(dip.max()), float(area.sum() / total)
    edges = np.append(np.arange(0.0, theta_max, _BIN), theta_max)
    order = np.argsort(dip)
    above = np.append(np.cumsum(area[order][::-1])[::-1], 0.0) / area.sum()
    share = above[np.searchsorted(dip[order], edges)]
    c = _exponent(1 - edges / theta_max, share)
    return Grasselli(theta_max, c, a_0, theta_max / (c + 1))


def _triangles(heights, spacing, direction):
    """Apparent dips, degrees, and areas of the triangles of all cells, for both diagonals."""
    dy, dx = spacing
    axis, sign = axis_and_sign(direction)
    a, b, c, d = heights[:-1, :-1], heights[:-1, 1:], heights[1:, :-1], heights[1:, 1:]
    dips, areas = [], []
    # Rises along x and y of the two halves of a cell, for both diagonals.
    for rise_x, rise_y in ((b - a, d - b), (d - c, c - a), (b - a, c - a), (d - c, d - b)):
        slope_x, slope_y = rise_x / dx, rise_y / dy
        measured = np.isfinite(slope_x + slope_y)
        along = sign * (slope_x if axis == "x" else slope_y)
        dips.append(np.degrees(np.arctan(along[measured])))
        areas.append(np.sqrt(1 + slope_x**2 + slope_y**2)[measured])
    return dips, areas


def _exponent(x: np.ndarray, y: np.ndarray) -> float:
    """Exponent of y = x^C by least squares."""
    from scipy import optimize

    inner = (x > 0) & (x < 1)

    def misfit(log_c: float) -> float:
        return float(np.sum((x[inner] ** np.exp(log_c) - y[inner]) ** 2))

    if not inner.any():
        return np.nan
    return float(np.exp(optimize.minimize_scalar(misfit, bounds=(-5, 5), method="bounded").x))
