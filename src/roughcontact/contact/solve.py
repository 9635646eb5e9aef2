"""Frictionless elastic contact of a composite topography with a rigid plane.

A state of contact has pressures p >= 0 and gaps g = u + (max h - h) - w >= 0 with p g = 0, u = K p;
if the force is given, the sum of p is fixed and w is free. With a hardness H the pressure is
limited to H, and nodes there may be pressed in. `active_set` and the page
packages/roughcontact/docs/solver.md describe how such a state is found. Here loads become
dimensionless, starts are chosen, and results are verified.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arguments import field, number, quoted
from ..elastic.halfspace import HalfSpace
from ..errors import NotConverged, interruptible
from ..limits import MAX_INPUT, MAX_RESULT, MIN_INPUT, MIN_RESULT
from .active_set import ActiveSetMethod
from .bounds import Bounds
from .candidates import (
    FROM_LOAD,
    MARGIN,
    STEP_GAIN,
    LoadCase,
    may_restrict,
    solve_nested,
    solve_restricted,
)
from .effort import SOLVING
from .full_approximation import full_approximation_start
from .nested_iteration import nested_iteration_start
from .state import Candidates, CandidateState, ContactState, unloaded_state
from .topography import HasHeights, Topography

# Largest extrapolation of earlier states, in steps between them.
FURTHEST = 2.0


@interruptible()
def solve_contact(
    composite: ArrayLike | HasHeights,
    space: HalfSpace,
    *,
    closure: float | None = None,
    force: float | None = None,
    mean_pressure: float | None = None,
    start: ContactState | None = None,
    rtol: float = 1e-6,
    hardness: float | ArrayLike | None = None,
) -> ContactState:
    """State of contact of a composite topography with a rigid plane.

    Parameters
    ----------
    composite : (ny, nx) array_like, or an object with ``heights()``
        Heights of the composite topography h, mm; the largest h touches first. A topography of
        SurfaceTopography has its first axis along x: ``HalfSpace(t.nb_grid_pts, t.pixel_size, E)``.
    space : HalfSpace
        The elastic operator on the same grid.
    closure : float, optional
        w, mm, from first touch: the rigid-body approach. One of ``closure``, ``force`` and
        ``mean_pressure`` is given.
    force : float, optional
        F, N.
    mean_pressure : float, optional
        F over the area of the window, MPa.
    start : ContactState, optional
        A state on the same grid to start from, such as that of the previous load.
    rtol : float
        Largest violation allowed of the gap and pressure conditions, as a fraction of the closure;
        under a given force also of the force, as a fraction of it.
    hardness : float or (ny, nx) array_like, optional
        H, MPa, of the surface or of each node: the pressure at which it yields (elastic, then
        perfectly plastic). Infinite at elastic nodes.

    Returns
    -------
    ContactState

    Raises
    ------
    ValueError
        If the topography has missing or masked cells or another shape, the start is not on this
        grid, the load is invalid or beyond double precision, or the force exceeds what the window
        carries at its hardness. Also if the closure is beyond full contact of an elastic surface
        that is repeated or mirrored.
    NotConverged
        If the conditions are not met to ``rtol``.

    Examples
    --------
    A sphere of radius 1 mm under 50 N. Hertz: w = (3 F / (4 E* sqrt R))^(2/3) = 0.0241 mm, peak
    pressure 988 MPa.

    >>> import numpy as np
    >>> from roughcontact import HalfSpace, solve_contact
    >>> y, x = (np.indices((128, 128)) - 63.5) * 0.01
    >>> state = solve_contact(-(x**2 + y**2) / 2, HalfSpace((128, 128), 0.01, 10e3), force=50.0)
    >>> f"{state.closure:.4f} mm, {state.pressure.max():.0f} MPa"
    '0.0241 mm, 988 MPa'

    The next load starts from it:

    >>> following = solve_contact(state.composite, state.space, force=60.0, start=state)
    >>> following.closure > state.closure
    True
    """
    if mean_pressure is not None:
        force = _force_of(mean_pressure, space, closure, force)
    load, topography = _checked(composite, space, closure, force, start, rtol)
    if load == 0:
        return unloaded_state(space, topography.clearance())
    units = _Units(space, load, force is not None)
    case = units.case(topography, _hardness_of_nodes(hardness, space, force))
    _check_reach(case, load)
    with SOLVING.counted(1):
        problem, solution = _solve(case, units, load, start, rtol)
    state = units.state(solution, topography, problem, start)
    if not state.residual <= rtol:
        what = "are still violated" if math.isfinite(state.residual) else "have no finite state"
        reason = f"contact conditions {what} after {state.iterations} applications of the operator"
        raise NotConverged(reason, state, state.residual)
    return state


def _force_of(mean_pressure, space, closure, force):
    """Force of a mean pressure on the window, N."""
    if closure is not None or force is not None:
        raise ValueError("give exactly one of closure=, force= and mean_pressure=")
    _check_space(space)
    pressure = number(mean_pressure, "mean pressure", "MPa")
    if not math.isfinite(pressure) or pressure < 0:
        raise ValueError(f"mean pressure {pressure}: expected a finite number >= 0, in MPa")
    return pressure * space.area


def _solve(case, units, load, start, rtol):
    """Problem as it was solved, and its solution; the caller checks the residual."""
    restrict = may_restrict(case.space, rtol) and case.bounds.uniform
    if start is None or not start.in_contact.any():
        if restrict:
            return solve_nested(case, rtol)
        problem = case.problem()
        return problem, ActiveSetMethod(problem, rtol).solve(nested_iteration_start(problem))
    if restrict:
        candidates = units.candidates(case, start, load)
        if candidates is not None:
            return solve_restricted(case, *candidates, rtol)
    problem = case.problem()
    pressure, displacement = units.extrapolated(start, load)
    if displacement is not None:
        changed = full_approximation_start(problem, pressure, displacement)
        if changed is not None:
            pressure, displacement = changed, None
    return problem, ActiveSetMethod(problem, rtol).solve(pressure, displacement)


def checked_hardness(hardness: float | None, space: HalfSpace, force: float | None) -> float:
    """Hardness as a number, MPa; infinite without one.

    Raises
    ------
    ValueError
        If it is invalid, or the window could not carry the force, N.
    """
    if hardness is None:
        return np.inf
    hardness = number(hardness, "hardness", "MPa")
    if not hardness >= MIN_INPUT:
        raise ValueError(f"hardness {hardness}: expected > 0 MPa, and at least {MIN_INPUT:g}")
    ny, nx = space.shape
    most = hardness * space.cell_area * ny * nx
    if force is not None and not force < most:
        raise ValueError(
            f"force {force:g} N: at hardness {hardness:g} MPa the window carries {most:g}"
        )
    return hardness


def _hardness_of_nodes(hardness, space, force):
    """Checked hardness of the surface, or of each node, (n,), infinite at elastic nodes."""
    if np.ndim(hardness) == 0:
        return checked_hardness(hardness, space, force)
    values = field(hardness, "hardness", space.shape)
    if not (values >= MIN_INPUT).all():
        raise ValueError(f"hardness: expected > 0 MPa on each node, and at least {MIN_INPUT:g}")
    most = float(values.sum()) * space.cell_area
    if force is not None and not force < most:
        raise ValueError(f"force {force:g} N: at this hardness the window carries {most:g}")
    return values.ravel()


def checked_problem(
    composite: ArrayLike,
    space: HalfSpace,
    closure: float | None,
    force: float | None,
    start: ContactState | None,
    rtol: float,
) -> tuple[float, np.ndarray]:
    """Load and clearance of a problem, from the arguments of `solve_contact` or another method.

    Returns
    -------
    load : float
        The closure or the force.
    clearance : (ny, nx) ndarray
        Clearance at first touch, mm.

    Raises
    ------
    ValueError
        As `solve_contact`.
    """
    load, topography = _checked(composite, space, closure, force, start, rtol)
    return load, topography.clearance()


def _checked(composite, space, closure, force, start, rtol):
    """Load and topography of `checked_problem`."""
    _check_space(space)
    topography = Topography(composite, space.shape)
    if (closure is None) == (force is None):
        raise ValueError("give exactly one of closure=, force= and mean_pressure=")
    name, unit = ("closure", "mm") if force is None else ("force", "N")
    load = number(closure if force is None else force, name, unit)
    if not math.isfinite(load) or load < 0:
        raise ValueError(f"{name} {load}: expected a finite number >= 0, in {unit}")
    if start is not None:
        _check_start(start, space)
    if not 0 < number(rtol, "rtol", "fractions of the closure") < 1:
        raise ValueError(f"rtol {rtol}: expected between 0 and 1")
    depth = topography.highest - topography.lowest
    if not depth <= MAX_INPUT:
        raise ValueError(f"composite topography {depth:g} mm deep: expected {MAX_INPUT:g} at most")
    if load > 0 and not _within_double_precision(space, load, force is not None, depth):
        raise ValueError(
            f"{name} {load:g} {unit}: too {'small' if load < 1 else 'large'} for double precision; "
            "expected such that closures, pressures and forces on this grid are of "
            f"{MIN_RESULT:g} to {MAX_RESULT:g} mm, MPa and N"
        )
    return load, topography


def _check_space(space):
    if not isinstance(space, HalfSpace):
        raise ValueError(f"space {quoted(space)}: expected a HalfSpace of the topography's shape")


def _check_reach(case, closure):
    """`ValueError` for a closure beyond the mean plane of an elastic repeated surface."""
    if case.by_force or case.space.is_free or not case.bounds.elastic:
        return
    most = float(case.topography.clearance().mean())
    if closure >= most:
        raise ValueError(
            f"closure {closure:g} mm: no force closes this {case.space.boundary} surface further "
            f"than its mean plane in full contact, {most:g} mm; give the force"
        )


def _check_start(start, space):
    """`ValueError` for a start that is no state on this grid."""
    if not isinstance(start, ContactState):
        raise ValueError(f"start {quoted(start)}: expected a ContactState, as solve_contact gives")
    # Only this solver makes a state on candidates; checking its displacement would compute it.
    if isinstance(start, CandidateState) and start.space.shape == space.shape:
        return
    for name in ("pressure", "displacement"):
        values = field(getattr(start, name), f"{name} of the start", space.shape)
        if not np.isfinite(values).all():
            raise ValueError(f"{name} of the start: expected finite numbers")
    for name in ("closure", "force"):
        if not math.isfinite(number(getattr(start, name), f"{name} of the start", "mm or N")):
            raise ValueError(f"{name} of the start: expected a finite number")


def _within_double_precision(space, load, by_force, depth):
    """True if all numbers of the state of a load keep all their digits."""
    length, pressure = _load_units(space, load, by_force)
    sizes = length, pressure, pressure * space.cell_area
    if not MIN_RESULT <= min(sizes) <= max(sizes) <= MAX_RESULT:
        return False
    return depth / length <= MAX_RESULT


def _load_units(space, load, by_force):
    """Units of length, mm, and of pressure, MPa, in which closure or mean pressure is one."""
    stress_per_length = space.modulus / space.cell
    if not by_force:
        return load, load * stress_per_length
    pressure = load / space.area
    return pressure / stress_per_length, pressure


def _on_grid(values, shape):
    """Values of nodes, (n,), on their grid; a scalar is returned unchanged."""
    return values if np.ndim(values) == 0 else values.reshape(shape)


class _Units:
    """Dimensionless units: the closure, or under a given force the mean pressure, is 1."""

    def __init__(self, space, load, by_force):
        self.space, self.by_force = space, by_force
        self.length, self.pressure = _load_units(space, load, by_force)
        self.load = float(space.shape[0] * space.shape[1]) if by_force else 1.0

    def case(self, topography, hardness):
        bounds = Bounds(0.0, hardness).over(self.pressure)
        if np.min(bounds.upper) < MIN_RESULT:
            raise ValueError(
                f"hardness {np.min(hardness):g}: too low for pressures of {self.pressure:g} MPa"
            )
        return LoadCase(self.space, topography, self.length, self.load, self.by_force, bounds)

    def candidates(self, case, start, load):
        """Candidates at a load, a start pressure and its displacement; None if there are too many.

        The start is `extrapolated`, and the bound on the closure grows in proportion to the force.
        """
        bound = MARGIN * self.load
        if self.by_force:
            factor = max(self._proportion(start, load), 1.0)
            bound = FROM_LOAD * start.closure / self.length * factor
        restricted = case.restricted(bound, None, STEP_GAIN)
        if restricted is None:
            return None
        nodes = restricted.nodes
        pressure = self._extrapolated(
            lambda state: state.pressure.ravel()[nodes].astype(float), start, load
        )
        pressure /= self.pressure
        if not pressure.any():
            return None
        same_space = start.space == self.space
        return restricted, pressure, restricted.operator(pressure) if same_space else None

    def extrapolated(self, start, load):
        """Pressure at a load, and its displacement if the start is on this half-space."""
        pressure = self._extrapolated(lambda state: state.pressure, start, load)
        pressure = np.asarray(pressure, float).ravel() / self.pressure
        if start.space != self.space:
            return pressure, None
        displacement = self._extrapolated(lambda state: state.displacement, start, load)
        return pressure, np.asarray(displacement, float).ravel() / self.length

    def _extrapolated(self, field_of, start, load):
        """Field at a load, along the line through two earlier states.

        In proportion to the load if there is only one, or if the start is on another half-space:
        the line through two of its states depends on its stiffness, and may lead far from any state
        of this one and to negative pressures.
        """
        before = start._before if start.space == self.space else None
        start_load = self._load_of(start)
        step = start_load - self._load_of(before) if before else 0.0
        if not step:
            return self._proportion(start, load) * field_of(start)
        along = min(max((load - start_load) / step, -1.0), FURTHEST)
        return (1 + along) * field_of(start) - along * field_of(before)

    def _proportion(self, start, load):
        """Ratio of a load to that of a state, at most FURTHEST."""
        start_load = self._load_of(start)
        return min(load / start_load, FURTHEST) if start_load > 0 else 1.0

    def _load_of(self, state):
        """Force or closure of a state, whichever is given."""
        return state.force if self.by_force else state.closure

    def state(self, solution, topography, problem, start):
        """Solution in mm, N and MPa."""
        space = self.space
        closure = solution.closure * self.length if self.by_force else self.length
        # Only one earlier state is kept, without its own predecessor.
        before = None if start is None or start.space != space else start.without_before()
        on_nodes = solution.pressure * self.pressure
        force = float(on_nodes.sum()) * space.cell_area
        common: dict[str, Any] = {
            "closure": closure,
            "force": force,
            # NaN violates no condition, and must not pass for a state.
            "residual": solution.residual if math.isfinite(force) else math.nan,
            "iterations": solution.applications,
            "space": space,
            "hardness": _on_grid(problem.bounds.upper, space.shape) * self.pressure,
        }
        if problem.nodes is not None:
            pressure = np.zeros(space.shape)
            pressure.ravel()[problem.nodes] = on_nodes
            return CandidateState(
                pressure,
                **common,
                before=before,
                solver=solve_contact,
                candidates=Candidates(
                    problem.nodes,
                    on_nodes,
                    solution.displacement * self.length,
                    topography.clearance_at(problem.nodes),
                    topography,
                ),
            )
        displacement = solution.displacement.reshape(space.shape) * self.length
        return ContactState(
            pressure=on_nodes.reshape(space.shape),
            displacement=displacement,
            gap=displacement + topography.clearance() - closure,
            **common,
            _before=before,
            _solver=solve_contact,
        )
