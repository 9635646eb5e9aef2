"""Flow and aperture statistics of a series of states, along and across the sliding."""

from typing import Any

import numpy as np

from ..core.intervals import t_quantile
from .aperture import QUANTILES, correlation_length, rms_slope, transmissivity_bounds
from .cubic_law import Flow, plane_flow
from .network import FlowNotConverged

#: Ways of the flow: along the sliding, and across it.
WAYS = ("along", "across")
#: Why a transmissivity is zero.
NO_PATH = "no path of open cells joins both sides"

#: Numbers of the flow one way: unit, long name.
OF_WAY = {
    "transmissivity": ("mm3", "transmissivity T = h_h^3/12 per unit viscosity"),
    "hydraulic_aperture": ("mm", "hydraulic aperture h_h"),
    "critical_gap": ("mm", "narrowest gap of the widest passage"),
    "channel_fraction": ("1", "fraction of the window that carries 90 % of the flow"),
    "flow_imbalance": ("1", "bound on the relative error of T by the mass balance"),
    "flow_reason": ("1", "why T is zero or missing"),
    "series_bound": ("mm3", "lower bound of T: strips along the flow, cells in series"),
    "parallel_bound": ("mm3", "upper bound of T: strips across the flow, cells side by side"),
    "gap_correlation_length": ("mm", "lag at which the correlation of the gap falls to 1/e"),
}
#: Numbers of a state: unit, long name.
OF_APERTURE = {"gap_slope": ("1", "rms slope of the open gap")}


def axes_of(axis: str) -> dict[str, str]:
    """Axis of the flow by way, of sliding along ``axis``."""
    return dict(zip(WAYS, (axis, "y" if axis == "x" else "x"), strict=True))


def flow_of(gap: np.ndarray, spacing: tuple[float, float], axis: str) -> tuple[Flow, str]:
    """Flow along an axis, and why it is zero or missing.

    Parameters
    ----------
    gap, spacing, axis
        As of :func:`flow.cubic_law.plane_flow`.

    Returns
    -------
    flow : Flow
        Of NaN where the solver gives none that balances.
    reason : str
    """
    try:
        flow = plane_flow(gap, spacing, axis)
    except FlowNotConverged as error:
        nothing = np.full(gap.shape, np.nan)
        return Flow(np.nan, error.imbalance, np.nan, nothing, nothing), str(error)
    return flow, "" if flow.transmissivity > 0 else NO_PATH


def transmissivity_of(gap: np.ndarray, spacing: tuple[float, float], axis: str) -> float:
    """Transmissivity along an axis, mm3; NaN where the mass balance is not closed."""
    return flow_of(gap, spacing, axis)[0].transmissivity


def coarse_transmissivity(gap: np.ndarray, spacing: tuple[float, float], axis: str) -> float:
    """The same from every second cell, for the error of the grid."""
    dy, dx = spacing
    return transmissivity_of(gap[::2, ::2], (2 * dy, 2 * dx), axis)


def window_interval(
    gap: np.ndarray, spacing: tuple[float, float], axis: str, whole: float
) -> tuple[float, float]:
    """95 % interval of the geometric mean of T over windows of this size, mm3.

    T is taken for the geometric mean of the four quarters: Student's t of their ln T, as of four
    independent parts. They are that where the gap correlates over far less than a quarter.

    Parameters
    ----------
    gap, spacing, axis
        As :func:`flow_of` takes them.
    whole : float
        Transmissivity of the window, about which the interval lies.

    Returns
    -------
    low, high : float
        NaN where one of the quarters lets nothing pass.
    """
    ny, nx = (n // 2 for n in gap.shape)
    quarters = [
        gap[rows, columns]
        for rows in (slice(ny), slice(-ny, None))
        for columns in (slice(nx), slice(-nx, None))
    ]
    flows = np.array([transmissivity_of(quarter, spacing, axis) for quarter in quarters])
    if not (flows > 0).all():
        return np.nan, np.nan
    factor = np.exp(t_quantile(3) * np.log(flows).std(ddof=1) / 2)
    return whole / factor, whole * factor


def numbers_of_flow(gap: np.ndarray, spacing: tuple[float, float], axis: str) -> dict[str, Any]:
    """The :data:`OF_WAY` of a gap, and its ``flux`` map; as :func:`flow_of` takes it."""
    flow, reason = flow_of(gap, spacing, axis)
    number = "yx".index(axis)
    lower, upper = transmissivity_bounds(gap, number)
    kept = ("transmissivity", "hydraulic_aperture", "critical_gap", "channel_fraction", "flux")
    return {
        **{name: getattr(flow, name) for name in kept},
        "flow_imbalance": flow.imbalance,
        "flow_reason": reason,
        "series_bound": lower,
        "parallel_bound": upper,
        "gap_correlation_length": correlation_length(gap, spacing[number], number),
    }


def numbers_of_aperture(gap: np.ndarray, spacing: tuple[float, float]) -> dict[str, Any]:
    """The :data:`OF_APERTURE` of a gap, and its ``quantiles``, mm, at :data:`QUANTILES`."""
    return {"gap_slope": rms_slope(gap, spacing), "quantiles": np.quantile(gap, QUANTILES)}


def percolation_pressures(pressure: np.ndarray, flows: np.ndarray) -> tuple[float, float]:
    """Largest pressure with a path through the gap, and the smallest without one, MPa.

    Parameters
    ----------
    pressure, flows : (n,) ndarray
        MPa, ascending, and transmissivity, mm3; where that is NaN, it is left out.

    Returns
    -------
    last_open, first_closed : float
        NaN where none is so.
    """
    opened, closed = pressure[flows > 0], pressure[flows == 0]
    return float(np.append(np.nan, opened)[-1]), float(np.append(closed, np.nan)[0])
