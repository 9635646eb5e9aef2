"""Slope of the force over the closure: normal stiffness of a contact, yielding or not."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..limits import RESOLVED_NODES

#: Half the span of a secant: HALF_SPAN of the closure, or HALF_SPAN_OF_NODES times the closure from
#: first touch of a node to its hardness, if that is more; at most MAX_HALF_SPAN of the closure.
HALF_SPAN, HALF_SPAN_OF_NODES, MAX_HALF_SPAN = 0.02, 4.0, 0.25
#: Tolerance of the two states at the ends of the secant.
SECANT_RTOL = 1e-5

#: Reasons why a branch has no slope.
NO_SECANT = "solved by another method, of which there is no secant"
ALL_YIELDED = "the whole window carries its hardness"
FEW_CELLS = f"too few contacts (under {RESOLVED_NODES}) carry the change of the force"


@dataclass(frozen=True)
class Slope:
    """Slope dF/dw of a branch of the closure curve.

    Attributes
    ----------
    value, error : float
        N/mm; NaN where it is not determined. The error is that of solving; for a yielding contact
        the ``scatter`` is added.
    cells : float
        Number of equal, independent cells whose sum would scatter as much as the change of the
        force; infinite on an elastic branch, whose slope is exact.
    reason : str
        Why there is no value; empty if there is one.
    """

    value: float
    error: float
    cells: float = np.inf
    reason: str = ""

    @property
    def scatter(self) -> float:
        """Scatter of the value as a sum over ``cells``, N/mm; 0 for an elastic branch."""
        return self.value / float(np.sqrt(self.cells)) if self.cells else np.nan


def secant_slope(state: Any, solve_contact: Callable[..., Any] | None) -> Slope:
    """Slope of the loading branch at a state in which nodes yield; no value without a solver.

    At one closure the force changes only on the few nodes between first touch and the hardness,
    while over a span of closures it rises by all nodes that come to yield: the first slope depends
    on the grid, the second on the joint. It is therefore the secant between two closures around the
    state's. The scatter is that of a sum over independent cells, relatively sqrt(sum dp^2) / sum
    dp.
    """
    if solve_contact is None:
        return Slope(np.nan, np.nan, 0.0, NO_SECANT)
    space, hardness = state.space, state.hardness
    own = float(space.influence()[0, 0]) * space.cell / space.modulus
    of_nodes = HALF_SPAN_OF_NODES * float(np.min(hardness)) * own
    half = min(max(HALF_SPAN * state.closure, of_nodes), MAX_HALF_SPAN * state.closure)

    def at(closure, start):
        case = (state.composite, space)
        return solve_contact(
            *case, closure=closure, hardness=hardness, start=start, rtol=SECANT_RTOL
        )

    high = at(state.closure + half, state)
    # Extrapolated along the line through both states, nodes at the hardness stay there. The state
    # may have come from a far lower load; extrapolated towards that, all nodes that have yielded
    # since would leave the hardness, and it would take three times as many iterations to put them
    # back.
    low = at(state.closure - half, state.with_before(high))
    change = (high.pressure - low.pressure) * space.cell_area
    total, scatter = float(change.sum()), float(np.sqrt((change**2).sum()))
    if not total > 0:
        return Slope(np.nan, np.nan, 0.0, ALL_YIELDED)
    cells = (total / scatter) ** 2
    if cells < RESOLVED_NODES:
        return Slope(np.nan, np.nan, cells, FEW_CELLS)
    value = total / (2 * half)
    solved = SECANT_RTOL * state.closure / half
    return Slope(value, value * (scatter / total + solved), cells)
