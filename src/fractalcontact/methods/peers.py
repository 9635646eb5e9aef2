"""Public contact codes behind the call of the comparison methods, where they are installed.

ContactMechanics (its substrate ``FreeFFTElasticHalfSpace``) and Tamaas (its non-periodic operator
``dcfft``) solve the same free-space problem. Each takes one control only. What they return is not
checked against the contact conditions: whether their own word can be trusted is for others to
judge. ``pip install -e '.[peers]'`` installs both.
"""

from functools import partial
from importlib.util import find_spec

import numpy as np

from ..contact import ContactState, checked_problem, unloaded_state
from ..errors import NotConverged
from .common import refuse_force, refuse_hardness

MAX_ITERATIONS = 500
#: The optimisers of ContactMechanics: its Polonsky-Keer iteration, and two on the dual problem.
OPTIMISERS = ("ccg", "dual", "dual-lbfgs")
# Their names there.
_DUAL = {"dual": "ccg-without-restart", "dual-lbfgs": "l-bfgs-b"}


class Failed(RuntimeError):
    """The code itself says that it did not converge; ``pressure`` is what it left, in MPa."""

    def __init__(self, message, pressure):
        super().__init__(message)
        self.pressure = pressure


class ContactMechanics:
    """ContactMechanics set up for one topography: ``FreeFFTElasticHalfSpace`` and an optimiser.

    ``ccg``: ``NonSmoothContactSystem.minimize_proxy``, its Polonsky-Keer iteration at a given
    offset (with ``external_force`` it took twice the time). ``dual`` and ``dual-lbfgs``:
    ``dual_minimize_proxy``, constrained conjugate gradients without restart, or L-BFGS-B, for pixel
    forces at a given offset; L-BFGS-B knows no limit of iterations. The package transforms with one
    thread; its parallelism is MPI's.

    Parameters
    ----------
    height : (ny, nx) array_like
        mm.
    space : HalfSpace
    optimiser : str
        One of `OPTIMISERS`.
    """

    control = "closure"

    def __init__(self, height, space, optimiser):
        from ContactMechanics import FreeFFTElasticHalfSpace
        from ContactMechanics.Systems import NonSmoothContactSystem
        from SurfaceTopography import Topography

        self.space, self.optimiser = space, optimiser
        sides = tuple(n * d for n, d in zip(space.shape, space.spacing, strict=True))
        self.substrate = FreeFFTElasticHalfSpace(space.shape, space.modulus, sides)
        # First touch at offset 0, so that its offset is our closure.
        topography = Topography(np.asarray(height, float) - np.max(height), sides)
        self.system = NonSmoothContactSystem(self.substrate, topography)

    def solve(self, closure, rtol, *, pixel_force=None, start=None):
        """Pressure at a closure.

        Parameters
        ----------
        closure : float
            mm.
        rtol : float
            Tolerance of gaps as a share of the closure, and of forces as one of ``pixel_force``.
        pixel_force : float, optional
            Mean force of a pixel in contact, N; by default that of one pressed alone.
        start : (ny, nx) ndarray, optional
            Pressure to start from, MPa.

        Returns
        -------
        (ny, nx) ndarray
            Pressure, MPa.

        Raises
        ------
        Failed
        """
        area = self.space.cell_area
        if pixel_force is None:
            pixel_force = self.space.modulus * self.space.cell * closure
        forces = None if start is None else start * area
        if self.optimiser == "ccg":
            result = self._ccg(closure, rtol, rtol * pixel_force, forces)
            found = result.jac
        else:
            result = self._dual(closure, rtol, forces)
            found = result.x
        pressure = np.reshape(found, self.space.shape) / area
        if not result.success:
            raise Failed(str(result.message), pressure)
        return pressure

    def _ccg(self, closure, rtol, force_tolerance, start):
        padded = None
        if start is not None:
            padded = np.zeros(self.substrate.nb_domain_grid_pts)
            padded[: start.shape[0], : start.shape[1]] = -start
        return self.system.minimize_proxy(
            offset=closure,
            initial_forces=padded,
            pentol=rtol * closure,
            forcetol=force_tolerance,
            thermotol=rtol,
            maxiter=MAX_ITERATIONS,
        )

    def _dual(self, closure, rtol, start):
        return self.system.dual_minimize_proxy(
            offset=closure,
            init_force=np.zeros(self.substrate.nb_grid_pts) if start is None else start.copy(),
            solver=_DUAL[self.optimiser],
            gtol=rtol * closure,
            maxiter=MAX_ITERATIONS,
        )


class Tamaas:
    """Tamaas set up for one topography: ``PolonskyKeerRey`` on ``dcfft``, force control only.

    Its solver starts from ``model.traction``: zero for a cold start (it then spreads the load
    evenly). Its displacement is known up to a constant, so the closure is evaluated from its
    pressure with its operator. The wheels on PyPI have one thread.

    Parameters
    ----------
    height : (ny, nx) array_like
        mm.
    space : HalfSpace
    """

    control = "force"

    def __init__(self, height, space):
        import tamaas

        tamaas.set_log_level(tamaas.LogLevel.warning)
        self.tamaas, self.space = tamaas, space
        sides = [n * d for n, d in zip(space.shape, space.spacing, strict=True)]
        self.window = sides[0] * sides[1]
        kind = tamaas.model_type.basic_2d
        self.model = tamaas.ModelFactory.createModel(kind, sides, list(space.shape))
        # The operator takes over the modulus it finds when it is registered.
        self.model.E, self.model.nu = space.modulus, 0.0
        tamaas.ModelFactory.registerNonPeriodic(self.model, "dcfft")
        self.height = np.ascontiguousarray(height, float)

    def solve(self, force, rtol, *, start=None, functional=None):
        """Pressure under a force.

        Parameters
        ----------
        force : float
            N.
        rtol : float
            Tolerance of Tamaas' own error measure.
        start : (ny, nx) ndarray, optional
            Pressure to start from, MPa.
        functional : tamaas.Functional, optional
            Added to the energy; one that adds nothing can count.

        Returns
        -------
        (ny, nx) ndarray
            Pressure, MPa.

        Raises
        ------
        Failed
        """
        self.model.traction[:] = 0.0 if start is None else start
        solver = self.tamaas.PolonskyKeerRey(self.model, self.height, rtol)
        solver.setIntegralOperator("dcfft")
        solver.max_iter = MAX_ITERATIONS
        if functional is not None:
            solver.addFunctionalTerm(functional)
        reached = solver.solve(force / self.window)
        pressure = np.array(self.model.traction)
        if not reached <= rtol:
            raise Failed(f"error {reached:.2g} after {MAX_ITERATIONS} iterations", pressure)
        return pressure

    def closure(self, pressure):
        """The closure of a pressure, from the mean gap over the contact, mm."""
        displacement = np.zeros_like(pressure)
        self.model.operators["dcfft"](pressure, displacement)
        gap = displacement + self.height.max() - self.height
        return float(gap[pressure > 0].mean())


def set_up(name, height, space):
    """A peer made ready for one topography.

    Parameters
    ----------
    name : str
        One of `installed`.
    height : (ny, nx) array_like
        mm.
    space : HalfSpace

    Returns
    -------
    ContactMechanics or Tamaas
    """
    if name == "Tamaas":
        return Tamaas(height, space)
    return ContactMechanics(height, space, name.removeprefix("ContactMechanics "))


def installed():
    """Names of the peers that can be imported: the optimisers of ContactMechanics, and Tamaas."""
    names = []
    if find_spec("ContactMechanics"):
        names += [f"ContactMechanics {optimiser}" for optimiser in OPTIMISERS]
    if find_spec("tamaas"):
        names.append("Tamaas")
    return names


def peer_methods():
    """The installed peers by name, with the call of `fractalcontact.solve_contact`."""
    return {name: partial(_solve_with, name) for name in installed()}


def _solve_with(
    name, composite, space, *, closure=None, force=None, start=None, rtol=1e-6, hardness=None
):
    refuse_hardness(name, hardness)
    if name != "Tamaas":
        refuse_force(name, force)
    elif closure is not None:
        raise ValueError("Tamaas takes a force only: give force=, not closure=")
    load, clearance = checked_problem(composite, space, closure, force, start, rtol)
    if load == 0:
        return unloaded_state(space, clearance)
    peer = set_up(name, composite, space)
    first = None if start is None else start.pressure
    try:
        pressure = peer.solve(load, rtol, start=first)
    except Failed as failure:
        state = state_of(peer, failure.pressure, clearance, closure)
        raise NotConverged(str(failure), state, state.residual) from failure
    return state_of(peer, pressure, clearance, closure)


def state_of(peer, pressure, clearance, closure=None):
    """What a peer's pressure is as a state, whether or not it satisfies the contact conditions.

    Parameters
    ----------
    peer : ContactMechanics or Tamaas
    pressure : (ny, nx) ndarray
        MPa.
    clearance : (ny, nx) ndarray
        Opening at first touch, mm.
    closure : float, optional
        mm; of Tamaas it is evaluated.

    Returns
    -------
    ContactState
        Its ``residual`` is measured with our operator; its ``iterations`` are not known: 0.
    """
    space = peer.space
    closure = peer.closure(pressure) if closure is None else closure
    displacement = space.displacement(pressure)
    gap = displacement + clearance - closure
    worst = max(gap[pressure > 0].max(initial=0.0), -gap.min(initial=0.0))
    return ContactState(
        pressure=pressure,
        displacement=displacement,
        gap=gap,
        closure=closure,
        force=float(pressure.sum()) * space.cell_area,
        residual=float(worst / closure),
        iterations=0,
        space=space,
    )
