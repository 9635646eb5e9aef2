"""Transmissivity of a joint by the local cubic law: div(g^3 grad p) = 0 on the open gap.

The aperture stands at the middles of the cells and contact is impermeable. The flow is the mean of
two. Faces between cells have the harmonic mean of both cubes in one, which mostly errs low,
and the conductivity of an aperture that is linear between the cells in the other, which errs high.
No flow leaves the sides of a window (it is not periodic). Zimmerman and Bodvarsson (Transp. Porous
Media 23 (1996) 1) review the law and its limits.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from ..core.estimate import Estimate
from ..core.intervals import t_quantile
from .network import Flow, FlowNotConverged, network_flow

#: Directions of the flow relative to the sliding.
WAYS = ("along", "across")
#: Power of the mean gap by which T of parallel plates grows.
GAP_POWER = 3.0


def plane_flow(
    gap: ArrayLike, spacing: tuple[float, float], axis: str = "x", faces: str = "mean"
) -> Flow:
    """Flow through a rectangular window from one side to the opposite one.

    Parameters
    ----------
    gap : (ny, nx) array_like
        g, mm, at the middles of the cells; 0 in contact. NaN is outside of the joint: closed.
    spacing : (float, float)
        Sides (dy, dx) of a cell, mm.
    axis : {"x", "y"}
        Along which the pressure falls.
    faces : {"mean", "harmonic", "linear"}
        Face values. Harmonic means alone are what most other codes take.

    Raises
    ------
    FlowNotConverged
        As :func:`flow.network.network_flow`.
    ValueError
        If a gap is negative or no gap of the window is known.
    """
    if axis == "y":
        turned = plane_flow(np.transpose(gap), spacing[::-1], faces=faces)
        return replace(turned, flux=turned.flux.T)
    opening = _checked(gap)
    (ny, nx), (dy, dx) = opening.shape, spacing
    ends = np.zeros((2, 1, nx))
    # From the middle of a cell to the end of the window is half a cell.
    ends[0, 0, 0] = ends[1, 0, -1] = 2 * dy / dx
    ends = np.broadcast_to(ends, (2, ny, nx))
    width = ny * dy
    return network_flow(opening, ends, spacing, nx * dx / width, width, faces)


def radial_flow(gap: ArrayLike, spacing: tuple[float, float], hole: float, rim: float) -> Flow:
    """Flow from a hole in the middle of a disc to its rim, as laboratories test cores.

    Parameters
    ----------
    gap : (ny, nx) array_like
        g, mm; 0 in contact, NaN closed. The disc is in the middle of the grid.
    spacing : (float, float)
        Sides (dy, dx) of a cell, mm.
    hole, rim : float
        Radii, mm.

    Returns
    -------
    Flow
        Its transmissivity is that of the parallel plates which let the same flow pass between the
        same radii, Q ln(rim/hole) / (2 pi); its ``flux`` is over the mean flow per width at the
        hole.

    Raises
    ------
    FlowNotConverged
        As :func:`flow.network.network_flow`.
    ValueError
        As :func:`plane_flow`, or if the radii are not 0 < hole < rim within the grid.

    Notes
    -----
    Between a cell and a circle that crosses the line to its neighbour the conductance is that of
    the distance to the circle.
    """
    opening = _checked(gap)
    (ny, nx), (dy, dx) = opening.shape, spacing
    y, x = dy * (np.arange(ny) - (ny - 1) / 2), dx * (np.arange(nx) - (nx - 1) / 2)
    if not 0 < hole < rim <= min(ny * dy, nx * dx) / 2:
        raise ValueError(f"hole {hole:g} mm and rim {rim:g} mm: expected 0 < hole < rim in the gap")
    radius = np.hypot(y[:, np.newaxis], x)
    between = (radius > hole) & (radius < rim)
    ends = _ends_at_circles(y[:, np.newaxis], x, spacing, (hole, rim)) * between
    length, width = np.log(rim / hole) / (2 * np.pi), 2 * np.pi * hole
    return network_flow(np.where(between, opening, 0.0), ends, spacing, length, width)


#: Smallest part of a cell that a circle cuts off: closer to it, a cell is on it.
_MIN_STEP = 1e-3


def _ends_at_circles(y, x, spacing, radii):
    """Conductances over conductivity of cells to the hole and to the rim, (2, ny, nx)."""
    dy, dx = spacing
    ends = np.zeros((2, y.size, x.size))
    for end, radius, side in zip(ends, radii, (-1, 1), strict=True):
        for down, right in ((0, dx), (0, -dx), (dy, 0), (-dy, 0)):
            # A step enters the hole by its near side, and leaves the rim by its far one.
            square, along = down**2 + right**2, y * down + x * right
            root = along**2 - square * (y**2 + x**2 - radius**2)
            part = (side * np.sqrt(np.maximum(root, 0)) - along) / square
            crossed = (root > 0) & (part > 0) & (part <= 1)
            end += np.where(crossed, dy * dx / square / np.maximum(part, _MIN_STEP), 0.0)
    return ends


def _checked(gap: ArrayLike) -> np.ndarray:
    """Copy of the gap with closed cells in place of missing ones."""
    opening = np.array(gap, float, order="C")
    missing = np.isnan(opening)
    opening[missing] = 0
    if opening.ndim != 2 or missing.all() or not 0 <= opening.min() <= opening.max() < np.inf:
        raise ValueError("gap: expected (ny, nx) finite numbers of 0 (contact) and more, or NaN")
    return opening


def flow_of(gap: np.ndarray, spacing: tuple[float, float], axis: str) -> Flow:
    """Flow as :func:`plane_flow` gives it, of NaN with the reason where it is not solved."""
    try:
        return plane_flow(gap, spacing, axis)
    except FlowNotConverged as error:
        return Flow(np.nan, error.imbalance, np.nan, np.full(gap.shape, np.nan), str(error))


def grid_error(gap: np.ndarray, spacing: tuple[float, float], axis: str, flow: Flow) -> float:
    """Grid error of T, mm3.

    The larger of half the face difference and the change where every second cell is left out.

    Parameters
    ----------
    gap, spacing, axis
        As of :func:`plane_flow`.
    flow : Flow
        Flow through the gap.
    """
    dy, dx = spacing
    coarse = flow_of(gap[::2, ::2], (2 * dy, 2 * dx), axis).transmissivity
    return float(np.fmax(flow.face_difference / 2, abs(coarse - flow.transmissivity)))


def window_interval(
    gap: np.ndarray,
    spacing: tuple[float, float],
    axis: str,
    whole: float,
    gap_error: float = 0.0,
) -> Estimate:
    """95 % interval of the geometric mean of T over windows of this size, mm3.

    Student's t of ln T of the four quarters, as of independent samples. They are independent
    where the gap correlates over far less than a quarter. Quarters of one loaded window share its
    mean gap, whose error enters :data:`GAP_POWER` times, in quadrature.

    Parameters
    ----------
    gap, spacing, axis
        As of :func:`plane_flow`.
    whole : float
        Transmissivity of the window, the centre of the interval.
    gap_error : float
        Half-width at 95 % of the mean gap over windows, as a fraction of it.

    Returns
    -------
    Estimate
        Without an interval where one of the quarters lets nothing pass.
    """
    ny, nx = (n // 2 for n in gap.shape)
    quarters = [
        gap[rows, columns]
        for rows in (slice(ny), slice(-ny, None))
        for columns in (slice(nx), slice(-nx, None))
    ]
    flows = np.array([flow_of(quarter, spacing, axis).transmissivity for quarter in quarters])
    if not (flows > 0).all():
        return Estimate(whole)
    of_quarters = t_quantile(3) * np.log(flows).std(ddof=1) / 2
    factor = np.exp(np.hypot(of_quarters, GAP_POWER * gap_error))
    return Estimate(whole, whole / factor, whole * factor)
