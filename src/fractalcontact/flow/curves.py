"""Flow through the gap of a state along one axis, with the errors of its grid and window."""

from typing import Any

import numpy as np

from ..core.estimate import Estimate
from ..core.intervals import t_quantile
from .aperture import correlation_length, transmissivity_bounds
from .cubic_law import plane_flow
from .network import Flow, FlowNotConverged

#: Ways of the flow: along the sliding, and across it.
WAYS = ("along", "across")
#: Why a transmissivity is zero.
NO_PATH = "no path of open cells joins both sides"


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
        return Flow(np.nan, error.imbalance, np.nan, np.full(gap.shape, np.nan)), str(error)
    return flow, "" if flow.transmissivity > 0 else NO_PATH


def transmissivity_of(gap: np.ndarray, spacing: tuple[float, float], axis: str) -> float:
    """Transmissivity along an axis, mm3; NaN where the mass balance is not closed."""
    return flow_of(gap, spacing, axis)[0].transmissivity


def window_interval(
    gap: np.ndarray, spacing: tuple[float, float], axis: str, whole: float
) -> Estimate:
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
    Estimate
        Without an interval where one of the quarters lets nothing pass.
    """
    ny, nx = (n // 2 for n in gap.shape)
    quarters = [
        gap[rows, columns]
        for rows in (slice(ny), slice(-ny, None))
        for columns in (slice(nx), slice(-nx, None))
    ]
    flows = np.array([transmissivity_of(quarter, spacing, axis) for quarter in quarters])
    if not (flows > 0).all():
        return Estimate(whole)
    factor = np.exp(t_quantile(3) * np.log(flows).std(ddof=1) / 2)
    return Estimate(whole, whole / factor, whole * factor)


def numbers_of_flow(
    gap: np.ndarray, spacing: tuple[float, float], axis: str, *, errors: bool
) -> dict[str, Any]:
    """Numbers of the flow along an axis, as the stage flow names them, and its ``flux`` map.

    Parameters
    ----------
    gap, spacing, axis
        As :func:`flow_of` takes them.
    errors : bool
        Whether T has its interval and ``transmissivity_grid_error``: six more solves.
    """
    flow, reason = flow_of(gap, spacing, axis)
    number, whole = "yx".index(axis), flow.transmissivity
    lower, upper = transmissivity_bounds(gap, number)
    coarse = np.nan
    if errors:
        coarse = transmissivity_of(gap[::2, ::2], (2 * spacing[0], 2 * spacing[1]), axis)
    return {
        "transmissivity": window_interval(gap, spacing, axis, whole) if errors else Estimate(whole),
        "transmissivity_grid_error": abs(coarse - whole),
        "critical_gap": flow.critical_gap,
        "channel_fraction": flow.channel_fraction,
        "flux": flow.flux,
        "flow_imbalance": flow.imbalance,
        "flow_reason": reason,
        "series_bound": lower,
        "parallel_bound": upper,
        "gap_correlation_length": correlation_length(gap, spacing[number], number),
    }


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
