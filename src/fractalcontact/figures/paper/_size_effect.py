"""Eq. 6 as the figures draw it: what the size of the joint makes of the nominal pressure."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes

from ...core.estimate import Estimate
from ...domain.renormalisation import nominal_pressure
from ..kit.domains import Loading

#: Sides b drawn, as multiples of the specimen's own: two decades.
_SIDES = np.array([0.1, 1.0, 10.0])


def fractal_pressure(force: float, side: float, delta: float) -> float:
    """sigma* = F / H_D with the fractal measure H_D = b^delta of the whole joint (eq. 5).

    So sigma_0 A_0 = sigma* H_D holds on the specimen itself, and eq. 6 passes through it. The
    measure N_n s_n^delta of the pre-fractals, ``hausdorff_measure`` in the atlas, differs from it
    by a factor without dimension, which eq. 6 does not contain.

    Parameters
    ----------
    force : float
        F, N.
    side : float
        b of the specimen, mm.
    delta : float
        Dimension of the contact domain.

    Returns
    -------
    float
        In N mm^-delta.
    """
    return force / side**delta


def size_effect(loading: Loading, i: int) -> pd.DataFrame:
    """Eq. 6 under the i-th load by both estimates of Delta_sigma, and the specimen itself.

    Parameters
    ----------
    loading : Loading
    i : int

    Returns
    -------
    pd.DataFrame
        One row an estimator and side b. sigma_0 goes with Delta_sigma, its low and high with the
        ends of the interval of Delta_sigma, each with its own sigma*; NaN where there is none.
    """
    return pd.concat(
        [_by_one_estimate(loading, estimate, i) for estimate in loading.estimates],
        ignore_index=True,
    )


def _by_one_estimate(loading, estimate, i):
    force = float(loading.forces[i])
    sides = loading.side * _SIDES
    dimension = estimate[i]
    stars = [fractal_pressure(force, loading.side, delta) for delta in dimension.ends]
    value, *ends = (
        nominal_pressure(star, delta, sides)
        for star, delta in zip(stars, dimension.ends, strict=True)
    )
    # The lines of both ends cross: which is the lower depends on b.
    pressure = Estimate(value, np.fmin(*ends), np.fmax(*ends))
    return pd.DataFrame(
        {
            "load_N": force,
            "estimator": estimate.label,
            **dimension.columns("delta_sigma"),
            "sigma_star_N_mm^-delta": stars[0],
            "b_mm": sides,
            **pressure.columns("sigma_0", "MPa"),
            "specimen_b_mm": loading.side,
            "specimen_sigma_0_MPa": force / loading.side**2,
        }
    )


def draw_axes(axes: Axes) -> None:
    """Logarithmic axes of sigma_0 over b."""
    axes.set(xscale="log", yscale="log")
    axes.set_xlabel("side $b$ of the joint (mm)")
    axes.set_ylabel(r"nominal pressure $\sigma_0$ (MPa)")
