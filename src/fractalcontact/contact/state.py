"""A state of contact: pressures, displacements, gaps, and what follows from them."""

import dataclasses
from dataclasses import dataclass

import numpy as np

from ..core.errors import NotConverged
from ..core.threads import computed_once
from ..elastic.halfspace import HalfSpace
from .effort import SOLVING
from .kkt import nodes_between_bounds
from .projected_cg import Operator, stiffness

# Largest relative error of the stiffness.
STIFFNESS_ERROR = 1e-6


@dataclass(frozen=True)
class ContactState:
    """A state of contact that satisfies the conditions to ``residual``.

    Attributes
    ----------
    pressure : (ny, nx) ndarray
        p, MPa, zero outside the contact domain.
    displacement : (ny, nx) ndarray
        Elastic displacement u = K p of the composite surface, mm.
    gap : (ny, nx) ndarray
        Remaining opening, mm; within ``residual`` times the closure of zero in contact, where
        the pressure is not at the cap.
    closure : float
        w from first touch, mm: the rigid-body approach (indentation) of contact mechanics.
    force : float
        F, N.
    residual : float
        Largest violation of the contact conditions, as a fraction of the closure; or, of a given
        force, as a fraction of it.
    iterations : int
        Applications of the elastic operator, whatever their precision. Those on coarser
        grids, for a start, are not counted.
    space : HalfSpace
        The operator it was solved with.
    hardness : float
        Largest pressure, MPa; infinity for an elastic surface.
    """

    pressure: np.ndarray
    displacement: np.ndarray
    gap: np.ndarray
    closure: float
    force: float
    residual: float
    iterations: int
    space: HalfSpace = dataclasses.field(repr=False)
    hardness: float = np.inf
    _before: "ContactState | None" = dataclasses.field(default=None, repr=False, compare=False)

    def __repr__(self):
        cap = "" if self.hardness == np.inf else f", hardness={self.hardness:.6g} MPa"
        nodes = np.count_nonzero(self.in_contact)
        return (
            f"<ContactState {self.pressure.shape[0]} x {self.pressure.shape[1]}: "
            f"force={self.force:.6g} N, closure={self.closure:.6g} mm, area={self.area:.6g} mm2, "
            f"{nodes} nodes in contact, residual={self.residual:.1g}{cap}>"
        )

    @property
    def in_contact(self) -> np.ndarray:
        """Contact domain, (ny, nx) bool: the nodes that carry pressure."""
        return self.pressure > 0

    @property
    def area(self) -> float:
        """A_r = N s^2, mm2."""
        return float(np.count_nonzero(self.in_contact)) * self.space.cell_area

    @property
    def ambiguous(self) -> int:
        """Number of nodes that may or may not touch, as the conditions hold to ``residual`` only.

        Their gap is within the gap tolerance, ``residual`` times the closure, or their pressure is
        no larger than that which closes such a gap on one cell.
        """
        tolerance = self.residual * self.closure
        weakest = tolerance * self.space.modulus / self.space.cell
        weak = self.in_contact & (self.pressure <= weakest)
        near = ~self.in_contact & (self.gap <= tolerance)
        return int(np.count_nonzero(weak) + np.count_nonzero(near))

    @computed_once
    def stiffness(self) -> float:
        """Normal stiffness dF/dw, N/mm, from K q = 1 on the nodes strictly between the bounds.

        It is 0 without any.

        Raises
        ------
        NotConverged
            If it is not known to :data:`STIFFNESS_ERROR`.
        """
        active = nodes_between_bounds(self.pressure.ravel(), self.hardness)
        with SOLVING.counted(0):
            value, error = stiffness(Operator(self.space), active)
        if not error <= STIFFNESS_ERROR:
            raise NotConverged("the stiffness equations on the contact set", self, error)
        return value * self.space.modulus * self.space.cell


def unloaded_state(space: HalfSpace, clearance: np.ndarray) -> ContactState:
    """The state of first touch: no pressure, no closure.

    Parameters
    ----------
    space : HalfSpace
    clearance : (ny, nx) ndarray
        Opening at first touch, mm.
    """
    zero = np.zeros(space.shape)
    return ContactState(zero, zero.copy(), clearance, 0.0, 0.0, 0.0, 0, space)
