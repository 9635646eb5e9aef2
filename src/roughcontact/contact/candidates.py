"""Candidates for contact: if few nodes can touch, the problem is solved on these alone.

Displacements are nowhere negative, as neither the influence nor the pressures are. So a node whose
clearance at first touch exceeds the closure has a gap, whatever the pressures, and is left out of
the search and of the verification. The others are the candidates. Under a given force the closure
is not known beforehand: candidates are chosen by a bound on it, from the next coarser grid, and
chosen again if the solution exceeds the bound. If they are few, an operator between them replaces
the convolution, and no array of the window's size is made: pair by pair for few pairs, else a fast
multipole method (`operator`, `elastic.direct`, `elastic.multipole`). Nested iteration proceeds as
usual, with candidates on each of its grids.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..elastic.block_pairs import MultipoleLevels
from ..elastic.halfspace import HalfSpace
from ..elastic.multipole import multipole_suits
from ..kernel_cache import njit
from .active_set import ActiveSetMethod
from .bounds import Bounds
from .kkt import Problem, Solution, coarser_load
from .nested_iteration import (
    COARSE_ITERATIONS,
    COARSE_RTOL,
    KEPT_CELLS,
    equalise_gaps,
    influence_on,
    nested_iteration_start,
    prolong,
    redistributions,
)
from .operator import Operator
from .preconditioner import forget_preconditioner
from .topography import Topography

#: Fewest nodes along the shorter side of a window, and of its coarser grids, for candidates. In
#: smaller windows a convolution takes no longer; on the coarser grids of larger ones the few
#: candidates of light contact take less time than the kernel's spectrum.
MIN_WINDOW, MIN_SIDE = 512, 64
#: Tightest tolerance for candidates, some hundred times the error of the operator between them.
MIN_RTOL = 1e-8
#: Candidates have a clearance below the given closure times this, so that all nodes that may touch
#: within the tolerance are among them.
MARGIN = 1.01
#: Bound on the closure under a given force: the closure of the coarser grid, increased by the
#: margin and by GROWTH times its last increase (FIRST_GROWTH on the coarsest); or FROM_LOAD times
#: the closure of another load, in proportion to the force, which rises faster than the closure; or
#: FURTHER times the closure of a solution beyond the bound.
GROWTH, FIRST_GROWTH, FROM_LOAD, FURTHER = 1.5, 0.25, 1.02, 1.1
#: Least ratio by which an application is cheaper on candidates of a load step that is restricted to
#: them, since coarser grids speed up a load step on the whole window.
STEP_GAIN = 2.0
#: Largest fraction of the nodes for which the cost of the operator is estimated at all.
MAX_CANDIDATES = 0.15
#: Candidates up to which the cost is not estimated. Pairs of so few nodes are summed one by one: in
#: double precision always, in single precision up to the MAX_PAIRS of `elastic.direct`, which 387
#: loaded nodes reach. Beyond these the multipole operator has few blocks.
FEW = 500
#: Cost of a batch of the operator, in units of a convolution's n log2(n); it includes the few more
#: applications of a solve on candidates. Measured from 512 x 512 to 2048 x 2048 at 1 to 5 % in
#: contact.
BATCH = 900.0


@dataclass(frozen=True)
class LoadCase:
    """Topography under a load, on its own grid or on a coarser one.

    Attributes
    ----------
    space : HalfSpace
    topography : Topography
    length : float
        Unit of length, mm.
    load : float
        The closure, or if ``by_force`` the sum of the pressures, in the units of `Problem`.
    by_force : bool
    bounds : Bounds
        Bounds of the pressure, uniform wherever candidates are chosen.
    level : int
        log2 of the cell side, relative to the topography's.
    """

    space: HalfSpace
    topography: Topography
    length: float
    load: float
    by_force: bool
    bounds: Bounds
    level: int = 0

    def coarser(self) -> "LoadCase":
        """Same case on the grid twice as coarse."""
        return replace(
            self,
            space=self.space.coarser(2),
            load=coarser_load(self.load, self.by_force),
            bounds=self.bounds.coarser(self.space.shape),
            level=self.level + 1,
        )

    def problem(self) -> Problem:
        """Problem on the whole window."""
        clearance = self.topography.clearance(self.level).ravel() / self.length
        return Problem(self.space, clearance, self.load, self.by_force, self.bounds)

    @cached_property
    def least_closure(self) -> float:
        """Lower bound on the closure of a given force: that of the bearing area that can carry it.

        No node carries more than its upper bound, and nodes in contact have no more clearance than
        the closure, as displacements are nowhere negative. 0 without an upper bound.
        """
        if not self.by_force or self.bounds.elastic:
            return 0.0
        total = self.space.shape[0] * self.space.shape[1]
        touching = min(max(math.ceil(self.load / self.bounds.upper), 1), total)
        return self.topography.bearing_clearance(touching, self.level) / self.length

    def restricted(
        self, bound: float, cells: np.ndarray | None, gain: float = 1.0
    ) -> "Restricted | None":
        """Problem on the candidates of a ``bound`` on the closure; None if it saves no time.

        ``cells``, (m,) int32, are cells of the next coarser grid that hold all candidates; an
        application must be ``gain`` times cheaper than a convolution.
        """
        total = self.space.shape[0] * self.space.shape[1]
        if self.load > MAX_CANDIDATES * total * self.bounds.upper and self.by_force:
            return None
        if bound < MARGIN * self.least_closure:
            bound, cells = MARGIN * self.least_closure, None
        nodes = self.topography.below(bound * self.length, self.level, cells)
        if nodes.size > MAX_CANDIDATES * total:
            return None
        levels = None
        if nodes.size > FEW:
            levels = MultipoleLevels(self.space.shape, nodes)
            if gain * levels.work * BATCH > total * np.log2(total):
                return None
        clearance = self.topography.clearance_at(nodes, self.level) / self.length
        problem = Problem(self.space, clearance, self.load, self.by_force, self.bounds, nodes)
        return Restricted(problem, bound, Operator(self.space, nodes, levels))


@dataclass
class Restricted:
    """Problem on candidates: all nodes whose clearance is below ``bound``."""

    problem: Problem
    bound: float
    operator: Operator

    @property
    def nodes(self) -> np.ndarray:
        """Candidates, (n,) int32: ascending numbers of cells."""
        assert self.problem.nodes is not None  # a restricted problem has them
        return self.problem.nodes

    def holds(self, solution: Solution) -> bool:
        """True if no other node can touch, within the tolerance either."""
        return not self.problem.by_force or solution.closure * MARGIN <= self.bound


def may_restrict(space: HalfSpace, rtol: float) -> bool:
    """True if the window and the tolerance are large enough for candidates.

    Windows that continue beyond their edges are excluded: some displacements are negative.
    """
    large = space.is_free and min(space.shape) >= MIN_WINDOW
    return large and MIN_RTOL <= rtol < MARGIN - 1 and multipole_suits(space)


def solve_nested(case: LoadCase, rtol: float) -> tuple[Problem, Solution]:
    """Cold solve by nested iteration, on candidates wherever that saves time.

    Returns the problem as it was solved, and its solution; the caller checks the residual.
    """
    start = _start(case)
    if start.restricted is None:
        return start.problem, ActiveSetMethod(start.problem, rtol).solve(start.pressure)
    return solve_restricted(case, start.restricted, start.pressure, None, rtol)


def solve_restricted(
    case: LoadCase,
    restricted: Restricted,
    start: np.ndarray,
    displacement: np.ndarray | None,
    rtol: float,
) -> tuple[Problem, Solution]:
    """Solve on candidates, and on more of them while the closure exceeds their bound.

    ``start``, (n,), is on the candidates and may be overwritten; ``displacement`` is K of it, if
    known. Returns as `solve_nested`.
    """
    applications = 0
    while True:
        problem = restricted.problem
        method = ActiveSetMethod(problem, rtol, restricted.operator)
        solution = method.solve(start, displacement)
        applications += solution.applications
        solution.applications = applications
        if restricted.holds(solution) or not solution.residual <= rtol:
            return problem, solution
        more = case.restricted(FURTHER * solution.closure, None)
        if more is None:
            whole = case.problem()
            start = np.zeros(whole.clearance.size)
            start[restricted.nodes] = solution.pressure
            solution = ActiveSetMethod(whole, rtol).solve(start)
            solution.applications += applications
            return whole, solution
        start = np.zeros(more.problem.clearance.size)
        start[np.searchsorted(more.nodes, restricted.nodes)] = solution.pressure
        restricted, displacement = more, None


@dataclass
class _Start:
    """Problem of a grid, its start, and the closure of the next coarser grid, if there is one."""

    problem: Problem
    restricted: Restricted | None
    pressure: np.ndarray
    coarse_closure: float = np.nan


def _start(case):
    """Start on a grid from the solution on the next coarser one, which is restricted likewise."""
    if min(case.space.shape) < MIN_SIDE:
        problem = case.problem()
        return _Start(problem, None, nested_iteration_start(problem))
    coarse_case = case.coarser()
    coarse = _start(coarse_case)
    operator = None if coarse.restricted is None else coarse.restricted.operator
    method = ActiveSetMethod(coarse.problem, COARSE_RTOL, operator, np.float32)
    solution = method.solve(coarse.pressure, min_iterations=COARSE_ITERATIONS)
    if coarse_case.space.shape[0] * coarse_case.space.shape[1] > KEPT_CELLS:
        forget_preconditioner(coarse_case.space)
    bound = _bound(case, solution.closure, coarse.coarse_closure)
    if coarse_case.bounds.reached_by(solution.pressure):
        growth = case.least_closure - coarse_case.least_closure
        bound = max(bound, MARGIN * (solution.closure + growth))
    # Each candidate lies in a coarse cell that is a candidate of the same bound there.
    if coarse.restricted is not None and bound <= coarse.restricted.bound:
        cells = coarse.restricted.nodes[coarse.problem.clearance < bound]
    else:
        cells = case.topography.below(bound * case.length, coarse_case.level, None)
    nodes, pressure = coarse.problem.nodes, solution.pressure / 2
    restricted = case.restricted(bound, cells)
    if restricted is not None:
        loaded = np.flatnonzero(pressure).astype(np.int32)
        cells = loaded if nodes is None else nodes[loaded]
        start = _prolonged(case, cells, pressure[loaded], restricted.nodes)
        return _Start(restricted.problem, restricted, start, solution.closure)
    problem = case.problem()
    if nodes is not None:
        window = np.zeros(coarse_case.space.shape[0] * coarse_case.space.shape[1])
        window[nodes] = pressure
        pressure = window
    pressure = pressure.reshape(coarse_case.space.shape)
    clearance = problem.clearance.reshape(case.space.shape)
    pressure = prolong(pressure, clearance, case.space.near_influence(4))
    return _Start(problem, None, case.bounds.clip(pressure.ravel()), solution.closure)


def _bound(case, closure, coarser_closure):
    """Bound on the closure from the closures of the two next coarser grids."""
    if not case.by_force:
        return MARGIN * case.load
    growth = closure / coarser_closure - 1 if np.isfinite(coarser_closure) else FIRST_GROWTH
    return closure * MARGIN * (MARGIN + GROWTH * max(growth, 0.0))


def _prolonged(case, cells, pressure, nodes):
    """Pressure of some nodes, prolonged from coarse cells as `prolong` does.

    The array spans the window, but only its pages near these cells are written and take memory.
    """
    ny, nx = case.space.shape
    my, mx = (ny + 1) // 2, (nx + 1) // 2
    padded = np.zeros((2 * my + 4, 2 * mx + 4))
    height = case.topography.height(case.level)
    _redistribute_cells(
        *(cells, pressure, padded, height, case.topography.highest, case.length),
        case.space.near_influence(4),
    )
    return case.bounds.clip(padded[nodes // nx + 2, nodes % nx + 2])


@njit(cache=True)
def _redistribute_cells(cells, coarse, padded, height, highest, length, influence):
    """Distribute the pressure of each cell over its nodes for even gaps, in place."""
    ny, nx = height.shape
    width = (nx + 1) // 2
    for cell in range(cells.size):
        top, side = 2 * (cells[cell] // width), 2 * (cells[cell] % width)
        for y in range(top, min(top + 2, ny)):
            for x in range(side, min(side + 2, nx)):
                padded[y + 2, x + 2] = coarse[cell]
    own, around = influence_on(influence)
    maps = redistributions(own)
    opening, pressure = np.zeros(4), np.zeros(4)
    for cell in range(cells.size):
        top, side = 2 * (cells[cell] // width), 2 * (cells[cell] % width)
        total, mask = 0.0, 0
        for a in range(4):
            y, x = top + a // 2, side + a % 2
            opening[a] = 0.0
            if y < ny and x < nx:
                opening[a] = (highest - float(height[y, x])) / length
                total += padded[y + 2, x + 2]
                mask |= 1 << a
        if not total > 0:
            continue
        for i in range(6):
            for j in range(6):
                value = padded[top + i, side + j]
                for a in range(4):
                    opening[a] += around[i, j, a] * value
        equalise_gaps(maps, opening, total, mask, pressure)
        for a in range(4):
            if mask & (1 << a):
                padded[top + a // 2 + 2, side + a % 2 + 2] = pressure[a]
