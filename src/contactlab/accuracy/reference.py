"""Test problems that solvers are timed on, each with a reference solution of known error.

The window is a unit square and E* = 1: the problem depends on no unit. Rough surfaces are loaded
until a given fraction of the nodes touches; the paraboloid of Hertz and the flat circular punch
reach a fixed closure.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from fractalcontact.surface.synthesis import self_affine
from roughcontact.contact.solve import solve_contact
from roughcontact.contact.state import ContactState
from roughcontact.elastic.halfspace import HalfSpace
from roughcontact.errors import NotConverged

from ..methods.registry import METHODS
from .cheap_models import CheapState
from .violation import violation

SIDE = 1.0  # mm
E_STAR = 1.0  # MPa
RMS = 0.02  # mm
# The reference is solved to the first of these that rounding lets the solver verify.
REFERENCE_TOLERANCES = (1e-12, 1e-11, 1e-10)
# Relative error to which the fraction in contact is met: it names a problem and decides nothing.
FRACTION_MET = 0.02
# Between closures as near to each other as this no other count of nodes is looked for.
CLOSED = 1e-3
#: Interpenetrating nodes up to which direct elimination is a matter of seconds.
ELIMINATED = 4500
# Hertz's contact and the punch reach this fraction of the way from the centre to the edge.
REACH = 0.8
# Closure of the punch relative to its radius; the problem is linear, and this decides nothing.
PUNCH_CLOSURE = 0.01
# What lies outside the punch is this many closures below it, and never touches.
PUNCH_STEP = 10.0


@dataclass(frozen=True)
class Reference:
    """Reference solution at one load, of known error.

    Attributes
    ----------
    closure, force : float
        mm and N.
    stiffness : float
        dF/dw, N/mm.
    fraction : float
        Of the nodes, in contact.
    tolerance : float
        The solver's own.
    state : ContactState
    """

    closure: float
    force: float
    stiffness: float
    fraction: float
    tolerance: float
    state: ContactState = field(repr=False)

    def error(self, answer: ContactState | CheapState) -> float:
        """Relative error of the force, whichever of closure and force the solver was given.

        An error of the closure counts as the force it stands for, by dF/dw.
        """
        change = answer.force - self.force - self.stiffness * (answer.closure - self.closure)
        return abs(change) / self.force

    def own_error(self, height: np.ndarray) -> float:
        """Bound of the reference's own relative error of the force.

        Notes
        -----
        Where gaps and pressures miss the conditions by a fraction v of the closure w, judged by a
        convolution that is not the solver's, the state lies between those at w (1 - v) and
        w (1 + v), as F rises with w: the error is at most v w dF/dw.
        """
        wrong, _ = violation(self.state, height)
        return float(wrong * self.closure * self.stiffness / self.force)


class ReferenceProblem(ABC):
    """A test problem on a square window, with its reference solution."""

    #: Nodes per side.
    size: int

    @property
    @abstractmethod
    def name(self) -> str:
        """Name of the problem in messages."""

    @property
    @abstractmethod
    def height(self) -> np.ndarray:
        """Composite topography (size, size), mm."""

    @property
    @abstractmethod
    def closure(self) -> float:
        """w, mm."""

    @cached_property
    def space(self) -> HalfSpace:
        """The half-space it is pressed on."""
        return HalfSpace((self.size, self.size), (SIDE / self.size, SIDE / self.size), E_STAR)

    @cached_property
    def single(self) -> Reference:
        """The reference solution."""
        state, tolerance = _tightest(self.height, self.space, self.closure, None)
        return Reference(
            closure=state.closure,
            force=state.force,
            stiffness=state.stiffness,
            fraction=np.count_nonzero(state.in_contact) / state.pressure.size,
            tolerance=tolerance,
            state=state,
        )

    @property
    def overlapping(self) -> int:
        """Number of nodes that the rigid plane would reach if nothing gave way."""
        return int(np.count_nonzero(self.height.max() - self.height < self.closure))

    def eliminated(self) -> float:
        """Difference of the reference's force from direct elimination, relative; NaN if too large.

        Elimination shares neither FFT nor iteration with the solver.
        """
        if self.overlapping > ELIMINATED:
            return np.nan
        exact = METHODS["dense"](self.height, self.space, closure=self.closure)
        return abs(self.single.force / exact.force - 1)

    @cached_property
    def _centred(self):
        """Coordinates (y, x) of the nodes from the middle of the window, mm."""
        along = (np.arange(self.size) + 0.5) / self.size * SIDE - SIDE / 2
        return along[:, np.newaxis], along[np.newaxis, :]


@dataclass(frozen=True)
class RoughProblem(ReferenceProblem):
    """A self-affine surface, loaded until a fraction of its nodes is in contact."""

    size: int
    hurst: float
    fraction: float
    seed: int

    @property
    def name(self) -> str:
        """Name of the problem in messages."""
        return f"{self.size}, H = {self.hurst:g}, {100 * self.fraction:g} %"

    @cached_property
    def height(self) -> np.ndarray:
        """Heights of the surface, mm."""
        return self_affine(
            (self.size, self.size), SIDE / self.size, self.hurst, rms=RMS, seed=self.seed
        )

    @cached_property
    def closure(self) -> float:
        """w, mm, at which the fraction is in contact."""
        return closure_at_fraction(self.height, self.space, self.fraction)


@dataclass(frozen=True)
class HertzProblem(ReferenceProblem):
    """A paraboloid of radius of curvature 1 mm: a^2 = R w."""

    size: int

    @property
    def name(self) -> str:
        """Name of the problem in messages."""
        return f"{self.size}, Hertz"

    @cached_property
    def height(self) -> np.ndarray:
        """Heights of the paraboloid, mm."""
        y, x = self._centred
        return -(y**2 + x**2) / 2

    @property
    def closure(self) -> float:
        """w, mm."""
        return (REACH * SIDE / 2) ** 2


@dataclass(frozen=True)
class PunchProblem(ReferenceProblem):
    """A flat circular punch."""

    size: int

    @property
    def name(self) -> str:
        """Name of the problem in messages."""
        return f"{self.size}, flat punch"

    @cached_property
    def height(self) -> np.ndarray:
        """Zero on the punch, far below around it, mm."""
        y, x = self._centred
        return np.where(np.hypot(y, x) < REACH * SIDE / 2, 0.0, -PUNCH_STEP * self.closure)

    @property
    def closure(self) -> float:
        """w, mm."""
        return PUNCH_CLOSURE * REACH * SIDE / 2


def problems_of(recipe: Mapping[str, Any]) -> dict[str, ReferenceProblem]:
    """Test problems of a study by name, computed when they are used.

    Parameters
    ----------
    recipe : mapping
        ``sizes`` (nodes per side), ``hurst``, ``contact`` (fractions of the nodes) and ``seed``.
    """
    problems: dict[str, ReferenceProblem] = {}
    for size in sorted(recipe["sizes"]):
        problems[f"n{size}_hertz"] = HertzProblem(size)
        problems[f"n{size}_punch"] = PunchProblem(size)
        for hurst in recipe["hurst"]:
            for fraction in recipe["contact"]:
                problem = RoughProblem(size, hurst, fraction, recipe["seed"])
                problems[f"n{size}_h{hurst:g}_c{100 * fraction:g}"] = problem
    return problems


def _tightest(height, space, closure, start):
    """The state at the tightest of `REFERENCE_TOLERANCES` that can be verified, and which it is."""
    for tolerance in REFERENCE_TOLERANCES:
        try:
            state = solve_contact(height, space, closure=closure, start=start, rtol=tolerance)
        except NotConverged as error:
            failure = error
            start = error.state
        else:
            return state, tolerance
    raise failure


def closure_at_fraction(height: np.ndarray, space: HalfSpace, fraction: float) -> float:
    """Closure at which a fraction of the nodes is in contact, by regula falsi on its logarithm.

    Parameters
    ----------
    height : (ny, nx) ndarray
        mm.
    space : HalfSpace
    fraction : float
        Met to `FRACTION_MET` of it, or as closely as the count of nodes in contact lets it be: on
        small grids several may touch at once.

    Returns
    -------
    float
        mm.
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
