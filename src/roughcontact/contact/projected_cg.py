"""Linear equations K x = b on a contact set: a preconditioned step, then conjugate gradients.

Where the sum of x is given, the gradients are projected so that they keep it (projected method of
N. I. M. Gould, M. E. Hribar and J. Nocedal, On the solution of equality constrained quadratic
programming problems arising in optimization, SIAM J. Sci. Comput. 23 (2001) 1376). The step before
them is clipped at the bounds (D. P. Bertsekas, Projected Newton methods for optimization problems
with simple constraints, SIAM J. Control Optim. 20 (1982) 221). Directions and their images are in
single precision.
"""

import numpy as np

from ..kernel_cache import njit
from .bounds import Bounds
from .operator import Operator

# Applications in one solve: on an exact set about ten reach 1e-6.
MAX_INNER = 60
# Passes in search of the closure that gives a clipped step its total.
CLIPPING_PASSES = 20
# To what fraction it has that; in a window that goes on beyond its edges, where clearances are a
# larger part of the closure.
TOTAL, REPEATED_TOTAL = 1e-7, 1e-12
# In it, least effect of closure on a node's pressure, as a fraction of the mean.
MIN_RESPONSE = 1e-2
# Stiffness: its error is of second order in this residual.
TANGENT_RESIDUAL = 1e-4
# Compliance: passes in which double precision corrects what single precision leaves.
COMPLIANCE_PASSES = 4


class ProjectedCG:
    """Conjugate gradients for K x = right side + multiplier on a contact set.

    The multiplier, of the constraint on the sum of x, is the change of closure that a given force
    leaves open; it is 0 where the closure is given.

    Parameters
    ----------
    operator : Operator
        Its preconditioner is that on the set.
    active : (n,) int ndarray
        Nodes of the set.
    right_side : (n,) ndarray

    Attributes
    ----------
    solution, residual : (n,) float32 ndarray
        x, and what is left of the right side.
    image : float32 ndarray
        K x on all nodes of the operator.
    multiplier : float
        Lagrange multiplier of the sum.
    unclipped : (n,) float32 ndarray
        0 at nodes that keep the x they have, whatever their equation says; else 1.
    at_lower, at_upper : (n,) bool ndarray
        Those that a clipped step took to a bound.

    Raises
    ------
    ValueError
        If the right side is not one on the set.
    """

    def __init__(self, operator: Operator, active: np.ndarray, right_side: np.ndarray):
        if right_side.shape != active.shape:
            raise ValueError(f"right side {right_side.shape}: expected {active.shape}")
        self.operator, self.active, self.inverse = operator, active, operator.inverse
        self.residual = right_side.astype(np.float32)
        self.solution = np.zeros(active.size, np.float32)
        self.image = np.zeros(operator.size, np.float32)
        self.unclipped = np.ones(active.size, np.float32)
        self.at_lower = self.at_upper = np.zeros(active.size, bool)
        self.multiplier = 0.0
        self._response: np.ndarray | None = None

    def clipped_step(self, start: np.ndarray, bounds: Bounds, total: float | None) -> None:
        """The preconditioner's whole step, clipped so that start + x keeps within bounds.

        With a ``total``, start + x has that sum. What the step does is left to `apply_step`.

        Raises
        ------
        ValueError
            If the start is not one on the set.
        """
        if start.shape != self.active.shape:
            raise ValueError(f"start {start.shape}: expected {self.active.shape}")
        aim, (low, high) = start + self.inverse(self.residual), bounds.on(start.size)
        if total is not None and self.active.size:  # it is empty where all that touches yields
            self._response = self.inverse(np.ones(self.active.size, np.float32))
            nearly = TOTAL if self.operator.space.is_free else REPEATED_TOTAL
            multiplier = _multiplier_of_total(aim, self._response, low, high, total, nearly)
            self.residual += np.float32(multiplier)
            self.multiplier += multiplier
        clipped = _clip(aim, start, low, high, self.solution, self.unclipped)
        self.at_lower, self.at_upper = clipped

    def apply_step(self, fixed: np.ndarray, change: np.ndarray) -> None:
        """Apply K to the step, and to the ``change`` of ``fixed`` nodes that goes with it."""
        self.image = self.operator.apply_sparse((self.active, self.solution), (fixed, change))
        self.residual *= self.unclipped
        _subtract(self.residual, np.float32(1), self.image, self.active, self.unclipped)

    def iterate(self, goal: float, *, by_force: bool) -> None:
        """Iterate conjugate gradients until no residual exceeds ``goal``."""
        response, total = self.unclipped, 0.0
        if by_force:
            response = self._response_of_unclipped()
            total = response.sum(dtype=float)
            if total <= 0:
                return
        direction, previous = None, 1.0
        for _ in range(MAX_INNER):
            if self._end_at_goal(goal, by_force):
                break
            search = self.inverse(self.residual)
            offset, slope, worst = _project(search, self.residual, self.unclipped, response, total)
            self.multiplier += offset
            if worst <= goal or slope <= 0:
                break
            if direction is None:
                direction = search
            else:
                direction *= np.float32(slope / previous)
                direction += search
            previous = slope
            image = self.operator.apply_sparse((self.active, direction))
            curvature = _curvature(direction, image, self.active, self.unclipped)
            if not curvature > 0:  # of a constant, in a window that goes on beyond its edges
                break
            length = np.float32(slope / curvature)
            add(self.solution, length, direction)
            add(self.image, length, image)
            _subtract(self.residual, length, image, self.active, self.unclipped)

    def _response_of_unclipped(self):
        """Preconditioned vector of ones on the unclipped nodes.

        No other response will do, however few nodes were clipped: with that of the whole set the
        gradients are not conjugate, and were seen to diverge.
        """
        if self._response is not None and self.unclipped.all():
            return self._response
        return self.inverse(self.unclipped) * self.unclipped

    def _end_at_goal(self, goal, by_force):
        """Move the multiplier, if open, by the mean residual where none then exceeds the goal.

        Returns whether it is so; else nothing changes. This is known without the preconditioner,
        unlike the multiplier that its search asks for.
        """
        mean, worst = _mean_and_worst(self.residual, self.unclipped, by_force)
        if worst > goal:
            return False
        self.multiplier -= mean
        self.residual -= np.float32(mean) * self.unclipped
        return True


def stiffness(operator: Operator, active: np.ndarray) -> tuple[float, float]:
    """Sum of q with K q = 1 on some nodes: dF/dw of a state in which these lie between the bounds.

    Infinite on all nodes of a window that goes on beyond its edges.

    Parameters
    ----------
    operator : Operator
    active : (n,) int32 ndarray

    Returns
    -------
    stiffness, error : float
        0 without nodes. ``error`` estimates the relative error, of second order in the
        residual of the equations.

    Notes
    -----
    For an approximate q with residual r = 1 - K q, sum(q) + r.q errs by r.K^-1 r only.
    """
    if active.size == 0:
        return 0.0, 0.0
    if not operator.space.is_free:
        if active.size == operator.size:
            return np.inf, 0.0
        value, error = _compliance(operator, active)
        return (1 / value, error) if value > 0 else (np.inf, np.inf)
    operator.precondition(active, fresh=True)
    equations = ProjectedCG(operator, active, np.ones(active.size))
    equations.iterate(TANGENT_RESIDUAL, by_force=False)
    residual, q = equations.residual.astype(float), equations.solution.astype(float)
    value = q.sum() + residual @ q
    return value, float(residual @ operator.inverse(equations.residual)) / value


def _compliance(operator, active):
    """The least q.K q of all q of sum 1 on some nodes, which is dw/dF, and its relative error.

    For windows that go on beyond their edges, where K has no inverse on all of the nodes, and
    nearly none on most. The least is the multiplier of the sum; an approximate q is above it by
    r.K^-1 r, of what is left of K q less its mean.
    """
    operator.precondition(active, fresh=True)
    response = operator.inverse(np.ones(active.size, np.float32))
    q, value, error = response.astype(float), np.inf, np.inf
    for _ in range(COMPLIANCE_PASSES):
        q /= q.sum()
        loaded = np.zeros(operator.size)
        loaded[active] = q
        image = operator(loaded)[active]
        value = float(q @ image)
        scale = float(np.abs(image - value).max())
        if not (value > 0 and scale > 0):
            return value, 0.0 if value > 0 else np.inf
        equations = ProjectedCG(operator, active, (value - image) / scale)
        search = operator.inverse(equations.residual)
        search -= response * np.float32(search.sum() / response.sum())
        error = scale**2 * abs(float(equations.residual @ search)) / value
        if error <= TANGENT_RESIDUAL**2:
            break
        equations.iterate(TANGENT_RESIDUAL, by_force=True)
        q += scale * equations.solution
    return value, error


@njit(cache=True)
def add(values: np.ndarray, scale: float, change: np.ndarray) -> None:
    """values += scale * change, without arrays in between."""
    if values.size != change.size:
        raise ValueError("expected as many changes as values")
    for i in range(values.size):
        values[i] += scale * change[i]


# Sums are made in double precision, and without the threads of a library of linear algebra.


@njit(cache=True)
def _project(search, residual, unclipped, response, total):
    """Make a search vanish on clipped nodes and, where the response has a total, sum to zero.

    Parameters
    ----------
    search, residual, unclipped : (n,) float32 ndarray
    response : (n,) float32 ndarray
        What the preconditioner makes of 1 on the unclipped nodes.
    total : float
        Its sum; 0 where the sum of the search is free.

    Returns
    -------
    offset : float
        What is added to the multiplier and to every residual; and the response times it to the
        search.
    slope, worst : float
        Search times residual, and the largest residual.
    """
    missing, slope, worst = 0.0, 0.0, np.float32(0)
    for i in range(search.size):
        search[i] *= unclipped[i]
        missing += search[i]
    offset = np.float32(-missing / total) if total > 0 else np.float32(0)
    for i in range(search.size):
        search[i] += offset * response[i]
        residual[i] += offset * unclipped[i]
        slope += search[i] * residual[i]
        worst = max(worst, abs(residual[i]))
    return float(offset), slope, worst


@njit(cache=True)
def _mean_and_worst(residual, unclipped, by_force):
    """Mean residual of the unclipped nodes, or 0 where it is not free; largest difference of it."""
    total, n = 0.0, 0
    for i in range(residual.size):
        if unclipped[i] > 0:
            total += residual[i]
            n += 1
    mean = total / n if by_force and n else 0.0
    worst = 0.0
    for i in range(residual.size):
        if unclipped[i] > 0:
            worst = max(worst, abs(residual[i] - mean))
    return mean, worst


@njit(cache=True)
def _curvature(direction, image, active, unclipped):
    """Direction times its image, on the unclipped nodes."""
    total = 0.0
    for i in range(active.size):
        total += direction[i] * image[active[i]] * unclipped[i]
    return total


@njit(cache=True)
def _subtract(residual, scale, image, active, unclipped):
    """residual -= scale * image, on the unclipped nodes."""
    for i in range(active.size):
        residual[i] -= scale * image[active[i]] * unclipped[i]


@njit(cache=True)
def _multiplier_of_total(aim, response, low, high, total, nearly):
    """Multiplier at which aim + multiplier * response, clipped, has a total; the aim moves there.

    Found by Newton's method, safeguarded by bisection.
    """
    n = aim.size
    # Where the approximation is not positive, as K^-1 1 is, more closure still means more.
    response = np.maximum(response.astype(np.float64), MIN_RESPONSE * response.mean())
    multiplier, least, most = 0.0, -np.inf, np.inf
    passes, bounded = 0, True
    for i in range(n):
        bounded = bounded and np.isfinite(high[i] - low[i])
    while passes < CLIPPING_PASSES or bounded:
        missing, slope = total, 0.0
        for i in range(n):
            end = aim[i] + multiplier * response[i]
            missing -= min(max(end, low[i]), high[i])
            if low[i] < end < high[i]:
                slope += response[i]
        if abs(missing) <= nearly * abs(total):
            break
        least, most = (multiplier, most) if missing > 0 else (least, multiplier)
        if slope > 0:
            multiplier += missing / slope
        # Between two bounds Newton's step may go to where every node is at one of them.
        if not least < multiplier < most:
            if bounded:
                least = max(least, np.min((low - aim) / response))
                most = min(most, np.max((high - aim) / response))
            elif np.isinf(most - least):
                break
            multiplier = (least + most) / 2
            if not least < multiplier < most:
                break
        passes += 1
    for i in range(n):
        aim[i] += multiplier * response[i]
    return multiplier


@njit(cache=True)
def _clip(aim, start, low, high, step, unclipped):
    """The step to an aim between bounds; nodes that it takes to the lower and to the upper one."""
    at_low, at_high = np.empty(aim.size, np.bool_), np.empty(aim.size, np.bool_)
    for i in range(aim.size):
        end = min(max(aim[i], low[i]), high[i])
        step[i] = end - start[i]
        at_low[i], at_high[i] = end <= low[i], end >= high[i]
        if at_low[i] or at_high[i]:
            unclipped[i] = 0
    return at_low, at_high
