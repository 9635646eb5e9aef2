"""Active-set iteration for the contact problem: pressures between bounds, an unknown closure.

With the gap g = K p + c - w at the nodes (c the clearance at first touch), a state of contact has
0 <= p <= H, and g = 0 where p lies between, g >= 0 where p = 0, g <= 0 where p = H. That is the
minimum of a strictly convex quadratic between bounds. The set of a correction is the nodes between
the bounds and those at a bound that the gap pulls off it. Its first step is a whole one of the
approximate inverse of K (`screening`), clipped at the bounds, so that nodes leave the set in the
same application of K that moves the others; conjugate gradients follow on those that stay. While
the set is far off, the nodes that a step would take to a bound are left out, and the step is made
anew on the others, before K is applied at all. Directions and their images are in single precision;
what is returned was judged on a displacement in double precision.
"""

from dataclasses import dataclass, replace

import numpy as np

from ..core.kernel_cache import njit
from .coarse_correction import only_in_one
from .kkt import between_bounds, examined_by, mean_reached
from .projected_cg import CLIPPING_PASSES, Operator, SetEquations, add, stiffness

# Corrections of the contact set before the solver gives up: trials needed at most some twenty.
MAX_CORRECTIONS = 200
# The linear solve for a set is stopped at a share of its first residual, as the set will change:
# so many times the share of the set that changed last, within these limits.
REDUCTION, LEAST_REDUCTION, MOST_REDUCTION = 3.0, 0.03, 0.3
# In so many corrections nodes are left out beforehand; in all of them the set might swing. Only on
# the way from another state, whose gaps overlap all around what touched: from a coarse start it
# saves applications, but no time, and neither in small windows. And no more than this share of the
# set: where most nodes yield, the few others would have to carry whatever a given force lacks.
FORESEEING, MOST_LEFT_OUT = 2, 0.5
# A violation no larger than so many tolerances is expected to fall below one in a single step,
# whose displacement is then computed in double precision at once.
NEARLY = 2.0
# After so many corrections the set may be swinging for ever: seen on combs and checkerboards under
# a given force, once in 2,000 scenes under a given closure. Then closures are given instead of the
# force, sets are solved to PATIENT_REDUCTION without clipping, and while nodes leave none enters.
PATIENCE = 30
PATIENT_REDUCTION = 1e-3
# Under a given force it swings for sure where a violation is still of the order of the closure
# after so many corrections: a spike carries what its neighbours, all or none of them, would.
HOPELESS, HOPELESS_VIOLATION = 15, 0.5
# Closures tried in search of one force; Newton's method needs about five.
MAX_CLOSURES = 50
# Aim this far below the tolerance, so that one correction too many is rarer than one too few.
SAFETY = 0.3
# Single precision carries a correction no further down than this share of its right side.
SINGLE_REACHES = 1e-5
# No closure is known better than this, as a share of it.
CLOSURE_ROUNDING = 1e-12
_FLOAT64 = np.dtype(np.float64)
# A total this close to F is F.
FORCE_ROUNDING = 1e-12


@dataclass
class Solution:
    """A pressure within its bounds, and how far it is from a state of contact.

    Attributes
    ----------
    pressure, displacement : (n,) ndarray
    closure : float
    residual : float
        Largest violation of the contact conditions, share of the closure.
    applications : int
        Applications of K, in either precision.
    """

    pressure: np.ndarray
    displacement: np.ndarray
    closure: float
    residual: float
    applications: int


class ActiveSet:
    """The iteration, from any start to a verified solution.

    Parameters
    ----------
    problem : Problem
    rtol : float
        Largest violation allowed, share of the closure.

    Raises
    ------
    ValueError
        If the clearance is not one of the grid.
    """

    def __init__(self, problem, rtol):
        _check_on_grid(problem.clearance, "clearance", problem.space)
        self.problem, self.rtol = problem, rtol
        self.operator = Operator(problem.space)

    def solve(self, pressure, displacement=None, *, at_least=0):
        """Iterate until a state is verified or patience ends; the caller checks the residual.

        Parameters
        ----------
        pressure : (n,) ndarray
            Where to start; may violate the bounds. Overwritten, and so is the displacement.
        displacement : (n,) ndarray, optional
            K of it, where known.
        at_least : int
            Corrections made even of what satisfies the tolerance, unless nothing is left of them.

        Returns
        -------
        Solution

        Raises
        ------
        ValueError
            If the start is not one of the grid.
        """
        problem = self.problem
        _check_on_grid(pressure, "pressure", problem.space)
        if displacement is not None:
            _check_on_grid(displacement, "displacement", problem.space)
        small = self.operator.inverse.small
        foreseeing = 0 if small or displacement is None else FORESEEING
        pressure, displacement = self._loaded(pressure, displacement)
        if displacement is None:
            displacement = self.operator(pressure.astype(np.float32)).astype(float)
            factor = self._best_factor(pressure, displacement)
            pressure, displacement = factor * pressure, factor * displacement
        closure = self._mean_gap(pressure, displacement) if problem.by_force else problem.load
        free, foreseen = np.empty(0, np.int32), False
        for correction in range(MAX_CORRECTIONS):
            examined = self._examine(pressure, displacement, closure)
            done = correction >= at_least or examined.worst <= SINGLE_REACHES * abs(closure)
            if done and examined.worst <= self.rtol * abs(closure):
                solution = self._verified(pressure, closure)
                if solution.residual <= self.rtol:
                    return solution
                pressure, displacement = solution.pressure, solution.displacement
                closure = solution.closure
                examined = self._examine(pressure, displacement, closure)
            patient = correction > PATIENCE
            if patient and examined.beyond.size:
                inside = (pressure[examined.free] > 0) & (pressure[examined.free] < problem.cap)
                examined = replace(examined, free=examined.free[inside])
            self.operator.inverse.update(examined.free, fresh=correction == 0)
            changed = only_in_one(free, examined.free).size / max(examined.free.size, 1)
            free = examined.free
            reduction = min(max(REDUCTION * changed, LEAST_REDUCTION), MOST_REDUCTION)
            if patient:
                reduction = PATIENT_REDUCTION
            elif done and not foreseen and examined.worst <= NEARLY * self.rtol * abs(closure):
                # Once only: where one step gains too little, conjugate gradients must follow.
                foreseen, reduction = True, None
            closure = self._correct(
                *(pressure, displacement, closure, examined, reduction),
                foreseeing=correction < foreseeing,
            )
            if reduction is None:
                solution = self._verified(pressure, closure)
                if solution.residual <= self.rtol:
                    return solution
                pressure, displacement = solution.pressure, solution.displacement
                closure = solution.closure
            hopeless = examined.worst > HOPELESS_VIOLATION * abs(closure)
            if problem.by_force and correction >= (HOPELESS if hopeless else PATIENCE):
                return self._by_closures(self._verified(pressure, closure))
        return self._verified(pressure, closure)

    def _by_closures(self, solution):
        """The state of the given force as that of a closure, found by Newton's method on F(w)."""
        problem, low, high = self.problem, 0.0, np.inf
        closure, tolerance = solution.closure, SAFETY * self.rtol
        for _ in range(MAX_CLOSURES):
            given = replace(problem, load=closure, by_force=False)
            search = ActiveSet(given, tolerance)
            solution = search.solve(solution.pressure, solution.displacement)
            self.operator.applications += search.operator.applications
            total = solution.pressure.sum()
            if abs(total / problem.load - 1) <= SAFETY * self.rtol:
                # What is missing goes to the nodes between the bounds, which may be few.
                verified = self._verified(solution.pressure, solution.closure)
                if verified.residual <= self.rtol:
                    return verified
            low, high = (closure, high) if total < problem.load else (low, closure)
            free = between_bounds(solution.pressure, problem.cap)
            slope, _ = stiffness(self.operator, free)
            if slope > 0:
                # Steep F(w): a closure within its tolerance must still tell the force within its.
                steepness = max(1.0, slope * abs(closure) / problem.load)
                tolerance = max(SAFETY * self.rtol / steepness, CLOSURE_ROUNDING)
                closure += (problem.load - total) / slope
            if not (slope > 0 and low < closure < high):
                closure = (low + min(high, 4 * low + 1)) / 2
        return self._verified(solution.pressure, solution.closure)

    def _examine(self, pressure, displacement, closure):
        problem = self.problem
        return examined_by(pressure, displacement, problem.clearance, closure, problem.cap)

    def _loaded(self, pressure, displacement):
        """The start, scaled to the force where that is given."""
        problem = self.problem
        if not problem.by_force:
            return pressure, displacement
        total = np.maximum(pressure, 0.0).sum()
        if not total > 0:
            return problem.first_touch(), None
        factor = problem.load / total
        if pressure.max() * factor > problem.cap:
            return self._within_cap(pressure), None
        return pressure * factor, None if displacement is None else displacement * factor

    def _best_factor(self, pressure, displacement):
        """What a start under a given closure is to be multiplied with: its energy is least then.

        On a coarse grid, of which each cell has its highest point, too much is carried.
        """
        problem, work = self.problem, pressure @ displacement
        if problem.by_force or not work > 0:
            return 1.0
        factor = pressure @ (problem.load - problem.clearance) / work
        return min(factor, problem.cap / pressure.max()) if factor > 0 else 1.0

    def _within_cap(self, pressure):
        """A start of the given force that breaks no bound.

        What its nodes cannot carry goes to those that are nearest to touching.
        """
        problem = self.problem
        pressure = np.clip(pressure, 0.0, problem.cap)
        _scale_to(problem.load, pressure, problem.cap)
        lacking = problem.load - pressure.sum()
        if lacking > FORCE_ROUNDING * problem.load:
            displacement = self.operator(pressure.astype(np.float32))
            empty = np.flatnonzero(pressure == 0)
            order = np.argsort((displacement + problem.clearance)[empty], kind="stable")
            nearest = empty[order[: int(2 * lacking / problem.cap) + 1]]
            pressure[nearest] = lacking / nearest.size
        return pressure

    def _mean_gap(self, pressure, displacement):
        """The closure that a given force leaves open: it makes the mean gap in contact vanish.

        Where all that touches is at the cap, any closure does that presses all of it and nothing
        else. It is the least of these; where there is none, the mean still leads on.
        """
        clearance, cap = self.problem.clearance, self.problem.cap
        mean = mean_reached(pressure, displacement, clearance, cap)
        if np.isfinite(mean):
            return mean
        reached, capped = displacement + clearance, pressure > 0
        least = reached[capped].max()
        if least <= reached[~capped].min(initial=np.inf):
            return least
        return reached[capped].mean()

    def _verified(self, pressure, closure):
        """The pressure put within its bounds, with a displacement in double precision."""
        problem = self.problem
        pressure = np.clip(pressure, 0.0, problem.cap)
        lacking = 0.0
        if problem.by_force:
            if not pressure.any():
                pressure = problem.first_touch()
            _scale_to(problem.load, pressure, problem.cap)
            lacking = abs(1 - pressure.sum() / problem.load)
        displacement = self.operator(pressure)
        if problem.by_force:
            closure = self._mean_gap(pressure, displacement)
        worst = self._examine(pressure, displacement, closure).worst
        residual = max(worst / abs(closure), lacking)
        return Solution(pressure, displacement, closure, residual, self.operator.applications)

    def _correct(self, pressure, displacement, closure, examined, reduction, *, foreseeing):
        """Correct pressure and displacement in place; returns the closure.

        ``reduction`` is the share of the first residual at which the linear solve stops. Without
        one a single step is taken, and the displacement left for a verification. If ``foreseeing``,
        nodes that the first step takes to a bound are left out of the set.
        """
        cap, patient = self.problem.cap, reduction == PATIENT_REDUCTION
        free, beyond = examined.free, examined.beyond
        bound = np.where(pressure[beyond] < 0, 0.0, cap)
        gap = displacement[free] + self.problem.clearance[free] - closure
        equations, back, scale = self._stepped(pressure, gap, free, beyond, bound, patient)
        leaving = equations.at_zero | equations.at_cap
        if foreseeing and 0 < np.count_nonzero(leaving) <= MOST_LEFT_OUT * free.size:
            beyond = np.concatenate([beyond, free[leaving]])
            bound = np.concatenate([bound, np.where(equations.at_zero[leaving], 0.0, cap)])
            free, gap = free[~leaving], gap[~leaving]
            self.operator.inverse.update(free, fresh=False)
            equations, back, scale = self._stepped(pressure, gap, free, beyond, bound, patient)
        if reduction is not None:
            equations.carry_out(beyond, back)
            goal = max(reduction, SINGLE_REACHES, SAFETY * self.rtol * abs(closure) / scale)
            equations.conjugate_gradients(goal, by_force=self.problem.by_force)
            add(displacement, scale, equations.image)
        pressure[beyond] = bound
        _step(pressure, free, scale, equations.solution, equations.at_zero, equations.at_cap, cap)
        return closure + scale * equations.common

    def _stepped(self, pressure, gap, free, beyond, bound, patient):
        """The equations on a set after their first step; and what goes with them.

        That is by how much the pressures ``beyond`` change, which go to a ``bound``, and the scale
        of all numbers in the equations, of these too.
        """
        problem = self.problem
        load = problem.load if problem.by_force else np.nan
        scale, right_side, start, back, wanted = _scaled(pressure, gap, free, beyond, bound, load)
        equations = SetEquations(self.operator, free, right_side)
        bounds = (-np.inf, np.inf) if patient else (0.0, problem.cap / scale)
        equations.clipped_step(start, bounds, wanted if problem.by_force else None)
        return equations, back, scale


def _check_on_grid(values, name, space):
    """Refuse what are not as many numbers as the grid has nodes."""
    nodes = space.shape[0] * space.shape[1]
    if values.shape != (nodes,) or values.dtype != _FLOAT64:
        raise ValueError(f"{name} {values.shape} of {values.dtype}: expected {(nodes,)} of float64")


@njit(cache=True)
def _scale_to(total, pressure, cap):
    """Scale a pressure to a total in place, none above the cap."""
    for _ in range(CLIPPING_PASSES):
        lacking, part = total, 0.0
        for value in pressure:
            lacking -= value
            if value < cap:
                part += value
        if abs(lacking) <= FORCE_ROUNDING * total or part == 0:
            break
        factor = 1 + lacking / part
        for i in range(pressure.size):
            if pressure[i] < cap:
                pressure[i] = min(pressure[i] * factor, cap)


@njit(cache=True)
def _scaled(pressure, gap, free, beyond, bound, load):
    """Numbers near one for the equations on a set: a scale, and what they are made of, over it.

    Returns
    -------
    scale : float
    right_side : (n,) float32 ndarray
        What is to close the gaps.
    start : (n,) ndarray
        Pressure of the set.
    back : (m,) float32 ndarray
        By how much the pressures ``beyond`` change, which go to their ``bound``.
    wanted : float
        What the set is to carry of the load; NaN where none is given.
    """
    back = np.empty(beyond.size)
    scale, lacking = np.finfo(np.float64).tiny, load
    for value in pressure:
        lacking -= value
    for i in range(beyond.size):
        back[i] = bound[i] - pressure[beyond[i]]
        lacking -= back[i]
        scale = max(scale, abs(back[i]))
    for value in gap:
        scale = max(scale, abs(value))
    if np.isfinite(lacking):
        scale = max(scale, abs(lacking) / max(free.size, 1))
    right_side, start = np.empty(free.size, np.float32), np.empty(free.size)
    carried = 0.0
    for i in range(free.size):
        right_side[i], start[i] = -gap[i] / scale, pressure[free[i]] / scale
        carried += start[i]
    return scale, right_side, start, (back / scale).astype(np.float32), carried + lacking / scale


@njit(cache=True)
def _step(pressure, free, scale, step, at_zero, at_cap, cap):
    """Add a step to the pressure of some nodes.

    Those that it takes to a bound are put exactly there, where rounding leaves them next to it.
    """
    for i in range(free.size):
        if at_zero[i]:
            pressure[free[i]] = 0.0
        elif at_cap[i]:
            pressure[free[i]] = cap
        else:
            pressure[free[i]] += scale * step[i]
