"""State of contact: pressures, displacements, gaps and derived quantities."""

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..elastic.halfspace import HalfSpace
from ..errors import NotConverged
from ..threads import computed_once
from .bounds import Bounds
from .corrected_area import corrected_area
from .effort import SOLVING
from .kkt import frank_wolfe_gap
from .operator import Operator
from .projected_cg import stiffness
from .slope import Slope, secant_slope
from .topography import Topography

# Largest relative error allowed of the stiffness.
STIFFNESS_ERROR = 1e-6


@dataclass(frozen=True)
class ContactState:
    """State of contact that satisfies the contact conditions to ``residual``.

    Attributes
    ----------
    pressure : (ny, nx) ndarray
        p, MPa, zero outside the contact domain.
    displacement : (ny, nx) ndarray
        Elastic displacement u = K p of the composite surface, mm.
    gap : (ny, nx) ndarray
        Gap, mm; in contact zero to within ``residual`` times the closure, and negative where the
        pressure is at the hardness.
    closure : float
        w from first touch, mm: the rigid-body approach (indentation) of contact mechanics. For a
        periodic or mirrored window it is the approach of the surface's mean plane.
    force : float
        F, N.
    residual : float
        Largest violation of the contact conditions, as a fraction of the closure; under a given
        force also of the force, as a fraction of it.
    iterations : int
        Applications of the elastic operator, in either precision; those on coarser grids, for a
        start, are not counted.
    space : HalfSpace
        The operator it was solved with.
    hardness : float or (ny, nx) ndarray
        Largest pressure, MPa, of all nodes or of each; infinite for an elastic surface.
    """

    pressure: np.ndarray
    displacement: np.ndarray
    gap: np.ndarray
    closure: float
    force: float
    residual: float
    iterations: int
    space: HalfSpace = dataclasses.field(repr=False)
    hardness: float | np.ndarray = np.inf
    _before: "ContactState | None" = dataclasses.field(default=None, repr=False, compare=False)
    _solver: Callable[..., Any] | None = dataclasses.field(default=None, repr=False, compare=False)

    def __repr__(self):
        least = np.min(self.hardness)
        cap = "" if least == np.inf else f", hardness={least:.6g} MPa"
        nodes = np.count_nonzero(self.in_contact)
        return (
            f"<ContactState {self.pressure.shape[0]} x {self.pressure.shape[1]}: "
            f"force={self.force:.6g} N, closure={self.closure:.6g} mm, area={self.area:.6g} mm2, "
            f"{nodes} nodes in contact, residual={self.residual:.1g}{cap}>"
        )

    @property
    def in_contact(self) -> np.ndarray:
        """Contact map, (ny, nx) bool: the nodes that carry pressure."""
        return self.pressure > 0

    @property
    def area(self) -> float:
        """Real contact area A_r = N s^2 of the N nodes in contact, mm2."""
        return float(np.count_nonzero(self.in_contact)) * self.space.cell_area

    @property
    def corrected_area(self) -> float:
        """Real contact area corrected for the staircase of its edge, mm2 (`corrected_area`)."""
        return float(corrected_area(self.in_contact, self.space.spacing))

    @property
    def mean_pressure(self) -> float:
        """Force over the area of the window, MPa."""
        return self.force / self.space.area

    @property
    def elastic_energy(self) -> float:
        """Elastic energy, sum p u s^2 / 2, N mm."""
        pressure, displacement, _ = self._on_nodes()
        return float((pressure * displacement).sum()) * self.space.cell_area / 2

    @property
    def ambiguous(self) -> int:
        """Number of ambiguous contact nodes, which may or may not touch at this ``residual``.

        Nodes out of contact count if their gap is within the gap tolerance, ``residual`` times the
        closure, and nodes in contact if their pressure is at most what closes such a gap on one
        cell.
        """
        tolerance = self.residual * self.closure
        if not self.space.is_free:
            mean = float(self.pressure.mean())
            tolerance += self.residual * mean * self.space.cell / self.space.modulus
        weakest = tolerance * self.space.modulus / self.space.cell
        pressure, _, gap = self._on_nodes()
        touching = pressure > 0
        weak, near = touching & (pressure <= weakest), ~touching & (gap <= tolerance)
        return int(np.count_nonzero(weak | near))

    @computed_once
    def energy_error(self) -> float:
        """Bound on the energy above its minimum at the same force, as a fraction of the energy.

        The energy E = sum (u / 2 + c) p s^2, elastic and of closing the clearance c, is least for
        the exact state among all pressures of its force within the bounds, whether the force or the
        closure was given. The bound is the Frank-Wolfe gap (`kkt.frank_wolfe_gap`); it also bounds
        the elastic energy of the pressure's error. 0 without a force.
        """
        pressure, displacement, gap = (values.ravel() for values in self._on_nodes())
        # The energy is sum p (c + u / 2), with the clearance c = g - u + w.
        energy = float(pressure @ (gap - displacement / 2)) + self.closure * float(pressure.sum())
        bound = frank_wolfe_gap(pressure, gap, np.ravel(self.hardness))
        return bound / energy if energy > 0 else 0.0

    def _on_nodes(self):
        """Pressure, displacement and gap of all nodes that may carry pressure.

        All others are further from contact than the tolerance.
        """
        return self.pressure, self.displacement, self.gap

    @property
    def composite(self) -> np.ndarray:
        """Composite topography that was solved, mm, (ny, nx), from any datum."""
        return self.displacement - self.gap

    @property
    def stiffness(self) -> float:
        """Normal stiffness dF/dw, N/mm: the value of `slope`. 0 without contact."""
        return self.slope.value

    @computed_once
    def slope(self) -> Slope:
        """Slope dF/dw of the branch, with its error and, if it has no value, the reason.

        For an elastic state it is exact, from K q = 1 on the contact domain; infinite in full
        contact of a periodic or mirrored window. Where nodes yield it is the secant of the loading
        branch (`slope.secant_slope`), from two more solves.

        Raises
        ------
        NotConverged
            If its relative error may exceed 1e-6, or as `solve_contact`.
        """
        if self._yields():
            return secant_slope(self, self._solver)
        with SOLVING.counted(0):
            value, error = stiffness(*self._operator_on_active())
        if not error <= STIFFNESS_ERROR:
            raise NotConverged("the stiffness equations on the contact set", self, error)
        if math.isinf(value):  # in full contact
            return Slope(value, 0.0)
        value *= self.space.modulus * self.space.cell
        return Slope(value, STIFFNESS_ERROR * value)

    def _yields(self):
        """True if a node is at its hardness."""
        return bool((self.pressure >= self.hardness).any())

    def _operator_on_active(self):
        """Operator, and the nodes strictly between the bounds."""
        between = Bounds(0.0, np.ravel(self.hardness)).between(self.pressure.ravel())
        return Operator(self.space), between

    def without_before(self) -> "ContactState":
        """Same state without the earlier state for its extrapolation."""
        return self.with_before(None)

    def with_before(self, other: "ContactState | None") -> "ContactState":
        """Same state, extrapolated as a start along the line through another one."""
        state = object.__new__(type(self))  # `copy.copy` takes as long as a compiled kernel does
        vars(state).update(vars(self), _before=other and other.without_before())
        return state


@dataclass(frozen=True)
class Candidates:
    """Candidates of a state on a ``topography``; all others have a gap, whatever the pressures.

    ``nodes``, (n,) int32, are ascending numbers of cells; pressure (MPa), displacement and
    clearance at first touch (mm) are on these, (n,).
    """

    nodes: np.ndarray
    pressure: np.ndarray
    displacement: np.ndarray
    clearance: np.ndarray
    topography: Topography


class CandidateState(ContactState):
    """State solved and verified on `Candidates` alone; arguments as of `ContactState`.

    Displacement and gap of the whole window are computed at their first use. ``before`` is the
    state it was solved from, ``solver`` the function for its slope.
    """

    _candidates: Candidates

    def __init__(
        self,
        pressure: np.ndarray,
        *,
        closure: float,
        force: float,
        residual: float,
        iterations: int,
        space: HalfSpace,
        hardness: float,
        before: ContactState | None,
        candidates: Candidates,
        solver: Callable[..., Any] | None = None,
    ):
        vars(self).update(
            pressure=pressure,
            closure=closure,
            force=force,
            residual=residual,
            iterations=iterations,
            space=space,
            hardness=hardness,
            _before=before,
            _solver=solver,
            _candidates=candidates,
        )

    @computed_once
    def displacement(self) -> np.ndarray:  # type: ignore[override]
        """Elastic displacement u = K p of the composite surface, mm, (ny, nx)."""
        return self.space.displacement(self.pressure)

    @computed_once
    def gap(self) -> np.ndarray:  # type: ignore[override]
        """Gap, mm, (ny, nx); `ValueError` if the topography has been changed since the solve."""
        topography, nodes = self._candidates.topography, self._candidates.nodes
        if not np.array_equal(topography.clearance_at(nodes), self._candidates.clearance):
            raise ValueError("the composite topography of this state has been changed since")
        return self.displacement + topography.clearance() - self.closure

    @property
    def composite(self) -> np.ndarray:
        """Composite topography that was solved, mm, (ny, nx)."""
        return self._candidates.topography.height()

    @property
    def candidates(self) -> int:
        """Number of candidates."""
        return self._candidates.nodes.size

    @property
    def area(self) -> float:
        """Real contact area A_r = N s^2, mm2."""
        return float(np.count_nonzero(self._candidates.pressure)) * self.space.cell_area

    def _on_nodes(self):
        candidates = self._candidates
        gap = candidates.displacement + candidates.clearance - self.closure
        return candidates.pressure, candidates.displacement, gap

    def _operator_on_active(self):
        between = Bounds(0.0, self.hardness).between(self._candidates.pressure)
        nodes = self._candidates.nodes[between]
        return Operator(self.space, nodes), np.arange(nodes.size, dtype=np.int32)


def unloaded_state(space: HalfSpace, clearance: np.ndarray) -> ContactState:
    """State of first touch, with a ``clearance`` (ny, nx), mm: no pressure, no closure."""
    zero = np.zeros(space.shape)
    return ContactState(zero, zero.copy(), clearance, 0.0, 0.0, 0.0, 0, space)
