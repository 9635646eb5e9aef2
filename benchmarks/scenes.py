"""The scenes every solver is measured on: self-affine surfaces on a unit square, E* = 1."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fractalcontact import HalfSpace, NotConverged, solve_contact
from fractalcontact.synthesis import self_affine

RMS = 0.02
LOADS = 16
# The reference is solved to the first of these that rounding lets the solver verify.
REFERENCE_TOLERANCES = (1e-12, 1e-11, 1e-10)
# The fraction in contact is met to this share: it names a scene and decides nothing else.
FRACTION_MET = 0.02


@dataclass(frozen=True)
class Reference:
    """What a solver is measured against at one load."""

    closure: float
    force: float
    stiffness: float
    fraction: float
    tolerance: float

    def error(self, answer):
        """Error as a share of the force, whichever of closure and force the solver was given.

        An error of the closure counts as the force it stands for, by dF/dw.
        """
        change = answer.force - self.force - self.stiffness * (answer.closure - self.closure)
        return abs(change) / self.force


@dataclass(frozen=True)
class Scene:
    """A surface, the fraction in contact it is pressed to, and references at every load."""

    size: int
    hurst: float
    fraction: float
    seed: int

    @property
    def name(self):
        """What the scene is called in messages."""
        return f"{self.size}, H = {self.hurst:g}, {100 * self.fraction:g} %"

    @cached_property
    def height(self):
        """Heights of the surface, mm."""
        return self_affine(
            (self.size, self.size), 1 / self.size, self.hurst, rms=RMS, seed=self.seed
        )

    @cached_property
    def space(self):
        """The half-space it is pressed on."""
        return HalfSpace((self.size, self.size), (1 / self.size, 1 / self.size), 1.0)

    @cached_property
    def closure(self):
        """w, mm, at which the fraction is in contact."""
        return closure_at_fraction(self.height, self.space, self.fraction)

    @cached_property
    def single(self):
        """The reference of the single solve."""
        return self._references([self.closure])[0]

    @cached_property
    def sweep(self):
        """References at the loads of the sweep, closures in even steps."""
        return self._references(self.closure * np.arange(1, LOADS + 1) / LOADS)

    def _references(self, closures):
        references, state = [], None
        for closure in closures:
            state, tolerance = _tightest(self.height, self.space, closure, state)
            references.append(
                Reference(
                    closure=state.closure,
                    force=state.force,
                    stiffness=state.stiffness,
                    fraction=np.count_nonzero(state.in_contact) / state.pressure.size,
                    tolerance=tolerance,
                )
            )
        return references


def _tightest(height, space, closure, start):
    for tolerance in REFERENCE_TOLERANCES:
        try:
            state = solve_contact(height, space, closure=closure, start=start, rtol=tolerance)
        except NotConverged as error:
            failure = error
            start = error.state
        else:
            return state, tolerance
    raise failure


def closure_at_fraction(height, space, fraction):
    """Closure at which a fraction of the nodes is in contact, by regula falsi on its logarithm."""
    low, high = 0.0, np.inf
    wanted, state = fraction * height.size, None
    trial = np.std(height)
    for _ in range(30):
        state = solve_contact(height, space, closure=trial, start=state, rtol=1e-3)
        share = np.count_nonzero(state.in_contact) / wanted
        if abs(share - 1) < FRACTION_MET:
            return trial
        low, high = (trial, high) if share < 1 else (low, trial)
        # Contact grows with the closure to a power between one and two.
        trial = trial * share ** (-1 / 1.5)
        if trial >= high or trial <= low:
            trial = (low + high) / 2
    raise RuntimeError(f"no closure found with {fraction} of the nodes in contact")
