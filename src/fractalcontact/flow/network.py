"""Flow through a grid of cells between an inlet and an outlet: assembly, solution, mass balance."""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from roughcontact.kernel_cache import njit

from .errors import FlowNotConverged
from .red_black import red_black_solver

#: Largest error of a flow that the imbalance of its cells may make, a fraction of the flow.
MAX_IMBALANCE = 1e-6
#: Steps of iterative refinement before a flow is refused.
REFINEMENTS = 2


@dataclass(frozen=True, eq=False)
class Network:
    """Cells and the conductances between them.

    Attributes
    ----------
    along_x : (ny, nx - 1) ndarray
        Conductance of the faces between neighbours in x; 0 where nothing passes.
    along_y : (ny - 1, nx) ndarray
        The same in y.
    inlet, outlet : (ny, nx) ndarray
        Conductance between a cell and the inlet (pressure 1) or the outlet (pressure 0).
    """

    along_x: np.ndarray
    along_y: np.ndarray
    inlet: np.ndarray
    outlet: np.ndarray


@dataclass(frozen=True, eq=False)
class NetworkFlow:
    """Flow through a network under a pressure difference of 1.

    Attributes
    ----------
    rate : float
        Flow per pressure difference; 0 where no path joins inlet and outlet.
    imbalance : float
        Bound on the relative error of ``rate`` by the imbalance of the cells.
    pressure : (ny, nx) ndarray
        NaN in cells that no path joins to both ends.
    flux_x, flux_y : (ny, nx - 1), (ny - 1, nx) ndarray
        Flow through the faces, positive towards larger x and y.
    """

    rate: float
    imbalance: float
    pressure: np.ndarray
    flux_x: np.ndarray
    flux_y: np.ndarray


def harmonic_faces(
    conductivity: np.ndarray, spacing: tuple[float, float]
) -> tuple[np.ndarray, np.ndarray]:
    """Conductances of the faces between cells: harmonic means, 0 beside a closed cell.

    Parameters
    ----------
    conductivity : (ny, nx) ndarray
        Of the cells, 0 where closed.
    spacing : (float, float)
        Sides (dy, dx) of a cell, mm.

    Returns
    -------
    along_x, along_y : ndarray
        As of :class:`Network`.
    """
    dy, dx = spacing
    left, right = conductivity[:, :-1], conductivity[:, 1:]
    below, above = conductivity[:-1], conductivity[1:]
    return _harmonic(left, right) * (dy / dx), _harmonic(below, above) * (dx / dy)


def _harmonic(one, other):
    # The product would underflow where gaps are small: divide first.
    return 2 * one / (1 + np.divide(one, other, where=other > 0, out=np.full_like(one, np.inf)))


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


@njit(cache=True)
def are_joined(opening: np.ndarray, level: float, inlet: np.ndarray, outlet: np.ndarray) -> bool:
    """True if a path of cells no lower than a level joins both ends.

    Parameters
    ----------
    opening : (ny, nx) ndarray
    level : float
    inlet, outlet : (ny, nx) bool ndarray
        Cells at each end.
    """
    ny, width = opening.shape[0], opening.shape[1] + 2
    # A rim of closed cells: then each cell has four neighbours.
    unseen = np.zeros((ny + 2) * width, np.bool_)
    waiting, n = np.empty(opening.size, np.int64), 0
    for row in range(ny):
        for column in range(width - 2):
            if opening[row, column] >= level:
                cell = (row + 1) * width + column + 1
                unseen[cell] = not inlet[row, column]
                if inlet[row, column]:
                    waiting[n] = cell
                    n += 1
    while n:
        n -= 1
        cell = waiting[n]
        if outlet[cell // width - 1, cell % width - 1]:
            return True
        for other in (cell - width, cell - 1, cell + 1, cell + width):
            if unseen[other]:
                unseen[other], waiting[n] = False, other
                n += 1
    return False


def solve_network(
    network: Network, open_cells: np.ndarray, *, cholmod: bool | None = None
) -> NetworkFlow:
    """Flow under a pressure of 1 at the inlet and 0 at the outlet.

    Parameters
    ----------
    network : Network
    open_cells : (ny, nx) bool ndarray
    cholmod : bool, optional
        As of :func:`flow.cholesky.factorised`.

    Raises
    ------
    FlowNotConverged
        If the mass balance leaves the flow uncertain by more than :data:`MAX_IMBALANCE`.

    Notes
    -----
    Solved for the pressure p and for its complement d = 1 - p at once: beside an end, the smaller
    of both has all its digits, and so do the flows through faces there, however narrow the
    passages elsewhere are. With r the imbalance of the cells, the outflow is off by sum(r d) of the
    exact d, which is between 0 and 1: sum(abs(r)) bounds its error whatever solver gave p.
    """
    cells = joined_cells(open_cells, network.inlet > 0, network.outlet > 0)
    shape = cells.shape
    if not cells.any():
        zero_x, zero_y = np.zeros_like(network.along_x), np.zeros_like(network.along_y)
        return NetworkFlow(0.0, 0.0, np.full(shape, np.nan), zero_x, zero_y)
    # Numbers of the order of one: aperture cubed in mm would leave the range of the factors.
    ends = np.stack([network.inlet, network.outlet]) * cells
    scale = 1 / max(network.along_x.max(initial=0), network.along_y.max(initial=0), ends.max())
    faces = network.along_x * scale, network.along_y * scale
    try:
        solve = red_black_solver(*faces, ends.sum(axis=0) * scale, cells, cholmod)
        solution = _complementary(solve(ends * scale), cells)
        for step in range(REFINEMENTS + 1):
            balance, flows, fluxes = _balance(network, *solution)
            error = float(np.abs(balance).sum()) / max(min(flows), np.finfo(float).tiny)
            if error <= MAX_IMBALANCE or step == REFINEMENTS:
                break
            change = solve(np.stack([balance, -balance]) * scale)
            solution = _complementary(solution + change, cells)
    except ArithmeticError as failed:
        raise FlowNotConverged(f"the equations are singular ({failed})", np.inf) from failed
    if not error <= MAX_IMBALANCE:
        raise FlowNotConverged("the passages differ too much in width", error)
    pressure = np.where(cells, solution[0], np.nan)
    return NetworkFlow(float(np.mean(flows)), error, pressure, *fluxes)


def _complementary(solution, cells):
    """Pressure and its complement, the larger of both computed from the smaller; 0 elsewhere."""
    p, d = solution
    low = p < d
    return np.stack([np.where(low, p, 1 - d), np.where(low, 1 - p, d)]) * cells


def _balance(network, p, d):
    """Net flow into each cell, the flows in and out, and those through the faces in x and y.

    Differences are those of the pressure p or of its complement d, whichever is more exact.
    """
    low = p < d
    flux_x, flux_y = (
        conductance * np.where(low[one], p[one] - p[other], d[other] - d[one])
        for conductance, one, other in (
            (network.along_x, np.s_[:, :-1], np.s_[:, 1:]),
            (network.along_y, np.s_[:-1], np.s_[1:]),
        )
    )
    entering, leaving = network.inlet * d, network.outlet * p
    net = entering - leaving
    net[:, :-1] -= flux_x
    net[:, 1:] += flux_x
    net[:-1] -= flux_y
    net[1:] += flux_y
    return net, (float(entering.sum()), float(leaving.sum())), (flux_x, flux_y)
