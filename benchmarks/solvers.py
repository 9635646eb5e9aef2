"""Every solver behind one call: ours, the package's comparison methods, and the public codes.

A solver is made for one test problem. ``solve(reference, tolerance, previous)`` loads it to the
reference's closure or force, whichever it controls, from ``previous`` (what the last call returned,
or None for a cold start), and returns an `Answer`. ``applications()`` is the number of zero-padded
convolutions of the last call; where counting costs time it is switched on by ``counting``.
``likely`` is a tolerance near the one that reaches the benchmark's error at 512 x 512: the search
for the best begins there, and ends at ``loosest``. Which methods and public codes there are, and
what they offer, they declare themselves (`contactlab.methods.registry`).
"""

from collections import Counter
from contextlib import contextmanager
from dataclasses import dataclass
from unittest import mock

import numpy as np

from contactlab.accuracy.speed import load_of
from contactlab.methods.peers import Failed as PeerFailed
from contactlab.methods.registry import METHODS, installed_peers
from fractalcontact import HalfSpace, NotConverged, solve_contact
from roughcontact.contact import operator
from roughcontact.contact.preconditioner import forget_preconditioner
from roughcontact.contact.state import CandidateState


class Failed(RuntimeError):
    """The solver itself says that it did not converge."""


@dataclass
class Answer:
    """Force and closure reached, and whatever the same solver can start from."""

    force: float
    closure: float
    state: object = None


class Solver:
    """A solver as the table needs it; this is the part most of them share."""

    runs_sweep = True
    counting = False
    loosest = 1e-2

    def carries(self, problem):
        """Whether a solve of this problem takes seconds rather than hours."""
        return True

    def complete(self, answer):
        """Fill in, outside the clock, what the solver does not report itself."""

    def coarse_applications(self):
        """Convolutions of the last call on coarser grids, as fractions of a full one by area."""
        return 0.0

    def path(self):
        """Which way the last call went: proof that a row times what its name says."""
        return ""


class Ours(Solver):
    """`fractalcontact.solve_contact`."""

    called, likely = "fractalcontact", 1e-6
    press = staticmethod(solve_contact)

    def __init__(self, problem, control):
        self.name, self.control = f"{self.called} ({control})", control
        self.height, self.space = problem.height, problem.space
        self.calls = {"full": 0, "coarse": 0.0}

    def solve(self, reference, tolerance, previous):
        """Load to the reference's closure or force."""
        load = {self.control: getattr(reference, self.control)}
        start = None if previous is None else previous.state
        if start is None:
            forget(self.space)
        if self.counting:
            with counted_convolutions(self.space.shape) as self.calls:
                state = self._solve(load, start, tolerance)
        else:
            state = self._solve(load, start, tolerance)
        # Its own count, or what was seen of it if that should be more.
        self.work = max(state.iterations, self.calls["full"])
        self.state = state
        return Answer(state.force, state.closure, state)

    def _solve(self, load, start, tolerance):
        try:
            with counted_between_candidates(self.space.shape) as self.between:
                return self.press(self.height, self.space, start=start, rtol=tolerance, **load)
        except NotConverged as error:
            raise Failed(str(error)) from error

    def applications(self):
        """Zero-padded convolutions of the last call."""
        return self.work

    def coarse_applications(self):
        """Convolutions of the last call on coarser grids, as fractions of a full one by area."""
        return self.calls["coarse"]

    def path(self):
        """Whether between candidates for contact, by which operator, or on the whole window."""
        kept = "grid kept between solves"
        if isinstance(self.state, CandidateState):
            used = " and ".join(f"{n} {name}" for name, n in self.between.items())
            return f"between {self.state.candidates} candidates, applications: {used}; {kept}"
        return f"convolution of the window, {self.work} applications; {kept}"


class AtDefault(Ours):
    """The same at its default tolerance, or a tighter one where that leaves a larger error."""

    called, loosest = "fractalcontact at its default", Ours.likely


def forget(space):
    """Drop what a half-space has kept of the last contact set: a cold solve must not use it."""
    forget_preconditioner(space)


@contextmanager
def counted_convolutions(shape):
    """Count the fields convolved meanwhile: on grids of a shape, on others as fractions of it."""
    counts, convolve = {"full": 0, "coarse": 0.0}, HalfSpace.convolve

    def counted(space, values):
        ny, nx = space.shape
        fields = values.size // (ny * nx)
        if space.shape == shape:
            counts["full"] += fields
        else:
            counts["coarse"] += fields * (ny * nx) / (shape[0] * shape[1])
        return convolve(space, values)

    HalfSpace.convolve = counted
    try:
        yield counts
    finally:
        HalfSpace.convolve = convolve


@contextmanager
def counted_between_candidates(shape):
    """Count applications between candidates meanwhile, on a grid of a shape, by the operator."""
    counts = Counter()

    def counted(name, made):
        class Counted(made):
            def __init__(self, space, *rest):
                super().__init__(space, *rest)
                self.name = name if space.shape == shape else None

            def __call__(self, positions, values):
                if self.name is not None:
                    counts[self.name] += 1
                return super().__call__(positions, values)

        return Counted

    direct = counted("pair by pair", operator.DirectOperator)
    multipole = counted("multipole", operator.MultipoleOperator)
    with mock.patch.multiple(operator, DirectOperator=direct, MultipoleOperator=multipole):
        yield counts


class MethodOfThePackage(Ours):
    """A comparison method of the package; what it counts as work is its own."""

    def __init__(self, problem, control, method):
        super().__init__(problem, control)
        self.name, self.press, self.method = f"{method.name} ({control})", method, method
        self.likely = 10**method.likely
        self.convolves = method.counts == "applications"
        self.runs_sweep = method.warm and self.convolves

    def carries(self, problem):
        """Whether no more nodes interpenetrate than the method can take."""
        return self.method.largest is None or problem.overlapping <= self.method.largest

    def applications(self):
        """Zero-padded convolutions of the last call."""
        return self.work if self.convolves else None


class PublicCode(Solver):
    """A public code under the load that it declares first.

    A closure that is not given is evaluated from the pressure, outside the clock.
    """

    def __init__(self, problem, peer):
        self.control = peer.loads[0]
        self.name, self.likely = f"{peer.name} ({self.control})", 10**peer.likely
        self.runs_sweep = peer.warm
        self.code = peer.set_up(problem.height, problem.space)

    def solve(self, reference, tolerance, previous):
        """Load to the reference's closure or force."""
        self.code.count(self.counting)
        start = None if previous is None else previous.state
        try:
            pressure = self.code.solve(load_of(reference, self.control, start), tolerance)
        except PeerFailed as error:
            raise Failed(str(error)) from error
        force = float(pressure.sum()) * self.code.space.cell_area
        closure = reference.closure if self.control == "closure" else np.nan
        return Answer(force, closure, pressure)

    def complete(self, answer):
        """The closure of an answer, where it was not given."""
        if self.control != "closure":
            answer.closure = self.code.closure(answer.state)

    def applications(self):
        """Zero-padded convolutions of the last call."""
        return self.code.applications

    def path(self):
        """As the code counts it itself."""
        return self.code.path


#: The fastest of the peers, under dense and under light contact.
FASTEST_PEERS = ("ContactMechanics dual", "ASPHER active set")


def solvers_for(problem, *, methods, peers_wanted, every):
    """Solvers that can carry a problem, ours first; public codes only where they are installed.

    Parameters
    ----------
    problem : RoughProblem
    methods : bool
        Whether the package's comparison methods are wanted, if ``every`` solver is.
    peers_wanted : list of str or None
        Public codes, by name; all if None.
    every : bool
        Whether all that are wanted: else ours, and the fastest of the public codes.
    """
    chosen = [Ours(problem, "closure"), Ours(problem, "force"), AtDefault(problem, "closure")]
    if methods and every:
        chosen += [
            MethodOfThePackage(problem, control, method)
            for method in METHODS.values()
            # Under a force too where the work is counted in convolutions, as ours is.
            for control in method.loads[: None if method.counts == "applications" else 1]
        ]
    chosen += [
        PublicCode(problem, peer)
        for name, peer in installed_peers().items()
        if (peers_wanted is None or name in peers_wanted)
        and (every or name in FASTEST_PEERS)
        and peer.takes(problem.space)
    ]
    return [solver for solver in chosen if solver.carries(problem)]
