"""Public contact codes behind the call of the comparison methods, where they are installed.

ContactMechanics (its substrate ``FreeFFTElasticHalfSpace``) and Tamaas (its non-periodic operator
``dcfft``) solve the same free-space problem. Both are given heights from the highest one down. What
they return is not checked against the contact conditions: whether their own word can be trusted is
for others to judge. ``pip install -e '.[peers]'`` installs both.
"""

from functools import partial
from importlib import import_module
from importlib.util import find_spec

import numpy as np

from ..core.child_process import in_child
from ..core.errors import NotConverged
from .common import in_stress, measured_state, refuse_closure, refuse_force, refuse_hardness

#: Limit of iterations where a peer is set up for large grids.
MAX_ITERATIONS = 500
#: Behind the call of the comparison methods patience is greater, in iterations and in seconds.
PATIENT_ITERATIONS, PATIENCE = 2000, 60.0
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

    ``ccg``: ``NonSmoothContactSystem.minimize_proxy``, its Polonsky-Keer iteration, at a given
    offset or force (the latter took twice the time), with or without a hardness. ``dual`` and
    ``dual-lbfgs``: ``dual_minimize_proxy``, constrained conjugate gradients without restart, or
    L-BFGS-B, for pixel forces at a given offset; L-BFGS-B is given no limit of iterations. The
    package transforms with one thread; its parallelism is MPI's.

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

        self.space, self.optimiser, self.max_iterations = space, optimiser, MAX_ITERATIONS
        sides = tuple(n * d for n, d in zip(space.shape, space.spacing, strict=True))
        self.substrate = FreeFFTElasticHalfSpace(space.shape, space.modulus, sides)
        # First touch at offset 0, so that its offset is our closure.
        self.height = -clearance_of(height)
        self.system = NonSmoothContactSystem(self.substrate, Topography(self.height, sides))

    def solve(self, closure, rtol, *, force=None, hardness=None, pixel_force=None, start=None):
        """Pressure at a closure or, of ``ccg``, under a force.

        Parameters
        ----------
        closure : float or None
            mm.
        rtol : float
            Tolerance of gaps as a share of the closure, and of forces as one of ``pixel_force``.
            Where the closure is not known or zero, gaps are compared with the standard deviation
            of the heights or, if that is more, with the closure of a punch as large as the window.
        force : float, optional
            N, instead of a closure.
        hardness : float, optional
            Largest pressure, MPa; of ``ccg``.
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
        length = closure or self._length(force)
        if pixel_force is None:
            pixel_force = self.space.modulus * self.space.cell * length
        forces = None if start is None else start * area
        if self.optimiser == "ccg":
            tolerances = {
                "pentol": rtol * length,
                "forcetol": rtol * pixel_force,
                "thermotol": rtol,
            }
            result = self._ccg(closure, force, hardness, forces, tolerances)
            found = result.jac
        else:
            result = self._dual(closure, rtol * length, forces)
            found = result.x
        cap = np.inf if hardness is None else hardness
        pressure = in_stress(np.reshape(found, self.space.shape), 1 / area, cap)
        if not result.success:
            raise Failed(str(result.message), pressure)
        return pressure

    def _length(self, force):
        """What gaps are compared with where the closure is not known, mm."""
        side = np.sqrt(np.prod(self.space.shape)) * self.space.cell
        return max(np.std(self.height), (force or 0.0) / (self.space.modulus * side))

    def _ccg(self, closure, force, hardness, start, tolerances):
        padded = None
        if start is not None:
            padded = np.zeros(self.substrate.nb_domain_grid_pts)
            padded[: start.shape[0], : start.shape[1]] = -start
        # Divided as in `in_stress`: what comes back at the cap must be seen to be there.
        cap = None if hardness is None else hardness / (1 / self.space.cell_area)
        return self.system.minimize_proxy(
            offset=closure,
            external_force=force,
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
        self.tamaas, self.space, self.max_iterations = tamaas, space, MAX_ITERATIONS
        sides = [n * d for n, d in zip(space.shape, space.spacing, strict=True)]
        self.window = sides[0] * sides[1]
        kind = tamaas.model_type.basic_2d
        self.model = tamaas.ModelFactory.createModel(kind, sides, list(space.shape))
        # The operator takes over the modulus it finds when it is registered.
        self.model.E, self.model.nu = space.modulus, 0.0
        tamaas.ModelFactory.registerNonPeriodic(self.model, "dcfft")
        self.height = np.ascontiguousarray(-clearance_of(height))

    def solve(self, force, rtol, *, start=None, functional=None):
        """Pressure under a force.

        Parameters
        ----------
        force : float
            N.
        rtol : float
            Tolerance of Tamaas' own error measure: the gap in contact, averaged with the pressure,
            as a share of the standard deviation of the heights.
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
        solver.max_iter = self.max_iterations
        if functional is not None:
            solver.addFunctionalTerm(functional)
        reached = solver.solve(force / self.window)
        pressure = np.array(self.model.traction)
        if not reached <= rtol:
            raise Failed(f"error {reached:.2g} after {self.max_iterations} iterations", pressure)
        return pressure

    def closure(self, pressure):
        """The closure of a pressure, from the mean gap over the contact, mm."""
        displacement = np.zeros_like(pressure)
        self.model.operators["dcfft"](pressure, displacement)
        return float((displacement - self.height)[pressure > 0].mean())


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
    """A load is passed on as it is: that it makes no sense is for the peer to say."""
    if name != "Tamaas":
        refuse_missing(name, composite)
    if name != "ContactMechanics ccg":
        refuse_hardness(name, hardness)
    if name == "Tamaas":
        refuse_closure(name, closure)
    elif name != "ContactMechanics ccg":
        refuse_force(name, force)
    # Once, and not in every child.
    import_module(name.split()[0].replace("Tamaas", "tamaas"))
    load = {"closure": closure, "force": force, "hardness": hardness}
    first = None if start is None else start.pressure
    press = partial(_pressed, name, composite, space, load, rtol, first)
    pressure, said = in_child(press, seconds=PATIENCE)
    state = state_of(space, pressure, clearance_of(composite), **load)
    if said:
        raise NotConverged(said, state, state.residual)
    return state


def _pressed(name, composite, space, load, rtol, start):
    """Pressure, and what a peer says if it did not converge."""
    peer = set_up(name, composite, space)
    peer.max_iterations = PATIENT_ITERATIONS
    try:
        if name == "Tamaas":
            return peer.solve(load["force"], rtol, start=start), ""
        return peer.solve(load.pop("closure"), rtol, start=start, **load), ""
    except Failed as failure:
        return failure.pressure, str(failure)


def refuse_missing(name, height):
    """Say that ContactMechanics takes a cell without a height for a hole, if there is one."""
    if not np.isfinite(height).all():
        raise ValueError(f"{name} solves another problem: a missing cell is one that never touches")


def clearance_of(height):
    """Opening at first touch, mm; cells without a height keep their NaN or infinity.

    Parameters
    ----------
    height : (ny, nx) array_like
        mm.

    Returns
    -------
    (ny, nx) ndarray
    """
    height = np.asarray(height, float)
    return height[np.isfinite(height)].max() - height


def state_of(space, pressure, clearance, *, closure=None, force=None, hardness=None):
    """What a peer's pressure is as a state, whether or not it satisfies the contact conditions.

    Parameters
    ----------
    space : HalfSpace
    pressure : (ny, nx) ndarray
        MPa.
    clearance : (ny, nx) ndarray
        Opening at first touch, mm.
    closure : float, optional
        mm; if it is not known it is evaluated as the mean over the contact that is no overlap.
    force, hardness : float, optional
        N and MPa, where they were given.

    Returns
    -------
    ContactState
        Its ``residual`` is measured with our operator; its ``iterations`` are not known: 0.
    """
    cap = np.inf if hardness is None else hardness
    if closure is None:
        between = (pressure > 0) & (pressure < cap)
        reached = space.displacement(pressure) + clearance
        closure = float(reached[between].mean()) if between.any() else 0.0
    return measured_state(space, clearance, pressure, closure, force=force, hardness=cap)
