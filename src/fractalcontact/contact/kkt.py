"""The contact problem and its conditions: which a pressure satisfies, and by how much it fails."""

from dataclasses import dataclass

import numpy as np

from ..core.kernel_cache import njit


@dataclass
class Problem:
    """What is pressed, in units in which loads are near one.

    Attributes
    ----------
    space : HalfSpace
    clearance : (n,) ndarray
        c at every node, flattened.
    load : float
        The closure, or the sum of the pressures.
    by_force : bool
        Which of the two.
    cap : float
        Largest pressure, or infinity.
    """

    space: object
    clearance: np.ndarray
    load: float
    by_force: bool
    cap: float = np.inf

    def first_touch(self):
        """The given force on the nodes that touch first, where nothing better is known.

        Forces so small that the depths of all other nodes drown theirs leave no other start.
        """
        touching = self.clearance == 0
        return touching * (self.load / np.count_nonzero(touching))


@dataclass(frozen=True)
class Examined:
    """What the contact conditions say of a pressure.

    Attributes
    ----------
    free : (n,) int32 ndarray
        Nodes on which the gap is to vanish.
    beyond : (m,) int32 ndarray
        Nodes whose pressure is beyond a bound.
    worst : float
        Largest violation: of a gap condition, or of a bound (as a node's pressure displaces it by
        about itself in these units).
    """

    free: np.ndarray
    beyond: np.ndarray
    worst: float


def examined_by(pressure, displacement, clearance, closure, cap):
    """What the contact conditions say.

    Parameters
    ----------
    pressure, displacement, clearance : (n,) ndarray
        p, K p and c at every node.
    closure : float
    cap : float
        Largest pressure, or infinity.

    Returns
    -------
    Examined

    Raises
    ------
    ValueError
        If these are not of one size.
    """
    if not pressure.shape == displacement.shape == clearance.shape:
        raise ValueError("expected pressure, displacement and clearance of one size")
    return Examined(*_examine(pressure, displacement, clearance, closure, cap))


def between_bounds(pressure, cap):
    """Nodes whose pressure is neither zero nor at the cap, (n,) int32: those that keep gap 0."""
    return np.flatnonzero((pressure > 0) & (pressure < cap)).astype(np.int32)


@njit(cache=True)
def mean_reached(pressure, displacement, clearance, cap):
    """Mean displacement and clearance of the nodes between the bounds; NaN without any."""
    if pressure.size != displacement.size or pressure.size != clearance.size:
        raise ValueError("expected pressure, displacement and clearance of one size")
    total, n = 0.0, 0
    for i in range(pressure.size):
        if 0 < pressure[i] < cap:
            total += displacement[i] + clearance[i]
            n += 1
    return total / n if n else np.nan


@njit(cache=True)
def _examine(pressure, displacement, clearance, closure, cap):
    """The parts of :class:`Examined`."""
    free = np.empty(pressure.size, np.int32)
    beyond = np.empty(pressure.size, np.int32)
    n, m, worst = 0, 0, 0.0
    for i in range(pressure.size):
        p = pressure[i]
        if p < 0 or p > cap:
            beyond[m] = i
            m += 1
            worst = max(worst, -p if p < 0 else p - cap)
            continue
        gap = displacement[i] + clearance[i] - closure
        if p == 0:
            off = -gap
        elif p == cap:
            off = gap
        else:
            off = abs(gap)
        if off > 0 or (p > 0 and p < cap):
            free[n] = i
            n += 1
            worst = max(worst, off)
    return free[:n].copy(), beyond[:m].copy(), worst
