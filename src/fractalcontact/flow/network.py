"""Flow through a grid of cells between an inlet and an outlet: assembly, solution, mass balance."""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage, sparse

from roughcontact.kernel_cache import njit

from .cholesky import solve_symmetric
from .errors import FlowNotConverged

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
    joined[_at_both(labels, inlet, outlet)] = True
    return joined[labels]


def are_joined(open_cells: np.ndarray, inlet: np.ndarray, outlet: np.ndarray) -> bool:
    """True if a path of open cells joins both ends, as :func:`joined_cells` takes them."""
    # A rim of closed cells: then each cell has four neighbours.
    rimmed = (np.pad(cells, 1).ravel() for cells in (open_cells, inlet, outlet))
    return _reached(*rimmed, open_cells.shape[1] + 2)


@njit(cache=True)
def _reached(unseen, inlet, outlet, width):
    """True if a path of cells, which become seen, leads from the inlet to the outlet."""
    waiting = np.empty(unseen.size, np.int64)
    for start in range(unseen.size):
        n = 0
        if unseen[start] and inlet[start]:
            unseen[start], waiting[0], n = False, start, 1
        while n:
            n -= 1
            cell = waiting[n]
            if outlet[cell]:
                return True
            for other in (cell - width, cell - 1, cell + 1, cell + width):
                if unseen[other]:
                    unseen[other], waiting[n] = False, other
                    n += 1
    return False


def _at_both(labels, inlet, outlet):
    """Labels above 0 at both ends."""
    both = np.intersect1d(labels[inlet], labels[outlet])
    return both[both > 0]


def solve_network(
    network: Network, open_cells: np.ndarray, *, cholmod: bool | None = None
) -> NetworkFlow:
    """Flow under a pressure of 1 at the inlet and 0 at the outlet.

    Parameters
    ----------
    network : Network
    open_cells : (ny, nx) bool ndarray
    cholmod : bool, optional
        As of :func:`flow.cholesky.solve_symmetric`.

    Returns
    -------
    NetworkFlow

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
    ends = np.stack([network.inlet[cells], network.outlet[cells]], axis=1)
    # Numbers of the order of one: aperture cubed in mm would leave the range of the factors.
    scale = 1 / max(network.along_x.max(initial=0), network.along_y.max(initial=0), ends.max())
    faces = _faces_of(network, cells)
    lower = _assemble(faces, ends, scale)
    right = ends * scale
    try:
        solution = _complementary(solve_symmetric(lower, right, cholmod=cholmod))
        for step in range(REFINEMENTS + 1):
            balance, flows = _balance(faces, ends, solution)
            error = float(np.abs(balance).sum()) / max(min(flows), np.finfo(float).tiny)
            if error <= MAX_IMBALANCE or step == REFINEMENTS:
                break
            change = np.stack([balance, -balance], axis=1) * scale
            solution = _complementary(solution + solve_symmetric(lower, change, cholmod=cholmod))
    except ArithmeticError as failed:
        raise FlowNotConverged(f"the equations are singular ({failed})", np.inf) from failed
    if not error <= MAX_IMBALANCE:
        raise FlowNotConverged("the passages differ too much in width", error)
    return _network_flow(network, cells, solution, float(np.mean(flows)), error)


def _complementary(solution):
    """Pressure and its complement, the larger of both computed from the smaller."""
    p, d = solution.T
    low = p < d
    return np.stack([np.where(low, p, 1 - d), np.where(low, 1 - p, d)], axis=1)


def _faces_of(network, cells):
    """Cell numbers at both sides of the faces between joined cells, and their conductances."""
    number = np.cumsum(cells.ravel()).reshape(cells.shape) - 1
    in_x, in_y = cells[:, :-1] & cells[:, 1:], cells[:-1] & cells[1:]
    first = np.concatenate([number[:, :-1][in_x], number[:-1][in_y]])
    second = np.concatenate([number[:, 1:][in_x], number[1:][in_y]])
    return first, second, np.concatenate([network.along_x[in_x], network.along_y[in_y]])


def _assemble(faces, ends, scale):
    """Lower triangle of the equations of mass balance."""
    first, second, conductance = faces
    n = len(ends)
    diagonal = ends.sum(axis=1)
    for side in (first, second):
        diagonal += np.bincount(side, conductance, n)
    each = np.arange(n)
    values = np.concatenate([diagonal, -conductance]) * scale
    # The second cell of a face has the larger number.
    rows, columns = np.concatenate([each, second]), np.concatenate([each, first])
    return sparse.coo_array((values, (rows, columns)), shape=(n, n))


def _drop(one, other, p, d):
    """Differences of the pressure p or of its complement d, whichever is known more closely."""
    return np.where(p[one] < d[one], p[one] - p[other], d[other] - d[one])


def _balance(faces, ends, solution):
    """Net flow into each cell, and the flows in and out."""
    first, second, conductance = faces
    flux = conductance * _drop(first, second, *solution.T)
    entering, leaving = ends[:, 0] * solution[:, 1], ends[:, 1] * solution[:, 0]
    n = len(ends)
    net = entering - leaving - np.bincount(first, flux, n) + np.bincount(second, flux, n)
    return net, (float(entering.sum()), float(leaving.sum()))


def _network_flow(network, cells, solution, rate, imbalance):
    p, d = np.full(cells.shape, np.nan), np.full(cells.shape, np.nan)
    p[cells], d[cells] = solution.T
    flux_x, flux_y = (
        np.nan_to_num(conductance * _drop(one, other, p, d))
        for conductance, one, other in (
            (network.along_x, np.s_[:, :-1], np.s_[:, 1:]),
            (network.along_y, np.s_[:-1], np.s_[1:]),
        )
    )
    return NetworkFlow(rate, imbalance, p, flux_x, flux_y)
