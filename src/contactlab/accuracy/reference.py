"""Test problems for the timing of solvers, each with a reference solution of known error.

The window is a unit square and E* = 1: the problem depends on no unit. Rough surfaces are loaded
until a given fraction of the nodes touches; the paraboloid of Hertz and the flat circular punch
reach a fixed closure.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from itertools import product
from typing import Any

import numpy as np

from fractalcontact.surface.synthesis import self_affine
from roughcontact.contact.solve import solve_contact
from roughcontact.contact.state import ContactState
from roughcontact.contact.violation import violation
from roughcontact.elastic.halfspace import HalfSpace
from roughcontact.errors import NotConverged

from ..methods.registry import METHODS
from .cheap_models import CheapState

SIDE = 1.0  # mm
E_STAR = 1.0  # MPa
RMS = 0.02  # mm
# Tolerances of the reference: the first that the solver can verify, for rounding, counts.
REFERENCE_TOLERANCES = (1e-12, 1e-11, 1e-10)
# Relative error of the fraction in contact, which only names a problem.
FRACTION_MET = 0.02
# Relative difference of closures at which the search for a count of nodes ends.
CLOSED = 1e-3
#: Most interpenetrating nodes for direct elimination within seconds.
ELIMINATED = 4500
# Fraction of the way from the centre to the edge that Hertz's contact and the punch reach.
REACH = 0.8
# Closure of the punch relative to its radius; the problem is linear and does not depend on it.
PUNCH_CLOSURE = 0.01
# Depth of the surface around the punch, in closures: it never touches.
PUNCH_STEP = 10.0


@dataclass(frozen=True)
class Reference:
    """Reference solution of known error; ``tolerance`` is the solver's own."""

    state: ContactState = field(repr=False)
    tolerance: float

    @property
    def fraction(self) -> float:
        """Fraction of the nodes in contact."""
        return float(self.state.in_contact.mean())

    def error(self, answer: ContactState | CheapState) -> float:
        """Relative error of the force, whichever of closure and force the solver was given.

        An error of the closure is converted to one of the force by dF/dw.
        """
        exact = self.state
        change = answer.force - exact.force - exact.stiffness * (answer.closure - exact.closure)
        return abs(change) / exact.force

    def own_error(self, height: np.ndarray) -> float:
        """Bound of the reference's own relative error of the force.

        Where gaps and pressures miss the conditions by a fraction v of the closure w, judged by a
        convolution that is not the solver's, the state lies between those at w (1 - v) and
        w (1 + v), as F rises with w: the error is at most v w dF/dw.
        """
        exact, (wrong, _) = self.state, violation(self.state, height)
        return float(wrong * exact.closure * exact.stiffness / exact.force)


@dataclass(frozen=True, eq=False)
class ReferenceProblem:
    """A test problem on a square window, with its reference solution.

    Attributes
    ----------
    name : str
        Name in messages.
    height : (size, size) ndarray
        Composite topography, mm.
    closure : float
        w, mm.
    hurst, fraction : float
        H of a rough surface, and the fraction of its nodes to be in contact.
    """

    name: str
    height: np.ndarray = field(repr=False)
    closure: float
    hurst: float = np.nan
    fraction: float = np.nan

    @property
    def size(self) -> int:
        """Nodes per side."""
        return len(self.height)

    @cached_property
    def space(self) -> HalfSpace:
        """Half-space under the surface."""
        return _unit_space(self.size)

    @cached_property
    def single(self) -> Reference:
        """Reference at the tightest of `REFERENCE_TOLERANCES` that can be verified."""
        start = None
        for tolerance in REFERENCE_TOLERANCES:
            try:
                state = solve_contact(
                    self.height, self.space, closure=self.closure, start=start, rtol=tolerance
                )
                return Reference(state, tolerance)
            except NotConverged as error:
                failure, start = error, error.state
        raise failure

    @property
    def overlapping(self) -> int:
        """Number of nodes above the rigid plane of the undeformed surface."""
        return int(np.count_nonzero(self.height.max() - self.height < self.closure))

    def eliminated(self) -> float:
        """Relative difference of the reference's force from direct elimination; NaN if too large.

        Elimination shares neither FFT nor iteration with the solver.
        """
        if self.overlapping > ELIMINATED:
            return np.nan
        exact = METHODS["dense"](self.height, self.space, closure=self.closure)
        return abs(self.single.state.force / exact.force - 1)


def rough_problem(size: int, hurst: float, fraction: float, seed: int) -> ReferenceProblem:
    """A self-affine surface, loaded until a fraction of its nodes is in contact."""
    height = self_affine((size, size), SIDE / size, hurst, rms=RMS, seed=seed)
    closure = closure_at_fraction(height, _unit_space(size), fraction)
    name = f"{size}, H = {hurst:g}, {100 * fraction:g} %"
    return ReferenceProblem(name, height, closure, hurst, fraction)


def hertz_problem(size: int) -> ReferenceProblem:
    """A paraboloid of radius of curvature 1 mm: a^2 = R w."""
    height = -(_radius(size) ** 2) / 2
    return ReferenceProblem(f"{size}, Hertz", height, (REACH * SIDE / 2) ** 2)


def punch_problem(size: int) -> ReferenceProblem:
    """A flat circular punch."""
    closure = PUNCH_CLOSURE * REACH * SIDE / 2
    height = np.where(_radius(size) < REACH * SIDE / 2, 0.0, -PUNCH_STEP * closure)
    return ReferenceProblem(f"{size}, flat punch", height, closure)


def _unit_space(size):
    return HalfSpace((size, size), (SIDE / size, SIDE / size), E_STAR)


def _radius(size):
    """Distance of the nodes from the middle of the window, mm."""
    along = (np.arange(size) + 0.5) / size * SIDE - SIDE / 2
    return np.hypot(along[:, np.newaxis], along)


def problems_of(recipe: Mapping[str, Any]) -> dict[str, Callable[[], ReferenceProblem]]:
    """Test problems of a study by name, made on first use.

    The recipe has ``sizes`` (nodes per side), ``hurst``, ``contact`` (fractions of the nodes) and
    ``seed``.
    """
    problems: dict[str, Callable[[], ReferenceProblem]] = {}
    for size in sorted(recipe["sizes"]):
        problems[f"n{size}_hertz"] = partial(hertz_problem, size)
        problems[f"n{size}_punch"] = partial(punch_problem, size)
        for hurst, fraction in product(recipe["hurst"], recipe["contact"]):
            problem = partial(rough_problem, size, hurst, fraction, recipe["seed"])
            problems[f"n{size}_h{hurst:g}_c{100 * fraction:g}"] = problem
    return problems


def closure_at_fraction(height: np.ndarray, space: HalfSpace, fraction: float) -> float:
    """Closure, mm, at which a fraction of the nodes is in contact, by regula falsi on its log.

    The fraction is met to `FRACTION_MET` of it, or as closely as the count of nodes in contact lets
    it be: on small grids several may touch at once. Heights are in mm.
    """
    low, high = 0.0, np.inf
    wanted, state = fraction * height.size, None
    trial = np.std(height)
    closest, met = np.inf, trial
    while closest >= FRACTION_MET and low < (1 - CLOSED) * high:
        state = solve_contact(height, space, closure=trial, start=state, rtol=1e-3)
        ratio = np.count_nonzero(state.in_contact) / wanted
        if abs(ratio - 1) < closest:
            closest, met = abs(ratio - 1), trial
        low, high = (trial, high) if ratio < 1 else (low, trial)
        # Contact grows with the closure to a power between one and two.
        trial = trial * ratio ** (-1 / 1.5)
        if not low < trial < high:
            trial = (low + high) / 2 if np.isfinite(high) else 2 * low
    return met
