"""Frictionless elastic contact of a composite topography with a rigid plane.

With the gap g = K p + (max h - h) - w at the nodes, a state of contact has p >= 0, g >= 0, p g = 0;
where the force is given its sum of p is fixed and w is free. That is the minimum of a strictly
convex quadratic under p >= 0, found by a projected Newton method (Bertsekas 1982). Outside, the
contact set is corrected at once wherever pressure is negative or the gap closed. Inside, conjugate
gradients on that set, preconditioned with the half-space's own |q|/2, run in single precision on a
double-precision residual. The conditions are checked in double precision before anything returns.
"""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from .halfspace import HalfSpace

# Corrections of the contact set before the solver gives up: trials needed at most 15 up to 2048^2.
MAX_CORRECTIONS = 200
# The inner solve is stopped at this share of its first residual: solving for a set that will still
# change is wasted, and trials found the total nearly flat between 0.03 and 0.7.
INNER_REDUCTION = 0.1
# Single precision carries a correction down to this share of its right side.
SINGLE_REACHES = 1e-5
# A total this close to F is F: the closure is then read from the gap itself.
FORCE_ROUNDING = 1e-12
# Inner iterations for one correction; on an exact set 14-27 reach 1e-6.
MAX_INNER = 200
# Aim this far below the tolerance, so that one correction too many is rarer than one too few.
SAFETY = 0.3
# A coarser grid gives the start until its shorter side has fewer nodes than this.
COARSEST = 24
# The coarse solution is only a start.
COARSE_RTOL = 3e-2


@dataclass(frozen=True)
class ContactState:
    """A state of contact that satisfies the conditions to ``residual``.

    Attributes
    ----------
    pressure : (ny, nx) ndarray
        p, MPa, zero outside the contact domain.
    displacement : (ny, nx) ndarray
        Elastic displacement u = K p of the composite surface, mm.
    gap : (ny, nx) ndarray
        Remaining opening, mm; within ``residual`` of zero in contact.
    closure : float
        w from first touch, mm.
    force : float
        F, N.
    residual : float
        Largest violation of the contact conditions, as a share of the closure.
    iterations : int
        Applications of the elastic operator, whatever their precision, coarse starts not counted.
    space : HalfSpace
        The operator it was solved with.
    """

    pressure: np.ndarray
    displacement: np.ndarray
    gap: np.ndarray
    closure: float
    force: float
    residual: float
    iterations: int
    space: HalfSpace = field(repr=False)

    @property
    def in_contact(self):
        """Contact domain, (ny, nx) bool: the nodes that carry pressure."""
        return self.pressure > 0

    @property
    def area(self):
        """A_r = N s^2, mm2."""
        return float(np.count_nonzero(self.in_contact)) * self.space.cell_area

    @cached_property
    def stiffness(self):
        """Normal stiffness dF/dw, N/mm, from H q = 1 on the contact set; 0 without contact.

        Raises
        ------
        NotConverged
            If that linear problem is not solved to 1e-6.
        """
        contact = self.in_contact
        if not contact.any():
            return 0.0
        unit = _solve_on_set(self.space, contact, np.ones(np.count_nonzero(contact)), 1e-6)
        if unit.error > 1e-6:
            raise NotConverged("the stiffness equations on the contact set", self, unit.error)
        return float(unit.solution.sum()) * self.space.modulus * self.space.cell


class NotConverged(RuntimeError):
    """No state satisfying the contact conditions was reached.

    Attributes
    ----------
    reason : str
    state : ContactState
        The best state reached; its ``residual`` says how far it is from being one.
    residual : float
    """

    def __init__(self, reason, state, residual):
        super().__init__(f"contact not solved: {reason}; best residual {residual:.3g}")
        self.reason, self.state, self.residual = reason, state, residual

    def __reduce__(self):
        return type(self), (self.reason, self.state, self.residual)


def solve_contact(composite, space, *, closure=None, force=None, start=None, rtol=1e-6):
    """Press a composite topography against a rigid plane.

    Parameters
    ----------
    composite : (ny, nx) array_like
        Composite topography h, mm; the largest h touches first.
    space : HalfSpace
        The elastic operator on the same grid.
    closure : float, optional
        w, mm, from first touch. Either this or ``force`` is given.
    force : float, optional
        F, N.
    start : ContactState, optional
        A state of the same grid to start from, such as the previous load step.
    rtol : float
        Largest violation allowed of gap and pressure conditions, as a share of the closure.

    Returns
    -------
    ContactState

    Raises
    ------
    ValueError
        If the topography has missing cells or another shape, or the load makes no sense.
    NotConverged
        If the conditions are not met to ``rtol``.
    """
    height = np.asarray(composite, float)
    load = checked_load(height, space, closure, force, start, rtol)
    clearance = height.max() - height
    if load == 0:
        return unloaded_state(space, clearance)
    problem = _Problem(space, clearance, load, force is not None)
    if start is not None:
        pressure = start.pressure / problem.pressure_unit
    else:
        pressure = _coarse_start(problem)
    solution = _newton(problem, pressure, rtol)
    state = solution.to_state()
    if not state.residual <= rtol:
        reason = f"the contact set still changed after {MAX_CORRECTIONS} corrections"
        raise NotConverged(reason, state, state.residual)
    return state


def checked_load(height, space, closure, force, start, rtol):
    """The closure or force given, after every argument of `solve_contact` was found sound."""
    if height.shape != space.shape:
        raise ValueError(f"composite topography {height.shape} on a half-space of {space.shape}")
    if not np.isfinite(height).all():
        missing = np.count_nonzero(~np.isfinite(height))
        raise ValueError(f"the composite topography has {missing} missing or infinite cells")
    if (closure is None) == (force is None):
        raise ValueError("give either closure= or force=")
    load = float(closure if force is None else force)
    if not np.isfinite(load) or load < 0:
        raise ValueError(f"{'closure' if force is None else 'force'} {load}: expected >= 0")
    if start is not None and start.pressure.shape != space.shape:
        raise ValueError(f"start of shape {start.pressure.shape} for a grid of {space.shape}")
    if not 0 < rtol < 1:
        raise ValueError(f"rtol {rtol}: expected between 0 and 1")
    return load


def unloaded_state(space, clearance):
    """The state of first touch: no pressure, no closure."""
    zero = np.zeros(space.shape)
    return ContactState(zero, zero.copy(), clearance, 0.0, 0.0, 0.0, 0, space)


class _Problem:
    """The contact problem in units in which loads are near one: nothing depends on mm or MPa."""

    def __init__(self, space, clearance, load, by_force):
        self.space, self.by_force = space, by_force
        stress_per_length = space.modulus / space.cell
        if by_force:
            self.pressure_unit = load / (space.cell_area * clearance.size)
            self.length_unit = self.pressure_unit / stress_per_length
            self.load = float(clearance.size)
        else:
            self.length_unit = load
            self.pressure_unit = load * stress_per_length
            self.load = 1.0
        self.clearance = clearance / self.length_unit

    def first_touch(self):
        """The given force on the nodes that touch first, where nothing better is known.

        Forces so small that the depths of all other nodes drown theirs leave no other start.
        """
        touching = self.clearance == 0
        return touching * (self.load / np.count_nonzero(touching))


@dataclass
class _Solution:
    """Where the iteration stands, in the problem's units."""

    problem: _Problem
    pressure: np.ndarray
    displacement: np.ndarray
    closure: float
    residual: float
    iterations: int = 0

    def to_state(self):
        length, stress = self.problem.length_unit, self.problem.pressure_unit
        space = self.problem.space
        pressure = self.pressure * stress
        gap = (self.displacement + self.problem.clearance - self.closure) * length
        return ContactState(
            pressure=pressure,
            displacement=self.displacement * length,
            gap=gap,
            closure=self.closure * length,
            force=float(pressure.sum()) * space.cell_area,
            residual=self.residual,
            iterations=self.iterations,
            space=space,
        )


def _newton(problem, pressure, rtol):
    """Projected Newton iteration from any start; the caller checks ``residual``."""
    space, load = problem.space, problem.load
    pressure = np.maximum(pressure, 0.0)
    closure = load
    if problem.by_force:
        loaded = pressure if pressure.any() else problem.first_touch()
        pressure = loaded * (load / loaded.sum())
        closure = None
    best, iterations = None, 0
    for _ in range(MAX_CORRECTIONS):
        displacement = space.convolve(pressure)
        iterations += 1
        gap = displacement + problem.clearance
        contact = pressure > 0
        lacking = load - pressure.sum() if problem.by_force else 0.0
        if problem.by_force and (closure is None or abs(lacking) <= FORCE_ROUNDING * load):
            closure = gap[contact].mean()
        gap -= closure
        # A step may overshoot to w < 0, which no state has: u >= 0, so its gaps then exceed |w|.
        residual = max(
            np.abs(gap[contact]).max(initial=0.0) / abs(closure),
            -gap.min() / abs(closure),
            abs(lacking) / load,
        )
        if best is None or residual < best.residual:
            best = _Solution(problem, pressure, displacement, closure, residual)
        if residual <= rtol:
            break
        contact |= gap < 0
        step = _solve_on_set(
            space,
            contact,
            -gap[contact],
            max(INNER_REDUCTION, SAFETY * rtol / residual),
            total=lacking if problem.by_force else None,
        )
        iterations += step.applications
        closure += step.common
        pressure = pressure.copy()
        pressure[contact] += step.solution
        np.maximum(pressure, 0.0, out=pressure)
        if problem.by_force:
            if not pressure.any():
                pressure = problem.first_touch()
            # A common factor restores F where it disturbs the gap less than the tolerance. Larger
            # ones were seen to make the set swing for ever: there the next step restores F.
            factor = load / pressure.sum()
            if abs(factor - 1) < SAFETY * rtol:
                pressure *= factor
    best.iterations = iterations
    return best


@dataclass
class _LinearSolution:
    """Solution on a contact set: its error as a share of the right side, and what it cost."""

    solution: np.ndarray
    common: float
    error: float
    applications: int


def _solve_on_set(space, contact, right_side, reduction, *, total=None):
    """Preconditioned conjugate gradients for K x = right_side on the contact set.

    With ``total``, x has that sum and the equations hold up to a common constant, the change of
    closure that a given force leaves free (projected method of Gould, Hribar and Nocedal, 2001).
    """
    precision = np.float32 if reduction > SINGLE_REACHES else np.float64
    grid = np.zeros(space.shape, precision)

    def on_set(operator, values):
        grid[contact] = values
        return operator(grid)[contact]

    scale = max(np.abs(right_side).max(), np.finfo(float).tiny)
    residual = (right_side / scale).astype(precision)
    solution = np.zeros_like(residual)
    common, applications = 0.0, 0
    if total is not None:
        ones = on_set(space.precondition, np.ones_like(residual))
        ones_total = ones.sum(dtype=float)
        if total != 0:
            solution = precision(total / scale / ones_total) * ones
            residual -= on_set(space.convolve, solution)
            applications += 1
    direction, previous = np.zeros_like(residual), np.inf
    while True:
        search = on_set(space.precondition, residual)
        if total is not None:
            offset = precision(search.sum(dtype=float) / ones_total)
            search -= offset * ones
            residual -= offset
            common -= float(offset) * scale
        error = float(np.abs(residual).max())
        if error <= reduction or applications >= MAX_INNER:
            break
        slope = float(np.dot(residual, search))
        direction *= precision(slope / previous)
        direction += search
        image = on_set(space.convolve, direction)
        applications += 1
        length = precision(slope / float(np.dot(direction, image)))
        solution += length * direction
        residual -= length * image
        previous = slope
    return _LinearSolution(solution.astype(float) * scale, common, error, applications)


def _coarse_start(problem):
    """Pressure to start from: the solution on the topography pooled 2 x 2, spread out."""
    space = problem.space
    ny, nx = space.shape
    if min(ny, nx) < COARSEST:
        return np.ones(space.shape)
    pooled = _pool_minimum(problem.clearance)
    dy, dx = space.spacing
    coarse_space = HalfSpace(pooled.shape, (2 * dy, 2 * dx), space.modulus, kernel=space.kernel)
    load = problem.load * problem.length_unit
    if problem.by_force:
        load = problem.load * problem.pressure_unit * space.cell_area
    coarse = _Problem(coarse_space, pooled * problem.length_unit, load, problem.by_force)
    solution = _newton(coarse, _coarse_start(coarse), COARSE_RTOL)
    pressure = solution.pressure * (coarse.pressure_unit / problem.pressure_unit)
    return np.repeat(np.repeat(pressure, 2, axis=0), 2, axis=1)[:ny, :nx]


def _pool_minimum(clearance):
    """Smallest clearance of each 2 x 2 nodes, an odd last row or column standing alone."""
    ny, nx = clearance.shape
    padded = np.pad(clearance, ((0, ny % 2), (0, nx % 2)), constant_values=np.inf)
    return padded.reshape((ny + 1) // 2, 2, (nx + 1) // 2, 2).min(axis=(1, 3))
