"""Every solver behind one call: ours, the package's comparison methods, and the public codes.

A solver is made for one scene. ``solve(reference, tolerance, previous)`` presses it to the
reference's closure or force, whichever it controls, from ``previous`` (what the last call returned,
or None for a cold start), and returns an `Answer`. ``applications()`` tells how many zero-padded
convolutions the last call took; where counting costs time it is switched on by ``counting``.
``likely`` is a tolerance near the one that reaches the benchmark's error at 512 x 512: the search
for the best begins there, and ends at ``loosest``.
"""

from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from fractalcontact import HalfSpace, NotConverged, solve_contact
from fractalcontact.contact.preconditioner import forget_preconditioner
from fractalcontact.methods import peers
from fractalcontact.methods.registry import METHODS


class Failed(RuntimeError):
    """The solver itself says that it did not converge."""


@dataclass
class Answer:
    """Force and closure reached, and whatever the same solver can start from."""

    force: float
    closure: float
    state: object = None


class Solver:
    """What the table needs of every solver; this is the part most of them share."""

    runs_sweep = True
    counting = False
    loosest = 1e-2

    def carries(self, scene):
        """Whether a solve of this scene takes seconds rather than hours."""
        return True

    def complete(self, answer):
        """Fill in, outside the clock, what the solver does not report itself."""

    def coarse_applications(self):
        """Convolutions of the last call on coarser grids, as shares of a full one by area."""
        return 0.0


class Ours(Solver):
    """`fractalcontact.solve_contact`."""

    called, likely = "fractalcontact", 1e-6
    press = staticmethod(solve_contact)

    def __init__(self, scene, control):
        self.name, self.control = f"{self.called} ({control})", control
        self.height, self.space = scene.height, scene.space
        self.calls = {"full": 0, "coarse": 0.0}

    def solve(self, reference, tolerance, previous):
        """Press to the reference's closure or force."""
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
        return Answer(state.force, state.closure, state)

    def _solve(self, load, start, tolerance):
        try:
            return self.press(self.height, self.space, start=start, rtol=tolerance, **load)
        except NotConverged as error:
            raise Failed(str(error)) from error

    def applications(self):
        """Zero-padded convolutions of the last call."""
        return self.work

    def coarse_applications(self):
        """Convolutions of the last call on coarser grids, as shares of a full one by area."""
        return self.calls["coarse"]


class AtDefault(Ours):
    """The same at its default tolerance, or a tighter one where that leaves a larger error."""

    called, loosest = "fractalcontact at its default", Ours.likely


def forget(space):
    """Drop what a half-space has kept of the last contact set: a cold solve must not find it."""
    forget_preconditioner(space)


@contextmanager
def counted_convolutions(shape):
    """Count the fields convolved meanwhile: on grids of a shape, and on others as shares of it."""
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


#: Interpenetrating nodes beyond which a single solve takes minutes or too much memory.
LARGEST = {"dense": 6000, "paper": 12_000, "gauss-seidel": 12_000, "nnls": 12_000}
#: The method whose `iterations` are convolutions.
CONVOLVES = "polonsky-keer"


class Method(Ours):
    """A comparison method of the package; what it counts as work is its own."""

    likely, loosest = 1e-5, 1e-2

    def __init__(self, scene, control, method):
        super().__init__(scene, control)
        self.name, self.method = f"{method} ({control})", method
        self.press = METHODS[method]
        self.runs_sweep = method == CONVOLVES

    def carries(self, scene):
        """Whether no more nodes interpenetrate than the method can take."""
        return scene.overlapping <= LARGEST.get(self.method, np.inf)

    def applications(self):
        """Zero-padded convolutions of the last call."""
        return self.work if self.method == CONVOLVES else None


class ContactMechanics(Solver):
    """ContactMechanics with one of the optimisers it offers.

    Tolerances are shares of the closure and of the mean pixel force in contact. Convolutions are
    counted by wrapping ``evaluate_disp`` and ``evaluate_force`` of the substrate, which all of its
    optimisers call.
    """

    control = "closure"

    def __init__(self, scene, optimiser):
        self.name = f"ContactMechanics {optimiser} (closure)"
        self.likely = 10**-4.5 if optimiser == "ccg" else 10**-5.5
        self.peer, self.work = peers.ContactMechanics(scene.height, scene.space, optimiser), None
        self.substrate = self.peer.substrate
        self.evaluate = {
            name: getattr(self.substrate, name) for name in ("evaluate_disp", "evaluate_force")
        }

    def solve(self, reference, tolerance, previous):
        """Press to the reference's closure or force."""
        self._count()
        start = None if previous is None else previous.state
        nodes = reference.fraction * reference.state.pressure.size
        try:
            pressure = self.peer.solve(
                reference.closure, tolerance, pixel_force=reference.force / nodes, start=start
            )
        except peers.Failed as error:
            raise Failed(str(error)) from error
        force = float(pressure.sum()) * self.peer.space.cell_area
        return Answer(force, reference.closure, pressure)

    def _count(self):
        self.work = 0 if self.counting else None
        for name, evaluate in self.evaluate.items():

            def counted(*args, evaluate=evaluate, **options):
                self.work += 1
                return evaluate(*args, **options)

            setattr(self.substrate, name, counted if self.counting else evaluate)

    def applications(self):
        """Zero-padded convolutions of the last call."""
        return self.work


class Tamaas(Solver):
    """Tamaas; force control only.

    Its closure is evaluated outside the clock. An iteration convolves twice, for gradient and step;
    iterations are counted by a functional that adds nothing.
    """

    control = "force"
    name = "Tamaas (force)"
    likely = 10**-3.5

    def __init__(self, scene):
        self.peer, self.counter = peers.Tamaas(scene.height, scene.space), None

    def solve(self, reference, tolerance, previous):
        """Press to the reference's closure or force."""
        self.counter = _tamaas_counter(self.peer.tamaas) if self.counting else None
        start = None if previous is None else previous.state
        try:
            pressure = self.peer.solve(
                reference.force, tolerance, start=start, functional=self.counter
            )
        except peers.Failed as error:
            raise Failed(str(error)) from error
        force = float(pressure.sum()) * self.peer.space.cell_area
        return Answer(force, np.nan, pressure)

    def complete(self, answer):
        """The closure of an answer, from the mean gap over the contact."""
        answer.closure = self.peer.closure(answer.state)

    def applications(self):
        """Zero-padded convolutions of the last call."""
        return 2 * self.counter.iterations


def _tamaas_counter(tamaas):
    class Counter(tamaas.Functional):
        def __init__(self):
            super().__init__()
            self.iterations = 0

        def computeGradF(self, variable, gradient):
            self.iterations += 1

        def computeF(self, variable, dual):
            return 0.0

    return Counter()


#: The fastest of the peers.
FASTEST_PEER = "ContactMechanics dual"


def solvers_for(scene, *, methods, peers_wanted, every):
    """The solvers that can carry a scene, ours first; peers only where they are installed.

    Parameters
    ----------
    scene : RoughScene
    methods : bool
        Whether the package's comparison methods are wanted, if ``every`` solver is.
    peers_wanted : list of str or None
        Other codes, by name; all if None.
    every : bool
        Whether all that are wanted: else ours, and the fastest of the peers.
    """
    chosen = [Ours(scene, "closure"), Ours(scene, "force"), AtDefault(scene, "closure")]
    if methods and every:
        chosen += [
            Method(scene, control, method)
            for method, control in [
                ("polonsky-keer", "closure"),
                ("polonsky-keer", "force"),
                ("dense", "closure"),
                ("paper", "closure"),
                ("gauss-seidel", "closure"),
                ("nnls", "closure"),
            ]
        ]
    chosen += [
        Tamaas(scene) if name == "Tamaas" else ContactMechanics(scene, name.split()[1])
        for name in peers.installed()
        if (peers_wanted is None or name in peers_wanted) and (every or name == FASTEST_PEER)
    ]
    return [solver for solver in chosen if solver.carries(scene)]
