"""Interface of public contact codes to the comparison methods.

Each is set up in a file of its own, on the same free-space problem and with heights from the
highest one down. Their results are not checked against the contact conditions: other modules judge
whether their own report can be trusted. ``pip install -e '.[peers]'`` installs them.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from fractalcontact.core.child_process import in_child
from roughcontact.contact.state import ContactState
from roughcontact.elastic.halfspace import HalfSpace
from roughcontact.errors import NotConverged

from .common import measured_state

#: Limit of iterations where a code is set up for large grids.
MAX_ITERATIONS = 500
#: Limits of iterations and of seconds in the call of the comparison methods, which may take longer.
PATIENT_ITERATIONS, PATIENCE = 2000, 60.0


class Failed(RuntimeError):
    """Failure to converge reported by the code itself; ``pressure`` is its last one, MPa."""

    def __init__(self, message: str, pressure: np.ndarray):
        super().__init__(message)
        self.pressure = pressure


@dataclass(frozen=True)
class Load:
    """Settings of a public code besides the topography.

    Attributes
    ----------
    closure, force : float or None
        w, mm, or F, N.
    hardness : float or None
        Largest pressure, MPa.
    start : (ny, nx) ndarray or None
        Pressure to start from, MPa.
    pixel_force : float or None
        Mean force of a pixel in contact, N, for codes whose tolerance is on forces.
    """

    closure: float | None = None
    force: float | None = None
    hardness: float | None = None
    start: np.ndarray | None = None
    pixel_force: float | None = None


class PublicCode:
    """A public code set up for one topography, mm; each code has a subclass in a file of its own.

    Attributes
    ----------
    height : (ny, nx) ndarray
        From the highest one down, mm: an offset counted from it is a closure.
    sides : (float, float)
        Sides of the window along y and x, mm.
    max_iterations : int
        Limit of iterations.
    """

    def __init__(self, height: ArrayLike, space: HalfSpace):
        self.space, self.max_iterations = space, MAX_ITERATIONS
        self.height = -clearance_of(height)
        ny, nx = space.shape
        self.sides = (ny * space.spacing[0], nx * space.spacing[1])

    def solve(self, load: Load, rtol: float) -> np.ndarray:
        """Pressure (ny, nx), MPa, under a load of the kinds that the code offers.

        ``rtol`` is the tolerance on the code's own measure of its error. Failed if the code reports
        that it did not converge.
        """
        raise NotImplementedError

    def closure(self, pressure: np.ndarray) -> float:
        """Closure of a pressure, mm, for a code that is given a force."""
        raise NotImplementedError

    def count(self, on: bool) -> None:
        """Begin or end to count applications of the operator; counting takes time."""

    @property
    def applications(self) -> int | None:
        """Applications of the operator since :meth:`count` began; None if they are not counted."""
        return None

    @property
    def path(self) -> str:
        """Path of the last call in a code with several: its operator and counters."""
        return ""


def solve_in_child(
    set_up: Callable[[ArrayLike, HalfSpace], PublicCode],
    composite: ArrayLike,
    space: HalfSpace,
    *,
    closure: float | None,
    force: float | None,
    hardness: float | None,
    start: ContactState | None,
    rtol: float,
) -> ContactState:
    """State by a public code in a child process, where it may crash or never end without harm.

    A load is passed on unchanged, so that the code itself refuses an invalid one.

    Parameters
    ----------
    set_up : callable
        Makes the code ready for a topography.
    composite : (ny, nx) array_like
        mm.
    space : HalfSpace
    closure, force, hardness : float or None
        mm, N and MPa.
    start : ContactState or None
    rtol : float
        Tolerance on the code's own measure of its error.

    Raises
    ------
    NotConverged
        If the code reports it.
    ChildFailed
        If it raises an error, crashes or takes longer than `PATIENCE` seconds.
    """
    load = Load(closure, force, hardness, start=None if start is None else start.pressure)
    press = partial(_pressed, set_up, composite, space, load, rtol)
    pressure, said = in_child(press, seconds=PATIENCE)
    clearance = clearance_of(composite)
    state = state_of(space, pressure, clearance, closure=closure, force=force, hardness=hardness)
    if said:
        raise NotConverged(said, state, state.residual)
    return state


def _pressed(set_up, composite, space, load, rtol):
    """Pressure, and the code's message if it did not converge."""
    code = set_up(composite, space)
    code.max_iterations = PATIENT_ITERATIONS
    try:
        return code.solve(load, rtol), ""
    except Failed as failure:
        return failure.pressure, str(failure)


def clearance_of(height: ArrayLike) -> np.ndarray:
    """Opening at first touch (ny, nx), mm; cells without a height keep their NaN or infinity."""
    height = np.asarray(height, float)
    return height[np.isfinite(height)].max() - height


def state_of(
    space: HalfSpace,
    pressure: np.ndarray,
    clearance: np.ndarray,
    *,
    closure: float | None = None,
    force: float | None = None,
    hardness: float | None = None,
) -> ContactState:
    """State of a code's pressure, MPa, whether or not it satisfies the contact conditions.

    ``clearance`` is the opening at first touch, mm. An unknown closure is the mean over the contact
    that is no overlap. Force (N) and hardness (MPa) are the given ones. ``residual`` is measured
    with our operator; ``iterations`` are not known and stated as 0.
    """
    cap = np.inf if hardness is None else hardness
    if closure is None:
        between = (pressure > 0) & (pressure < cap)
        reached = space.displacement(pressure) + clearance
        closure = float(reached[between].mean()) if between.any() else 0.0
    return measured_state(space, clearance, pressure, closure, force=force, hardness=cap)
