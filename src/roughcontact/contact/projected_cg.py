"""Linear equations K x = b on a contact set: a preconditioned step, then conjugate gradients.

If the sum of x is given, the gradients are projected so that they keep it (projected conjugate
gradients: N. I. M. Gould, M. E. Hribar and J. Nocedal, On the solution of equality constrained
quadratic programming problems arising in optimization, SIAM J. Sci. Comput. 23 (2001) 1376). The
step before them is clipped at the bounds (D. P. Bertsekas, Projected Newton methods for
optimization problems with simple constraints, SIAM J. Control Optim. 20 (1982) 221). Directions and
their images are in single precision.
"""

import numpy as np

from ..kernel_cache import njit
from .bounds import Bounds
from .operator import Operator

# Most applications in one solve; on the exact set about ten reach 1e-6.
MAX_INNER = 60
# Most passes in search of the closure that gives a clipped step its total.
CLIPPING_PASSES = 20
# Tolerance of the total, in free windows and in repeated ones, where clearances are a larger part
# of the closure.
TOTAL, REPEATED_TOTAL = 1e-7, 1e-12
# Least effect of the closure on a node's pressure in the search for that closure, as a fraction of
# the mean.
MIN_RESPONSE = 1e-2
# Residual of the stiffness equations; the stiffness errs by its second order.
TANGENT_RESIDUAL = 1e-4
# Most passes of the compliance, each of which corrects in double precision the error of the last.
COMPLIANCE_PASSES = 4


class ProjectedCG:
    """Conjugate gradients for K x = right side + multiplier on a contact set.

    The Lagrange multiplier of the sum of x is the change of the closure under a given force; it is
    0 if the closure is given. The operator's preconditioner must be that of the ``active`` set,
    (n,).

    Attributes
    ----------
    solution, residual : (n,) float32 ndarray
        x, and the residual of the equations.
    image : float32 ndarray
        K x on all nodes of the operator.
    multiplier : float
        Lagrange multiplier of the sum.
    unclipped : (n,) float32 ndarray
        0 at nodes whose x stays fixed, whatever their equation; else 1.
    at_lower, at_upper : (n,) bool ndarray
        Nodes that a clipped step took to a bound.
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
        """Set `solution` to the preconditioned step x, clipped to keep start + x within the bounds.

        With a ``total``, start + x has that sum to within a fraction `TOTAL` of it (in repeated
        windows `REPEATED_TOTAL`); where a bound is infinite, as far as `CLIPPING_PASSES` allow.
        `apply_step` applies K to the step.
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
        """Apply K to the step and to the ``change`` of the ``fixed`` nodes."""
        self.image = self.operator.apply_sparse((self.active, self.solution), (fixed, change))
        self.residual *= self.unclipped
        _subtract(self.residual, np.float32(1), self.image, self.active, self.unclipped)

    def iterate(self, goal: float, *, by_force: bool) -> None:
        """Conjugate gradients until no residual exceeds ``goal``."""
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
            if not curvature > 0:  # a constant, in a window that continues beyond its edges
                break
            length = np.float32(slope / curvature)
            add(self.solution, length, direction)
            add(self.image, length, image)
            _subtract(self.residual, length, image, self.active, self.unclipped)

    def _response_of_unclipped(self):
        """Preconditioned vector of ones on the unclipped nodes.

        With the response of the whole set the gradients are not conjugate, however few nodes were
        clipped, and were seen to diverge.
        """
        if self._response is not None and self.unclipped.all():
            return self._response
        return self.inverse(self.unclipped) * self.unclipped

    def _end_at_goal(self, goal, by_force):
        """Move the multiplier, if free, by the mean residual, if no residual then exceeds the goal.

        Returns whether it did. This test needs no preconditioner, unlike the multiplier of the
        search.
        """
        mean, worst = _mean_and_worst(self.residual, self.unclipped, by_force)
        if worst > goal:
            return False
        self.multiplier -= mean
        self.residual -= np.float32(mean) * self.unclipped
        return True


def stiffness(operator: Operator, active: np.ndarray) -> tuple[float, float]:
    """Stiffness dF/dw of nodes between the bounds: sum of q with K q = 1 on them.

    Returns the stiffness and its relative error, of second order in the residual of the equations;
    0 without nodes, and infinity on all nodes of a window that continues beyond its edges. For an
    approximate q with residual r = 1 - K q, sum(q) + r.q errs by r.K^-1 r only.
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
    """Compliance dw/dF: the least q.K q of all q of sum 1 on some nodes, and its relative error.

    For windows that continue beyond their edges, where K has no inverse on all of the nodes and
    nearly none on most. The least value is the multiplier of the sum; an approximate q exceeds it
    by r.K^-1 r, with r = K q less its mean.
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
    """In place, values += scale * change, without temporary arrays."""
    if values.size != change.size:
        raise ValueError("expected as many changes as values")
    for i in range(values.size):
        values[i] += scale * change[i]


# Sums are in double precision, and without the threads of a linear-algebra library.


@njit(cache=True)
def _project(search, residual, unclipped, response, total):
    """Make a search vanish on clipped nodes and, if the response has a ``total``, sum to zero.

    ``response`` is the preconditioned vector of ones on the unclipped nodes and ``total`` its sum;
    0 if the sum of the search is free. Returns the offset, which was added to the multiplier and to
    every residual (and times the response to the search), search times residual, and the largest
    residual.
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
    """Mean residual of the unclipped nodes (0 if ``by_force`` is False), and largest deviation."""
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
    """Product of a direction and its image, on the unclipped nodes."""
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
    """Multiplier at which aim + multiplier * response, clipped, has a total; moves the aim there.

    Newton's method, safeguarded by bisection.
    """
    n = aim.size
    # Made positive, as K^-1 1 is, so that the total rises with the closure.
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
        # Newton's step may lead to where every node is at one of its bounds.
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
    """Step to an aim within bounds; returns the nodes that it takes to either bound."""
    at_low, at_high = np.empty(aim.size, np.bool_), np.empty(aim.size, np.bool_)
    for i in range(aim.size):
        end = min(max(aim[i], low[i]), high[i])
        step[i] = end - start[i]
        at_low[i], at_high[i] = end <= low[i], end >= high[i]
        if at_low[i] or at_high[i]:
            unclipped[i] = 0
    return at_low, at_high
