"""Contact as a dense quadratic programme between bounds: a judge that shares only the influence."""

import numpy as np

from roughcontact.elastic.influence import love_displacement


def dense_operator(space):
    """Displacement of every node per pressure on every node, mm/MPa."""
    (ny, nx), (dy, dx) = space.shape, space.spacing
    y, x = (axis.ravel() for axis in np.mgrid[:ny, :nx])
    apart = (x[:, None] - x) * dx, (y[:, None] - y) * dy
    return love_displacement(*apart, dx, dy) / space.modulus


def dense_pressure(matrix, clearance, closure, cap):
    """Least p.K p / 2 + p.(c - w) over 0 <= p <= H, H one or each node's, by principal pivoting.

    Each node is at zero, between the bounds or at the cap, and all that are wrong change at once;
    where that makes no progress, only the last of them does, which cannot cycle (J. J. Judice and
    F. M. Pires, Comput. Oper. Res. 21 (1994) 587; K. G. Murty, Opsearch 11 (1974) 9).
    """
    aim = (closure - clearance) / matrix[0, 0]
    matrix = matrix * (np.broadcast_to(cap, aim.shape) / matrix[0, 0])
    least = matrix.diagonal().max()
    at_cap, free = np.zeros((2, aim.size), bool)
    fewest, patience = aim.size + 1, 3
    while True:
        p = at_cap.astype(float)
        right_side = aim[free] - matrix[np.ix_(free, at_cap)].sum(axis=1)
        p[free] = np.linalg.solve(matrix[np.ix_(free, free)], right_side)
        gap = matrix @ p - aim
        rounding = 1e-13 * max(np.abs(aim).max(), least)
        leaves_down, leaves_up = free & (p < 0), free & (p > 1)
        enters = np.where(at_cap, gap > rounding, gap < -rounding) & ~free
        wrong = leaves_down | leaves_up | enters
        if not wrong.any():
            return cap * p
        if np.count_nonzero(wrong) < fewest:
            fewest, patience = np.count_nonzero(wrong), 3
        elif patience:
            patience -= 1
        else:
            wrong &= np.arange(wrong.size) == np.flatnonzero(wrong)[-1]
        at_cap = (at_cap & ~wrong) | (leaves_up & wrong)
        free ^= wrong
