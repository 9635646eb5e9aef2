"""The contact problem and its complementarity (KKT) conditions: how far a pressure is from them.

With the gap g = K p + c - w at the nodes (c the clearance at first touch, w the closure, H a cap on
the pressure) a state of contact has 0 <= p <= H, and g = 0 where p lies between, g >= 0 where it is
0, g <= 0 where it is H. These are the Karush-Kuhn-Tucker conditions of a strictly convex quadratic
programme between bounds: minimise p.K p / 2 + p.(c - w) over 0 <= p <= H. Where the force is given,
w is the Lagrange multiplier of the sum of p.
"""

from dataclasses import dataclass

import numpy as np

from ..elastic.halfspace import HalfSpace
from ..kernel_cache import njit

# A total this close to F is F.
FORCE_ROUNDING = 1e-12


@dataclass
class Problem:
    """A contact problem in units in which the closure, or under a force the mean pressure, is one.

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
    nodes : (n,) int32 ndarray or None
        Numbers of the cells that may touch, ascending, where the problem is restricted to these:
        whatever is on nodes is then on them alone. None where it is on the whole window.
    """

    space: HalfSpace
    clearance: np.ndarray
    load: float
    by_force: bool
    cap: float = np.inf
    nodes: np.ndarray | None = None

    def coarser(self, clearance: np.ndarray) -> "Problem":
        """A problem on the grid twice as coarse, on the whole window.

        Parameters
        ----------
        clearance : (m,) ndarray
            c at every node of that grid.
        """
        load, cap = coarser_load(self.load, self.by_force, self.cap)
        return Problem(self.space.coarser(2), clearance, load, self.by_force, cap)

    def first_touch(self) -> np.ndarray:
        """The given force on the nodes that touch first, as far as the cap lets them carry it.

        Where nothing better is known: forces so small that the depths of all other nodes drown
        theirs leave no other start.
        """
        touching = self.clearance == 0
        return touching * min(self.load / np.count_nonzero(touching), self.cap)

    def closure_at_force(self, pressure: np.ndarray, displacement: np.ndarray) -> float:
        """The closure at which a given force acts: it makes the mean gap in contact vanish.

        Where all that touches is at the cap, the conditions hold for any closure that overlaps all
        of it and nothing else. It is the least of these; where there is none, the mean still leads
        on.
        """
        mean = mean_closure(pressure, displacement, self.clearance, self.cap)
        if np.isfinite(mean):
            return mean
        reached, capped = displacement + self.clearance, pressure > 0
        least = reached[capped].max()
        if least <= reached[~capped].min(initial=np.inf):
            return least
        return reached[capped].mean()


def coarser_load(load: float, by_force: bool, cap: float) -> tuple[float, float]:
    """Load and cap of a problem, on the grid twice as coarse.

    In units of the fine grid the same pressure displaces cells twice as wide twice as much: its
    number is doubled there. The sum of the pressures is over a fourth of the cells, and so halved.

    Parameters
    ----------
    load, by_force, cap
        As of `Problem`.

    Returns
    -------
    load, cap : float
    """
    return load / 2 if by_force else load, 2 * cap


@dataclass
class Iterate:
    """A pressure, its displacement and a closure.

    Attributes
    ----------
    pressure, displacement : (n,) ndarray
        p and K p.
    closure : float
    """

    pressure: np.ndarray
    displacement: np.ndarray
    closure: float


@dataclass
class Solution(Iterate):
    """An iterate within its bounds, whose displacement was computed for itself.

    In double precision, but for solutions on coarser grids that only a start is made of.

    Attributes
    ----------
    residual : float
        Largest violation of the contact conditions, as a fraction of the closure; or, of a given
        force, as a fraction of it.
    applications : int
        Applications of K, in either precision.
    """

    residual: float
    applications: int


@dataclass(frozen=True)
class KKTResidual:
    """By how much, and where, the contact conditions are violated.

    Attributes
    ----------
    active : (n,) int32 ndarray
        The active contact set: nodes on which the gap is to vanish. Those between the bounds, and
        those at a bound that the gap pulls off it.
    infeasible : (m,) int32 ndarray
        Nodes whose pressure is beyond a bound.
    largest : float
        Largest violation: of a gap condition, or of a bound (as a node's pressure displaces it by
        about itself in these units). Not yet a fraction of the closure.
    """

    active: np.ndarray
    infeasible: np.ndarray
    largest: float

    def holds_to(self, tolerance: float, closure: float) -> bool:
        """Whether no violation exceeds a fraction of the closure."""
        return self.largest <= tolerance * abs(closure)


def kkt_residual(
    pressure: np.ndarray,
    displacement: np.ndarray,
    clearance: np.ndarray,
    closure: float,
    cap: float,
) -> KKTResidual:
    """Residual of the contact conditions.

    Parameters
    ----------
    pressure, displacement, clearance : (n,) ndarray
        p, K p and c at every node.
    closure : float
    cap : float
        Largest pressure, or infinity.

    Returns
    -------
    KKTResidual

    Raises
    ------
    ValueError
        If these are not of one size.
    """
    if not pressure.shape == displacement.shape == clearance.shape:
        raise ValueError("expected pressure, displacement and clearance of one size")
    return KKTResidual(*_kkt_residual(pressure, displacement, clearance, closure, cap))


def frank_wolfe_gap(pressure: np.ndarray, gap: np.ndarray, cap: float) -> float:
    """Bound on how far the energy of a pressure is above the least of the same force.

    Parameters
    ----------
    pressure, gap : (n,) ndarray
        Between the bounds; and K p + c, less any constant. Nodes that are further apart than all
        that carry pressure may be left out.
    cap : float
        Largest pressure, or infinity.

    Returns
    -------
    float
        In the unit of their product.

    Notes
    -----
    E(p) = p.K p / 2 + p.c is convex with gradient v = K p + c. So for the pressure p* of least
    energy among those of the same sum F and the same bounds, E(p) - E(p*) <= v.(p - p*) <= G,
    the largest v.(p - q) over all such q: the Frank-Wolfe gap (M. Frank and P. Wolfe, Naval
    Res. Logist. Quart. 3 (1956) 95; M. Jaggi, Proc. 30th Int. Conf. Mach. Learn. (2013) 427).
    Without a cap the best q puts F on the node of least v, and G = sum p_i (v_i - min v); with
    a cap H it puts H on each of the F / H nodes of least v. A constant in v, such as the
    closure, changes nothing.
    """
    loaded = pressure > 0
    if not loaded.any():
        return 0.0
    within = gap[gap <= gap[loaded].max()]
    excess = within - within.min()
    total = pressure[loaded] @ (gap[loaded] - within.min())
    if np.isfinite(cap):
        whole, rest = divmod(pressure[loaded].sum() / cap, 1.0)
        most = min(int(whole), excess.size - 1)
        excess = np.partition(excess, most)
        total -= cap * (excess[:most].sum() + rest * excess[most])
    return max(float(total), 0.0)


def nodes_between_bounds(pressure: np.ndarray, cap: float) -> np.ndarray:
    """Nodes at which neither bound is active, (n,) int32: those whose gap stays 0."""
    return np.flatnonzero((pressure > 0) & (pressure < cap)).astype(np.int32)


@njit(cache=True)
def mean_closure(
    pressure: np.ndarray, displacement: np.ndarray, clearance: np.ndarray, cap: float
) -> float:
    """Closure at which the mean gap of the nodes between the bounds vanishes; NaN without any."""
    if pressure.size != displacement.size or pressure.size != clearance.size:
        raise ValueError("expected pressure, displacement and clearance of one size")
    total, n = 0.0, 0
    for i in range(pressure.size):
        if 0 < pressure[i] < cap:
            total += displacement[i] + clearance[i]
            n += 1
    return total / n if n else np.nan


@njit(cache=True)
def _kkt_residual(pressure, displacement, clearance, closure, cap):
    """The parts of :class:`KKTResidual`."""
    active = np.empty(pressure.size, np.int32)
    infeasible = np.empty(pressure.size, np.int32)
    n, m, largest = 0, 0, 0.0
    for i in range(pressure.size):
        p = pressure[i]
        if p < 0 or p > cap:
            infeasible[m] = i
            m += 1
            largest = max(largest, -p if p < 0 else p - cap)
            continue
        gap = displacement[i] + clearance[i] - closure
        if p == 0:
            violation = -gap
        elif p == cap:
            violation = gap
        else:
            violation = abs(gap)
        if violation > 0 or (p > 0 and p < cap):
            active[n] = i
            n += 1
            largest = max(largest, violation)
    return active[:n].copy(), infeasible[:m].copy(), largest
