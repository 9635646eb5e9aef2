"""Flow through a grid of cells between an inlet and an outlet: solution and mass balance."""

import numpy as np
from scipy import ndimage

from roughcontact.kernel_cache import njit

from .red_black import RedBlackCells

#: Largest error of a flow that the imbalance of its cells may make, a fraction of the flow.
MAX_IMBALANCE = 1e-6
#: Such an error at which iterative refinement ends, and its steps.
AIMED_IMBALANCE = 1e-8
REFINEMENTS = 2


class FlowNotConverged(RuntimeError):
    """No flow whose mass balance closes was reached.

    Attributes
    ----------
    imbalance : float
        Bound on the error of the flow that the imbalance of its cells makes, a fraction of it.
    """

    def __init__(self, reason: str, imbalance: float):
        super().__init__(
            f"flow not solved: {reason}; the mass balance leaves {imbalance:.3g} of it open"
        )
        self.reason, self.imbalance = reason, imbalance

    def __reduce__(self):
        return type(self), (self.reason, self.imbalance)


def joined_cells(open_cells: np.ndarray, inlet: np.ndarray, outlet: np.ndarray) -> np.ndarray:
    """Open cells that a path of open cells joins to both ends, (ny, nx) bool.

    Parameters
    ----------
    open_cells, inlet, outlet : (ny, nx) bool ndarray
        Open cells, and those of them at each end.
    """
    labels, n = ndimage.label(open_cells)
    joined = np.zeros(n + 1, bool)
    joined[np.intersect1d(labels[inlet], labels[outlet])] = True
    joined[0] = False
    return joined[labels]


def solve_network(
    conductivity: np.ndarray,
    ends: np.ndarray,
    spacing: tuple[float, float],
    *,
    cholmod: bool | None = None,
) -> tuple[float, float, np.ndarray, np.ndarray]:
    """Flow under a pressure of 1 at the inlet and 0 at the outlet.

    Parameters
    ----------
    conductivity : (ny, nx) ndarray
        Of the cells, of the order of 1 at most, 0 where closed; a path joins both ends.
    ends : (2, ny, nx) ndarray
        Conductance of a cell to the inlet and to the outlet over its conductivity, 0 inside.
    spacing : (float, float)
        Sides (dy, dx) of a cell, mm.
    cholmod : bool, optional
        As of :func:`flow.cholesky.factorised`.

    Returns
    -------
    rate : float
        Flow per pressure difference.
    imbalance : float
        Bound on the relative error of ``rate`` by the imbalance of the cells.
    flux : (ny, nx) ndarray
        Flow per width in the cells, from the flows through their faces.
    pressure : (ny, nx) ndarray
        NaN in cells that no path joins to both ends.

    Raises
    ------
    FlowNotConverged
        If the mass balance leaves the flow uncertain by more than :data:`MAX_IMBALANCE`.

    Notes
    -----
    The pressure p and its complement d = 1 - p are refined, each for itself: beside an end, the
    smaller of both has all its digits, and so do the flows through faces there, however narrow the
    passages elsewhere are. With r the imbalance of the cells, the outflow is off by sum(r d) of the
    exact d, which is between 0 and 1: sum(abs(r)) bounds its error whatever solver gave p.
    """
    cells = joined_cells(conductivity > 0, *(ends > 0))
    try:
        network = RedBlackCells(conductivity, ends, cells, spacing, cholmod)
        p = network.solve(network.ends[0])
        solution = np.stack([p, 1 - p])
        for step in range(REFINEMENTS + 1):
            # Inflow by the complement, outflow by the pressure.
            flows = network.ends * solution[::-1]
            inflow, outflow = flows.sum(axis=1)
            balance, passing = _balance(network.faces, network.neighbours, solution, flows)
            least, total = float(min(inflow, outflow)), float(np.abs(balance).sum())
            error = total / least if least > 0 else np.inf
            if error <= AIMED_IMBALANCE or step == REFINEMENTS:
                break
            change = network.solve(balance)
            solution = _complementary(solution + np.stack([change, -change]))
    except ArithmeticError as failed:
        raise FlowNotConverged(f"the equations are singular ({failed})", np.inf) from failed
    if not error <= MAX_IMBALANCE:
        raise FlowNotConverged("the passages differ too much in width", error)
    dy, dx = spacing
    # A cell at an end has the flow of that end beside that of its face.
    p, flux = solution[0], np.hypot(passing[0] / dx, passing[1] / dy) / 2 + flows.sum(axis=0) / (2 * dy)
    of_cells = (np.append(one, none)[network.numbers] for one, none in ((flux, 0.0), (p, np.nan)))
    return float(outflow), error, *of_cells


def _complementary(solution):
    """Pressure and its complement, the larger of both computed from the smaller."""
    p, d = solution
    low = p < d
    return np.stack([np.where(low, p, 1 - d), np.where(low, 1 - p, d)])


@njit(cache=True)
def _balance(faces, neighbours, solution, flows):
    """Net flow into each cell, and the sums of those through its two faces in y and x.

    Differences are those of the pressure or of its complement, whichever is more exact.
    """
    net, passing = flows[0] - flows[1], np.zeros_like(flows)
    n_red = net.size - len(faces)
    for black in range(len(faces)):
        cell = n_red + black
        lower = 0 if solution[0, cell] < solution[1, cell] else 1
        for way in range(4):
            other = neighbours[black, way]
            drop = solution[lower, cell] - solution[lower, other]
            flow = faces[black, way] * (drop if lower == 0 else -drop)
            net[cell] -= flow
            net[other] += flow
            # Ways are up, left, right, down.
            onwards = flow if way > 1 else -flow
            direction = 0 if way in (0, 3) else 1
            passing[direction, cell] += onwards
            passing[direction, other] += onwards
    return net, passing
