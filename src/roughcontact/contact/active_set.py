"""Active-set iteration for the contact problem: pressures between bounds, an unknown closure.

The active contact set of an iterate holds the nodes between the bounds and those at a bound that
the gap pulls off it (`kkt`). On it the gap is made to vanish: first by the whole step of the sparse
inverse-Cholesky preconditioner, clipped at the bounds, so that nodes leave the set in the same
application of K that moves the others; then by conjugate gradients on the nodes that stay. In the
first iterations of a load step the set is predicted: nodes that a step would take to a bound are
left out, and the step is computed again on the others, before K is applied at all. Directions and
their images are in single precision; the returned state is verified on a displacement in double
precision. (Primal-dual active sets, a semismooth Newton method: M. Hintermueller, K. Ito and K.
Kunisch, SIAM J. Optim. 13 (2002) 865. The whole solver on one page:
packages/roughcontact/docs/solver.md.)
"""

from dataclasses import dataclass
from enum import Enum, auto

import numpy as np

from ..kernel_cache import njit
from .bounds import Bounds
from .feasible import first_iterate, verified
from .kkt import Iterate, KKTResidual, Problem, Solution, kkt_residual
from .node_sets import symmetric_difference
from .operator import Operator
from .projected_cg import ProjectedCG, add
from .projected_step import closure_of_step
from .safeguards import (
    SAFETY,
    many_iterations,
    many_iterations_under_force,
    newton_on_closure,
    without_entering,
)

# Iterations before the solver gives up; trials needed at most some twenty.
MAX_ITERATIONS = 200
# An inexact linear solve stops at a fraction of the scale of its equations, as the set will change:
# REDUCTION times the fraction of the set that changed last, within the limits. The scale is the
# largest of the gaps on the set, the changes of nodes put at a bound, and the missing force per
# node. A solve against cycling is nearly exact.
REDUCTION, MIN_REDUCTION, MAX_REDUCTION = 3.0, 0.03, 0.3
EXACT_REDUCTION = 1e-3
# Iterations with set prediction; in all of them sets might cycle. It is used only from another
# state, in windows that are not small: after nested iteration it saves applications but no time.
# At most MAX_LEFT_OUT of the set is left out: if most nodes yield, the few others would have to
# carry all the missing force.
SET_PREDICTIONS, MAX_LEFT_OUT = 2, 0.5
# Largest violation, in tolerances, at which the preconditioned step is made alone and verified in
# double precision at once, since it is expected to be the last. This is done once, and not between
# candidates, where double precision takes as long as several steps.
SINGLE_STEP_BELOW = 2.0
# Violation, as a fraction of the closure, below which a step in single precision gains little.
SINGLE_PRECISION_FLOOR = 1e-5
# Largest clearance, in the problem's unit of length, for judging a start in single precision:
# beyond it the rounding may exceed the closure.
SINGLE_PRECISION_CLEARANCE = 1e6
# Bounds of a step that is not clipped.
UNBOUNDED = Bounds(-np.inf, np.inf)
_FLOAT64 = np.dtype(np.float64)


class LinearSolve(Enum):
    """Accuracy of the linear solve on an active set."""

    #: As accurate as the set is known: the usual case.
    INEXACT = auto()
    #: The preconditioned step alone, verified at once, where it should be the last.
    SINGLE_STEP = auto()
    #: Nearly exact and without clipping, after many iterations under a given closure.
    EXACT = auto()


@dataclass(frozen=True)
class WorkingSet:
    """Active nodes of one iteration, and nodes ``fixed`` at a ``bound``; int32 numbers of nodes."""

    active: np.ndarray
    fixed: np.ndarray
    bound: np.ndarray

    def without(self, left_out: np.ndarray, bound: np.ndarray) -> "WorkingSet":
        """Same set with some active nodes, (n,) bool, moved to a bound."""
        return WorkingSet(
            self.active[~left_out],
            np.concatenate([self.fixed, self.active[left_out]]),
            np.concatenate([self.bound, bound]),
        )


class ActiveSetMethod:
    """The iteration, from any start to a verified solution.

    Parameters
    ----------
    problem : Problem
    rtol : float
        Largest violation allowed, as a fraction of the closure.
    operator : Operator, optional
        Shared with other solves, so that their applications are counted together.
    dtype : type
        Precision of the verification: float32 if the solution is only a start on a finer grid.
    """

    def __init__(
        self,
        problem: Problem,
        rtol: float,
        operator: Operator | None = None,
        dtype: type = np.float64,
    ):
        if operator is None:
            operator = Operator(problem.space, problem.nodes)
        _check_on_nodes(problem.clearance, "clearance", operator)
        self.problem, self.rtol, self.operator = problem, rtol, operator
        wide = problem.clearance.max(initial=0.0) > SINGLE_PRECISION_CLEARANCE
        self._dtype = np.float64 if wide else dtype

    def solve(
        self,
        pressure: np.ndarray,
        displacement: np.ndarray | None = None,
        *,
        min_iterations: int = 0,
    ) -> Solution:
        """Iterate until a state is verified, or MAX_ITERATIONS; the caller checks the residual.

        ``pressure``, (n,), is the start and may violate the bounds; ``displacement`` is K of it, if
        known. Both are overwritten. ``min_iterations`` are made even from a start within tolerance,
        unless its violations are below SINGLE_PRECISION_FLOOR.
        """
        problem, operator, rtol = self.problem, self.operator, self.rtol
        _check_on_nodes(pressure, "pressure", operator)
        if displacement is not None:
            _check_on_nodes(displacement, "displacement", operator)
        # States of this half-space at other loads come with a displacement. A start without one was
        # prolonged from a coarser grid, and its set is nearly right, or belongs to another
        # half-space. On grids that only give a start (``min_iterations``) prediction gains nothing.
        from_load_step = displacement is not None and not min_iterations
        predictions = SET_PREDICTIONS if from_load_step and not operator.inverse.small else 0
        iterate = first_iterate(problem, operator, pressure, displacement)
        previous_active, violation = np.empty(0, np.int32), 0.0
        single_step_left = problem.nodes is None
        for iteration in range(MAX_ITERATIONS):
            # Safeguards: Newton's method under a given force, exact solves under a given closure.
            newton = many_iterations_under_force(iteration, violation, problem.tolerated(iterate))
            exact = many_iterations(iteration)
            if problem.by_force and newton:
                start = verified(problem, operator, iterate)
                return newton_on_closure(problem, rtol, operator, start, self._solve_closure)
            kkt = self._kkt_residual(iterate)
            unit = problem.tolerated(iterate)
            may_end = iteration >= min_iterations or kkt.holds_to(SINGLE_PRECISION_FLOOR, unit)
            if may_end and kkt.holds_to(rtol, unit):
                iterate = solution = verified(problem, operator, iterate, self._dtype)
                if solution.residual <= rtol:
                    return solution
                kkt = self._kkt_residual(iterate)
            violation = kkt.largest
            if exact:
                kkt = without_entering(kkt, iterate.pressure, problem.bounds)
            single_step = may_end and single_step_left
            linear_solve = self._linear_solve(kkt, problem.tolerated(iterate), exact, single_step)
            operator.precondition(kkt.active, fresh=iteration == 0)
            reduction = _reduction(linear_solve, previous_active, kkt.active)
            self._step(iterate, kkt, linear_solve, reduction, predict=iteration < predictions)
            previous_active = kkt.active
            if linear_solve is LinearSolve.SINGLE_STEP:
                # Only once: if one step gains too little, conjugate gradients must follow.
                single_step_left = False
                iterate = solution = verified(problem, operator, iterate, self._dtype)
                if solution.residual <= rtol:
                    return solution
        return verified(problem, operator, iterate, self._dtype)

    def _linear_solve(self, kkt, unit, exact, single_step):
        """Kind of linear solve: ``exact`` as a safeguard, or ``single_step`` while one is left."""
        if exact:
            return LinearSolve.EXACT
        if single_step and kkt.holds_to(SINGLE_STEP_BELOW * self.rtol, unit):
            return LinearSolve.SINGLE_STEP
        return LinearSolve.INEXACT

    def _solve_closure(self, problem, rtol, start):
        """Solution of the same problem under a given closure."""
        method = ActiveSetMethod(problem, rtol, self.operator)
        return method.solve(start.pressure, start.displacement)

    def _kkt_residual(self, iterate):
        """KKT residual of an iterate; where nodes yield, its closure becomes that of a step."""
        problem = self.problem
        iterate.closure = closure_of_step(problem, iterate)
        return kkt_residual(
            iterate.pressure,
            iterate.displacement,
            problem.clearance,
            iterate.closure,
            problem.bounds,
        )

    def _step(
        self,
        iterate: Iterate,
        kkt: KKTResidual,
        linear_solve: LinearSolve,
        reduction: float,
        *,
        predict: bool,
    ) -> None:
        """One step on the active set, in place.

        ``reduction`` is the fraction of the equations' scale at which the linear solve stops. After
        a single step the displacement is left to the verification. With ``predict``, nodes that the
        first step takes to a bound are left out of the set. Conjugate gradients and unclipped steps
        may take pressures beyond their bounds; the next iteration puts these ``infeasible`` nodes
        at them.
        """
        clipped = linear_solve is not LinearSolve.EXACT
        bound = self.problem.bounds.at(kkt.infeasible).clip(iterate.pressure[kkt.infeasible])
        working = WorkingSet(kkt.active, kkt.infeasible, bound)
        equations, change, scale = self._preconditioned_step(iterate, working, clipped)
        leaving = equations.at_lower | equations.at_upper
        if predict and 0 < np.count_nonzero(leaving) <= MAX_LEFT_OUT * leaving.size:
            left = self.problem.bounds.at(working.active[leaving])
            bound = np.where(equations.at_lower[leaving], left.lower, left.upper)
            working = working.without(leaving, bound)
            self.operator.precondition(working.active, fresh=False)
            equations, change, scale = self._preconditioned_step(iterate, working, clipped)
        if linear_solve is not LinearSolve.SINGLE_STEP:
            equations.apply_step(working.fixed, change)
            wanted = SAFETY * self.rtol * self.problem.tolerated(iterate) / scale
            equations.iterate(max(reduction, wanted), by_force=self.problem.by_force)
            add(iterate.displacement, scale, equations.image)
        iterate.pressure[working.fixed] = working.bound
        _add_step(
            *(iterate.pressure, working.active, scale, equations.solution),
            *(equations.at_lower, equations.at_upper),
            *self.problem.bounds.on(iterate.pressure.size),
        )
        iterate.closure += scale * equations.multiplier

    def _preconditioned_step(self, iterate, working, clipped):
        """Equations on a set after their first step, changes of the fixed nodes, and the scale.

        All numbers are divided by the scale.
        """
        problem = self.problem
        gap = iterate.displacement[working.active] + problem.clearance[working.active]
        gap -= iterate.closure
        scale, right_side, start, change, carried = _scaled(
            *(iterate.pressure, gap, working.active, working.fixed, working.bound),
            problem.load if problem.by_force else np.nan,
        )
        equations = ProjectedCG(self.operator, working.active, right_side)
        bounds = problem.bounds.at(working.active).over(scale) if clipped else UNBOUNDED
        equations.clipped_step(start, bounds, carried if problem.by_force else None)
        return equations, change, scale


def _reduction(linear_solve, previous_active, active):
    """Fraction of its scale at which the linear solve on an active set stops."""
    if linear_solve is LinearSolve.EXACT:
        return EXACT_REDUCTION
    changed = symmetric_difference(previous_active, active).size / max(active.size, 1)
    return min(max(REDUCTION * changed, MIN_REDUCTION), MAX_REDUCTION)


def _check_on_nodes(values, name, operator):
    """`ValueError` for arrays without one float64 for each node."""
    nodes = (operator.size,)
    if values.shape != nodes or values.dtype != _FLOAT64:
        raise ValueError(f"{name} {values.shape} of {values.dtype}: expected {nodes} of float64")


@njit(cache=True)
def _scaled(pressure, gap, active, fixed, bound, load):
    """Scale of the equations on a set, and their values divided by it.

    Returns the scale, the right side (n,) float32 that closes the gaps, the pressure of the set
    (n,), the change of the ``fixed`` nodes' pressures to their ``bound``, (m,) float32, and the
    load to be carried by the set; NaN if none is given.
    """
    change = np.empty(fixed.size)
    scale, lacking = np.finfo(np.float64).tiny, load
    for value in pressure:
        lacking -= value
    for i in range(fixed.size):
        change[i] = bound[i] - pressure[fixed[i]]
        lacking -= change[i]
        scale = max(scale, abs(change[i]))
    for value in gap:
        scale = max(scale, abs(value))
    if np.isfinite(lacking):
        scale = max(scale, abs(lacking) / max(active.size, 1))
    right_side, start = np.empty(active.size, np.float32), np.empty(active.size)
    carried = 0.0
    for i in range(active.size):
        right_side[i], start[i] = -gap[i] / scale, pressure[active[i]] / scale
        carried += start[i]
    return scale, right_side, start, (change / scale).astype(np.float32), carried + lacking / scale


@njit(cache=True)
def _add_step(pressure, active, scale, step, at_lower, at_upper, lower, upper):
    """Add a step to the pressure of the active nodes.

    Nodes that it takes to a bound are set exactly to it, where the sum would be rounded.
    """
    for i in range(active.size):
        if at_lower[i]:
            pressure[active[i]] = lower[active[i]]
        elif at_upper[i]:
            pressure[active[i]] = upper[active[i]]
        else:
            pressure[active[i]] += scale * step[i]
