"""Flow through the gap of a state along one axis, and its interval over windows."""

import numpy as np

from ..core.estimate import Estimate
from ..core.intervals import t_quantile
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
