"""The paper's active set by elimination alone (sect. 4), tried on a joint's own topography.

Nodes in tension are dropped, and none is taken back. The set that is left is the contact if no
dropped node interpenetrates. Systems are solved directly, on a grid of few nodes.
"""

import numpy as np
import xarray as xr

from roughcontact.elastic.halfspace import HalfSpace

from ..core.datasets import labelled_dataset
from ..states.loading import JointLoading

#: Most nodes along a side of the grid, whose influence matrix is written out.
MAX_SIDE = 24

#: Fractions of the nodes that interpenetrate at the closures tried.
TENTATIVE = (0.1, 0.3, 0.6)

#: Penetration and tension below this fraction of the closure, and of the largest pressure, are
#: rounding.
ROUNDING = 1e-9

_TABLE = {
    "elimination_steps": ("tentative", "1", "systems solved until no node was in tension"),
    "elimination_wrong": (
        "tentative",
        "1",
        "nodes that elimination dropped and that interpenetrate",
    ),
    "elimination_side": ((), "1", "nodes along the longer side of the grid of these systems"),
}


def elimination_alone(loading: JointLoading) -> xr.Dataset:
    """Contact sets of a free window by elimination, at the one offset and three closures.

    A closure is stated as (tentative,), the fraction of the nodes that interpenetrate at first:
    ``elimination_steps`` and ``elimination_wrong``, on every k-th node of the window, at most
    :data:`MAX_SIDE` along a side. Flush faces have NaN.
    """
    composite = loading.composite(loading.cells.item())
    factor = -(-max(composite.shape) // MAX_SIDE)
    heights = composite[::factor, ::factor]
    # The paper's window stands alone, whatever the boundary of the joint.
    spacing, e_star = tuple(loading.spacing * factor), loading.settings.material.e_star
    space = HalfSpace(heights.shape, spacing, e_star, kernel=loading.solver.kernel)
    clearance = heights.max() - heights
    closures = np.quantile(clearance, TENTATIVE)
    rows = [_eliminated(clearance, space, float(closure)) for closure in closures]
    steps, _, wrong = np.array(rows).T
    columns = {"elimination_steps": steps, "elimination_wrong": wrong}
    columns["elimination_side"] = max(heights.shape)
    return labelled_dataset(_TABLE, columns, coords={"tentative": list(TENTATIVE)})


def _eliminated(clearance: np.ndarray, space: HalfSpace, closure: float) -> tuple[float, ...]:
    """Systems solved, nodes left and nodes dropped wrongly."""
    clearance = clearance.ravel()
    if not closure > 0:
        return (np.nan,) * 3
    inside = np.flatnonzero(clearance < closure)
    influence = _influence(space, inside)
    interference = closure - clearance[inside]
    kept, steps = np.ones(inside.size, bool), 0
    while True:
        pressure = np.zeros(inside.size)
        pressure[kept] = np.linalg.solve(influence[np.ix_(kept, kept)], interference[kept])
        steps += 1
        tension = pressure < -ROUNDING * pressure.max()
        if not tension.any():
            break
        kept &= ~tension
    penetration = interference - influence @ pressure
    wrong = np.count_nonzero(~kept & (penetration > ROUNDING * closure))
    return steps, int(np.count_nonzero(kept)), int(wrong)


def _influence(space: HalfSpace, nodes: np.ndarray) -> np.ndarray:
    """Displacement at nodes under unit pressure at each of them, mm/MPa; nodes by flat index."""
    influence = space.influence() * (space.cell / space.modulus)
    y, x = np.divmod(nodes, space.shape[1])
    return influence[np.abs(y[:, None] - y[None, :]), np.abs(x[:, None] - x[None, :])]
