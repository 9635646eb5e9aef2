"""Flow through a grid of cells between an inlet and an outlet: solution and mass balance."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from heapq import heappop, heappush

import numpy as np
from numpy.typing import ArrayLike
from scipy import ndimage

from roughcontact.kernel_cache import njit

from ..core.text import percent
from .red_black import NEIGHBOURS, RedBlackCells, face_conductivity

#: Face values between cells, by name: whether each of the flows that are solved takes an aperture
#: linear between the cells, or harmonic means. T is the mean of these flows.
FACE_VALUES = {"harmonic": (False,), "linear": (True,), "mean": (False, True)}
#: Largest difference of T by both face values, as a fraction of their mean, on a grid that resolves
#: the flow. Beyond it no face value is known to be near the flow of a finer grid.
MAX_FACE_DIFFERENCE = 0.3
#: Fraction of the critical gap below which gaps are closed: their conductances, below 3e-14 of
#: those on the widest path by harmonic means, would cost the equations their precision.
CLOSED_BELOW = 3e-5
#: Fraction of the flow that the flow channels are said to carry.
CHANNEL_FLOW = 0.9
#: Largest relative error of a flow by the mass balance of its cells and by the narrow gaps.
MAX_IMBALANCE = 1e-6
#: Error at which iterative refinement ends, and the most steps that it takes.
AIMED_IMBALANCE = 1e-8
REFINEMENTS = 2
#: Reason of a transmissivity of zero.
NO_PATH = "no path of open cells joins both sides"


def hydraulic_aperture(transmissivity: ArrayLike) -> np.ndarray:
    """Hydraulic aperture h_h = (12 T)^(1/3), mm, of a transmissivity T, mm3."""
    return np.cbrt(12 * np.asarray(transmissivity))


@dataclass(frozen=True, eq=False)
class Flow:
    """Flow through a joint along one axis, per unit viscosity.

    Attributes
    ----------
    transmissivity : float
        T = h_h^3 / 12, mm3: the flow per unit width at unit pressure gradient and viscosity. 0
        where no path of open cells joins both ends, NaN where the equations are not solved.
    imbalance : float
        Bound on the relative error of T: by the mass balance of the cells, and by the narrow gaps
        that are closed.
    critical_gap : float
        Narrowest gap on the widest path between both ends, mm; 0 without a path.
    flux : (ny, nx) ndarray
        Flow per unit width in each cell, divided by its mean over the window.
    reason : str
        Why T is zero, missing, or not resolved by the grid.
    face_difference : float
        T by linear apertures less T by harmonic means, mm3; NaN where one of them alone is solved.
    """

    transmissivity: float
    imbalance: float
    critical_gap: float
    flux: np.ndarray
    reason: str = ""
    face_difference: float = np.nan

    @property
    def resolved(self) -> bool:
        """False where the face values differ by over :data:`MAX_FACE_DIFFERENCE` of T."""
        return not self.face_difference > MAX_FACE_DIFFERENCE * self.transmissivity

    @property
    def hydraulic_aperture(self) -> float:
        """Hydraulic aperture h_h, mm."""
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
    """The flow is not known to :data:`MAX_IMBALANCE`.

    Attributes
    ----------
    imbalance : float
        Bound on the relative error of the flow.
    """

    def __init__(self, reason: str, imbalance: float):
        super().__init__(reason, imbalance)
        self.reason, self.imbalance = reason, imbalance

    def __str__(self) -> str:
        return f"flow not solved: {self.reason}; it may be off by {self.imbalance:.3g} of itself"


def network_flow(
    gap: np.ndarray,
    ends: np.ndarray,
    spacing: tuple[float, float],
    length: float,
    width: float,
    faces: str = "mean",
) -> Flow:
    """Flow under a pressure of 1 at the inlet and 0 at the outlet, by the local cubic law.

    Parameters
    ----------
    gap : (ny, nx) ndarray
        g, mm, 0 where closed.
    ends : (2, ny, nx) ndarray
        Conductance from the middle of a cell to the inlet and to the outlet, divided by the
        conductivity g^3 of the cell; 0 for cells inside.
    spacing : (float, float)
        Sides (dy, dx) of a cell, mm.
    length : float
        Length over width of parallel plates: T is that of plates with the same flow.
    width : float
        Width that the flow is divided by for the mean of ``flux``, mm.
    faces : str
        Of :data:`FACE_VALUES`. The mean of both is not solved by itself: T and flux are means of
        two solutions, and the imbalance is the larger one.

    Raises
    ------
    FlowNotConverged
        If the flow is uncertain by more than :data:`MAX_IMBALANCE`, by the mass balance or by the
        narrow gaps that are closed.

    Notes
    -----
    The pressure p and its complement d = 1 - p are stored and refined separately. Near an end one
    of them is small; it keeps all its digits, and flows through faces are differences of the
    smaller one. If r is the imbalance of each cell, the outflow has the error sum(r d) with the
    exact d. As 0 <= d <= 1, sum(abs(r)) bounds that error for any solver.

    Over most fields the flow by harmonic means errs low and that by linear apertures high: sampled
    from a finer grid they bracket its flow, and their mean is nearer to it by a factor of 2 to 10.
    Along a wedge both err high, by their end cells.

    Gaps below :data:`CLOSED_BELOW` of the critical gap are closed, which can only lower the flow.
    By Dirichlet's principle the flow through all gaps is at most the sum of conductance times
    squared pressure drop over all faces, for any pressures. With the pressures solved, the faces
    between cells that are solved add up to the outflow, but for sum(abs(r)). The other faces, with
    pressures chosen for the cells that are not solved, bound what closing them takes away.
    """
    critical = critical_gap(gap, *(ends > 0))
    if not critical:
        return Flow(0.0, 0.0, 0.0, np.zeros_like(gap), NO_PATH)
    # Scaled by the widest gap: cubes of apertures in mm can underflow in the factorisation.
    widest = gap.max()
    relative = np.where(gap >= CLOSED_BELOW * critical, gap / widest, 0.0)
    cells = joined_cells(relative > 0, *(ends > 0))
    flows = []
    for linear in FACE_VALUES[faces]:
        network = _Network(relative, ends, cells, spacing, linear=linear)
        lost = flow_of_closed_gaps(
            gap / widest, ends, spacing, relative > 0, cells, network.pressure, linear=linear
        )
        error = network.error + lost / network.outflow
        if not error <= MAX_IMBALANCE:
            raise FlowNotConverged("too much passes through narrow gaps", error)
        transmissivity = network.outflow * length * widest**3 / 12
        flux = network.flux * (width / network.outflow)
        flows.append(Flow(transmissivity, error, critical, flux))
    return _mean_flow(flows)


def _mean_flow(flows: Sequence[Flow]) -> Flow:
    """Mean of the flows by harmonic means and by linear apertures; a single flow as it is."""
    if len(flows) == 1:
        return flows[0]
    low, high = flows
    mean = (low.transmissivity + high.transmissivity) / 2
    difference = high.transmissivity - low.transmissivity
    # Each flux is over its own mean: weighed by T they add up to flows.
    flux = (low.transmissivity * low.flux + high.transmissivity * high.flux) / (2 * mean)
    error = max(low.imbalance, high.imbalance)
    flow = Flow(mean, error, low.critical_gap, flux, face_difference=difference)
    if flow.resolved:
        return flow
    change = percent(difference / mean)
    reason = f"the grid does not resolve the flow: face values change T by {change}"
    return replace(flow, reason=reason)


class _Network:
    """Solution of the cells by one face value.

    Attributes
    ----------
    outflow : float
        Flow at unit pressure and viscosity.
    error : float
        Bound on its relative error, by the mass balance of the cells.
    pressure, flux : (ny, nx) ndarray
        Of the cells, 0 of others; the flux is the flow per unit width.
    """

    def __init__(self, relative, ends, cells, spacing, *, linear):
        try:
            network = RedBlackCells(relative, ends, cells, spacing, linear=linear)
            p = network.solve(network.ends[0])
            solution = np.stack([p, 1 - p])
            for step in range(REFINEMENTS + 1):
                # The inlet is at d = 0, the outlet at p = 0: both flows are sums of small terms.
                flows = network.ends * solution[::-1]
                inflow, outflow = flows.sum(axis=1)
                balance, passing = _balance(network.faces, network.neighbours, solution, flows)
                least, total = float(min(inflow, outflow)), float(np.abs(balance).sum())
                self.error = total / least if least > 0 else np.inf
                if self.error <= AIMED_IMBALANCE or step == REFINEMENTS:
                    break
                change = network.solve(balance)
                solution = _complementary(solution + np.stack([change, -change]))
        except ArithmeticError as failed:
            raise FlowNotConverged(f"the equations are singular ({failed})", np.inf) from failed
        if not self.error <= MAX_IMBALANCE:
            raise FlowNotConverged("the passages differ too much in width", self.error)
        self.outflow = float(outflow)
        self.pressure = np.append(solution[0], 0.0)[network.numbers]
        dy, dx = spacing
        # Half the sum of the flows through opposite faces; ends are faces too.
        flux = np.hypot(passing[0] / dx, passing[1] / dy) / 2 + flows.sum(axis=0) / (2 * dy)
        self.flux = np.append(flux, 0.0)[network.numbers]


def flow_of_closed_gaps(
    gap: np.ndarray,
    ends: np.ndarray,
    spacing: tuple[float, float],
    open_cells: np.ndarray,
    cells: np.ndarray,
    pressure: np.ndarray,
    *,
    linear: bool = False,
) -> float:
    """Upper bound of the flow that is lost where narrow gaps are closed, by Dirichlet's principle.

    Parameters
    ----------
    gap, ends, spacing
        As of :func:`network_flow`; the flow is that of the conductivity gap^3.
    linear
        As of :func:`flow.red_black.face_conductivity`.
    open_cells, cells : (ny, nx) bool ndarray
        Cells that are not closed, and those of them that are solved.
    pressure : (ny, nx) ndarray
        Of the cells that are solved.

    Notes
    -----
    A narrow gap has the pressure of the nearest cell that is solved. Open cells that only narrow
    gaps join to the others have one pressure a pool: that of the end which the pool touches, else
    the mean of those nearest. So each face with a pressure drop has a narrow gap on one side.
    """
    if not ((gap > 0) & ~open_cells).any():
        return 0.0
    nearest = ndimage.distance_transform_edt(~cells, return_distances=False, return_indices=True)
    pools, n = ndimage.label(open_cells & ~cells)
    means = ndimage.mean(pressure[tuple(nearest)], pools, np.arange(n + 1))
    at_inlet, at_outlet = (np.unique(pools[end > 0]) for end in ends)
    means[at_inlet], means[at_outlet] = 1.0, 0.0
    pressure = np.where(pools > 0, means[pools], pressure[tuple(nearest)])
    unsolved = ~cells & (gap > 0)
    drops = ends[0] * (1 - pressure) ** 2 + ends[1] * pressure**2
    lost = float((gap * gap * gap * drops)[unsolved].sum())
    dy, dx = spacing
    for axis, ratio in enumerate((dx / dy, dy / dx)):
        g, p, counts = (np.moveaxis(of, axis, 0) for of in (gap, pressure, unsolved))
        faces = (g[1:] > 0) & (g[:-1] > 0) & (counts[1:] | counts[:-1])
        face = ratio * face_conductivity(g[1:][faces], g[:-1][faces], linear)
        lost += float(face @ np.diff(p, axis=0)[faces] ** 2)
    return lost


def joined_cells(open_cells: np.ndarray, inlet: np.ndarray, outlet: np.ndarray) -> np.ndarray:
    """Mask (ny, nx) of the open cells in clusters that touch both ends.

    Parameters
    ----------
    open_cells, inlet, outlet : (ny, nx) bool ndarray
        Open cells, cells at the inlet and cells at the outlet.
    """
    labels, _ = ndimage.label(open_cells)
    joined = np.intersect1d(labels[inlet], labels[outlet])
    return np.isin(labels, joined[joined > 0])


@njit(cache=True)
def critical_gap(gap: np.ndarray, inlet: np.ndarray, outlet: np.ndarray) -> float:
    """Critical gap of percolation, mm: the narrowest gap on the widest path between both ends.

    Cells are reached from the inlet, the widest first, until one lies at the outlet; the narrowest
    of those reached is the critical gap. It is 0 where no path of open cells joins both ends.

    Parameters
    ----------
    gap : (ny, nx) ndarray
        mm, 0 where closed.
    inlet, outlet : (ny, nx) bool ndarray
        Cells at the ends.
    """
    ny, nx = gap.shape
    unseen, waiting, n = gap > 0, np.empty(gap.size, np.int32), 0
    # Neighbours narrower than the level wait in a heap until it falls to the widest of them.
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
            for down, right in NEIGHBOURS:
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
    """Pressure and complement; the larger of the two is one minus the smaller."""
    p, d = solution
    low = p < d
    return np.stack([np.where(low, p, 1 - d), np.where(low, 1 - p, d)])


@njit(cache=True)
def _balance(faces, neighbours, solution, flows):
    """Net flow into each cell (n,), and sums of the flows through its faces in y and x (2, n).

    A flow is the difference of p, or of d, whichever is smaller in the black cell.
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
            # NEIGHBOURS are up, left, right, down.
            onwards = flow if way > 1 else -flow
            direction = 0 if way in (0, 3) else 1
            passing[direction, cell] += onwards
            passing[direction, other] += onwards
    return net, passing
