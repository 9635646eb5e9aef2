"""Eq. 6 as the figures draw it: what the size of the joint makes of the nominal pressure."""

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes

from ...domain.renormalisation import RESOLUTION, hausdorff_measure, nominal_pressure
from ..kit.domains import Loading

#: Sides b drawn, as multiples of the specimen's own: two decades.
_SIDES = np.array([0.1, 1.0, 10.0])


def fractal_pressure(scaling: xr.Dataset, key: str, delta: float) -> float:
    """sigma* = F / H_D under one load if the contact domain has the dimension ``delta``.

    Parameters
    ----------
    scaling : xr.Dataset
        Under one load.
    key : {"area", "box"}
        H_D is the geometric mean over the resolutions fitted, or that of the finest one.
    delta : float

    Returns
    -------
    float
        In N mm^-delta.
    """
    # sigma_n was kept at the resolutions that were fitted, and no others.
    fitted = scaling["area_corrected"].where(np.isfinite(scaling["sigma_n"]))
    area = fitted if key == "area" else scaling["area"].sel(resolution=[scaling.resolution.min()])
    measure = hausdorff_measure(scaling["spacing"], area, delta)
    return float(scaling["normal_force"] / np.exp(np.log(measure).mean(RESOLUTION)))


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
    scaling = loading.scaling.isel(normal_force=i)
    sides = loading.side * _SIDES
    dimensions = (estimate.value[i], estimate.low[i], estimate.high[i])
    stars = [fractal_pressure(scaling, estimate.key, delta) for delta in dimensions]
    value, *ends = (
        nominal_pressure(star, delta, sides) for star, delta in zip(stars, dimensions, strict=True)
    )
    return pd.DataFrame(
        {
            "load_N": loading.forces[i],
            "estimator": estimate.label,
            "delta_sigma": dimensions[0],
            "delta_sigma_low": dimensions[1],
            "delta_sigma_high": dimensions[2],
            "sigma_star_N_mm^-delta": stars[0],
            "b_mm": sides,
            "sigma_0_MPa": value,
            # The lines of both ends cross: which is the lower depends on b.
            "sigma_0_low_MPa": np.fmin(*ends),
            "sigma_0_high_MPa": np.fmax(*ends),
            "specimen_b_mm": loading.side,
            "specimen_sigma_0_MPa": loading.forces[i] / loading.side**2,
        }
    )


def draw_axes(axes: Axes) -> None:
    """Logarithmic axes of sigma_0 over b."""
    axes.set(xscale="log", yscale="log")
    axes.set_xlabel("side $b$ of the joint (mm)")
    axes.set_ylabel(r"nominal pressure $\sigma_0$ (MPa)")
