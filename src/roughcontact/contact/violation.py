"""Violation of the contact conditions by a state of any solver."""

import numpy as np
from scipy.signal import fftconvolve

from ..elastic.influence import love_displacement
from .state import ContactState


def violation(state: ContactState, height: np.ndarray) -> tuple[float, float]:
    """Largest violation of the contact conditions, judged by a convolution of its own.

    Parameters
    ----------
    state : ContactState
        Of a free window with Love's kernel, elastic or with one hardness.
    height : (ny, nx) ndarray
        Composite topography, mm.

    Returns
    -------
    violation, rounding : float
        Relative to the closure: distance of gaps and pressures from a state of contact, and the
        part of it that the rounding of the heights explains.

    Raises
    ------
    ValueError
        If the window is not free or has another kernel.
    """
    if not state.space.is_free or state.space.kernel != "love":
        raise ValueError("violation: expected a state of a free window with Love's kernel")
    (ny, nx), (dy, dx) = state.space.shape, state.space.spacing
    y, x = np.arange(1 - ny, ny)[:, None] * dy, np.arange(1 - nx, nx)[None, :] * dx
    kernel = love_displacement(x, y, dx, dy) / state.space.modulus
    displacement = fftconvolve(state.pressure, kernel, mode="full")[ny - 1 :, nx - 1 :][:ny, :nx]
    gap = displacement + (height.max() - height) - state.closure
    pressure, cap = state.pressure, state.hardness
    between = (pressure > 0) & (pressure < cap)
    worst = max(
        np.abs(gap[between]).max(initial=0.0),
        -gap[pressure < cap].min(initial=0.0),
        gap[pressure >= cap].max(initial=0.0),
    )
    if pressure.min() < 0 or pressure.max() > cap:
        worst = np.inf
    return worst / state.closure, 4 * np.spacing(np.abs(height).max()) / state.closure
