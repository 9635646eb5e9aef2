"""Contact problem, its complementarity (KKT) conditions, and the residual of a pressure.

With the gap g = K p + c - w at the nodes (c the clearance at first touch, w the closure, H a bound
on the pressure) a state of contact has 0 <= p <= H, and g = 0 where p lies between, g >= 0 where
it is 0, g <= 0 where it is H. These are the Karush-Kuhn-Tucker conditions of a strictly convex
quadratic programme between bounds: minimise p.K p / 2 + p.(c - w) over 0 <= p <= H. If the force is
given, w is the Lagrange multiplier of the sum of p.
"""

from dataclasses import dataclass

import numpy as np

from ..elastic.halfspace import HalfSpace
from ..kernel_cache import njit
from .bounds import Bounds

# Relative rounding of the force.
FORCE_ROUNDING = 1e-12
# Bounds of an elastic surface.
ELASTIC = Bounds()


@dataclass
class Problem:
    """Contact problem; the unit is the closure, or the mean pressure under a given force.

    Attributes
    ----------
    space : HalfSpace
    clearance : (n,) ndarray
        c at every node, flattened.
    load : float
        The closure, or if ``by_force`` the sum of the pressures.
    by_force : bool
    bounds : Bounds
        Bounds of the pressure.
    nodes : (n,) int32 ndarray or None
        Ascending numbers of the cells that may touch, if the problem is restricted to them: all
        arrays are then on these nodes alone. None on the whole window.
    """

    space: HalfSpace
    clearance: np.ndarray
    load: float
    by_force: bool
    bounds: Bounds = ELASTIC
    nodes: np.ndarray | None = None

    @property
    def largest_closure(self) -> float:
        """Closure in full contact of an elastic window without free edges; else infinity.

        No force brings its mean plane nearer.
        """
        bounded = self.bounds.elastic and not self.space.is_free
        return float(self.clearance.mean()) if bounded else np.inf

    def tolerated(self, iterate: "Iterate") -> float:
        """Unit of violations: the closure.

        In full contact of a window that continues beyond its edges the closure may be 0 under any
        pressure, as between two planes. The displacement of one cell under the mean pressure is
        added.
        """
        closure = abs(iterate.closure)
        return closure if self.space.is_free else closure + abs(float(iterate.pressure.mean()))

    def coarser(self, clearance: np.ndarray) -> "Problem":
        """Problem on the whole grid twice as coarse, with its ``clearance`` (m,)."""
        load = coarser_load(self.load, self.by_force)
        if not (self.by_force or self.space.is_free) and self.clearance.any():
            # The mean plane of the highest of each four nodes is nearer: it may not close so far.
            load *= float(clearance.mean() / self.clearance.mean())
        bounds = self.bounds.coarser(self.space.shape)
        return Problem(self.space.coarser(2), clearance, load, self.by_force, bounds)

    def first_touch(self) -> np.ndarray:
        """Given force on the nodes that touch first, as far as their bounds allow.

        It is the start if nothing better is known, for forces so small that rounding of the other
        nodes' clearances hides them.
        """
        touching = self.clearance == 0
        return self.bounds.clip(touching * (self.load / np.count_nonzero(touching)))

    def closure_at_force(self, pressure: np.ndarray, displacement: np.ndarray) -> float:
        """Closure at which a given force acts: the mean gap between the bounds vanishes.

        If all nodes in contact are at their upper bound, the conditions hold for any closure that
        overlaps all of them and no other node; the least of these is returned. If there is none,
        the mean is a guess for the next iteration.
        """
        mean = mean_closure(pressure, displacement, self.clearance, self.bounds)
        if np.isfinite(mean):
            return mean
        reached, capped = displacement + self.clearance, pressure > self.bounds.lower
        least = reached[capped].max()
        if least <= reached[~capped].min(initial=np.inf):
            return least
        return reached[capped].mean()


def coarser_load(load: float, by_force: bool) -> float:
    """Load of a problem on the grid twice as coarse.

    The number of a pressure is doubled there (`Bounds.coarser`) and a fourth of the cells are
    summed: a force is halved, a closure stays.
    """
    return load / 2 if by_force else load


@dataclass
class Iterate:
    """Pressure p, displacement K p, both (n,), and closure."""

    pressure: np.ndarray
    displacement: np.ndarray
    closure: float


@dataclass
class Solution(Iterate):
    """Iterate within its bounds, with a displacement computed from its final pressure.

    The displacement is in double precision, except for solutions that are only a start on a finer
    grid.

    Attributes
    ----------
    residual : float
        Largest violation of the contact conditions, as a fraction of the closure; under a given
        force also the violation of the force, as a fraction of it.
    applications : int
        Applications of K, in either precision.
    """

    residual: float
    applications: int


@dataclass(frozen=True)
class KKTResidual:
    """Violation of the contact conditions.

    Attributes
    ----------
    active : (n,) int32 ndarray
        Active contact set, on which the gap is to vanish: nodes between the bounds, and nodes at a
        bound that the gap pulls off it.
    infeasible : (m,) int32 ndarray
        Nodes whose pressure is beyond a bound.
    largest : float
        Largest violation of a gap condition or of a bound, not yet divided by the closure. (A
        node's pressure displaces it by about itself in these units.)
    """

    active: np.ndarray
    infeasible: np.ndarray
    largest: float

    def holds_to(self, tolerance: float, unit: float) -> bool:
        """True if no violation exceeds ``tolerance`` times their unit (`Problem.tolerated`)."""
        return self.largest <= tolerance * unit


def kkt_residual(
    pressure: np.ndarray,
    displacement: np.ndarray,
    clearance: np.ndarray,
    closure: float,
    bounds: Bounds,
) -> KKTResidual:
    """KKT residual of p, K p and c at every node, all (n,), at a closure."""
    if not pressure.shape == displacement.shape == clearance.shape:
        raise ValueError("expected pressure, displacement and clearance of one size")
    on_nodes = bounds.on(pressure.size)
    return KKTResidual(*_kkt_residual(pressure, displacement, clearance, closure, *on_nodes))


def frank_wolfe_gap(pressure: np.ndarray, gap: np.ndarray, upper: float | np.ndarray) -> float:
    """Bound on the energy of a pressure above the least energy of the same force.

    Parameters
    ----------
    pressure, gap : (n,) ndarray
        Pressure within the bounds, and K p + c up to a constant. Nodes with a larger gap than all
        loaded nodes may be left out.
    upper : float or (n,) ndarray
        Largest pressure, or infinity; the least is 0.

    Returns
    -------
    float
        In the unit of pressure times gap.

    Notes
    -----
    E(p) = p.K p / 2 + p.c is convex with gradient v = K p + c. So for the pressure p* of least
    energy among those of the same sum F and the same bounds, E(p) - E(p*) <= v.(p - p*) <= G,
    the largest v.(p - q) over all such q: the Frank-Wolfe gap (M. Frank and P. Wolfe, Naval
    Res. Logist. Quart. 3 (1956) 95; M. Jaggi, Proc. 30th Int. Conf. Mach. Learn. (2013) 427).
    The best q loads the nodes in the order of v, each up to its bound H; without one, the node of
    least v alone, and G = sum p_i (v_i - min v). A constant in v, such as the closure, changes
    nothing.
    """
    loaded = pressure > 0
    if not loaded.any():
        return 0.0
    within = gap <= gap[loaded].max()
    excess, total = gap[within] - gap[within].min(), pressure[loaded].sum()
    order = np.argsort(excess)
    most = np.minimum(np.broadcast_to(upper, gap.shape)[within][order], total)
    best = np.clip(total - (np.cumsum(most) - most), 0.0, most)
    return max(float(pressure[within] @ excess - best @ excess[order]), 0.0)


def mean_closure(
    pressure: np.ndarray, displacement: np.ndarray, clearance: np.ndarray, bounds: Bounds
) -> float:
    """Closure at which the mean gap of the nodes between the bounds vanishes; NaN without any."""
    if not pressure.shape == displacement.shape == clearance.shape:
        raise ValueError("expected pressure, displacement and clearance of one size")
    return _mean_closure(pressure, displacement, clearance, *bounds.on(pressure.size))


@njit(cache=True)
def _mean_closure(pressure, displacement, clearance, lower, upper):
    """`mean_closure` with bounds on each node."""
    total, n = 0.0, 0
    for i in range(pressure.size):
        if lower[i] < pressure[i] < upper[i]:
            total += displacement[i] + clearance[i]
            n += 1
    return total / n if n else np.nan


@njit(cache=True)
def _kkt_residual(pressure, displacement, clearance, closure, lower, upper):
    """Fields of :class:`KKTResidual`."""
    active = np.empty(pressure.size, np.int32)
    infeasible = np.empty(pressure.size, np.int32)
    n, m, largest = 0, 0, 0.0
    for i in range(pressure.size):
        p, low, high = pressure[i], lower[i], upper[i]
        if p < low or p > high:
            infeasible[m] = i
            m += 1
            largest = max(largest, low - p if p < low else p - high)
            continue
        gap = displacement[i] + clearance[i] - closure
        if p == low:
            violation = -gap
        elif p == high:
            violation = gap
        else:
            violation = abs(gap)
        if violation > 0 or (p > low and p < high):
            active[n] = i
            n += 1
            largest = max(largest, violation)
    return active[:n].copy(), infeasible[:m].copy(), largest
