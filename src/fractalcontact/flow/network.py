"""Flow through a grid of cells between an inlet and an outlet: solution and mass balance."""

from dataclasses import dataclass
from heapq import heappop, heappush

import numpy as np
from numpy.typing import ArrayLike
from scipy import ndimage

from roughcontact.kernel_cache import njit

from .red_black import WAYS, RedBlackCells

#: Gaps below this fraction of the widest passage's narrowest gap are closed: what they carry, a
#: part in 1e9 of that passage, is beyond the precision of the equations.
CLOSED_BELOW = 1e-3
#: Fraction of the flow that the flow channels are said to carry.
CHANNEL_FLOW = 0.9
#: Largest error of a flow that the imbalance of its cells may make, a fraction of the flow.
MAX_IMBALANCE = 1e-6
#: Such an error at which iterative refinement ends, and its steps.
AIMED_IMBALANCE = 1e-8
REFINEMENTS = 2


def hydraulic_aperture(transmissivity: ArrayLike) -> np.ndarray:
    """Hydraulic aperture h_h = (12 T)^(1/3), mm, of a transmissivity T, mm3."""
    return np.cbrt(12 * np.asarray(transmissivity))


@dataclass(frozen=True, eq=False)
class Flow:
    """Flow through a joint along one axis, per unit viscosity.

    Attributes
    ----------
    transmissivity : float
        T = h_h^3 / 12, mm3: flow per width, pressure gradient and inverse viscosity. 0 where the
        gap does not percolate.
    imbalance : float
        Bound on its relative error by the mass balance of the cells.
    critical_gap : float
        The largest gap such that a path of gaps no smaller joins both ends, mm; 0 without a path.
    flux : (ny, nx) ndarray
        Flow per width in each cell over the mean flow per width of the window.
    """

    transmissivity: float
    imbalance: float
    critical_gap: float
    flux: np.ndarray

    @property
    def hydraulic_aperture(self) -> float:
        """h_h of the transmissivity, mm."""
        return float(hydraulic_aperture(self.transmissivity))

    @property
    def channel_fraction(self) -> float:
        """Smallest fraction of the window that carries :data:`CHANNEL_FLOW` of the flow."""
        flux = np.sort(self.flux, axis=None)[::-1]
        total = flux.sum()
        if not total > 0:
            return np.nan
        return (int(np.searchsorted(flux.cumsum(), CHANNEL_FLOW * total)) + 1) / flux.size


class FlowNotConverged(RuntimeError):
    """No flow whose mass balance closes was reached.

    Attributes
    ----------
    imbalance : float
        Bound on the error of the flow that the imbalance of its cells makes, a fraction of it.
    """

    def __init__(self, reason: str, imbalance: float):
        super().__init__(reason, imbalance)
        self.reason, self.imbalance = reason, imbalance

    def __str__(self) -> str:
        return f"flow not solved: {self.reason}; mass balance open by {self.imbalance:.3g} of it"


def network_flow(
    gap: np.ndarray, ends: np.ndarray, spacing: tuple[float, float], length: float, width: float
) -> Flow:
    """Flow under a pressure of 1 at the inlet and 0 at the outlet, by the local cubic law.

    Parameters
    ----------
    gap : (ny, nx) ndarray
        g, mm, 0 where closed.
    ends : (2, ny, nx) ndarray
        Conductance of a cell to the inlet and to the outlet over its conductivity, 0 inside.
    spacing : (float, float)
        Sides (dy, dx) of a cell, mm.
    length : float
        Of the parallel plates of the same flow, in widths.
    width : float
        Of the mean flux, mm.

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
    critical = critical_gap(gap, *(ends > 0))
    if not critical:
        return Flow(0.0, 0.0, 0.0, np.zeros_like(gap))
    # Over the widest gap: apertures cubed in mm would leave the range of the factors.
    widest = gap.max()
    relative = np.where(gap >= CLOSED_BELOW * critical, gap / widest, 0.0)
    cells = joined_cells(relative > 0, *(ends > 0))
    try:
        network = RedBlackCells(relative * relative * relative, ends, cells, spacing)
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
    flux = np.hypot(passing[0] / dx, passing[1] / dy) / 2 + flows.sum(axis=0) / (2 * dy)
    flux = np.append(flux, 0.0)[network.numbers] * (width / float(outflow))
    return Flow(float(outflow) * length * widest**3 / 12, error, critical, flux)


def joined_cells(open_cells: np.ndarray, inlet: np.ndarray, outlet: np.ndarray) -> np.ndarray:
    """Open cells that a path of open cells joins to both ends, (ny, nx) bool.

    Parameters
    ----------
    open_cells, inlet, outlet : (ny, nx) bool ndarray
        Open cells, and those of them at each end.
    """
    labels, _ = ndimage.label(open_cells)
    joined = np.intersect1d(labels[inlet], labels[outlet])
    return np.isin(labels, joined[joined > 0])


@njit(cache=True)
def critical_gap(gap: np.ndarray, inlet: np.ndarray, outlet: np.ndarray) -> float:
    """Narrowest gap of the widest passage between both ends, mm; 0 without a passage.

    Parameters
    ----------
    gap : (ny, nx) ndarray
        mm, 0 where closed.
    inlet, outlet : (ny, nx) bool ndarray
        Cells at the ends.
    """
    ny, nx = gap.shape
    unseen, waiting, n = gap > 0, np.empty(gap.size, np.int32), 0
    # Cells below the level wait for it to fall to the widest of them.
    level, below = np.inf, [(0.0, 0) for _ in range(0)]
    for row, column in np.argwhere(inlet & unseen):
        unseen[row, column] = False
        heappush(below, (-gap[row, column], row * nx + column))
    while below:
        height, waiting[0] = heappop(below)
        level, n = min(level, -height), 1
        while n:
            n -= 1
            row, column = divmod(waiting[n], nx)
            if outlet[row, column]:
                return level
            for down, right in WAYS:
                i, j = row + down, column + right
                if 0 <= i < ny and 0 <= j < nx and unseen[i, j]:
                    unseen[i, j] = False
                    if gap[i, j] >= level:
                        waiting[n] = i * nx + j
                        n += 1
                    else:
                        heappush(below, (-gap[i, j], i * nx + j))
    return 0.0


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
