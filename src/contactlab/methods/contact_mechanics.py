"""ContactMechanics, a public code: its substrate ``FreeFFTElasticHalfSpace`` and an optimiser.

``ccg``: ``NonSmoothContactSystem.minimize_proxy``, its Polonsky-Keer iteration, at a given offset
or force (the latter took twice the time), with or without a hardness. ``dual`` and ``dual-lbfgs``:
``dual_minimize_proxy``, constrained conjugate gradients without restart, or L-BFGS-B, for pixel
forces at a given offset; L-BFGS-B is given no limit of iterations. The package transforms with one
thread; its parallelism is MPI's.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from roughcontact.elastic.halfspace import HalfSpace

from .common import in_stress
from .method import Method
from .peers import Failed, Load, PublicCode

# Names of the dual optimisers in ContactMechanics.
_DUAL = {"dual": "ccg-without-restart", "dual-lbfgs": "l-bfgs-b"}


class ContactMechanics(PublicCode):
    """ContactMechanics set up for one topography, with optimiser "ccg", "dual" or "dual-lbfgs"."""

    def __init__(self, height: ArrayLike, space: HalfSpace, optimiser: str):
        from ContactMechanics import FreeFFTElasticHalfSpace
        from ContactMechanics.Systems import NonSmoothContactSystem
        from SurfaceTopography import Topography

        super().__init__(height, space)
        self.optimiser = optimiser
        self.substrate = FreeFFTElasticHalfSpace(space.shape, space.modulus, self.sides)
        self.system = NonSmoothContactSystem(self.substrate, Topography(self.height, self.sides))
        # All of its optimisers call these two functions.
        self._evaluate = {
            name: getattr(self.substrate, name) for name in ("evaluate_disp", "evaluate_force")
        }

    def solve(self, load: Load, rtol: float) -> np.ndarray:
        """Pressure at a closure or, of ``ccg``, under a force, as `PublicCode.solve`.

        The tolerance is relative: of gaps to the closure, of forces to ``pixel_force``, by default
        that of a pixel pressed alone. Where the closure is not known or zero, gaps are compared
        with the standard deviation of the heights or, if that is more, with the closure of a punch
        as large as the window.
        """
        area = self.space.cell_area
        length = load.closure or self._length(load.force)
        pixel_force = load.pixel_force
        if pixel_force is None:
            pixel_force = self.space.modulus * self.space.cell * length
        forces = None if load.start is None else load.start * area
        if self.optimiser == "ccg":
            tolerances = {
                "pentol": rtol * length,
                "forcetol": rtol * pixel_force,
                "thermotol": rtol,
            }
            result = self._ccg(load, forces, tolerances)
            reached = result.jac
        else:
            result = self._dual(load.closure, rtol * length, forces)
            reached = result.x
        cap = np.inf if load.hardness is None else load.hardness
        pressure = in_stress(np.reshape(reached, self.space.shape), 1 / area, cap)
        if not result.success:
            raise Failed(str(result.message), pressure)
        return pressure

    def _length(self, force):
        """Scale of the gaps of a load without closure, mm."""
        side = np.sqrt(np.prod(self.space.shape)) * self.space.cell
        return max(np.std(self.height), (force or 0.0) / (self.space.modulus * side))

    def _ccg(self, load, start, tolerances):
        padded = None
        if start is not None:
            padded = np.zeros(self.substrate.nb_domain_grid_pts)
            padded[: start.shape[0], : start.shape[1]] = -start
        # The division is that of `in_stress`, so that pressures at the cap are recognised.
        cap = None if load.hardness is None else load.hardness / (1 / self.space.cell_area)
        return self.system.minimize_proxy(
            offset=load.closure,
            external_force=load.force,
            hardness=cap,
            initial_forces=padded,
            maxiter=self.max_iterations,
            **tolerances,
        )

    def _dual(self, closure, tolerance, start):
        return self.system.dual_minimize_proxy(
            offset=closure,
            init_force=np.zeros(self.substrate.nb_grid_pts) if start is None else start.copy(),
            solver=_DUAL[self.optimiser],
            gtol=tolerance,
            maxiter=self.max_iterations,
        )

    def count(self, on: bool) -> None:
        """Begin or end to count calls, by wrapping ``evaluate_disp`` and ``evaluate_force``."""
        self._applications = 0
        for name, evaluate in self._evaluate.items():

            def counted(*args, evaluate=evaluate, **options):
                self._applications += 1
                return evaluate(*args, **options)

            setattr(self.substrate, name, counted if on else evaluate)

    @property
    def applications(self) -> int:
        """Displacements and forces evaluated, each by one zero-padded convolution."""
        return self._applications


_CCG = Method(
    name="ContactMechanics ccg",
    order=110,
    loads=("closure", "force"),
    hardness=("closure", "force"),
    kernels=("love",),
    holes=True,
    warm=True,
    counts="applications",
    likely=-4.5,
    packages=("ContactMechanics", "muGrid"),
    options={"optimiser": "ccg"},
    solver=ContactMechanics,
)
_BY_CLOSURE = replace(_CCG, loads=("closure",), hardness=(), likely=-5.5)
METHODS = [
    _CCG,
    *(
        replace(
            _BY_CLOSURE,
            name=f"ContactMechanics {optimiser}",
            order=120 + 10 * place,
            options={"optimiser": optimiser},
        )
        for place, optimiser in enumerate(_DUAL)
    ),
]
