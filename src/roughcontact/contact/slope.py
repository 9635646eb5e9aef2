"""Slope of the force over the closure: the normal stiffness of a contact, yielding or not."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..limits import RESOLVED_NODES

#: Half the span of a secant: a fraction of the closure, or as many times that over which one node
#: comes from first touch to its hardness, where that is more; no more than a part of the closure.
HALF_SPAN, HALF_SPAN_OF_NODES, MAX_HALF_SPAN = 0.02, 4.0, 0.25
#: Tolerance of the two states at its ends.
SECANT_RTOL = 1e-5


@dataclass(frozen=True)
class Slope:
    """dF/dw of a branch of the closure curve.

    Attributes
    ----------
    value, error : float
        N/mm; NaN where it is not determined. The error is that of solving, and of a yielding
        contact the ``scatter`` added.
    cells : float
        Number of equal cells that would carry the change of the force with as much scatter: one
        where a single cell carries it. Infinite on an elastic branch, whose slope is exact.
    reason : str
        Why there is no value; empty where there is one.
    """

    value: float
    error: float
    cells: float = np.inf
    reason: str = ""

    @property
    def scatter(self) -> float:
        """Scatter of the value as a sum over so many cells, N/mm; 0 of an elastic branch."""
        return self.value / float(np.sqrt(self.cells)) if self.cells else np.nan


def secant_slope(state: Any, solve_contact: Callable[..., Any] | None) -> Slope:
    """Slope of the loading branch at a state in which nodes yield.

    Parameters
    ----------
    state : ContactState
    solve_contact : callable or None
        The solver that it is of; no value without.

    Raises
    ------
    NotConverged
        As `solve_contact`.

    Notes
    -----
    At one closure the force changes on the few nodes alone that are between first touch and the
    hardness, while over a span of closures it rises by all those that come to yield: the first is
    a number of the grid, the second one of the joint. It is the secant between two closures about
    that of the state. The scatter is that of a sum over independent cells, relative to it
    sqrt(sum dp^2) / sum dp.
    """
    if solve_contact is None:
        return Slope(np.nan, np.nan, 0.0, "solved by another method, of which there is no secant")
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
    # On the line through both, nodes at the hardness stay there; towards a far lower load, of which
    # the state may have come, all that have yielded since would leave it, and three times as many
    # iterations put them back.
    low = at(state.closure - half, state.with_before(high))
    change = (high.pressure - low.pressure) * space.cell_area
    total, scatter = float(change.sum()), float(np.sqrt((change**2).sum()))
    if not total > 0:
        return Slope(np.nan, np.nan, 0.0, "the whole window carries its hardness")
    cells = (total / scatter) ** 2
    if cells < RESOLVED_NODES:
        reason = f"the force changes on {cells:.1f} cells, fewer than {RESOLVED_NODES}"
        return Slope(np.nan, np.nan, cells, reason)
    value = total / (2 * half)
    solved = SECANT_RTOL * state.closure / half
    return Slope(value, value * (scatter / total + solved), cells)
