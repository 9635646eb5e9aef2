"""The upper envelope of triangles at the nodes of a grid, compiled."""

import math

import numpy as np

from roughcontact.kernel_cache import njit

#: Slack, as a fraction of the triangle, by which a node counts as inside: a node on an edge then
#: belongs to both triangles in spite of rounding.
_SLACK = 1e-9
#: Largest thickness, as a fraction of the longest side, of triangles that stand upright or have no
#: area.
_FLAT = 1e-12


@njit(cache=True)
def _nodes_between(low, high, count):
    """Nodes 0 to count - 1 that lie between two places."""
    # Cut off in floating point: a stray vertex may lie beyond all whole numbers.
    first = min(max(0.0, low - _SLACK), float(count))
    last = min(max(-1.0, high + _SLACK), count - 1.0)
    return range(math.ceil(first), math.floor(last) + 1)


@njit(cache=True)
def raise_to_triangles(
    heights: np.ndarray, u: np.ndarray, v: np.ndarray, z: np.ndarray, triangles: np.ndarray
) -> None:
    """Raise heights (rows, columns) at the nodes of a grid, in place, to the triangles above them.

    Heights are NaN where nothing is yet. Corners have a place ``u`` along columns and ``v`` along
    rows, in nodes from the first one, and a height ``z``; ``triangles`` (m, 3) are rows of these.
    """
    rows, columns = heights.shape
    for t in range(triangles.shape[0]):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        ub, vb, uc, vc = u[b] - u[a], v[b] - v[a], u[c] - u[a], v[c] - v[a]
        twice_area = ub * vc - vb * uc
        if not abs(twice_area) > _FLAT * (ub * ub + vb * vb + uc * uc + vc * vc):
            continue
        for j in _nodes_between(min(v[a], v[b], v[c]), max(v[a], v[b], v[c]), rows):
            for i in _nodes_between(min(u[a], u[b], u[c]), max(u[a], u[b], u[c]), columns):
                from_b = ((i - u[a]) * vc - (j - v[a]) * uc) / twice_area
                from_c = (ub * (j - v[a]) - vb * (i - u[a])) / twice_area
                from_a = 1.0 - from_b - from_c
                if min(from_a, from_b, from_c) >= -_SLACK:
                    height = from_a * z[a] + from_b * z[b] + from_c * z[c]
                    if not heights[j, i] >= height:  # also where it is missing
                        heights[j, i] = height
