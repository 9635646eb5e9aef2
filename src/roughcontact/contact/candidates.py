"""Candidates for contact: where few nodes can touch, the problem is solved on these alone.

Displacements are nowhere negative, as neither the influence nor the pressures are. So a node whose
clearance at first touch exceeds the closure has a gap, whatever the pressures: it need not be
looked at, neither in the search nor in the verification. The others are the candidates. Under a
given force the closure is not known before: candidates are chosen by a bound on it, from the next
coarser grid, and chosen anew if the solution turns out to be beyond the bound. Where they are few,
an operator between them takes the place of the convolution, and no array of the window's size is
made: pair by pair where pairs are few, else a fast multipole method (`operator`, `elastic.direct`,
`elastic.multipole`). Nested iteration goes on as always, with candidates on each of its grids.
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

#: On windows of fewer nodes along the shorter side a convolution takes no longer; on coarser grids
#: of larger ones the few candidates of light contact take less than the kernel's spectrum.
MIN_WINDOW, MIN_SIDE = 512, 64
#: Tighter tolerances are left to the convolution: this is some hundred times the error of the
#: operator between candidates.
MIN_RTOL = 1e-8
#: Candidates are those whose clearance is below a given closure times this: nodes that may or may
#: not touch within the tolerance are among them.
MARGIN = 1.01
#: The bound on the closure under a given force is that of the coarser grid, increased by the margin
#: and by this many times what it increased by to there (on the coarsest, by a fraction). Or it is
#: that of another load in proportion to the force, which rises faster than the closure, or of a
#: solution beyond the bound, times a factor.
GROWTH, FIRST_GROWTH, FROM_LOAD, FURTHER = 1.5, 0.25, 1.02, 1.1
#: A load step on the whole window has help from coarser grids: it is restricted only if an
#: application is this many times cheaper.
STEP_GAIN = 2.0
#: Where more of the nodes than this are candidates it is not asked what the operator would take.
MAX_CANDIDATES = 0.15
#: Nor where they are no more than this. Pairs of so few nodes are then summed one by one: in double
#: precision always, in single precision up to the MAX_PAIRS of `elastic.direct`, which are reached
#: by 387 nodes that are all loaded. Beyond these the multipole operator has few blocks.
FEW = 500
#: A batch of the operator takes as long as a convolution where nodes times their log2 is this many,
#: and solves on candidates take some more applications: measured from 512 x 512 to 2048 x 2048, at
#: 1 to 5 % in contact.
BATCH = 900.0


@dataclass(frozen=True)
class LoadCase:
    """A topography under a load, on the grid that is asked for and on coarser ones.

    Attributes
    ----------
    space : HalfSpace
    topography : Topography
    length : float
        Unit of length, mm.
    load : float
        The closure, or the sum of the pressures, in units as in `Problem`.
    by_force : bool
        Which of the two.
    bounds : Bounds
        Of the pressure, the same on all nodes wherever candidates are chosen.
    level : int
        How many times coarser than that of the topography the grid is, as a power of two.
    """

    space: HalfSpace
    topography: Topography
    length: float
    load: float
    by_force: bool
    bounds: Bounds
    level: int = 0

    def coarser(self) -> "LoadCase":
        """The same on a grid twice as coarse."""
        return replace(
            self,
            space=self.space.coarser(2),
            load=coarser_load(self.load, self.by_force),
            bounds=self.bounds.coarser(self.space.shape),
            level=self.level + 1,
        )

    def problem(self) -> Problem:
        """The problem on the whole window."""
        clearance = self.topography.clearance(self.level).ravel() / self.length
        return Problem(self.space, clearance, self.load, self.by_force, self.bounds)

    @cached_property
    def least_closure(self) -> float:
        """Lower bound on the closure of a given force: that of the bearing area that can carry it.

        No node carries more than its bound, and what touches has no more clearance than the
        closure, as displacements are nowhere negative. 0 without an upper bound.
        """
        if not self.by_force or self.bounds.elastic:
            return 0.0
        total = self.space.shape[0] * self.space.shape[1]
        touching = min(max(math.ceil(self.load / self.bounds.upper), 1), total)
        return self.topography.bearing_clearance(touching, self.level) / self.length

    def restricted(
        self, bound: float, cells: np.ndarray | None, gain: float = 1.0
    ) -> "Restricted | None":
        """The problem on candidates of a bound on the closure, if that takes less time.

        Parameters
        ----------
        bound : float
        cells : (m,) int32 ndarray or None
            Cells of the next coarser grid that hold all candidates.
        gain : float
            How many times less an application has to take.
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
    """A problem on candidates.

    Attributes
    ----------
    problem : Problem
        On its nodes alone, the candidates.
    bound : float
        All nodes of smaller clearance are candidates.
    operator : Operator
    """

    problem: Problem
    bound: float
    operator: Operator

    @property
    def nodes(self) -> np.ndarray:
        """The candidates, (n,) int32: numbers of cells, ascending."""
        assert self.problem.nodes is not None  # it is on these alone
        return self.problem.nodes

    def holds(self, solution: Solution) -> bool:
        """True if no node that is not a candidate can touch, within the tolerance either."""
        return not self.problem.by_force or solution.closure * MARGIN <= self.bound


def may_restrict(space: HalfSpace, rtol: float) -> bool:
    """True if the window is so large, and the tolerance such, that candidates may pay.

    Not of windows that go on beyond their edges: their displacements are negative somewhere.
    """
    large = space.is_free and min(space.shape) >= MIN_WINDOW
    return large and MIN_RTOL <= rtol < MARGIN - 1 and multipole_suits(space)


def solve_nested(case: LoadCase, rtol: float) -> tuple[Problem, Solution]:
    """Cold solve by nested iteration, on candidates wherever that takes less time.

    Returns
    -------
    problem : Problem
        What was solved: on candidates, or on the whole window.
    solution : Solution
        The caller checks its residual.
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

    Parameters
    ----------
    case : LoadCase
    restricted : Restricted
    start : (n,) ndarray
        On the candidates; may be overwritten.
    displacement : (n,) ndarray or None
        K of it, where known.
    rtol : float

    Returns
    -------
    problem : Problem
    solution : Solution
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
    """The problem of a grid, restricted or not, and where its solve starts.

    And the closure of the next coarser grid, where there is one.
    """

    problem: Problem
    restricted: Restricted | None
    pressure: np.ndarray
    coarse_closure: float = np.nan


def _start(case):
    """The start on a grid: from the solution on the next coarser one, restricted likewise."""
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
    # Whatever is a candidate here lies in a cell that is one of the same bound there.
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
    """Bound of the closure from those of the two next coarser grids."""
    if not case.by_force:
        return MARGIN * case.load
    growth = closure / coarser_closure - 1 if np.isfinite(coarser_closure) else FIRST_GROWTH
    return closure * MARGIN * (MARGIN + GROWTH * max(growth, 0.0))


def _prolonged(case, cells, pressure, nodes):
    """Pressure of some nodes from that of coarse cells: as `prolong` does.

    Memory is taken for the neighbourhood of these cells alone.
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
