"""Tamaas, a public code: ``PolonskyKeerRey`` on its non-periodic operator ``dcfft``, by force only.

Its solver starts from ``model.traction``: zero for a cold start (it then spreads the load evenly).
Its displacement is known up to a constant, so the closure is evaluated from its pressure with its
operator. The wheels on PyPI have one thread.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from roughcontact.elastic.halfspace import HalfSpace

from .method import Method
from .peers import Failed, Load, PublicCode


class Tamaas(PublicCode):
    """Tamaas set up for one topography."""

    def __init__(self, height: ArrayLike, space: HalfSpace):
        import tamaas

        super().__init__(height, space)
        tamaas.set_log_level(tamaas.LogLevel.warning)
        self.tamaas: Any = tamaas
        self._counter: Any = None
        self.window = self.sides[0] * self.sides[1]
        kind = tamaas.model_type.basic_2d
        self.model = tamaas.ModelFactory.createModel(kind, list(self.sides), list(space.shape))
        # The operator copies the modulus when it is registered, so that it is set first.
        self.model.E, self.model.nu = space.modulus, 0.0
        tamaas.ModelFactory.registerNonPeriodic(self.model, "dcfft")
        self.height = np.ascontiguousarray(self.height)

    def solve(self, load: Load, rtol: float) -> np.ndarray:
        """Pressure under a force, as `PublicCode.solve`.

        The tolerance is on the gap in contact, averaged with the pressure, relative to the standard
        deviation of the heights.
        """
        if load.force is None:
            raise ValueError("Tamaas takes a force: give force=")
        self.model.traction[:] = 0.0 if load.start is None else load.start
        solver = self.tamaas.PolonskyKeerRey(self.model, self.height, rtol)
        solver.setIntegralOperator("dcfft")
        solver.max_iter = self.max_iterations
        if self._counter is not None:
            solver.addFunctionalTerm(self._counter)
        # Tamaas solves for given forces only.
        reached = solver.solve(load.force / self.window)  # type: ignore[operator]
        pressure = np.array(self.model.traction)
        if not reached <= rtol:
            raise Failed(f"error {reached:.2g} after {self.max_iterations} iterations", pressure)
        return pressure

    def closure(self, pressure: np.ndarray) -> float:
        """Closure of a pressure, from the mean gap over the contact, mm."""
        displacement = np.zeros_like(pressure)
        self.model.operators["dcfft"](pressure, displacement)
        return float((displacement - self.height)[pressure > 0].mean())

    def count(self, on: bool) -> None:
        """Begin or end to count gradients, by a functional that adds zero to the energy."""
        self._counter = _counter(self.tamaas) if on else None

    @property
    def applications(self) -> int:
        """Zero-padded convolutions: two an iteration, for gradient and step."""
        return 2 * self._counter.iterations


def _counter(tamaas):
    class Counter(tamaas.Functional):
        def __init__(self):
            super().__init__()
            self.iterations = 0

        def computeGradF(self, variable, gradient):
            self.iterations += 1

        def computeF(self, variable, dual):
            return 0.0

    return Counter()


METHODS = [
    Method(
        name="Tamaas",
        order=200,
        loads=("force",),
        kernels=("love",),
        warm=True,
        counts="applications",
        likely=-3.5,
        packages=("tamaas",),
        solver=Tamaas,
    )
]
