"""Scalars of a contact state, and their solver error bounds."""

from typing import Any

import numpy as np

from roughcontact.contact.corrected_area import EDGE_EXCESS, contact_perimeter, corrected_area
from roughcontact.contact.slope import Slope
from roughcontact.contact.state import STIFFNESS_ERROR, ContactState

from ..core.limits import MIN_FREE_NODES
from ..joint.overlap import suspect_load_share
from .area_sampling import state_area_sampling
from .states import SCALARS

#: Reason of a stiffness that is not computed.
NOT_WANTED = "computed at the finest resolution alone"
#: Reason why a state that yields has no stiffness of its own.
FEW_FREE_NODES = f"too few contacts (under {MIN_FREE_NODES}) carry the change of the force"


def aperture(state: ContactState) -> np.ndarray:
    """Aperture (ny, nx) of a state, mm: its gap, exactly 0 in contact.

    In contact a solved gap is within the tolerance of 0, and negative where a node at the hardness
    is pressed in: the face has crushed by as much.
    """
    return np.where(state.in_contact, 0.0, np.maximum(state.gap, 0.0))


def numbers_of(
    state: ContactState, suspicious: np.ndarray | None = None, *, stiff: bool = True
) -> dict[str, Any]:
    """Scalars of a contact state and their errors, stored without its fields.

    :data:`states.states.SCALARS`, :data:`states.states.ERRORS` and :data:`states.states.REASONS`.
    Suspicious nodes are those of :func:`joint.overlap.suspect_nodes`, none if left out. The
    stiffness takes more solves; it is NaN where it is not wanted. Raises `NotConverged` as that
    does.
    """
    spacing, gap = state.space.spacing, aperture(state)
    slope = resolved_slope(state) if stiff else Slope(np.nan, np.nan, reason=NOT_WANTED)
    of_domain: dict[str, Any] = {
        "nodes": np.count_nonzero(state.in_contact),
        "extent": _extent(state.in_contact),
        "perimeter": contact_perimeter(state.in_contact, spacing),
        "area_corrected": state_area(state),
        "area_sampling": state_area_sampling(state),
        "mean_gap": float(gap.mean()),
        "gap_deviation": float(gap.std()),
        "suspect_load_share": (
            0.0 if suspicious is None else suspect_load_share(state.pressure, suspicious)
        ),
        "stiffness": slope.value,
        "stiffness_scatter": slope.scatter,
        "stiffness_reason": slope.reason,
    }
    of_state = {name: getattr(state, name) for name in SCALARS if name not in of_domain}
    return of_domain | of_state | state_errors(state, slope)


def resolved_slope(state: ContactState) -> Slope:
    """Slope dF/dw of a state; of one that yields only where enough free nodes carry the change.

    With a hardness the force changes on the free nodes alone, those between first touch and the
    hardness. Where they amount to fewer than :data:`MIN_FREE_NODES` equal ones, the slope is that
    of single cells: at 1 MPa a joint had 19.6 MPa/mm where its closure curve had 30.4.
    """
    slope = state.slope
    if slope.reason or slope.cells >= MIN_FREE_NODES:
        return slope
    return Slope(np.nan, np.nan, slope.cells, FEW_FREE_NODES)


def state_area(state: ContactState) -> float:
    """Real contact area of a state, corrected for the perimeter, mm2.

    It is at least the area that carries the force at the hardness, if there is one.
    """
    corrected = float(corrected_area(state.in_contact, state.space.spacing))
    return max(corrected, state.force / float(np.max(state.hardness)))


def _extent(in_contact: np.ndarray) -> float:
    """Fraction of the cells within the smallest rectangle around those in contact."""
    touched = [np.flatnonzero(in_contact.any(axis=axis)) for axis in (0, 1)]
    sides = [int(np.ptp(along)) + 1 if along.size else 0 for along in touched]
    return float(np.prod(sides)) / in_contact.size


def state_errors(state: ContactState, slope: Slope | None = None) -> dict[str, float]:
    """Solver error bounds of a state's scalars: its KKT conditions hold to a residual only.

    Parameters
    ----------
    state
        As for :func:`numbers_of`.
    slope : Slope, optional
        By default its own.

    Returns
    -------
    dict
        :data:`states.states.ERRORS`.

    Notes
    -----
    A state that violates the conditions by a fraction r of its closure w is the exact one of a
    topography that differs by up to r w, and heights raised by no more than that change the closure
    by no more. Area and perimeter change by the nodes whose contact that leaves ambiguous, each
    with all its edges; so does the stiffness, in proportion to the nodes with inactive bounds.
    Where nodes yield it is a secant between two other states, and has an error of its own.
    """
    space, ambiguous = state.space, state.ambiguous
    dy, dx = space.spacing
    hidden = state.residual * state.closure * space.modulus / space.cell
    below_cap = state.in_contact & (state.pressure < state.hardness)
    near_cap = below_cap & (state.pressure >= state.hardness - hidden)
    loose = ambiguous + np.count_nonzero(near_cap)
    fraction = STIFFNESS_ERROR + loose / max(int(np.count_nonzero(below_cap)), 1)
    slope = slope or resolved_slope(state)
    return {
        "closure_error": state.residual * state.closure,
        "area_error": ambiguous * space.cell_area,
        "nodes_error": ambiguous,
        "perimeter_error": ambiguous * 2 * (dy + dx),
        "area_corrected_error": ambiguous * (1 + 4 * EDGE_EXCESS) * space.cell_area,
        "stiffness_error": fraction * slope.value if np.isinf(slope.cells) else slope.error,
    }
